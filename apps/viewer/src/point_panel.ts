// The tab with the points whose paths may be drawn.

import { make } from "./dom";
import type { Page } from "./page";
import { Trace } from "./traces";

const mostBodies = 500;
const mostPoints = 1000;

export function pointPanel(page: Page, named: Trace[]): HTMLElement {
  const root = make("div", {}, make("p", { class: "note" }, "Points whose paths are drawn."));
  const centroids = page.motion.names.bodies.slice(0, mostBodies)
      .map((name, body) => ({ body, u: 0, v: 0, name: `${name} (centroid)`, owner: name, point: "" }));
  for (const point of [...named, ...centroids].slice(0, mostPoints)) {
    const box = make("input", { type: "checkbox" });
    box.checked = page.stage.traces.some((trace) => trace.name === point.name);
    box.addEventListener("change", () => {
      page.stage.traces = page.stage.traces.filter((trace) => trace.name !== point.name);
      if (box.checked) page.stage.traces.push(point);
      page.redraw();
    });
    root.append(make("div", {}, make("label", {}, box, ` ${point.name}`)));
  }
  return root;
}
