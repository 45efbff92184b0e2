// An analysis as something that moves: its poses along a clock, and the shapes of its modes.

import { Analysis, Names, PageData } from "./contract";
import { decodeNumbers, Frames } from "./decode";
import { Pose } from "./placement";
import { Units } from "./units";

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
  /** Poses as the clock meets them: rows of a list of instants need not be in the order of time. */
  private readonly order: number[];
  /** The place of each pose in this order. */
  private readonly place: number[];
  readonly names: Names;
  readonly units: Units;
  /** Which shape swings; -1: none. */
  shape = -1;

  constructor(readonly data: PageData, readonly analysis: Analysis) {
    const poses = analysis.poses;
    this.units = new Units(data.units);
    const { given, bodies, elements, points } = data.drawings[analysis.drawing];
    this.given = given;
    this.names = { bodies: bodies ?? data.bodies, elements: elements ?? data.elements, points: points ?? data.points };
    this.pose = new Pose(new Float64Array(3 * this.names.bodies.length));
    this.t = decodeNumbers(poses.t);
    this.frames = poses.count > 0 ? new Frames(poses.frames, this.names.bodies.length) : null;
    this.velocities = poses.velocities ? decodeNumbers(poses.velocities) : null;
    this.reactions = poses.reactions ? decodeNumbers(poses.reactions.values) : null;
    this.loads = poses.loads ? decodeNumbers(poses.loads) : null;
    this.shapes = analysis.shapes.map(decodeNumbers);
    this.base = poses.count - 1;
    this.count = this.shapes.length > 0 ? Math.max(1, poses.count - 1) : poses.count;
    this.timed = analysis.columns.length > 0 && analysis.columns[0].name === "t" && this.count > 1;
    this.order = Array.from({ length: this.count }, (_, k) => k);
    if (this.timed) this.order.sort((a, b) => this.t[a] - this.t[b]);
    this.place = new Array(this.count);
    this.order.forEach((pose, k) => (this.place[pose] = k));
    if (this.shapes.length > 0 && this.count === 1) this.shape = 0;
  }

  get moves(): boolean {
    return this.count > 1 || this.shape >= 0;
  }

  /** The clock runs from here ... */
  get begin(): number {
    return this.timed ? this.t[this.order[0]] : 0;
  }

  /** ... to here: seconds of the analysis, or of a showing where it has no time. */
  get end(): number {
    if (this.shape >= 0) return swingSeconds;
    if (this.timed) return this.t[this.order[this.count - 1]];
    return this.count > 1 ? sequenceSeconds : 0;
  }

  /** Place in the order of time at an instant of the clock, with fraction. */
  position(clock: number): number {
    if (this.shape >= 0 || this.count < 2) return 0;
    if (!this.timed) return ((this.count - 1) * clock) / sequenceSeconds;
    let low = 0;
    let high = this.count - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.t[this.order[middle]] <= clock) low = middle;
      else high = middle;
    }
    const from = this.t[this.order[low]];
    const width = this.t[this.order[high]] - from;
    return low + (width > 0 ? Math.min(1, Math.max(0, (clock - from) / width)) : 0);
  }

  /** The instant of the clock at a place in the order of time. */
  clockAt(position: number): number {
    if (!this.timed) return this.count > 1 ? (position / (this.count - 1)) * sequenceSeconds : 0;
    const low = Math.min(this.count - 1, Math.floor(position));
    const high = Math.min(this.count - 1, low + 1);
    const from = this.t[this.order[low]];
    return from + (position - low) * (this.t[this.order[high]] - from);
  }

  /** The instant of the clock at which the pose nearest to a row of the analysis is shown. */
  clockOfRow(row: number): number {
    const { stride, total } = this.analysis.poses;
    const pose = row >= total - 1 ? this.count - 1 : Math.min(this.count - 1, Math.round(row / stride));
    return this.clockAt(this.place[pose]);
  }

  /** Puts the bodies where they are; `swing` scales a shape, in m of its largest displacement. */
  moveTo(clock: number, swing: number): void {
    const q = this.pose.q;
    if (!this.frames) {
      q.set(this.given);
    } else if (this.shape >= 0) {
      this.frames.interpolate(this.base, this.base, 0, q);
      const shape = this.shapes[this.shape];
      const factor = (swing * Math.sin((2 * Math.PI * clock) / swingSeconds)) / largestDisplacement(shape);
      for (let k = 0; k < q.length; ++k) q[k] += factor * shape[k];
    } else {
      const position = this.position(clock);
      const before = Math.min(this.count - 1, Math.floor(position));
      const after = Math.min(this.count - 1, before + 1);
      this.frames.interpolate(this.order[before], this.order[after], position - before, q);
    }
    this.pose.update();
  }

  /** The pose that is nearest to the clock: what values are shown for. */
  nearestPose(clock: number): number {
    return this.shape >= 0 ? this.base : this.poseAt(clock);
  }

  /** Of those that follow each other, the one nearest to the clock. */
  poseAt(clock: number): number {
    return this.order[Math.round(this.position(clock))] ?? 0;
  }

  /** The number among all rows of the analysis of a pose that was kept. */
  rowNumber(pose: number): number {
    const { count, stride, total } = this.analysis.poses;
    return pose >= count - 1 ? total - 1 : pose * stride;
  }

  /** Path of a point of a body over all poses in the order of time, x and y in turn. */
  path(body: number, u: number, v: number): Float64Array {
    const out = new Float64Array(2 * this.count);
    if (!this.frames) return out;
    const scratch = new Pose(new Float64Array(this.pose.q.length));
    for (let k = 0; k < this.count; ++k) {
      this.frames.interpolate(this.order[k], this.order[k], 0, scratch.q);
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
