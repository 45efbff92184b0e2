// Arrows of velocities, reactions and applied forces, each kind with a scale of its own: the longest of the whole run
// is `longest` px at the scale 1.

import { Camera } from "./camera";
import { Highlight } from "./mechanism";
import { Motion } from "./motion";
import { Painter } from "./painter";
import { Theme } from "./theme";

const longest = 90;
/** More arrows of a kind than this hide what they stand at. */
const mostInSight = 400;

export type ArrowKind = "velocities" | "reactions" | "loads";
export const arrowKinds: ArrowKind[] = ["velocities", "reactions", "loads"];

const colours: Record<ArrowKind, [string, string]> = {
  velocities: ["#00796b", "#4fd1b5"],
  reactions: ["#b02a2a", "#ff8a8a"],
  loads: ["#7b3fa0", "#d0a0f0"],
};

export function arrowColour(kind: ArrowKind, theme: Theme): string {
  return colours[kind][theme.dark ? 1 : 0];
}

interface Arrow {
  body: number;
  /** -1: of the body itself */
  element: number;
  x: number;
  y: number;
  fx: number;
  fy: number;
  /** The tip is at (x, y), else the tail. */
  towards: boolean;
}

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

  /** Draws those in sight; where they are too many, only those of what is lit, and says so by true. */
  draw(kind: ArrowKind, painter: Painter, camera: Camera, theme: Theme, pose: number, factor: number,
       lit: Highlight): boolean {
    const colour = arrowColour(kind, theme);
    const scale = (factor * longest) / this.largest[kind];
    const inSight: Arrow[] = [];
    for (const found of this.arrowsAt(kind, pose)) {
      const px = camera.toPageX(found.x);
      const py = camera.toPageY(found.y);
      if (px >= 0 && px <= camera.width && py >= 0 && py <= camera.height) inSight.push(found);
    }
    const many = inSight.length > mostInSight;
    const held = many && lit.body >= 0 ? this.elementsOf(lit.body) : new Set<number>();
    const isLit = ({ body, element }: Arrow) =>
      element >= 0 ? element === lit.element || held.has(element) : body >= 0 && body === lit.body;
    for (const shown of many ? inSight.filter(isLit) : inSight) {
      const { x, y, fx, fy, towards } = shown;
      drawArrow(painter, camera.toPageX(x), camera.toPageY(y), fx * scale, -fy * scale, towards, colour);
    }
    return many;
  }

  /** The elements that hold a body. */
  private elementsOf(body: number): Set<number> {
    const { shapes, loads } = this.motion.data.drawings[this.motion.analysis.drawing];
    const found = new Set<number>();
    for (const shape of shapes) if (shape[2] >= 0 && (shape[3] === body || shape[6] === body)) found.add(shape[2]);
    for (const load of loads) if (load.body === body) found.add(load.element);
    return found;
  }

  private arrowsAt(kind: ArrowKind, pose: number): Arrow[] {
    const { data, analysis, velocities, reactions, loads } = this.motion;
    const bodies = this.motion.names.bodies.length;
    const now = this.motion.pose;
    if (kind === "velocities" && velocities) {
      const at = 3 * bodies * pose;
      return Array.from({ length: bodies }, (_, body) => ({
        body, element: -1, x: now.q[3 * body], y: now.q[3 * body + 1], fx: velocities[at + 3 * body],
        fy: velocities[at + 3 * body + 1], towards: false,
      }));
    }
    if (kind === "reactions" && reactions && analysis.poses.reactions) {
      const { elements } = analysis.poses.reactions;
      return elements.map((element, n) => {
        const k = 4 * (elements.length * pose + n);
        return { body: -1, element, x: reactions[k], y: reactions[k + 1], fx: reactions[k + 2], fy: reactions[k + 3],
                 towards: false };
      });
    }
    if (kind !== "loads" || !loads) return [];
    const drawn = data.drawings[analysis.drawing].loads;
    return drawn.map(({ body, element, point: [u, v], in_body_axes }, k) => {
      const fx = loads[2 * (drawn.length * pose + k)];
      const fy = loads[2 * (drawn.length * pose + k) + 1];
      const c = in_body_axes ? now.cosine[body] : 1;
      const s = in_body_axes ? now.sine[body] : 0;
      return { body, element, x: now.pointX(body, u, v), y: now.pointY(body, u, v), fx: c * fx - s * fy,
               fy: s * fx + c * fy, towards: true };
    });
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
function drawArrow(painter: Painter, x: number, y: number, dx: number, dy: number, towards: boolean, colour: string): void {
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
