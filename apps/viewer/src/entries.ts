// What can be chosen on the page: the analyses of the run, and those of the two designs of an optimisation.

import { Analysis, Design, PageData } from "./contract";
import { unanalysed } from "./unanalysed";

export interface Behind {
  name: string;
  analysis: Analysis;
}

export interface Entry {
  label: string;
  /** Whose rows and report are shown. */
  analysis: Analysis;
  /** Whose poses are shown: its own, or those of one of its designs. */
  moving: Analysis;
  /** The same of another design, drawn faintly behind. */
  behind: Behind | null;
}

/** The last analysis of a design that went through poses. */
export function posedOf(design: Design): Analysis | null {
  return design.analyses.filter(({ poses }) => poses.count > 0).pop() ?? null;
}

function label(number: number, analysis: Analysis): string {
  const outcome = analysis.status === "ok" ? "" : `: ${analysis.status}`;
  return `${number} ${analysis.type}${outcome}`;
}

/** The analyses inside an optimisation, of the start and of what was found: each has the other behind it. */
function ofDesigns(number: number, designs: Design[]): Entry[] {
  return designs.flatMap((design) => design.analyses.map((analysis, k) => {
    const other = designs.find((one) => one !== design);
    const same = other?.analyses[k];
    const behind = other && same && same.poses.count > 0 ? { name: other.name, analysis: same } : null;
    return { label: `${number} ${design.name}: ${analysis.type}`, analysis, moving: analysis, behind };
  }));
}

export function entriesOf(data: PageData): Entry[] {
  if (data.analyses.length === 0) {
    const given = unanalysed();
    return [{ label: "none: as given", analysis: given, moving: given, behind: null }];
  }
  return data.analyses.flatMap((analysis, k) => {
    const entry: Entry = { label: label(k + 1, analysis), analysis, moving: analysis, behind: null };
    const designs = analysis.designs ?? [];
    if (analysis.type !== "optimise") {
      const first = designs.map(posedOf).find((posed) => posed !== null);
      return [first ? { ...entry, moving: first } : entry];
    }
    const inside = ofDesigns(k + 1, designs);
    const best = designs[designs.length - 1] as Design | undefined;
    const shown = best && posedOf(best);
    const behind = inside.find(({ analysis: one }) => one === shown)?.behind ?? null;
    return [shown ? { ...entry, moving: shown, behind } : entry, ...inside];
  });
}
