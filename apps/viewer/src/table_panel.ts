// The tab with the rows as a table: what any analysis has, also one this page does not know.

import { button, make } from "./dom";
import { save } from "./files";
import { Table, withUnit } from "./table";

const mostRows = 300;
const mostColumns = 40;

export function tablePanel(table: Table, name: string, chosen: (row: number) => void): HTMLElement {
  const root = make("div");
  const { names, rows } = table;
  if (names.length === 0 || rows === 0) return make("p", { class: "note" }, "This analysis has no rows.");
  const columns = names.map((_, k) => k).slice(0, mostColumns);
  const step = Math.max(1, Math.ceil(rows / mostRows));
  const body: HTMLElement[] = [
    make("tr", {}, ...columns.map((c) => make("th", {}, withUnit(names[c], table.unit(c))))),
  ];
  for (let row = 0; row < rows; row += step) {
    const line = make("tr", { tabindex: "0" }, ...columns.map((c) => make("td", {}, table.text(c, row))));
    const number = table.numberOf(row);
    line.addEventListener("click", () => chosen(number));
    line.addEventListener("keydown", (event) => event.key === "Enter" && chosen(number));
    body.push(line);
  }
  const said: string[] = [];
  if (step > 1) said.push(`every ${step}th of ${rows} rows`);
  if (names.length > mostColumns) said.push(`the first ${mostColumns} of ${names.length} columns`);
  root.append(make("p", { class: "note" }, said.length > 0 ? `Shown: ${said.join(", ")}. ` : "",
                   button("CSV", "save all rows and columns as CSV",
                          () => save(`${name}.csv`, table.csv(names.map((_, k) => k)), "text/csv"))),
              make("div", { class: "scroll" }, make("table", {}, ...body)));
  return root;
}
