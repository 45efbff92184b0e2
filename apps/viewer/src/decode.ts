// Packed numbers back into arrays. Numbers are little-endian, as on every machine that browsers run on.

import { PackedFrames, PackedNumbers } from "./contract";

function bytesOf(base64: string): Uint8Array {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  return bytes;
}

export function decodeNumbers(packed: PackedNumbers): Float64Array | Float32Array {
  const buffer = bytesOf(packed.data).buffer;
  return packed.type === "float64" ? new Float64Array(buffer) : new Float32Array(buffer);
}

/** Frames [x, y, angle] of all bodies, pose after pose; decoded as they are read, so that memory stays small. */
export class Frames {
  private readonly values: Float32Array | Uint16Array;
  private readonly base: ArrayLike<number>;
  private readonly step: number[];
  readonly wrapped: boolean;

  constructor(packed: PackedFrames, private readonly bodies: number) {
    const buffer = bytesOf(packed.data).buffer;
    this.wrapped = packed.type === "uint16";
    this.values = this.wrapped ? new Uint16Array(buffer) : new Float32Array(buffer);
    this.base = decodeNumbers(packed.base);
    this.step = packed.step;
  }

  /** Between two poses, `part` of the way; angles that were wrapped turn the shorter way. */
  interpolate(from: number, to: number, part: number, out: Float64Array): void {
    const width = 3 * this.bodies;
    const { values, base, step } = this;
    const first = from * width;
    const second = to * width;
    for (let k = 0, b = 0; k < width; k += 3, b += 2) {
      for (let c = 0; c < 2; ++c) {
        const a = values[first + k + c];
        out[k + c] = base[b + c] + step[c] * (a + part * (values[second + k + c] - a));
      }
      const a = values[first + k + 2];
      let change = values[second + k + 2] - a;
      if (this.wrapped) change -= 65536 * Math.round(change / 65536);
      out[k + 2] = step[2] * (a + part * change);
    }
  }
}
