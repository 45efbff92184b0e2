// What part of the plane is seen: scale in pixels a metre and the place in the middle of the canvas.

export class Camera {
  scale = 1;
  x = 0;
  y = 0;
  width = 1;
  height = 1;
  /** The scale at which everything is seen: symbols keep their size up to it and grow slowly beyond. */
  fitted = 1;

  toPageX(x: number): number {
    return (x - this.x) * this.scale + this.width / 2;
  }

  toPageY(y: number): number {
    return this.height / 2 - (y - this.y) * this.scale;
  }

  toPlaneX(px: number): number {
    return (px - this.width / 2) / this.scale + this.x;
  }

  toPlaneY(py: number): number {
    return (this.height / 2 - py) / this.scale + this.y;
  }

  /** `top`: px at the upper edge that stay free, for buttons. */
  fit(low: [number, number], high: [number, number], room: number, top: number): void {
    const wide = Math.max(1, this.width - 2 * room);
    const tall = Math.max(1, this.height - top - 2 * room);
    const dx = high[0] - low[0];
    const dy = high[1] - low[1];
    this.scale = Math.min(dx > 0 ? wide / dx : Infinity, dy > 0 ? tall / dy : Infinity);
    this.fitted = this.scale;
    if (!isFinite(this.scale)) {
      // A single place has no size to go by: its symbols are drawn as large as they become when a view is enlarged.
      this.scale = 100;
      this.fitted = this.scale / 8;
    }
    this.x = (low[0] + high[0]) / 2;
    this.y = (low[1] + high[1]) / 2 + top / 2 / this.scale;
  }

  /** Zooms so that the place under the pixel stays where it is. */
  zoom(factor: number, px: number, py: number): void {
    const x = this.toPlaneX(px);
    const y = this.toPlaneY(py);
    this.scale = Math.min(this.fitted * 1e5, Math.max(this.fitted * 1e-3, this.scale * factor));
    this.x = x - (px - this.width / 2) / this.scale;
    this.y = y + (py - this.height / 2) / this.scale;
  }

  pan(dx: number, dy: number): void {
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }
}
