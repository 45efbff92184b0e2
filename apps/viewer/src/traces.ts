// Paths of points on the page. A trace goes by the names of its body and point: other parameters put it elsewhere.

import { Camera } from "./camera";
import { Motion } from "./motion";

export interface Trace {
  body: number;
  u: number;
  v: number;
  name: string;
  /** Names of its body, and of the point if it has one. */
  owner: string;
  point: string;
}

/** The named points of a motion. */
export function pointsOf(motion: Motion): Trace[] {
  const { points, bodies } = motion.names;
  return points.body.map((body, k) => ({
    body, u: points.at[2 * k], v: points.at[2 * k + 1], name: `${bodies[body]}.${points.name[k]}`,
    owner: bodies[body], point: points.name[k],
  }));
}

/** Paths in a motion, computed when they are first asked for. */
export class Traces {
  private readonly paths = new Map<string, Float64Array>();

  constructor(private readonly motion: Motion) {}

  private place(trace: Trace): { body: number; u: number; v: number } {
    const { bodies, points } = this.motion.names;
    const body = bodies.indexOf(trace.owner);
    const k = points.name.findIndex((name, n) => name === trace.point && points.body[n] === body);
    return k < 0 ? trace : { body, u: points.at[2 * k], v: points.at[2 * k + 1] };
  }

  /** A trace on the page, and where its point is now. */
  onPage(trace: Trace, camera: Camera): { x: number; y: number; points: Float64Array } {
    const { body, u, v } = this.place(trace);
    let path = this.paths.get(trace.name);
    if (!path) {
      path = this.motion.path(body, u, v);
      this.paths.set(trace.name, path);
    }
    const points = new Float64Array(path.length);
    for (let k = 0; k < path.length; k += 2) {
      points[k] = camera.toPageX(path[k]);
      points[k + 1] = camera.toPageY(path[k + 1]);
    }
    const { pose } = this.motion;
    return { x: camera.toPageX(pose.pointX(body, u, v)), y: camera.toPageY(pose.pointY(body, u, v)), points };
  }
}
