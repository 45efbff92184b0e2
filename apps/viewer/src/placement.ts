// Where a shape stands at a configuration: the same frames (origin, e_u, e_v) as lib/catena/drawing/shapes/placement.hpp.

import { Shape } from "./contract";

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

const anchorBody = 0;
const anchorPoint = 1;
const anchorSpan = 2;

/** `size`: that of symbols, m. */
export function place(shape: Shape, pose: Pose, size: number, out: Placement): void {
  const [anchor, , , i, xi, yi, j, xj, yj] = shape;
  out.x = pose.pointX(i, xi, yi);
  out.y = pose.pointY(i, xi, yi);
  if (anchor === anchorBody) {
    out.ux = i < 0 ? 1 : pose.cosine[i];
    out.uy = i < 0 ? 0 : pose.sine[i];
    out.vx = -out.uy;
    out.vy = out.ux;
  } else if (anchor === anchorPoint) {
    const c = j < 0 ? 1 : pose.cosine[j];
    const s = j < 0 ? 0 : pose.sine[j];
    out.ux = size * (c * xj - s * yj);
    out.uy = size * (s * xj + c * yj);
    out.vx = -out.uy;
    out.vy = out.ux;
  } else {
    const hx = pose.pointX(j, xj, yj) - out.x;
    const hy = pose.pointY(j, xj, yj) - out.y;
    const length = Math.hypot(hx, hy);
    const acrossX = length > 0 ? -hy / length : 0;
    const acrossY = length > 0 ? hx / length : 1;
    const span = anchor === anchorSpan;
    out.ux = span ? hx : acrossY;
    out.uy = span ? hy : -acrossX;
    out.vx = span ? size * acrossX : acrossX;
    out.vy = span ? size * acrossY : acrossY;
  }
}
