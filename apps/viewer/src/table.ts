// The columns of an analysis as arrays, decoded when they are first asked for.

import { Analysis } from "./contract";
import { decodeNumbers } from "./decode";
import { short } from "./ticks";

export class Table {
  private readonly known = new Map<number, ArrayLike<number>>();

  constructor(readonly analysis: Analysis) {}

  get names(): string[] {
    return this.analysis.columns.map((column) => column.name);
  }

  get rows(): number {
    return this.analysis.rows.count;
  }

  unit(column: number): string {
    const unit = this.analysis.columns[column].unit;
    return unit === "1" ? "" : unit;
  }

  values(column: number): ArrayLike<number> {
    let values = this.known.get(column);
    if (!values) {
      values = decodeNumbers(this.analysis.columns[column].values);
      this.known.set(column, values);
    }
    return values;
  }

  /** Whether values have a place along an axis: words have none. */
  hasNumbers(column: number): boolean {
    return this.analysis.columns[column].words === undefined;
  }

  /** The columns that can be plotted, `most` at most. */
  numeric(most: number): number[] {
    return this.names.map((_, k) => k).filter((k) => this.hasNumbers(k)).slice(0, most);
  }

  /** A value for people. */
  text(column: number, row: number): string {
    const value = this.values(column)[row];
    return this.analysis.columns[column].words?.[String(value)] ?? short(value);
  }

  find(name: string): number {
    return this.analysis.columns.findIndex((column) => column.name === name);
  }

  /** The kept row nearest to row `number` of the analysis. */
  rowAt(number: number): number {
    const { count, total, stride } = this.analysis.rows;
    if (number >= total - 1) return count - 1;
    return Math.min(count - 1, Math.round(number / stride));
  }

  /** The number among all rows of the analysis of the kept row k. */
  numberOf(k: number): number {
    const { count, total, stride } = this.analysis.rows;
    return k >= count - 1 ? total - 1 : k * stride;
  }

  csv(columns: number[]): string {
    const quoted = (name: string) => (/[",\r\n]/.test(name) ? `"${name.replace(/"/g, '""')}"` : name);
    const lines = [columns.map((c) => quoted(this.analysis.columns[c].name)).join(",")];
    const cell = (c: number, k: number) => {
      const value = this.values(c)[k];
      if (!this.hasNumbers(c)) return quoted(this.text(c, k));
      return isFinite(value) ? String(value) : "";
    };
    for (let k = 0; k < this.rows; ++k) lines.push(columns.map((c) => cell(c, k)).join(","));
    return lines.join("\r\n") + "\r\n";
  }
}

export function withUnit(name: string, unit: string): string {
  return unit ? `${name} [${unit}]` : name;
}
