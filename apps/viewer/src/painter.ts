// What mechanisms and plots are drawn on: a canvas of the page, or an SVG file to be saved. Pixels, y downwards.

export interface Paint {
  stroke?: string;
  fill?: string;
  width?: number;
  dash?: number[];
}

export interface TextPaint {
  size: number;
  colour: string;
  anchor?: "start" | "middle" | "end";
  upwards?: boolean;
}

export interface Painter {
  /** x and y in turn; a value that is no number ends a line. */
  path(points: ArrayLike<number>, closed: boolean, paint: Paint): void;
  circle(x: number, y: number, radius: number, paint: Paint): void;
  text(x: number, y: number, text: string, paint: TextPaint): void;
  clip(x: number, y: number, width: number, height: number): void;
  unclip(): void;
  /** What follows is drawn faintly: `opacity` below one; one ends it. */
  fade(opacity: number): void;
}

export class CanvasPainter implements Painter {
  constructor(private readonly context: CanvasRenderingContext2D) {
    context.lineJoin = "round";
    context.lineCap = "round";
  }

  path(points: ArrayLike<number>, closed: boolean, paint: Paint): void {
    this.context.beginPath();
    let begun = false;
    for (let k = 0; k + 1 < points.length; k += 2) {
      if (!isFinite(points[k]) || !isFinite(points[k + 1])) {
        begun = false;
      } else if (begun) {
        this.context.lineTo(points[k], points[k + 1]);
      } else {
        this.context.moveTo(points[k], points[k + 1]);
        begun = true;
      }
    }
    if (closed) this.context.closePath();
    this.paint(paint);
  }

  circle(x: number, y: number, radius: number, paint: Paint): void {
    if (!isFinite(x) || !isFinite(y)) return;
    this.context.beginPath();
    this.context.arc(x, y, radius, 0, 2 * Math.PI);
    this.paint(paint);
  }

  text(x: number, y: number, text: string, paint: TextPaint): void {
    const c = this.context;
    c.save();
    c.font = `${paint.size}px system-ui, sans-serif`;
    c.fillStyle = paint.colour;
    c.textAlign = paint.anchor === "middle" ? "center" : paint.anchor === "end" ? "right" : "left";
    c.translate(x, y);
    if (paint.upwards) c.rotate(-Math.PI / 2);
    c.fillText(text, 0, 0);
    c.restore();
  }

  clip(x: number, y: number, width: number, height: number): void {
    this.context.save();
    this.context.beginPath();
    this.context.rect(x, y, width, height);
    this.context.clip();
  }

  unclip(): void {
    this.context.restore();
  }

  fade(opacity: number): void {
    this.context.globalAlpha = opacity;
  }

  private paint(paint: Paint): void {
    const c = this.context;
    if (paint.fill) {
      c.fillStyle = paint.fill;
      c.fill();
    }
    if (paint.stroke) {
      c.strokeStyle = paint.stroke;
      c.lineWidth = paint.width ?? 1;
      c.setLineDash(paint.dash ?? []);
      c.stroke();
    }
  }
}

export function escapeMarkup(text: string): string {
  return text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/"/g, "&quot;");
}

export class SvgPainter implements Painter {
  private out = "";
  private clips = 0;

  constructor(private readonly width: number, private readonly height: number, private readonly paper: string) {}

  path(points: ArrayLike<number>, closed: boolean, paint: Paint): void {
    let data = "";
    let begun = false;
    for (let k = 0; k + 1 < points.length; k += 2) {
      if (!isFinite(points[k]) || !isFinite(points[k + 1])) {
        begun = false;
        continue;
      }
      data += `${begun ? "L" : "M"}${points[k].toFixed(2)} ${points[k + 1].toFixed(2)}`;
      begun = true;
    }
    if (data) this.out += `<path d="${data}${closed ? "Z" : ""}"${this.attributes(paint)}/>\n`;
  }

  circle(x: number, y: number, radius: number, paint: Paint): void {
    if (!isFinite(x) || !isFinite(y)) return;
    const place = `cx="${x.toFixed(2)}" cy="${y.toFixed(2)}" r="${radius.toFixed(2)}"`;
    this.out += `<circle ${place}${this.attributes(paint)}/>\n`;
  }

  text(x: number, y: number, text: string, paint: TextPaint): void {
    const turn = paint.upwards ? " rotate(-90)" : "";
    this.out +=
      `<text transform="translate(${x.toFixed(2)} ${y.toFixed(2)})${turn}" font-size="${paint.size}" ` +
      `fill="${paint.colour}" text-anchor="${paint.anchor ?? "start"}">${escapeMarkup(text)}</text>\n`;
  }

  clip(x: number, y: number, width: number, height: number): void {
    const name = `clip${++this.clips}`;
    this.out +=
      `<clipPath id="${name}"><rect x="${x}" y="${y}" width="${width}" height="${height}"/></clipPath>` +
      `<g clip-path="url(#${name})">\n`;
  }

  unclip(): void {
    this.out += "</g>\n";
  }

  fade(opacity: number): void {
    this.out += opacity < 1 ? `<g opacity="${opacity}">\n` : "</g>\n";
  }

  finish(): string {
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" width="${this.width}" height="${this.height}" ` +
      `viewBox="0 0 ${this.width} ${this.height}" font-family="Helvetica, Arial, sans-serif" ` +
      `stroke-linejoin="round" stroke-linecap="round">\n` +
      `<rect width="100%" height="100%" fill="${this.paper}"/>\n${this.out}</svg>\n`
    );
  }

  private attributes(paint: Paint): string {
    const stroke = paint.stroke ? ` stroke="${paint.stroke}" stroke-width="${paint.width ?? 1}"` : "";
    const dash = paint.dash ? ` stroke-dasharray="${paint.dash.join(" ")}"` : "";
    return ` fill="${paint.fill ?? "none"}"${stroke}${dash}`;
  }
}
