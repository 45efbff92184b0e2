// Parallel coordinates: an axis a column, a line a row. Shows which designs of a sweep go with which results.

import { Painter } from "./painter";
import { Table, withUnit } from "./table";
import { css, Theme } from "./theme";
import { along, Axis, short } from "./ticks";

const mostAxes = 10;
const mostLines = 3000;
const side = 46;
const top = 34;
const bottom = 18;

function exactRange(values: ArrayLike<number>): Axis {
  const axis = { first: Infinity, last: -Infinity, log: false };
  for (let k = 0; k < values.length; ++k) {
    if (!isFinite(values[k])) continue;
    axis.first = Math.min(axis.first, values[k]);
    axis.last = Math.max(axis.last, values[k]);
  }
  return axis;
}

export class ParallelPlot {
  width = 320;
  readonly height = 230;
  private readonly columns: number[];
  private readonly axes: Axis[];
  private readonly step: number;

  /** Columns that are constant tell nothing of the rows; the number of the design, the first one, neither. */
  constructor(private readonly table: Table) {
    const candidates = table.numeric(Infinity).filter((k) => k > 0 || table.names[0] !== "design");
    const varies = (column: number) => {
      const values = table.values(column);
      for (let k = 1; k < values.length; ++k) if (isFinite(values[k]) && values[k] !== values[0]) return true;
      return false;
    };
    this.columns = candidates.filter(varies).slice(0, mostAxes);
    this.axes = this.columns.map((column) => exactRange(table.values(column)));
    this.step = Math.max(1, Math.ceil(table.rows / mostLines));
  }

  get worthwhile(): boolean {
    return this.columns.length >= 3;
  }

  private axisX(k: number): number {
    return side + (k * (this.width - 2 * side)) / (this.columns.length - 1);
  }

  private pageY(k: number, row: number): number {
    const value = this.table.values(this.columns[k])[row];
    return top + (1 - along(this.axes[k], value)) * (this.height - top - bottom);
  }

  private points(row: number): number[] {
    return this.columns.flatMap((_, k) => [this.axisX(k), this.pageY(k, row)]);
  }

  draw(painter: Painter, theme: Theme): void {
    for (let row = 0; row < this.table.rows; row += this.step)
      painter.path(this.points(row), false, { stroke: css(theme.faint), width: 0.5 });
    this.columns.forEach((column, k) => {
      const x = this.axisX(k);
      painter.path([x, top, x, this.height - bottom], false, { stroke: css(theme.ink), width: 1.2 });
      const name = withUnit(this.table.names[column], this.table.unit(column));
      const text = { size: 10.5, colour: css(theme.ink), anchor: "middle" as const };
      painter.text(x, k % 2 === 0 ? 10 : 22, name, text);
      painter.text(x, this.height - 5, short(this.axes[k].first), { ...text, colour: css(theme.faint) });
      painter.text(x, top - 3, short(this.axes[k].last), { ...text, size: 9, colour: css(theme.faint) });
    });
  }

  drawCursor(painter: Painter, theme: Theme, cursor: number): void {
    if (cursor >= 0 && cursor < this.table.rows)
      painter.path(this.points(cursor), false, { stroke: css(theme.accent), width: 2.5 });
  }

  /** The row whose line passes nearest to a place. */
  rowNear(px: number, py: number): number {
    const gap = this.axisX(1) - this.axisX(0);
    const k = Math.min(this.columns.length - 2, Math.max(0, Math.floor((px - side) / gap)));
    const part = (px - this.axisX(k)) / gap;
    let best = -1;
    let least = Infinity;
    for (let row = 0; row < this.table.rows; ++row) {
      const away = Math.abs((1 - part) * this.pageY(k, row) + part * this.pageY(k + 1, row) - py);
      if (away < least) {
        least = away;
        best = row;
      }
    }
    return best;
  }
}
