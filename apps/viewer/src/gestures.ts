// What pointers do on a canvas, with one finger, two, or a mouse: pan, zoom, click, point at something. Places are px
// from the canvas's upper left corner.

export interface Gestures {
  zoom(factor: number, x: number, y: number): void;
  pan(dx: number, dy: number): void;
  click(x: number, y: number): void;
  /** Shows everything. */
  reset(): void;
  point?(x: number, y: number): void;
  leave?(): void;
}

interface Place {
  x: number;
  y: number;
}

/** What a hand moves without meaning to, px. */
const still = 5;

export function listenToPointers(canvas: HTMLCanvasElement, gestures: Gestures): void {
  const pointers = new Map<number, Place>();
  let moved = 0;
  const at = (event: MouseEvent): Place => {
    const box = canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const p = at(event);
    gestures.zoom(Math.exp(-event.deltaY * 0.0015), p.x, p.y);
  }, { passive: false });
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    if (pointers.size === 0) moved = 0;
    pointers.set(event.pointerId, at(event));
  });
  canvas.addEventListener("pointermove", (event) => {
    const now = at(event);
    const before = pointers.get(event.pointerId);
    if (!before) {
      gestures.point?.(now.x, now.y);
      return;
    }
    const other = [...pointers.entries()].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const apart = (p: Place) => Math.hypot(p.x - other.x, p.y - other.y);
      const factor = apart(now) / apart(before);
      if (isFinite(factor) && factor > 0) gestures.zoom(factor, (now.x + other.x) / 2, (now.y + other.y) / 2);
    }
    const share = 1 / pointers.size;
    gestures.pan((now.x - before.x) * share, (now.y - before.y) * share);
    moved += Math.abs(now.x - before.x) + Math.abs(now.y - before.y);
    pointers.set(event.pointerId, now);
  });
  const release = (event: PointerEvent) => {
    const was = pointers.delete(event.pointerId);
    const p = at(event);
    if (was && pointers.size === 0 && moved < still && event.type === "pointerup") gestures.click(p.x, p.y);
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", () => gestures.leave?.());
  canvas.addEventListener("dblclick", () => gestures.reset());
}
