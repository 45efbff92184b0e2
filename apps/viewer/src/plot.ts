// One plot: columns over a column, with zoom, cursor, extremes and marks.

import { Painter } from "./painter";
import { Table, withUnit } from "./table";
import { css, Theme } from "./theme";
import { along, Axis, rangeOf, ticksOf, valueAt } from "./ticks";

export interface PlotMark {
  row: number;
  label: string;
}

const left = 58;
const right = 14;
const top = 8;
const bottom = 34;

export class Plot {
  logX = false;
  logY = false;
  /** Points instead of lines, for rows in no order. */
  scatter = false;
  private zoomX: Axis | null = null;
  private zoomY: Axis | null = null;
  width = 320;
  height = 180;

  constructor(readonly table: Table, public x: number, public ys: number[], private readonly marks: PlotMark[],
              private readonly unstable: boolean[] | null) {}

  resetZoom(): void {
    this.zoomX = null;
    this.zoomY = null;
  }

  get axisX(): Axis {
    return this.zoomX ?? rangeOf([this.table.values(this.x)], this.logX);
  }

  get axisY(): Axis {
    return this.zoomY ?? rangeOf(this.ys.map((y) => this.table.values(y)), this.logY);
  }

  zoom(factor: number, px: number, py: number): void {
    const scaled = (axis: Axis, place: number): Axis => ({
      first: valueAt(axis, place - place / factor),
      last: valueAt(axis, place + (1 - place) / factor),
      log: axis.log,
    });
    const u = (px - left) / (this.width - left - right);
    const v = 1 - (py - top) / (this.height - top - bottom);
    this.zoomX = scaled(this.axisX, Math.min(1, Math.max(0, u)));
    this.zoomY = scaled(this.axisY, Math.min(1, Math.max(0, v)));
  }

  pan(dx: number, dy: number): void {
    const moved = (axis: Axis, by: number): Axis => ({
      first: valueAt(axis, by), last: valueAt(axis, 1 + by), log: axis.log,
    });
    this.zoomX = moved(this.axisX, -dx / (this.width - left - right));
    this.zoomY = moved(this.axisY, dy / (this.height - top - bottom));
  }

  pageX(axis: Axis, value: number): number {
    return left + along(axis, value) * (this.width - left - right);
  }

  pageY(axis: Axis, value: number): number {
    return top + (1 - along(axis, value)) * (this.height - top - bottom);
  }

  /** The row whose point of the first line is nearest to a place; -1 without rows. */
  rowNear(px: number, py: number): number {
    const [ax, ay] = [this.axisX, this.axisY];
    const xs = this.table.values(this.x);
    const rising = this.isRising(xs);
    let best = -1;
    let least = Infinity;
    for (const y of this.ys.slice(0, 1)) {
      const ys = this.table.values(y);
      for (let k = 0; k < xs.length; ++k) {
        const dx = this.pageX(ax, xs[k]) - px;
        const dy = rising ? 0 : this.pageY(ay, ys[k]) - py;
        const away = dx * dx + dy * dy;
        if (away < least) {
          least = away;
          best = k;
        }
      }
    }
    return best;
  }

  private isRising(values: ArrayLike<number>): boolean {
    for (let k = 1; k < values.length; ++k) if (!(values[k] >= values[k - 1])) return false;
    return true;
  }

  /** All but the cursor. */
  draw(painter: Painter, theme: Theme): void {
    const [ax, ay] = [this.axisX, this.axisY];
    this.axes(painter, theme, ax, ay);
    this.clip(painter);
    const xs = this.table.values(this.x);
    this.ys.forEach((y, k) => this.line(painter, theme, ax, ay, xs, this.table.values(y), k));
    this.drawMarks(painter, theme, ax, ay, xs);
    painter.unclip();
  }

  drawCursor(painter: Painter, theme: Theme, row: number): void {
    const xs = this.table.values(this.x);
    if (row < 0 || row >= xs.length) return;
    const [ax, ay] = [this.axisX, this.axisY];
    this.clip(painter);
    const px = this.pageX(ax, xs[row]);
    painter.path([px, top, px, this.height - bottom], false, { stroke: css(theme.accent), width: 1 });
    this.ys.forEach((y, k) => {
      const py = this.pageY(ay, this.table.values(y)[row]);
      painter.circle(px, py, 3.4, { fill: theme.line(k), stroke: css(theme.paper) });
    });
    painter.unclip();
  }

  private clip(painter: Painter): void {
    painter.clip(left, top, this.width - left - right, this.height - top - bottom);
  }

  private axes(painter: Painter, theme: Theme, ax: Axis, ay: Axis): void {
    const ink = css(theme.faint);
    const grid = css(theme.grid);
    const floor = this.height - bottom;
    const tx = ticksOf(ax, Math.max(2, Math.floor((this.width - left - right) / 70)));
    tx.at.forEach((value, k) => {
      const px = this.pageX(ax, value);
      painter.path([px, top, px, floor], false, { stroke: grid });
      painter.text(px, floor + 13, tx.labels[k], { size: 10.5, colour: ink, anchor: "middle" });
    });
    const ty = ticksOf(ay, Math.max(2, Math.floor((floor - top) / 32)));
    ty.at.forEach((value, k) => {
      const py = this.pageY(ay, value);
      painter.path([left, py, this.width - right, py], false, { stroke: grid });
      painter.text(left - 5, py + 3.5, ty.labels[k], { size: 10.5, colour: ink, anchor: "end" });
    });
    painter.path([left, top, this.width - right, top, this.width - right, floor, left, floor], true,
                 { stroke: css(theme.faint), width: 1 });
    const name = withUnit(this.table.name(this.x), this.table.unit(this.x));
    painter.text((left + this.width - right) / 2, this.height - 6, name,
                 { size: 11, colour: css(theme.ink), anchor: "middle" });
    const units = [...new Set(this.ys.map((y) => this.table.unit(y)))].filter((unit) => unit);
    if (units.length > 0)
      painter.text(12, (top + floor) / 2, `[${units.join(", ")}]`,
                   { size: 11, colour: css(theme.ink), anchor: "middle", upwards: true });
  }

  private line(painter: Painter, theme: Theme, ax: Axis, ay: Axis, xs: ArrayLike<number>, ys: ArrayLike<number>,
               k: number): void {
    const colour = theme.line(k);
    const points = new Float64Array(2 * xs.length);
    for (let row = 0; row < xs.length; ++row) {
      points[2 * row] = this.pageX(ax, xs[row]);
      points[2 * row + 1] = this.pageY(ay, ys[row]);
    }
    // A line of one point, between gaps, would not be seen.
    const shown = (row: number) => isFinite(points[2 * row] + points[2 * row + 1]);
    const alone = (row: number) => shown(row) && !shown(row - 1) && !shown(row + 1);
    for (let row = 0; row < xs.length; ++row) {
      if (this.scatter || alone(row)) painter.circle(points[2 * row], points[2 * row + 1], 2.5, { fill: colour });
    }
    if (!this.scatter && this.unstable) {
      this.partsByStability(painter, points, colour);
    } else if (!this.scatter) {
      painter.path(points, false, { stroke: colour, width: 1.6, dash: k >= 7 ? [6, 4] : undefined });
    }
    this.extremes(painter, points, ys, colour);
  }

  /** Stable parts solid, unstable ones dashed. */
  private partsByStability(painter: Painter, points: Float64Array, colour: string): void {
    const unstable = this.unstable as boolean[];
    let first = 0;
    for (let row = 1; row <= unstable.length && 2 * row <= points.length; ++row) {
      if (row < unstable.length && unstable[row] === unstable[first]) continue;
      const last = Math.min(row, points.length / 2 - 1);
      const dash = unstable[first] ? [5, 4] : undefined;
      painter.path(points.subarray(2 * first, 2 * last + 2), false, { stroke: colour, width: 1.8, dash });
      first = row;
    }
  }

  private extremes(painter: Painter, points: Float64Array, ys: ArrayLike<number>, colour: string): void {
    if (ys.length < 3 || this.scatter) return;
    let [low, high] = [-1, -1];
    for (let row = 0; row < ys.length; ++row) {
      if (!isFinite(ys[row])) continue;
      if (low < 0 || ys[row] < ys[low]) low = row;
      if (high < 0 || ys[row] > ys[high]) high = row;
    }
    // What differs by rounding alone is constant.
    const size = low < 0 ? 0 : Math.max(Math.abs(ys[low]), Math.abs(ys[high]));
    if (low < 0 || ys[high] - ys[low] <= 1e-7 * size) return;
    for (const row of [low, high]) painter.circle(points[2 * row], points[2 * row + 1], 2.6, { fill: colour });
  }

  private drawMarks(painter: Painter, theme: Theme, ax: Axis, ay: Axis, xs: ArrayLike<number>): void {
    // Where they crowd, as blows of a bouncing ball, a label that would cover another is left out.
    const labels: { x: number; y: number; width: number }[] = [];
    const widthOf = (label: string) => 6 * label.length;
    const end = this.width - right;
    for (const mark of this.marks) {
      const row = this.table.rowAt(mark.row);
      if (row < 0 || this.ys.length === 0) continue;
      const px = this.pageX(ax, xs[row]);
      const py = this.pageY(ay, this.table.values(this.ys[0])[row]);
      painter.circle(px, py, 5, { stroke: css(theme.warning), width: 2 });
      const width = widthOf(mark.label);
      // Near the end of the axis it stands to the left of its mark.
      const label = { x: px + 7 + width > end ? px - 7 - width : px + 7, y: py - 6, width };
      const covers = labels.some((other) => Math.abs(other.y - label.y) < 11 && label.x < other.x + other.width &&
                                            other.x < label.x + label.width);
      if (covers) continue;
      labels.push(label);
      painter.text(label.x, label.y, mark.label, { size: 10.5, colour: css(theme.warning) });
    }
  }

  /** Names and values at a row, for the legend. */
  legend(row: number): { name: string; value: string; unit: string }[] {
    return this.ys.map((y) => {
      const value = row >= 0 && row < this.table.rows ? this.table.text(y, row) : "–";
      return { name: this.table.name(y), value, unit: this.table.unit(y) };
    });
  }
}
