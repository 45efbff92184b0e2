// The buttons upon the mechanism, and the bar that shows how long a metre is.

import { arrowKinds } from "./arrows";
import { button, byId, make } from "./dom";
import { save, saveCanvas } from "./files";
import type { Page } from "./page";
import { short } from "./ticks";

const units = { velocities: "m/s", reactions: "N", loads: "N" };
const names = { velocities: "velocities", reactions: "reactions", loads: "forces" };

export function makeStageTools(page: Page): void {
  const { stage, data } = page;
  const tools = byId("stage-tools");
  tools.replaceChildren(
      button("fit", "show everything (f)", () => stage.fit()),
      button("PNG", "save the picture as PNG", () => saveCanvas(`${data.scene}.png`, stage.picture(page.player.clock))),
      button("SVG", "save the picture as SVG",
             () => save(`${data.scene}.svg`, stage.svg(page.player.clock), "image/svg+xml")));
  const shown = arrowKinds.filter((kind) => stage.arrows.has(kind));
  for (const kind of shown) {
    const box = make("input", { type: "checkbox" });
    box.checked = stage.shownArrows.has(kind);
    box.addEventListener("change", () => {
      if (box.checked) stage.shownArrows.add(kind);
      else stage.shownArrows.delete(kind);
      page.redraw();
    });
    const most = `${short(stage.arrows.largestOf(kind))} ${units[kind]}`;
    tools.append(make("label", { title: `the longest arrow is ${most}` }, box, ` ${names[kind]} ≤ ${most}`));
  }
  if (shown.length > 0) tools.append(arrowLength(page));
}

function arrowLength(page: Page): HTMLElement {
  const range = { min: "-1.5", max: "1.5", step: "0.1" };
  const scale = make("input", { type: "range", "aria-label": "length of arrows", ...range });
  scale.value = String(Math.log10(page.stage.arrowScale));
  scale.addEventListener("input", () => {
    page.stage.arrowScale = Math.pow(10, Number(scale.value));
    page.redraw();
  });
  return make("label", { title: "length of arrows" }, "↔ ", scale);
}

/** A round length of at most 120 px. `scale`: px a metre. */
export function drawScaleBar(scale: number): void {
  const power = Math.pow(10, Math.floor(Math.log10(120 / scale)));
  const length = [5, 2, 1].map((factor) => factor * power).find((l) => l * scale <= 120) ?? power;
  const bar = byId("scale-bar");
  bar.style.width = `${length * scale}px`;
  const millimetres = length < 1 && length >= 1e-3;
  bar.replaceChildren(make("span", {}, millimetres ? `${short(1000 * length)} mm` : `${short(length)} m`));
}
