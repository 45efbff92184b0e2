// The buttons upon the mechanism, and the bar that shows how long a metre is.

import { ArrowKind, arrowColour, arrowKinds } from "./arrows";
import { button, byId, make } from "./dom";
import { save, saveCanvas } from "./files";
import type { Page } from "./page";
import { short } from "./ticks";
import { Units } from "./units";

const units: Record<ArrowKind, string> = { velocities: "m/s", reactions: "N", loads: "N" };
const names: Record<ArrowKind, string> = { velocities: "velocities", reactions: "reactions", loads: "forces" };

export function makeStageTools(page: Page): void {
  const { stage, data } = page;
  const tools = byId("stage-tools");
  tools.replaceChildren(
      button("fit", "show everything (f)", () => stage.fit()),
      button("PNG", "save the picture as PNG", () => saveCanvas(`${data.scene}.png`, stage.picture(page.player.clock))),
      button("SVG", "save the picture as SVG",
             () => save(`${data.scene}.svg`, stage.svg(page.player.clock), "image/svg+xml")));
  if (page.motion.names.bodies.length === 0)
    tools.append(make("span", { class: "said" }, "the scene has no bodies: there is nothing to draw"));
  if (page.designName) tools.append(make("span", { class: "said", id: "design" }, page.designName));
  const shown = arrowKinds.filter((kind) => stage.arrows.has(kind));
  for (const kind of shown) {
    const box = make("input", { type: "checkbox" });
    box.checked = stage.shownArrows.has(kind);
    box.addEventListener("change", () => {
      if (box.checked) stage.shownArrows.add(kind);
      else stage.shownArrows.delete(kind);
      page.redraw();
    });
    const most = page.motion.units.text(stage.arrows.largestOf(kind), units[kind]);
    const swatch = make("i", { class: "swatch" });
    swatch.style.background = arrowColour(kind, stage.theme);
    tools.append(make("label", { title: `the longest arrow is ${most}` }, box, " ", swatch, `${names[kind]} ≤ ${most}`));
  }
  if (shown.length > 0) tools.append(arrowLength(page));
  const { poses } = page.motion.analysis;
  if (poses.count > 0 && !poses.arrows)
    tools.append(make("span", { class: "said", title: "velocities and forces of so many would make the page too large" },
                      "too many bodies for arrows"));
  tools.append(make("span", { class: "said", id: "arrow-note", hidden: true },
                    "many arrows: only those of what is pointed at; zoom in for all"));
  if (stage.behind) tools.append(behindChoice(page, stage.behind.name));
}

/** Whether the other design is drawn as well, faintly. */
function behindChoice(page: Page, name: string): HTMLElement {
  const box = make("input", { type: "checkbox", id: "behind" });
  box.checked = page.stage.showBehind;
  box.addEventListener("change", () => {
    page.stage.showBehind = box.checked;
    page.redraw();
  });
  return make("label", { title: `${name}, drawn faintly (b)` }, box, ` ${name}, faint`);
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

/** A round length of at most 120 px, in the unit of lengths, else in m or mm. `scale`: px a metre. */
export function drawScaleBar(scale: number, shown: Units): void {
  const { unit, factor } = shown.of("m");
  const pixels = scale / factor;
  const power = Math.pow(10, Math.floor(Math.log10(120 / pixels)));
  const length = [5, 2, 1].map((round) => round * power).find((l) => l * pixels <= 120) ?? power;
  const bar = byId("scale-bar");
  bar.style.width = `${length * pixels}px`;
  const millimetres = !shown.has("m") && length < 1 && length >= 1e-3;
  bar.replaceChildren(make("span", {}, millimetres ? `${short(1000 * length)} mm` : `${short(length)} ${unit}`));
}
