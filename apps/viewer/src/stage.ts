// The mechanism on its canvas: camera, pictures, pointer.

import { ArrowKind, arrowKinds, Arrows } from "./arrows";
import { MechanismBehind } from "./behind";
import { Camera } from "./camera";
import { byId } from "./dom";
import { listenToPointers } from "./gestures";
import { LargeScene } from "./large_scene";
import { Highlight, MechanismPainter, nothing } from "./mechanism";
import { Motion } from "./motion";
import { CanvasPainter, Painter, SvgPainter } from "./painter";
import { ShapeTable } from "./placement";
import { css, Theme } from "./theme";
import { Trace, Traces } from "./traces";

/** More shapes than this in sight go to WebGL: a canvas draws some ten thousand lines a picture. */
const mostOnCanvas = 4000;
const room = 46;

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
  behind: MechanismBehind | null = null;
  showBehind = true;
  private extentLow: [number, number] = [0, 0];
  private extentHigh: [number, number] = [0, 0];
  private paths!: Traces;
  /** Pictures drawn so far, for measurements. */
  pictures = 0;

  constructor(public theme: Theme, private readonly changed: () => void,
              private readonly hovered: (shape: number, px: number, py: number) => void,
              private readonly clicked: (shape: number) => void) {
    this.listen();
  }

  /** `others`: motions that may be shown in its place, for which there is to be room. */
  show(motion: Motion, behind: { name: string; motion: Motion } | null, others: Motion[]): void {
    this.motion = motion;
    this.behind = behind && new MechanismBehind(behind.name, behind.motion);
    if (this.behind && this.behind.shapes > mostOnCanvas) this.behind = null;
    this.paths = new Traces(motion);
    const { drawing } = this;
    const redundant = new Set<number>();
    const names = new Set(motion.analysis.redundant);
    if (names.size > 0) motion.names.elements.name.forEach((name, k) => names.has(name) && redundant.add(k));
    this.shapes = new ShapeTable(drawing);
    this.painter = new MechanismPainter(drawing, this.shapes, redundant);
    this.arrows = new Arrows(motion);
    this.large = drawing.shapes.length > mostOnCanvas ? LargeScene.create(this.glCanvas, drawing, this.shapes) : null;
    this.large?.paint(this.theme);
    this.findExtent(others.map((other) => new MechanismBehind("", other)));
  }

  get drawing() {
    return this.motion.data.drawings[this.motion.analysis.drawing];
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.large?.paint(theme);
  }

  /** Over at most some twenty poses: what lies between is not far from them. */
  private findExtent(others: MechanismBehind[]): void {
    const low: [number, number] = [Infinity, Infinity];
    const high: [number, number] = [-Infinity, -Infinity];
    const samples = this.drawing.shapes.length > mostOnCanvas ? 3 : 24;
    const { begin, end } = this.motion;
    for (let k = 0; k <= samples; ++k) {
      const clock = begin + (k / samples) * (end - begin);
      this.motion.moveTo(clock, 0);
      this.painter.extent(this.motion.pose, low, high);
      this.behind?.moveWith(this.motion, clock, 0);
      this.behind?.extent(low, high);
    }
    for (const other of others) {
      for (const part of [0, 0.25, 0.5, 0.75, 1]) {
        other.motion.moveTo(other.motion.begin + part * (other.motion.end - other.motion.begin), 0);
        other.extent(low, high);
      }
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
    if (this.behind && this.showBehind) {
      this.behind.moveWith(this.motion, clock, this.swing);
      this.behind.draw(painter, this.camera, this.theme, this.traces);
    }
    this.painter.draw(painter, this.camera, this.motion.pose, this.theme, this.lit, only);
    for (const trace of this.traces) {
      const { x, y, points } = this.paths.onPage(trace, this.camera);
      painter.path(points, false, { stroke: css(this.theme.accent), width: 1.6 });
      painter.circle(x, y, 3.2, { fill: css(this.theme.accent) });
    }
    const pose = this.motion.nearestPose(clock);
    let many = false;
    for (const kind of arrowKinds) {
      if (this.shownArrows.has(kind) && this.arrows.has(kind) && this.motion.shape < 0)
        many = this.arrows.draw(kind, painter, this.camera, this.theme, pose, this.arrowScale, this.lit) || many;
    }
    const note = document.getElementById("arrow-note");
    if (note && note.hidden === many) note.hidden = !many;
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
    listenToPointers(this.canvas, {
      zoom: (factor, x, y) => (this.camera.zoom(factor, x, y), this.changed()),
      pan: (dx, dy) => (this.camera.pan(dx, dy), this.changed()),
      click: (x, y) => this.clicked(this.find(x, y)),
      reset: () => this.fit(),
      point: (x, y) => this.hovered(this.find(x, y), x, y),
      leave: () => this.hovered(-1, 0, 0),
    });
  }

  /** Body and element of a shape. */
  ownerOf(shape: number): Highlight {
    const element = this.shapes.element[shape];
    return element >= 0 ? { body: -2, element } : { body: this.shapes.bodyOf(shape), element: -1 };
  }
}
