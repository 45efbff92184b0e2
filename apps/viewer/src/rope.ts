// Where a rope runs at a configuration: the same corners as in lib/catena/drawing/shapes/rope_points.hpp.

import { Rope } from "./contract";
import { Pose } from "./placement";

const arcPieces = 32;
/** An arc this little short of a whole turn is none. */
const noContact = 0.01;
/** Above this angle of contact a rope passes its circle if both stretches are long enough to cross there. */
const mostContact = (4 * Math.PI) / 3;

type Circle = { x: number; y: number; radius: number };

function direction(from: Circle, to: Circle): { ux: number; uy: number; length: number } {
  const [hx, hy] = [to.x - from.x, to.y - from.y];
  const offset = to.radius - from.radius;
  const square = hx * hx + hy * hy;
  const length = Math.sqrt(square - offset * offset);
  return { ux: (length * hx + offset * hy) / square, uy: (length * hy - offset * hx) / square, length };
}

/** Angle of contact of a circle; below zero the rope from a to b would have to cross itself to touch it. */
function contactBetween(a: Circle, between: Circle, b: Circle): number {
  const before = direction(a, between);
  const after = direction(between, b);
  let contact = Math.atan2(before.ux * after.uy - before.uy * after.ux, before.ux * after.ux + before.uy * after.uy);
  if (between.radius < 0) contact = -contact;
  if (contact < 0) contact += 2 * Math.PI;
  const needed = Math.abs(between.radius) * Math.tan((2 * Math.PI - contact) / 2);
  const crosses = contact > mostContact && before.length > needed && after.length > needed;
  return crosses ? contact - 2 * Math.PI : contact;
}

/** The circles without those that the rope passes, of those before `last`, where its own way ends. */
function touched(circles: Circle[], last: number): Circle[] {
  const off = circles.map(() => false);
  // Each pass changes one, that which is wrong by most.
  for (let pass = 0; pass < 2 * circles.length; ++pass) {
    let changed = 0;
    let worst = 0;
    for (let k = 1; k < last; ++k) {
      if (circles[k].radius === 0) continue;
      let [a, b] = [k - 1, k + 1];
      while (off[a]) --a;
      while (off[b]) ++b;
      const contact = contactBetween(circles[a], circles[k], circles[b]);
      const wrong = off[k] ? (contact < Math.PI ? contact : 0) : -contact;
      if (!(wrong > worst)) continue;
      worst = wrong;
      changed = k;
    }
    if (changed === 0) break;
    off[changed] = !off[changed];
  }
  return circles.filter((_, k) => !off[k]);
}

/** A way over `nodes` circles, each with body, x, y and radius. */
export class RopeWay {
  readonly nodes: number;
  private readonly points: Float64Array;

  constructor(private readonly rope: Rope) {
    this.nodes = rope.nodes.length / 4;
    let corners = 0;
    for (let k = 0; k + 1 < this.nodes; ++k) {
      if (k > 0 && rope.nodes[4 * k + 3] !== 0) corners += arcPieces - 1;
      corners += this.isLast(k) ? 1 : 2;
    }
    this.points = new Float64Array(2 * corners);
  }

  /** How many corners it has in every pose. */
  get corners(): number {
    return this.points.length / 2;
  }

  /** After the last circle of its own: the next node says only how far that one is touched. */
  private isLast(k: number): boolean {
    return this.rope.leads_on && k + 2 === this.nodes;
  }

  /** Corners x, y in turn, m; not finite where there is no straight line between two circles. They stand until the next
   * call. */
  at(pose: Pose): Float64Array {
    const { points } = this;
    const { nodes } = this.rope;
    const all: Circle[] = [];
    for (let k = 0; k < this.nodes; ++k) {
      const n = 4 * k;
      all.push({
        x: pose.pointX(nodes[n], nodes[n + 1], nodes[n + 2]),
        y: pose.pointY(nodes[n], nodes[n + 1], nodes[n + 2]),
        radius: nodes[n + 3],
      });
    }
    const circles = touched(all, this.nodes - (this.rope.leads_on ? 2 : 1));
    let at = 0;
    let [beforeX, beforeY] = [0, 0];
    const add = ({ x, y, radius }: Circle, ux: number, uy: number) => {
      points[at++] = x + radius * uy;
      points[at++] = y - radius * ux;
    };
    for (let k = 0; k + 1 < circles.length; ++k) {
      const [circle, next] = [circles[k], circles[k + 1]];
      const { ux, uy } = direction(circle, next);
      if (k > 0 && circle.radius !== 0) {
        const sense = Math.sign(circle.radius);
        let contact = sense * Math.atan2(beforeX * uy - beforeY * ux, beforeX * ux + beforeY * uy);
        if (contact < -noContact) contact += 2 * Math.PI;
        for (let m = 1; m < arcPieces; ++m) {
          const turned = (sense * contact * m) / arcPieces;
          const [c, s] = [Math.cos(turned), Math.sin(turned)];
          add(circle, c * beforeX - s * beforeY, s * beforeX + c * beforeY);
        }
      }
      add(circle, ux, uy);
      if (!this.rope.leads_on || k + 2 < circles.length) add(next, ux, uy);
      [beforeX, beforeY] = [ux, uy];
    }
    // As many corners in every pose.
    for (; at < points.length; ++at) points[at] = points[at - 2];
    return points;
  }
}
