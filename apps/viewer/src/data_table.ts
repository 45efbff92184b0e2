// A table of texts on the page, with rows that may be chosen by pointer and by key.

import { make } from "./dom";

export interface DataRow {
  cells: string[];
  chosen?: boolean;
  action?: () => void;
}

export function dataTable(head: string[], rows: DataRow[]): HTMLElement {
  const lines = rows.map(({ cells, chosen, action }) => {
    const line = make("tr", { class: chosen ? "chosen" : "" }, ...cells.map((cell) => make("td", {}, cell)));
    if (action) {
      line.tabIndex = 0;
      line.addEventListener("click", action);
      line.addEventListener("keydown", (event) => event.key === "Enter" && action());
    }
    return line;
  });
  const top = head.length > 0 ? [make("tr", {}, ...head.map((name) => make("th", {}, name)))] : [];
  return make("div", { class: "scroll" }, make("table", {}, ...top, ...lines));
}
