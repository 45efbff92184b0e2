// Units in which numbers are shown. The data are in SI; the document names those that are to be others.

import { ShownUnit } from "./contract";
import { short } from "./ticks";

export class Units {
  private readonly known: Map<string, ShownUnit>;

  constructor(shown: Record<string, ShownUnit>) {
    this.known = new Map(Object.entries(shown));
  }

  /** Of numbers that are in this unit of the SI; "1" and "" have none. */
  of(si: string): ShownUnit {
    return this.known.get(si) ?? { unit: si === "1" ? "" : si, factor: 1 };
  }

  has(si: string): boolean {
    return this.known.has(si);
  }

  get any(): boolean {
    return this.known.size > 0;
  }

  /** A number in SI for people, with its unit. */
  text(value: number, si: string): string {
    const { unit, factor } = this.of(si);
    return unit ? `${short(factor * value)} ${unit}` : short(factor * value);
  }
}
