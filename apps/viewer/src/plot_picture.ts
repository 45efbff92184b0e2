// A plot on its canvas. All but the cursor, which moves with every picture of a motion, is drawn once and kept: rows by
// the thousand take milliseconds.

import { make } from "./dom";
import { CanvasPainter, Painter } from "./painter";
import { css, Theme } from "./theme";

export interface Drawable {
  width: number;
  readonly height: number;
  draw(painter: Painter, theme: Theme): void;
  drawCursor(painter: Painter, theme: Theme, cursor: number): void;
}

export class PlotPicture {
  private readonly kept = make("canvas");
  /** How often the plot was drawn, for measurements. */
  drawn = 0;

  constructor(private readonly plot: Drawable, private readonly canvas: HTMLCanvasElement) {}

  /** Draws it anew, as wide as its canvas is on the page. */
  draw(theme: Theme, cursor: number): void {
    const { plot, canvas, kept } = this;
    if (canvas.isConnected && canvas.clientWidth > 0) plot.width = canvas.clientWidth;
    const ratio = window.devicePixelRatio || 1;
    canvas.width = kept.width = Math.round(plot.width * ratio);
    canvas.height = kept.height = Math.round(plot.height * ratio);
    const context = kept.getContext("2d");
    if (!context) return;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    plot.draw(new CanvasPainter(context), theme);
    this.drawn++;
    this.showCursor(theme, cursor);
  }

  showCursor(theme: Theme, cursor: number): void {
    this.paint(this.canvas, theme, cursor, false);
  }

  /** A copy on paper, to be saved. */
  onPaper(theme: Theme, cursor: number): HTMLCanvasElement {
    const copy = make("canvas");
    copy.width = this.kept.width;
    copy.height = this.kept.height;
    this.paint(copy, theme, cursor, true);
    return copy;
  }

  private paint(canvas: HTMLCanvasElement, theme: Theme, cursor: number, paper: boolean): void {
    const context = canvas.getContext("2d");
    if (!context) return;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    if (paper) {
      context.fillStyle = css(theme.paper);
      context.fillRect(0, 0, canvas.width, canvas.height);
    }
    context.drawImage(this.kept, 0, 0);
    const ratio = canvas.width / this.plot.width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.plot.drawCursor(new CanvasPainter(context), theme, cursor);
  }
}
