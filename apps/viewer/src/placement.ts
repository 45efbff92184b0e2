// Where a shape stands at a configuration: the same frames (origin, e_u, e_v) as in
// lib/catena/drawing/shapes/placement.hpp.

import { Drawing } from "./contract";
import { RopeWay } from "./rope";

export interface Placement {
  x: number;
  y: number;
  ux: number;
  uy: number;
  vx: number;
  vy: number;
}

/** Coordinates of bodies with their trigonometry; body -1 is the ground. */
export class Pose {
  readonly cosine: Float64Array;
  readonly sine: Float64Array;

  constructor(readonly q: Float64Array) {
    this.cosine = new Float64Array(q.length / 3);
    this.sine = new Float64Array(q.length / 3);
  }

  update(): void {
    for (let b = 0; b < this.cosine.length; ++b) {
      this.cosine[b] = Math.cos(this.q[3 * b + 2]);
      this.sine[b] = Math.sin(this.q[3 * b + 2]);
    }
  }

  pointX(body: number, u: number, v: number): number {
    return body < 0 ? u : this.q[3 * body] + this.cosine[body] * u - this.sine[body] * v;
  }

  pointY(body: number, u: number, v: number): number {
    return body < 0 ? v : this.q[3 * body + 1] + this.sine[body] * u + this.cosine[body] * v;
  }
}

export const anchorBody = 0;
export const anchorPoint = 1;
export const anchorSpan = 2;
const anchorRope = 4;

/** The shapes of a drawing as arrays of numbers: a picture of 10^5 links reads each of them. */
export class ShapeTable {
  readonly count: number;
  readonly anchor: Uint8Array;
  readonly symbol: Int32Array;
  readonly element: Int32Array;
  readonly bodyI: Int32Array;
  readonly bodyJ: Int32Array;
  /** x, y on body i, then on body j. */
  readonly at: Float64Array;
  /** By shape. */
  readonly ropes = new Map<number, RopeWay>();

  constructor({ shapes, ropes }: Drawing) {
    this.count = shapes.length;
    this.anchor = Uint8Array.from(shapes, (shape) => shape[0]);
    this.symbol = Int32Array.from(shapes, (shape) => shape[1]);
    this.element = Int32Array.from(shapes, (shape) => shape[2]);
    this.bodyI = Int32Array.from(shapes, (shape) => shape[3]);
    this.bodyJ = Int32Array.from(shapes, (shape) => shape[6]);
    this.at = new Float64Array(4 * shapes.length);
    shapes.forEach((shape, k) => this.at.set([shape[4], shape[5], shape[7], shape[8]], 4 * k));
    shapes.forEach((shape, k) => {
      if (shape[0] !== anchorRope) return;
      const rope = ropes?.[shape[3]];
      if (rope) this.ropes.set(k, new RopeWay(rope));
      // Its corners are places on the ground.
      this.anchor[k] = anchorBody;
      this.bodyI[k] = -1;
    });
  }

  /** The body whose colour a shape has. */
  bodyOf(k: number): number {
    return this.anchor[k] === anchorPoint && this.bodyJ[k] >= 0 ? this.bodyJ[k] : this.bodyI[k];
  }

  /** `size`: that of symbols, m. */
  place(k: number, pose: Pose, size: number, out: Placement): void {
    const anchor = this.anchor[k];
    const i = this.bodyI[k];
    const j = this.bodyJ[k];
    const at = 4 * k;
    out.x = pose.pointX(i, this.at[at], this.at[at + 1]);
    out.y = pose.pointY(i, this.at[at], this.at[at + 1]);
    if (anchor === anchorBody) {
      out.ux = i < 0 ? 1 : pose.cosine[i];
      out.uy = i < 0 ? 0 : pose.sine[i];
      out.vx = -out.uy;
      out.vy = out.ux;
      return;
    }
    const xj = this.at[at + 2];
    const yj = this.at[at + 3];
    if (anchor === anchorPoint) {
      const c = j < 0 ? 1 : pose.cosine[j];
      const s = j < 0 ? 0 : pose.sine[j];
      out.ux = size * (c * xj - s * yj);
      out.uy = size * (s * xj + c * yj);
      out.vx = -out.uy;
      out.vy = out.ux;
      return;
    }
    const hx = pose.pointX(j, xj, yj) - out.x;
    const hy = pose.pointY(j, xj, yj) - out.y;
    const length = Math.sqrt(hx * hx + hy * hy);
    const acrossX = length > 0 ? -hy / length : 0;
    const acrossY = length > 0 ? hx / length : 1;
    const span = anchor === anchorSpan;
    out.ux = span ? hx : acrossY;
    out.uy = span ? hy : -acrossX;
    out.vx = span ? size * acrossX : acrossX;
    out.vy = span ? size * acrossY : acrossY;
  }
}
