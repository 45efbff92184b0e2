// What the pointer is at and what was chosen: lit on the stage, described in a box, its columns plotted.

import { byId } from "./dom";
import { describe } from "./hover";
import { Highlight, nothing } from "./mechanism";
import type { Page } from "./page";

export class Choice {
  private chosen: Highlight = nothing;
  private readonly box = byId("hover");

  constructor(private readonly page: Page) {}

  clear(): void {
    this.chosen = nothing;
    this.page.stage.lit = nothing;
    this.box.hidden = true;
  }

  /** `shape` -1: the pointer is at nothing. */
  pointAt(shape: number, x: number, y: number): void {
    const { stage } = this.page;
    stage.lit = shape >= 0 ? stage.ownerOf(shape) : this.chosen;
    this.box.hidden = shape < 0;
    if (shape >= 0) this.describe(stage.lit, x, y);
    this.page.redraw();
  }

  private describe(owner: Highlight, x: number, y: number): void {
    const { motion, poseTable, player, stage } = this.page;
    const pose = motion.nearestPose(player.clock);
    const row = poseTable.rowAt(motion.rowNumber(pose));
    this.box.hidden = false;
    this.box.replaceChildren(...describe(motion, poseTable, row, pose, owner));
    const { width, height } = stage.camera;
    this.box.style.left = `${Math.max(0, Math.min(x + 14, width - this.box.offsetWidth - 6))}px`;
    this.box.style.top = `${Math.max(0, Math.min(y + 14, height - this.box.offsetHeight - 6))}px`;
  }

  choose(shape: number): void {
    this.chosen = shape < 0 ? nothing : this.page.stage.ownerOf(shape);
    this.page.stage.lit = this.chosen;
    this.plot();
    this.page.redraw();
  }

  /** The next body or element in the order of the scene, as a pointer would find it. */
  step(by: number): void {
    const { bodies, elements } = this.page.motion.names;
    const count = bodies.length + elements.name.length;
    if (count === 0) return;
    const { body, element } = this.chosen;
    const now = element >= 0 ? bodies.length + element : body >= 0 ? body : by > 0 ? -1 : count;
    const next = (now + by + count) % count;
    this.chosen = next < bodies.length ? { body: next, element: -1 } : { body: nothing.body, element: next - bodies.length };
    this.page.stage.lit = this.chosen;
    // Below the buttons, where a pointer need not be.
    this.describe(this.chosen, 0, byId("stage-tools").offsetHeight);
    this.page.redraw();
  }

  /** A plot of the columns of what is chosen. */
  plot(): void {
    const { elements, bodies } = this.page.motion.names;
    const { element, body } = this.chosen;
    const name = element >= 0 ? elements.name[element] : bodies[body];
    if (name !== undefined) this.page.plots.showColumnsOf(name);
  }
}
