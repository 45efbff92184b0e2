// An analysis as something that moves: its poses along a clock, and the shapes of its modes.

import { Analysis, PageData } from "./contract";
import { decodeNumbers, Frames } from "./decode";
import { Pose } from "./placement";

/** Seconds of a shape's swing to and fro, and of a whole untimed sequence of poses. */
const swingSeconds = 2;
const sequenceSeconds = 6;

export class Motion {
  readonly pose: Pose;
  readonly t: ArrayLike<number>;
  readonly timed: boolean;
  /** Poses that follow each other; that of the shapes is not among them. */
  readonly count: number;
  readonly velocities: ArrayLike<number> | null;
  readonly reactions: ArrayLike<number> | null;
  readonly loads: ArrayLike<number> | null;
  readonly shapes: ArrayLike<number>[];
  private readonly frames: Frames | null;
  private readonly base: number;
  private readonly given: number[];
  /** Which shape swings; -1: none. */
  shape = -1;

  constructor(readonly data: PageData, readonly analysis: Analysis) {
    const poses = analysis.poses;
    this.given = data.drawings[analysis.drawing].given;
    this.pose = new Pose(new Float64Array(3 * data.bodies.length));
    this.t = decodeNumbers(poses.t);
    this.frames = poses.count > 0 ? new Frames(poses.frames, data.bodies.length) : null;
    this.velocities = poses.velocities ? decodeNumbers(poses.velocities) : null;
    this.reactions = poses.reactions ? decodeNumbers(poses.reactions.values) : null;
    this.loads = poses.loads ? decodeNumbers(poses.loads) : null;
    this.shapes = analysis.shapes.map(decodeNumbers);
    this.base = poses.count - 1;
    this.count = this.shapes.length > 0 ? Math.max(1, poses.count - 1) : poses.count;
    this.timed = analysis.columns.length > 0 && analysis.columns[0].name === "t" && this.count > 1;
    if (this.shapes.length > 0 && this.count === 1) this.shape = 0;
  }

  get moves(): boolean {
    return this.count > 1 || this.shape >= 0;
  }

  /** The clock runs from here ... */
  get begin(): number {
    return this.timed ? this.t[0] : 0;
  }

  /** ... to here: seconds of the analysis, or of a showing where it has no time. */
  get end(): number {
    if (this.shape >= 0) return swingSeconds;
    if (this.timed) return this.t[this.count - 1];
    return this.count > 1 ? sequenceSeconds : 0;
  }

  /** Place among the poses at an instant of the clock, with fraction. */
  position(clock: number): number {
    if (this.shape >= 0 || this.count < 2) return 0;
    if (!this.timed) return ((this.count - 1) * clock) / sequenceSeconds;
    let low = 0;
    let high = this.count - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.t[middle] <= clock) low = middle;
      else high = middle;
    }
    const width = this.t[high] - this.t[low];
    return low + (width > 0 ? Math.min(1, Math.max(0, (clock - this.t[low]) / width)) : 0);
  }

  /** The instant of the clock at a place among the poses. */
  clockAt(position: number): number {
    if (!this.timed) return this.count > 1 ? (position / (this.count - 1)) * sequenceSeconds : 0;
    const low = Math.min(this.count - 1, Math.floor(position));
    const high = Math.min(this.count - 1, low + 1);
    return this.t[low] + (position - low) * (this.t[high] - this.t[low]);
  }

  /** Puts the bodies where they are; `swing` scales a shape, in m of its largest displacement. */
  moveTo(clock: number, swing: number): void {
    const q = this.pose.q;
    if (!this.frames) {
      q.set(this.given);
    } else if (this.shape >= 0) {
      this.frames.interpolate(this.base, 0, q);
      const shape = this.shapes[this.shape];
      const factor = (swing * Math.sin((2 * Math.PI * clock) / swingSeconds)) / largestDisplacement(shape);
      for (let k = 0; k < q.length; ++k) q[k] += factor * shape[k];
    } else {
      const position = this.position(clock);
      const row = Math.min(this.count - 1, Math.floor(position));
      this.frames.interpolate(row, Math.min(position - row, row + 1 < this.count ? 1 : 0), q);
    }
    this.pose.update();
  }

  /** The pose that is nearest to the clock: what values are shown for. */
  nearestPose(clock: number): number {
    return this.shape >= 0 ? this.base : Math.round(this.position(clock));
  }

  /** The number among all rows of the analysis of a pose that was kept. */
  rowNumber(pose: number): number {
    const { count, stride, total } = this.analysis.poses;
    return pose >= count - 1 ? total - 1 : pose * stride;
  }

  /** Path of a point of a body over all poses, x and y in turn. */
  path(body: number, u: number, v: number): Float64Array {
    const out = new Float64Array(2 * this.count);
    if (!this.frames) return out;
    const scratch = new Pose(new Float64Array(this.pose.q.length));
    for (let k = 0; k < this.count; ++k) {
      this.frames.interpolate(k, 0, scratch.q);
      const angle = scratch.q[3 * body + 2];
      out[2 * k] = scratch.q[3 * body] + Math.cos(angle) * u - Math.sin(angle) * v;
      out[2 * k + 1] = scratch.q[3 * body + 1] + Math.sin(angle) * u + Math.cos(angle) * v;
    }
    return out;
  }
}

function largestDisplacement(shape: ArrayLike<number>): number {
  let largest = 0;
  for (let k = 0; k + 2 < shape.length; k += 3) largest = Math.max(largest, Math.hypot(shape[k], shape[k + 1]));
  if (largest > 0) return largest;
  for (let k = 2; k < shape.length; k += 3) largest = Math.max(largest, Math.abs(shape[k]));
  return largest > 0 ? largest : 1;
}
