// Keys: everything that a pointer does on the page.

import { byId, make } from "./dom";
import type { Page } from "./page";
import { speeds } from "./player";

const keys: [string, string][] = [
  ["space", "play, pause"],
  ["← →", "one row back, on; with shift ten"],
  ["home, end", "to the first, the last row"],
  ["[ ]", "slower, faster"],
  ["l", "loop"],
  ["+ −", "zoom in, out"],
  ["alt and arrows", "pan"],
  ["f", "show everything"],
  ["+ − f, alt and arrows on a plot", "the same there"],
  ["← → on parallel axes", "from design to design"],
  ["n, p", "next, previous analysis"],
  ["m", "next mode"],
  [". ,", "choose the next, the previous body or element"],
  ["enter", "plot the columns of what is chosen"],
  ["b", "the other design behind, of an optimisation"],
  ["1 2 3 4", "plots, report, table, points"],
  ["d", "dark, light"],
  ["?", "this list"],
];

function pan(page: Page, key: string): boolean {
  const step = 40;
  const by: Record<string, [number, number]> = {
    ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step],
  };
  if (!by[key]) return false;
  page.stage.camera.pan(...by[key]);
  page.redraw();
  return true;
}

function faster(page: Page, by: number): void {
  const at = speeds.indexOf(page.player.speed) + by;
  page.player.setSpeed(speeds[Math.min(speeds.length - 1, Math.max(0, at))]);
}

function zoom(page: Page, factor: number): void {
  page.stage.camera.zoom(factor, page.stage.camera.width / 2, page.stage.camera.height / 2);
  page.redraw();
}

function nextAnalysis(page: Page, by: number): void {
  const { entries } = page;
  const count = entries.length;
  if (count > 1) page.showEntry(entries[(entries.indexOf(page.entry) + by + count) % count]);
}

function toggleBehind(page: Page): void {
  page.stage.showBehind = !page.stage.showBehind;
  const box = document.getElementById("behind");
  if (box instanceof HTMLInputElement) box.checked = page.stage.showBehind;
  page.redraw();
}

function act(page: Page, event: KeyboardEvent): boolean {
  const { player, motion } = page;
  if (event.altKey) return pan(page, event.key);
  const rows = event.shiftKey ? 10 : 1;
  const actions: Record<string, () => void> = {
    " ": () => player.toggle(),
    ArrowLeft: () => player.step(-rows),
    ArrowRight: () => player.step(rows),
    Home: () => (player.pause(), player.moveTo(motion.begin)),
    End: () => (player.pause(), player.moveTo(motion.end)),
    "[": () => faster(page, -1),
    "]": () => faster(page, 1),
    l: () => player.setLoop(!player.loop),
    "+": () => zoom(page, 1.25),
    "=": () => zoom(page, 1.25),
    "-": () => zoom(page, 0.8),
    f: () => page.stage.fit(),
    n: () => nextAnalysis(page, 1),
    p: () => nextAnalysis(page, -1),
    m: () => motion.shapes.length > 0 && page.showShape((motion.shape + 1) % motion.shapes.length),
    "1": () => page.showTab("plots"),
    "2": () => page.showTab("report"),
    "3": () => page.showTab("table"),
    "4": () => page.showTab("points"),
    d: () => page.toggleTheme(),
    b: () => toggleBehind(page),
    ".": () => page.choice.step(1),
    ",": () => page.choice.step(-1),
    Enter: () => page.choice.plot(),
    "?": () => byId<HTMLDialogElement>("help").showModal(),
  };
  const action = actions[event.key];
  if (!action) return false;
  action();
  return true;
}

export function listenToKeys(page: Page): void {
  const help = byId<HTMLDialogElement>("help");
  const rows = keys.map(([key, what]) => make("tr", {}, make("td", {}, key), make("td", {}, what)));
  help.append(make("h2", {}, "keys"), make("table", {}, ...rows),
              make("form", { method: "dialog" }, make("button", {}, "close")));
  byId("help-button").addEventListener("click", () => help.showModal());
  addEventListener("keydown", (event) => {
    const target = event.target instanceof Element ? event.target : document.body;
    const typing = target.matches("input[type=search], select, dialog *");
    // What has the focus takes its own keys: buttons and rows the space bar, sliders the arrows. Those of the time bar
    // go by rows, as everywhere on the page.
    const pressed = target.matches("button, input, tr") && (event.key === " " || event.key === "Enter");
    const slid = target.matches("input[type=range]:not(#clock)") && /^(Arrow|Home|End|Page)/.test(event.key);
    if (typing || pressed || slid || event.ctrlKey || event.metaKey) return;
    if (act(page, event)) event.preventDefault();
  });
}
