// Where a rope runs at a configuration: the same corners as in lib/catena/drawing/shapes/rope_points.hpp.

import { Rope } from "./contract";
import { Pose } from "./placement";

const arcPieces = 32;
/** An arc this little short of a whole turn is none. */
const noContact = 0.01;

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
    let at = 0;
    let [beforeX, beforeY] = [0, 0];
    const add = (x: number, y: number, radius: number, ux: number, uy: number) => {
      points[at++] = x + radius * uy;
      points[at++] = y - radius * ux;
    };
    let x = pose.pointX(nodes[0], nodes[1], nodes[2]);
    let y = pose.pointY(nodes[0], nodes[1], nodes[2]);
    for (let k = 0; k + 1 < this.nodes; ++k) {
      const n = 4 * (k + 1);
      const radius = nodes[n - 1];
      const nextX = pose.pointX(nodes[n], nodes[n + 1], nodes[n + 2]);
      const nextY = pose.pointY(nodes[n], nodes[n + 1], nodes[n + 2]);
      const [hx, hy] = [nextX - x, nextY - y];
      const offset = nodes[n + 3] - radius;
      const square = hx * hx + hy * hy;
      const length = Math.sqrt(square - offset * offset);
      const ux = (length * hx + offset * hy) / square;
      const uy = (length * hy - offset * hx) / square;
      if (k > 0 && radius !== 0) {
        const sense = Math.sign(radius);
        let contact = sense * Math.atan2(beforeX * uy - beforeY * ux, beforeX * ux + beforeY * uy);
        if (contact < -noContact) contact += 2 * Math.PI;
        for (let m = 1; m < arcPieces; ++m) {
          const turned = (sense * contact * m) / arcPieces;
          const [c, s] = [Math.cos(turned), Math.sin(turned)];
          add(x, y, radius, c * beforeX - s * beforeY, s * beforeX + c * beforeY);
        }
      }
      add(x, y, radius, ux, uy);
      if (!this.isLast(k)) add(nextX, nextY, nodes[n + 3], ux, uy);
      [x, y, beforeX, beforeY] = [nextX, nextY, ux, uy];
    }
    return points;
  }
}
