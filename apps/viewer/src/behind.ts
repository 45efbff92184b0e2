// Another mechanism drawn faintly behind the one that is shown: the other design of an optimisation.

import { Camera } from "./camera";
import { MechanismPainter, nothing } from "./mechanism";
import { Motion } from "./motion";
import { Painter } from "./painter";
import { ShapeTable } from "./placement";
import { css, Theme } from "./theme";
import { Trace, Traces } from "./traces";

/** How visible it is. */
const faint = 0.35;

export class MechanismBehind {
  private readonly painter: MechanismPainter;
  private readonly traces: Traces;

  constructor(readonly name: string, readonly motion: Motion) {
    const drawing = motion.data.drawings[motion.analysis.drawing];
    this.painter = new MechanismPainter(drawing, new ShapeTable(drawing), new Set());
    this.traces = new Traces(motion);
  }

  get shapes(): number {
    return this.motion.data.drawings[this.motion.analysis.drawing].shapes.length;
  }

  /** To the time of the one in front, or as far on its way where there is none. */
  moveWith(front: Motion, clock: number, swing: number): void {
    const { motion } = this;
    const part = front.end > front.begin ? (clock - front.begin) / (front.end - front.begin) : 0;
    motion.moveTo(front.timed && motion.timed ? clock : motion.begin + part * (motion.end - motion.begin), swing);
  }

  extent(low: [number, number], high: [number, number]): void {
    this.painter.extent(this.motion.pose, low, high);
  }

  draw(painter: Painter, camera: Camera, theme: Theme, traces: Trace[]): void {
    painter.fade(faint);
    this.painter.draw(painter, camera, this.motion.pose, theme, nothing, null);
    for (const trace of traces) {
      const { points } = this.traces.onPage(trace, camera);
      painter.path(points, false, { stroke: css(theme.ink), width: 1.6, dash: [6, 4] });
    }
    painter.fade(1);
  }
}
