// Arrows of velocities, reactions and applied forces, each kind with a scale of its own: the longest of the whole run
// is `longest` px at the scale 1.

import { Camera } from "./camera";
import { Motion } from "./motion";
import { Painter } from "./painter";
import { Theme } from "./theme";

const longest = 90;

export type ArrowKind = "velocities" | "reactions" | "loads";
export const arrowKinds: ArrowKind[] = ["velocities", "reactions", "loads"];

const colours: Record<ArrowKind, [string, string]> = {
  velocities: ["#00796b", "#4fd1b5"],
  reactions: ["#b02a2a", "#ff8a8a"],
  loads: ["#7b3fa0", "#d0a0f0"],
};

export class Arrows {
  private readonly largest: Record<ArrowKind, number>;

  constructor(private readonly motion: Motion) {
    const { velocities, reactions, loads } = motion;
    this.largest = {
      velocities: largestPair(velocities, 3, 0),
      reactions: largestPair(reactions, 4, 2),
      loads: largestPair(loads, 2, 0),
    };
  }

  has(kind: ArrowKind): boolean {
    return this.largest[kind] > 0;
  }

  largestOf(kind: ArrowKind): number {
    return this.largest[kind];
  }

  draw(kind: ArrowKind, painter: Painter, camera: Camera, theme: Theme, pose: number, factor: number): void {
    const colour = colours[kind][theme.dark ? 1 : 0];
    const scale = (factor * longest) / this.largest[kind];
    this.visit(kind, pose, (x, y, fx, fy, towards) => {
      arrow(painter, camera.toPageX(x), camera.toPageY(y), fx * scale, -fy * scale, towards, colour);
    });
  }

  private visit(kind: ArrowKind, pose: number,
                f: (x: number, y: number, fx: number, fy: number, towards: boolean) => void): void {
    const { data, analysis } = this.motion;
    const bodies = this.motion.names.bodies.length;
    const now = this.motion.pose;
    if (kind === "velocities" && this.motion.velocities) {
      const at = 3 * bodies * pose;
      for (let b = 0; b < bodies; ++b) {
        const v = this.motion.velocities;
        f(now.q[3 * b], now.q[3 * b + 1], v[at + 3 * b], v[at + 3 * b + 1], false);
      }
    } else if (kind === "reactions" && this.motion.reactions && analysis.poses.reactions) {
      const count = analysis.poses.reactions.elements.length;
      for (let k = 4 * count * pose; k < 4 * count * (pose + 1); k += 4) {
        const r = this.motion.reactions;
        f(r[k], r[k + 1], r[k + 2], r[k + 3], false);
      }
    } else if (kind === "loads" && this.motion.loads) {
      const loads = data.drawings[analysis.drawing].loads;
      loads.forEach((load, k) => {
        const values = this.motion.loads as ArrayLike<number>;
        const fx = values[2 * (loads.length * pose + k)];
        const fy = values[2 * (loads.length * pose + k) + 1];
        const c = load.in_body_axes ? now.cosine[load.body] : 1;
        const s = load.in_body_axes ? now.sine[load.body] : 0;
        const [u, v] = load.point;
        f(now.pointX(load.body, u, v), now.pointY(load.body, u, v), c * fx - s * fy, s * fx + c * fy, true);
      });
    }
  }
}

function largestPair(values: ArrayLike<number> | null, stride: number, offset: number): number {
  let largest = 0;
  for (let k = offset; values && k + 1 < values.length; k += stride) {
    const length = Math.hypot(values[k], values[k + 1]);
    if (isFinite(length)) largest = Math.max(largest, length);
  }
  return largest;
}

/** `towards`: the tip is at (x, y), else the tail. */
function arrow(painter: Painter, x: number, y: number, dx: number, dy: number, towards: boolean, colour: string): void {
  const length = Math.hypot(dx, dy);
  if (!(length > 1.5)) return;
  const tipX = towards ? x : x + dx;
  const tipY = towards ? y : y + dy;
  const head = Math.min(9, length);
  const [ux, uy] = [dx / length, dy / length];
  const [bx, by] = [tipX - head * ux, tipY - head * uy];
  painter.path([tipX - dx, tipY - dy, bx, by], false, { stroke: colour, width: 2 });
  painter.path([tipX, tipY, bx - 0.4 * head * uy, by + 0.4 * head * ux, bx + 0.4 * head * uy, by - 0.4 * head * ux],
               true, { fill: colour });
}
