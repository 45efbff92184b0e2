// The tab with the rows as a table: what any analysis has, also one this page does not know.

import { DataRow, dataTable } from "./data_table";
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
  const head = columns.map((c) => withUnit(names[c], table.unit(c)));
  const lines: DataRow[] = [];
  for (let row = 0; row < rows; row += step) {
    const number = table.numberOf(row);
    lines.push({ cells: columns.map((c) => table.text(c, row)), action: () => chosen(number) });
  }
  const said: string[] = [];
  if (step > 1) said.push(`every ${step}th of ${rows} rows`);
  if (names.length > mostColumns) said.push(`the first ${mostColumns} of ${names.length} columns`);
  root.append(make("p", { class: "note" }, said.length > 0 ? `Shown: ${said.join(", ")}. ` : "",
                   button("CSV", "save all rows and columns as CSV",
                          () => save(`${name}.csv`, table.csv(names.map((_, k) => k)), "text/csv"))),
              dataTable(head, lines));
  return root;
}
