// The columns of an analysis as arrays, decoded when they are first asked for.

import { Analysis } from "./contract";
import { decodeNumbers } from "./decode";
import { short } from "./ticks";
import { Units } from "./units";

/** Stands for the number of a row where a column is asked for: iterates of an optimisation have no column that counts. */
export const rowNumber = -1;

export class Table {
  private readonly known = new Map<number, ArrayLike<number>>();

  constructor(readonly analysis: Analysis, private readonly units: Units) {}

  get names(): string[] {
    return this.analysis.columns.map((column) => column.name);
  }

  get rows(): number {
    return this.analysis.rows.count;
  }

  name(column: number): string {
    if (column === rowNumber) return this.analysis.type === "optimise" ? "iterate" : "row";
    return this.analysis.columns[column].name;
  }

  unit(column: number): string {
    return column === rowNumber ? "" : this.units.of(this.analysis.columns[column].unit).unit;
  }

  values(column: number): ArrayLike<number> {
    let values = this.known.get(column);
    if (!values) {
      values = column === rowNumber ? Float64Array.from({ length: this.rows }, (_, k) => this.numberOf(k))
                                    : this.shown(column);
      this.known.set(column, values);
    }
    return values;
  }

  /** As they are shown: in units that need not be those of the data. */
  private shown(column: number): ArrayLike<number> {
    const { unit, values } = this.analysis.columns[column];
    const { factor } = this.units.of(unit);
    const numbers = decodeNumbers(values);
    return factor === 1 ? numbers : numbers.map((value) => factor * value);
  }

  /** Whether values have a place along an axis: words have none. */
  hasNumbers(column: number): boolean {
    return column === rowNumber || this.analysis.columns[column].words === undefined;
  }

  /** The columns that can be plotted, `most` at most. */
  numeric(most: number): number[] {
    return this.names.map((_, k) => k).filter((k) => this.hasNumbers(k)).slice(0, most);
  }

  /** A value for people. */
  text(column: number, row: number): string {
    const value = this.values(column)[row];
    const words = column === rowNumber ? undefined : this.analysis.columns[column].words;
    return words?.[String(value)] ?? short(value);
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
    const lines = [columns.map((c) => quoted(this.name(c))).join(",")];
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
