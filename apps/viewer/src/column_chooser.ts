// Which columns a plot shows: a list with boxes, and a search for pages of thousands of columns.

import { make } from "./dom";
import { Plot } from "./plot";

export const mostListed = 400;

export function columnChooser(plot: Plot, changed: () => void): HTMLElement {
  const search = make("input", { type: "search", placeholder: "search columns", "aria-label": "search columns" });
  const items = make("div");
  const fill = () => {
    items.replaceChildren();
    const wanted = search.value.toLowerCase();
    const found = plot.table.names.map((name, k) => ({ name, k }))
        .filter(({ name, k }) => plot.table.hasNumbers(k) && name.toLowerCase().includes(wanted));
    for (const { name, k } of found.slice(0, mostListed)) {
      const box = make("input", { type: "checkbox" });
      box.checked = plot.ys.includes(k);
      box.addEventListener("change", () => {
        plot.ys = box.checked ? [...plot.ys, k] : plot.ys.filter((y) => y !== k);
        changed();
      });
      items.append(make("label", {}, box, " ", name));
    }
    const more = found.length - mostListed;
    if (more > 0) items.append(make("p", { class: "note" }, `${more} more: search`));
  };
  search.addEventListener("input", fill);
  fill();
  return make("div", { class: "chooser" }, search, items);
}
