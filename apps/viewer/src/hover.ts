// What is said of a body or an element under the pointer: name, type, values with units.

import { make } from "./dom";
import { Highlight } from "./mechanism";
import { Motion } from "./motion";
import { Table } from "./table";
import { short } from "./ticks";

const mostValues = 9;

/** Where a body is and how it moves, at the pose that is shown. */
function ofBody(motion: Motion, body: number, pose: number): string[] {
  const { units } = motion;
  const q = motion.pose.q;
  const [x, y, angle] = [q[3 * body], q[3 * body + 1], q[3 * body + 2]];
  const { unit, factor } = units.of("m");
  const turned = units.has("rad") ? units.text(angle, "rad") : `${short((angle * 180) / Math.PI)}°`;
  const lines = [`centroid ${short(factor * x)}, ${short(factor * y)} ${unit}`, `angle ${turned}`];
  const v = motion.velocities;
  const at = 3 * (motion.names.bodies.length * pose + body);
  if (v && isFinite(v[at])) lines.push(`speed ${units.text(Math.hypot(v[at], v[at + 1]), "m/s")}`);
  return lines;
}

/** What a joint or a driver exerts on its second body. */
function ofElement(motion: Motion, element: number, pose: number): string[] {
  const { reactions, units } = motion;
  const elements = motion.analysis.poses.reactions?.elements ?? [];
  const k = elements.indexOf(element);
  if (!reactions || k < 0) return [];
  const at = 4 * (elements.length * pose + k);
  const size = Math.hypot(reactions[at + 2], reactions[at + 3]);
  return isFinite(size) ? [`force ${units.text(size, "N")}`] : [];
}

export function describe(motion: Motion, table: Table, row: number, pose: number, owner: Highlight): (Node | string)[] {
  const isElement = owner.element >= 0;
  const { elements, bodies } = motion.names;
  const name = isElement ? elements.name[owner.element] : bodies[owner.body] ?? "ground";
  const type = isElement ? elements.types[elements.type[owner.element]] : "body";
  const lines = isElement ? ofElement(motion, owner.element, pose) : owner.body >= 0 ? ofBody(motion, owner.body, pose) : [];
  table.names.forEach((column, k) => {
    if (lines.length >= mostValues || !column.startsWith(`${name}.`) || row < 0) return;
    lines.push(`${column.slice(name.length + 1)} = ${table.text(k, row)} ${table.unit(k)}`);
  });
  return [make("b", {}, name), ` ${type}`, ...lines.map((line) => make("div", {}, line))];
}
