// Mechanisms of thousands of bodies by WebGL: every span as a line, every area by its outline, in the colours of
// bodies.
//
// Corners are computed here once a picture and handed over in one array; a mechanism of 10^5 links is 2 x 10^5 corners.
// Symbols, which stand at points, come behind all links and are left out while they are smaller than a pixel.

import { Camera } from "./camera";
import { Drawing, Line } from "./contract";
import { symbolSize } from "./mechanism";
import { anchorPoint, Placement, Pose, ShapeTable } from "./placement";
import { Rgb, Theme } from "./theme";

const vertexSource = `
attribute vec2 place;
attribute vec3 colour;
uniform vec4 view;
varying vec3 shade;
void main() {
  gl_Position = vec4((place - view.xy) * view.zw, 0.0, 1.0);
  shade = colour;
}`;

const fragmentSource = `
precision mediump float;
varying vec3 shade;
void main() { gl_FragColor = vec4(shade, 1.0); }`;

function compile(gl: WebGLRenderingContext): WebGLProgram | null {
  const program = gl.createProgram();
  if (!program) return null;
  for (const [type, source] of [[gl.VERTEX_SHADER, vertexSource], [gl.FRAGMENT_SHADER, fragmentSource]] as const) {
    const shader = gl.createShader(type);
    if (!shader) return null;
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  return gl.getProgramParameter(program, gl.LINK_STATUS) ? program : null;
}

const isLeftOut = (line: Line) => line.radius !== undefined || line.role === "wheel";

/** Whether WebGL is computed by the processor: smooth edges then cost half of the pictures (4.4 a second, not 9.5,
 * with 10^5 links on two shared cores). */
function isSoftware(): boolean {
  const gl = document.createElement("canvas").getContext("webgl");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  if (!gl || !info) return false;
  const software = /swiftshader|llvmpipe|software/i.test(String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return software;
}

export class LargeScene {
  private readonly placement: Placement = { x: 0, y: 0, ux: 0, uy: 0, vx: 0, vy: 0 };
  private readonly corners: Float32Array;
  private readonly colours: Uint8Array;
  private readonly cornerBuffer: WebGLBuffer | null;
  private readonly colourBuffer: WebGLBuffer | null;
  /** Shapes in the order of drawing; the first `links` of them are no symbols. */
  private readonly order: number[] = [];
  private readonly links: number;
  private count = 0;

  /** null where the browser has no WebGL. */
  static create(canvas: HTMLCanvasElement, drawing: Drawing, shapes: ShapeTable): LargeScene | null {
    const gl = canvas.getContext("webgl", { antialias: !isSoftware(), alpha: true });
    const program = gl ? compile(gl) : null;
    return gl && program ? new LargeScene(gl, program, drawing, shapes) : null;
  }

  private constructor(private readonly gl: WebGLRenderingContext, private readonly program: WebGLProgram,
                      private readonly drawing: Drawing, private readonly shapes: ShapeTable) {
    let segments = 0;
    const symbols: number[] = [];
    for (let k = 0; k < shapes.count; ++k) {
      segments += this.segmentsOf(k);
      (shapes.anchor[k] === anchorPoint ? symbols : this.order).push(k);
    }
    this.links = this.order.length;
    for (const k of symbols) this.order.push(k);
    this.corners = new Float32Array(4 * segments);
    this.colours = new Uint8Array(6 * segments);
    this.cornerBuffer = gl.createBuffer();
    this.colourBuffer = gl.createBuffer();
  }

  /** Its lines but circles, which are pins, too small to be seen, and areas of wheels, whose rims are drawn. */
  private linesOf(shape: number): Line[] {
    const { lines } = this.drawing.symbols[this.shapes.symbol[shape]];
    return lines.some(isLeftOut) ? lines.filter((line) => !isLeftOut(line)) : lines;
  }

  private segmentsOf(shape: number): number {
    const rope = this.shapes.ropes.get(shape);
    if (rope) return rope.corners - 1;
    let segments = 0;
    for (const line of this.linesOf(shape)) segments += line.points.length / 2 - (line.closed ? 0 : 1);
    return segments;
  }

  /** To be called once a theme. */
  paint(theme: Theme): void {
    let at = 0;
    for (const k of this.order) {
      const base: Rgb = theme.body(this.shapes.bodyOf(k));
      const corners = 2 * this.segmentsOf(k);
      for (let n = 0; n < corners; ++n) {
        for (let c = 0; c < 3; ++c) this.colours[at++] = base[c];
      }
    }
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.colourBuffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, this.colours, this.gl.STATIC_DRAW);
  }

  draw(camera: Camera, pose: Pose, ratio: number): void {
    const { gl } = this;
    this.computeCorners(camera, pose);
    gl.viewport(0, 0, camera.width * ratio, camera.height * ratio);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.useProgram(this.program);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.cornerBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, this.corners.subarray(0, this.count), gl.STREAM_DRAW);
    const placeAt = gl.getAttribLocation(this.program, "place");
    gl.enableVertexAttribArray(placeAt);
    gl.vertexAttribPointer(placeAt, 2, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.colourBuffer);
    const colourAt = gl.getAttribLocation(this.program, "colour");
    gl.enableVertexAttribArray(colourAt);
    gl.vertexAttribPointer(colourAt, 3, gl.UNSIGNED_BYTE, true, 0, 0);
    // Places are relative to the middle of the view already: single precision suffices at any zoom.
    gl.uniform4f(gl.getUniformLocation(this.program, "view"), 0, 0, (2 * camera.scale) / camera.width,
                 (2 * camera.scale) / camera.height);
    gl.drawArrays(gl.LINES, 0, this.count / 2);
  }

  clear(): void {
    this.gl.clearColor(0, 0, 0, 0);
    this.gl.clear(this.gl.COLOR_BUFFER_BIT);
  }

  private computeCorners(camera: Camera, pose: Pose): void {
    const size = symbolSize(this.drawing, camera);
    const { placement: p, corners } = this;
    let at = 0;
    const last = size * camera.scale < 1 ? this.links : this.order.length;
    for (let n = 0; n < last; ++n) {
      const shape = this.order[n];
      this.shapes.place(shape, pose, size, p);
      const x = p.x - camera.x;
      const y = p.y - camera.y;
      const rope = this.shapes.ropes.get(shape)?.at(pose);
      for (const line of this.linesOf(shape)) {
        const q = rope ?? line.points;
        const pieces = q.length / 2 - (line.closed ? 0 : 1);
        for (let k = 0; k < pieces; ++k) {
          const a = 2 * k;
          const b = a + 2 < q.length ? a + 2 : 0;
          corners[at++] = x + p.ux * q[a] + p.vx * q[a + 1];
          corners[at++] = y + p.uy * q[a] + p.vy * q[a + 1];
          corners[at++] = x + p.ux * q[b] + p.vx * q[b + 1];
          corners[at++] = y + p.uy * q[b] + p.vy * q[b + 1];
          // A rope has gaps, which are no lines.
          if (rope && !isFinite(q[a] + q[b])) corners.fill(0, at - 4, at);
        }
      }
    }
    this.count = at;
  }
}
