// Draws the shapes of a mechanism, and finds which of them lies under the pointer.

import { Camera } from "./camera";
import { Drawing, Line } from "./contract";
import { Painter } from "./painter";
import { anchorBody, anchorSpan, Placement, Pose, ShapeTable } from "./placement";
import { Theme } from "./theme";

/** Largest and smallest size of a symbol on the page, px. */
const largestSymbol = 7;
const smallestSymbol = 0.4;

export interface Highlight {
  body: number;
  element: number;
}

export const nothing: Highlight = { body: -2, element: -1 };

/** Size of symbols, m: a quarter of a usual link, but within the limits on the page. */
export function symbolSize(drawing: Drawing, camera: Camera): number {
  const growth = Math.max(1, Math.sqrt(camera.scale / camera.fitted));
  const most = largestSymbol * Math.min(growth, 2.5);
  const wanted = drawing.typical_length > 0 ? 0.25 * drawing.typical_length * camera.scale : most;
  return Math.min(most, Math.max(smallestSymbol, wanted)) / camera.scale;
}

export class MechanismPainter {
  private readonly placement: Placement = { x: 0, y: 0, ux: 0, uy: 0, vx: 0, vy: 0 };

  constructor(private readonly drawing: Drawing, private readonly shapes: ShapeTable,
              private readonly redundant: Set<number>) {}

  /** `only`: numbers of the shapes to draw; all if null. */
  draw(painter: Painter, camera: Camera, pose: Pose, theme: Theme, lit: Highlight, only: number[] | null): void {
    const size = symbolSize(this.drawing, camera);
    const count = only ? only.length : this.shapes.count;
    for (let n = 0; n < count; ++n) {
      const k = only ? only[n] : n;
      this.shapes.place(k, pose, size, this.placement);
      for (const line of this.linesOf(k)) this.line(painter, camera, pose, theme, k, line, size, lit);
    }
  }

  private linesOf(k: number): Line[] {
    return this.drawing.symbols[this.shapes.symbol[k]].lines;
  }

  /** Corners of a line in the frame of its shape. */
  private cornersOf(k: number, line: Line, pose: Pose): ArrayLike<number> {
    return this.shapes.ropes.get(k)?.at(pose) ?? line.points;
  }

  private line(painter: Painter, camera: Camera, pose: Pose, theme: Theme, k: number, line: Line, size: number,
               lit: Highlight): void {
    const body = this.shapes.bodyOf(k);
    const element = this.shapes.element[k];
    const p = this.placement;
    const isLit = (element >= 0 && element === lit.element) || (body >= 0 && element < 0 && body === lit.body);
    const isRedundant = this.redundant.has(element);
    const colour = theme.edge(line.role, body);
    const edge = isRedundant ? `rgb(${theme.warning})` : isLit ? `rgb(${theme.accent})` : colour;
    const fill = line.filled ? theme.fill(line.role, body) : undefined;
    const thin = isLit || isRedundant ? 2.6 : 1.2;
    if (line.radius) {
      const x = camera.toPageX(p.x + p.ux * line.points[0] + p.vx * line.points[1]);
      const y = camera.toPageY(p.y + p.uy * line.points[0] + p.vy * line.points[1]);
      const radius = line.radius * Math.hypot(p.vx, p.vy) * camera.scale;
      painter.circle(x, y, radius, { stroke: edge, fill, width: thin });
      return;
    }
    const points = this.onPage(k, line, pose, camera);
    const width = (line.width ?? 0) * size * camera.scale;
    const closed = line.closed === true;
    if (width > 2.4) {
      painter.path(points, closed, { stroke: edge, width: width + 2 * thin });
      const solid = line.role === "belt" || line.role === "cable";
      painter.path(points, closed, { stroke: solid ? colour : theme.fill(line.role, body), fill, width });
    } else {
      const dash = line.role === "measure" ? [6, 4] : undefined;
      painter.path(points, closed, { stroke: edge, fill, width: Math.max(thin, width), dash });
    }
  }

  private onPage(k: number, line: Line, pose: Pose, camera: Camera): Float64Array {
    const p = this.placement;
    const corners = this.cornersOf(k, line, pose);
    const out = new Float64Array(corners.length);
    for (let n = 0; n < out.length; n += 2) {
      const u = corners[n];
      const v = corners[n + 1];
      out[n] = camera.toPageX(p.x + p.ux * u + p.vx * v);
      out[n + 1] = camera.toPageY(p.y + p.uy * u + p.vy * v);
    }
    return out;
  }

  /** What all shapes together cover, without the size of symbols. */
  extent(pose: Pose, low: [number, number], high: [number, number]): void {
    const p = this.placement;
    for (let n = 0; n < this.shapes.count; ++n) {
      this.shapes.place(n, pose, 0, p);
      for (const line of this.linesOf(n)) {
        const around = (line.radius ?? 0) * Math.hypot(p.vx, p.vy);
        const corners = this.cornersOf(n, line, pose);
        for (let k = 0; k < corners.length; k += 2) {
          const x = p.x + p.ux * corners[k] + p.vx * corners[k + 1];
          const y = p.y + p.uy * corners[k] + p.vy * corners[k + 1];
          if (!isFinite(x) || !isFinite(y)) continue;
          low[0] = Math.min(low[0], x - around);
          low[1] = Math.min(low[1], y - around);
          high[0] = Math.max(high[0], x + around);
          high[1] = Math.max(high[1], y + around);
        }
      }
    }
  }

  /** Shapes whose place is near the canvas, at most `most`; null if there are more. */
  visible(camera: Camera, pose: Pose, most: number): number[] | null {
    const out: number[] = [];
    const room = 60;
    // Where everything is in sight there is nothing to look for.
    if (this.shapes.count > most && camera.scale < 1.5 * camera.fitted) return null;
    for (let k = 0; k < this.shapes.count; ++k) {
      this.shapes.place(k, pose, 0, this.placement);
      const { x, y, ux, uy } = this.placement;
      const span = this.shapes.anchor[k] === anchorSpan;
      const px = camera.toPageX(x);
      const py = camera.toPageY(y);
      const qx = span ? camera.toPageX(x + ux) : px;
      const qy = span ? camera.toPageY(y + uy) : py;
      const outside =
        Math.max(px, qx) < -room || Math.min(px, qx) > camera.width + room ||
        Math.max(py, qy) < -room || Math.min(py, qy) > camera.height + room;
      if (outside && this.shapes.anchor[k] !== anchorBody) continue;
      if (out.length === most) return null;
      out.push(k);
    }
    return out;
  }

  /** The shape drawn last among those within `reach` px of a place on the page; -1: none. */
  find(camera: Camera, pose: Pose, px: number, py: number, reach: number): number {
    const size = symbolSize(this.drawing, camera);
    let found = -1;
    let best = Infinity;
    for (let k = this.shapes.count - 1; k >= 0; --k) {
      this.shapes.place(k, pose, size, this.placement);
      for (const line of this.linesOf(k)) {
        const away = this.distance(k, line, camera, pose, px, py, size);
        if (away < reach && away < best - 1) {
          best = away;
          found = k;
        }
      }
    }
    return found;
  }

  private distance(shape: number, line: Line, camera: Camera, pose: Pose, px: number, py: number,
                   size: number): number {
    const points = this.onPage(shape, line, pose, camera);
    const scale = Math.hypot(this.placement.vx, this.placement.vy) * camera.scale;
    if (line.radius) {
      const away = Math.hypot(points[0] - px, points[1] - py);
      return line.filled && away < line.radius * scale ? 0 : Math.abs(away - line.radius * scale);
    }
    let best = Infinity;
    const corners = points.length / 2;
    for (let k = 0; k < (line.closed ? corners : corners - 1); ++k) {
      const m = (k + 1) % corners;
      const away = toSegment(px, py, points[2 * k], points[2 * k + 1], points[2 * m], points[2 * m + 1]);
      if (away < best) best = away;  // not where a corner is no number
    }
    if (line.closed && line.filled && isInside(points, px, py)) return 0;
    return Math.max(0, best - ((line.width ?? 0) * size * camera.scale) / 2);
  }
}

function toSegment(px: number, py: number, ax: number, ay: number, bx: number, by: number): number {
  const dx = bx - ax;
  const dy = by - ay;
  const square = dx * dx + dy * dy;
  const part = square > 0 ? Math.min(1, Math.max(0, ((px - ax) * dx + (py - ay) * dy) / square)) : 0;
  return Math.hypot(px - ax - part * dx, py - ay - part * dy);
}

function isInside(points: Float64Array, px: number, py: number): boolean {
  let inside = false;
  const corners = points.length / 2;
  for (let k = 0, m = corners - 1; k < corners; m = k++) {
    const [ax, ay, bx, by] = [points[2 * k], points[2 * k + 1], points[2 * m], points[2 * m + 1]];
    if (ay > py !== by > py && px < ((bx - ax) * (py - ay)) / (by - ay) + ax) inside = !inside;
  }
  return inside;
}
