// The mechanism on its canvas: camera, pictures, pointer.

import { ArrowKind, arrowKinds, Arrows } from "./arrows";
import { Camera } from "./camera";
import { byId } from "./dom";
import { LargeScene } from "./large_scene";
import { Highlight, MechanismPainter, nothing } from "./mechanism";
import { Motion } from "./motion";
import { CanvasPainter, Painter, SvgPainter } from "./painter";
import { ShapeTable } from "./placement";
import { css, Theme } from "./theme";

/** More shapes than this in sight go to WebGL: a canvas draws some ten thousand lines a picture. */
const mostOnCanvas = 4000;
const room = 46;

export interface Trace {
  body: number;
  u: number;
  v: number;
  name: string;
}

export class Stage {
  readonly camera = new Camera();
  readonly canvas = byId<HTMLCanvasElement>("mechanism");
  private readonly glCanvas = byId<HTMLCanvasElement>("large");
  private motion!: Motion;
  private painter!: MechanismPainter;
  private shapes!: ShapeTable;
  private large: LargeScene | null = null;
  arrows!: Arrows;
  shownArrows = new Set<ArrowKind>(["loads"]);
  arrowScale = 1;
  traces: Trace[] = [];
  lit: Highlight = nothing;
  private extentLow: [number, number] = [0, 0];
  private extentHigh: [number, number] = [0, 0];
  private paths = new Map<string, Float64Array>();
  /** Pictures drawn so far, for those who measure. */
  pictures = 0;

  constructor(public theme: Theme, private readonly changed: () => void,
              private readonly hovered: (shape: number, px: number, py: number) => void,
              private readonly clicked: (shape: number) => void) {
    this.listen();
  }

  show(motion: Motion): void {
    this.motion = motion;
    const { drawing } = this;
    const redundant = new Set<number>();
    const names = new Set(motion.analysis.redundant);
    if (names.size > 0) motion.names.elements.name.forEach((name, k) => names.has(name) && redundant.add(k));
    this.shapes = new ShapeTable(drawing.shapes);
    this.painter = new MechanismPainter(drawing, this.shapes, redundant);
    this.arrows = new Arrows(motion);
    this.paths.clear();
    this.large = drawing.shapes.length > mostOnCanvas ? LargeScene.create(this.glCanvas, drawing, this.shapes) : null;
    this.large?.paint(this.theme);
    this.findExtent();
  }

  get drawing() {
    return this.motion.data.drawings[this.motion.analysis.drawing];
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.large?.paint(theme);
  }

  /** Over at most some twenty poses: what lies between is not far from them. */
  private findExtent(): void {
    const low: [number, number] = [Infinity, Infinity];
    const high: [number, number] = [-Infinity, -Infinity];
    const samples = this.drawing.shapes.length > mostOnCanvas ? 3 : 24;
    const { begin, end } = this.motion;
    for (let k = 0; k <= samples; ++k) {
      this.motion.moveTo(begin + (k / samples) * (end - begin), 0);
      this.painter.extent(this.motion.pose, low, high);
    }
    if (!(low[0] <= high[0])) [low[0], low[1], high[0], high[1]] = [-1, -1, 1, 1];
    this.extentLow = low;
    this.extentHigh = high;
  }

  /** By how much a mode moves: a twelfth of the mechanism. */
  get swing(): number {
    const wide = this.extentHigh[0] - this.extentLow[0];
    const tall = this.extentHigh[1] - this.extentLow[1];
    return Math.max(wide, tall) / 12 || 0.1;
  }

  fit(): void {
    this.resize();
    const buttons = Math.min(byId("stage-tools").offsetHeight, this.camera.height / 4);
    this.camera.fit(this.extentLow, this.extentHigh, Math.min(room, this.camera.width / 6), buttons);
    this.changed();
  }

  resize(): void {
    const ratio = window.devicePixelRatio || 1;
    const box = this.canvas.getBoundingClientRect();
    this.camera.width = Math.max(1, box.width);
    this.camera.height = Math.max(1, box.height);
    for (const canvas of [this.canvas, this.glCanvas]) {
      canvas.width = Math.round(this.camera.width * ratio);
      canvas.height = Math.round(this.camera.height * ratio);
    }
  }

  draw(clock: number): void {
    this.motion.moveTo(clock, this.swing);
    const context = this.canvas.getContext("2d");
    if (!context) return;
    const ratio = this.canvas.width / this.camera.width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.camera.width, this.camera.height);
    const many = this.drawing.shapes.length > mostOnCanvas;
    const visible = many ? this.painter.visible(this.camera, this.motion.pose, mostOnCanvas) : null;
    const byGl = many && visible === null && this.large !== null;
    if (byGl) this.large?.draw(this.camera, this.motion.pose, ratio);
    else this.large?.clear();
    this.paint(new CanvasPainter(context), clock, byGl ? [] : visible);
    this.pictures++;
  }

  private paint(painter: Painter, clock: number, only: number[] | null): void {
    this.painter.draw(painter, this.camera, this.motion.pose, this.theme, this.lit, only);
    for (const trace of this.traces) {
      const { x, y, points } = this.pageTrace(trace);
      painter.path(points, false, { stroke: css(this.theme.accent), width: 1.6 });
      painter.circle(x, y, 3.2, { fill: css(this.theme.accent) });
    }
    const pose = this.motion.nearestPose(clock);
    for (const kind of arrowKinds) {
      if (this.shownArrows.has(kind) && this.arrows.has(kind) && this.motion.shape < 0)
        this.arrows.draw(kind, painter, this.camera, this.theme, pose, this.arrowScale);
    }
  }

  /** A trace on the page, and where its point is now. */
  pageTrace(trace: Trace): { x: number; y: number; points: Float64Array } {
    let path = this.paths.get(trace.name);
    if (!path) {
      path = this.motion.path(trace.body, trace.u, trace.v);
      this.paths.set(trace.name, path);
    }
    const points = new Float64Array(path.length);
    for (let k = 0; k < path.length; k += 2) {
      points[k] = this.camera.toPageX(path[k]);
      points[k + 1] = this.camera.toPageY(path[k + 1]);
    }
    const { pose } = this.motion;
    return {
      x: this.camera.toPageX(pose.pointX(trace.body, trace.u, trace.v)),
      y: this.camera.toPageY(pose.pointY(trace.body, trace.u, trace.v)),
      points,
    };
  }

  svg(clock: number): string {
    this.motion.moveTo(clock, this.swing);
    const { width, height } = this.camera;
    const painter = new SvgPainter(Math.round(width), Math.round(height), css(this.theme.paper));
    this.paint(painter, clock, null);
    return painter.finish();
  }

  /** The canvas as a picture: both layers on paper. */
  picture(clock: number): HTMLCanvasElement {
    this.draw(clock);
    const copy = document.createElement("canvas");
    copy.width = this.canvas.width;
    copy.height = this.canvas.height;
    const context = copy.getContext("2d");
    if (context) {
      context.fillStyle = css(this.theme.paper);
      context.fillRect(0, 0, copy.width, copy.height);
      context.drawImage(this.glCanvas, 0, 0);
      context.drawImage(this.canvas, 0, 0);
    }
    return copy;
  }

  private find(px: number, py: number): number {
    return this.drawing.shapes.length > 20 * mostOnCanvas
      ? -1
      : this.painter.find(this.camera, this.motion.pose, px, py, 7);
  }

  private listen(): void {
    const pointers = new Map<number, { x: number; y: number }>();
    let moved = 0;
    const at = (event: PointerEvent | WheelEvent) => {
      const box = this.canvas.getBoundingClientRect();
      return { x: event.clientX - box.left, y: event.clientY - box.top };
    };
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const p = at(event);
      this.camera.zoom(Math.exp(-event.deltaY * 0.0015), p.x, p.y);
      this.changed();
    }, { passive: false });
    this.canvas.addEventListener("pointerdown", (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, at(event));
      moved = 0;
    });
    this.canvas.addEventListener("pointermove", (event) => {
      const now = at(event);
      const before = pointers.get(event.pointerId);
      if (!before) {
        this.hovered(this.find(now.x, now.y), now.x, now.y);
        return;
      }
      const others = [...pointers.entries()].filter(([id]) => id !== event.pointerId);
      if (others.length === 1) {
        const other = others[0][1];
        const apart = (p: { x: number; y: number }) => Math.hypot(p.x - other.x, p.y - other.y);
        const factor = apart(now) / apart(before);
        if (isFinite(factor) && factor > 0) this.camera.zoom(factor, (now.x + other.x) / 2, (now.y + other.y) / 2);
      }
      const share = 1 / pointers.size;
      this.camera.pan((now.x - before.x) * share, (now.y - before.y) * share);
      moved += Math.abs(now.x - before.x) + Math.abs(now.y - before.y);
      pointers.set(event.pointerId, now);
      this.changed();
    });
    const release = (event: PointerEvent) => {
      const p = at(event);
      const was = pointers.delete(event.pointerId);
      if (was && moved < 5 && event.type === "pointerup") this.clicked(this.find(p.x, p.y));
    };
    this.canvas.addEventListener("pointerup", release);
    this.canvas.addEventListener("pointercancel", release);
    this.canvas.addEventListener("pointerleave", () => this.hovered(-1, 0, 0));
    this.canvas.addEventListener("dblclick", () => this.fit());
  }

  /** Body and element of a shape. */
  ownerOf(shape: number): Highlight {
    const element = this.shapes.element[shape];
    return element >= 0 ? { body: -2, element } : { body: this.shapes.bodyOf(shape), element: -1 };
  }
}
