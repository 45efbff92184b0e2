// What happens on the way: events, singular instants, critical points; and which parts of a path are unstable.

import { Analysis } from "./contract";
import { Motion } from "./motion";
import { PlotMark } from "./plot";
import { Table } from "./table";

export interface Mark extends PlotMark {
  /** Its instant, s, where it has one. */
  t?: number;
}

export function marksOf(motion: Motion): Mark[] {
  const marks: Mark[] = [];
  const rowAt = (t: number) => (motion.timed ? motion.rowNumber(motion.poseAt(t)) : 0);
  for (const key of ["events", "singular", "critical"]) {
    const records = motion.analysis.fields[key];
    if (!Array.isArray(records)) continue;
    for (const record of records as Record<string, unknown>[]) {
      const t = typeof record.t === "number" ? record.t : undefined;
      const row = typeof record.row === "number" ? record.row : t === undefined ? 0 : rowAt(t);
      const words = [record.name, record.kind].filter((word) => typeof word === "string");
      marks.push({ row, t, label: words.join(" ").replace(/_/g, " ") || key });
    }
  }
  return marks;
}

/** By row of the table; null where the analysis does not tell. */
export function unstableRows(analysis: Analysis, table: Table): boolean[] | null {
  const negative = analysis.fields.negative_modes;
  if (!Array.isArray(negative)) return null;
  return Array.from({ length: table.rows }, (_, k) => Number(negative[table.numberOf(k)] ?? 0) > 0);
}
