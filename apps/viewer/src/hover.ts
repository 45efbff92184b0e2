// What is said of a body or an element under the pointer: name, type, values with units.

import { make } from "./dom";
import { Highlight } from "./mechanism";
import { Motion } from "./motion";
import { Table } from "./table";
import { short } from "./ticks";

const mostValues = 9;

export function describe(motion: Motion, table: Table, row: number,
                         owner: Highlight): (Node | string)[] {
  const isElement = owner.element >= 0;
  const { elements, bodies } = motion.names;
  const name = isElement ? elements.name[owner.element] : bodies[owner.body] ?? "ground";
  const type = isElement ? elements.types[elements.type[owner.element]] : "body";
  const lines: string[] = [];
  if (!isElement && owner.body >= 0) {
    const q = motion.pose.q;
    const [x, y, angle] = [q[3 * owner.body], q[3 * owner.body + 1], q[3 * owner.body + 2]];
    lines.push(`centroid ${short(x)}, ${short(y)} m`, `angle ${short((angle * 180) / Math.PI)}°`);
  }
  table.names.forEach((column, k) => {
    if (lines.length >= mostValues || !column.startsWith(`${name}.`) || row < 0) return;
    lines.push(`${column.slice(name.length + 1)} = ${table.text(k, row)} ${table.unit(k)}`);
  });
  return [make("b", {}, name), ` ${type}`, ...lines.map((line) => make("div", {}, line))];
}
