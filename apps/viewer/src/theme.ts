// Colours of roles and bodies, dark and light; those of bodies are the ones of Okabe and Ito, which people with
// colour-blindness can tell apart (lib/catena/drawing/figures/role_colours.hpp).

export type Rgb = [number, number, number];

const bodyColours: Rgb[] = [
  [0, 114, 178],
  [213, 94, 0],
  [0, 158, 115],
  [204, 121, 167],
  [230, 159, 0],
  [86, 180, 233],
  [140, 122, 43],
];

const ofBody = new Set(["link", "gear", "curve", "wheel"]);

function mix(a: Rgb, b: Rgb, part: number): Rgb {
  return [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])];
}

export function css(colour: Rgb): string {
  return `rgb(${colour.map((c) => Math.round(c)).join(",")})`;
}

export class Theme {
  readonly paper: Rgb;
  readonly ink: Rgb;
  readonly faint: Rgb;
  readonly accent: Rgb;
  readonly warning: Rgb;
  readonly grid: Rgb;
  private readonly known = new Map<string, string>();

  constructor(readonly dark: boolean) {
    this.paper = dark ? [22, 25, 30] : [255, 255, 255];
    this.ink = dark ? [226, 230, 236] : [34, 34, 34];
    this.faint = dark ? [130, 138, 150] : [120, 124, 130];
    this.accent = dark ? [120, 190, 255] : [0, 95, 170];
    this.warning = dark ? [255, 150, 90] : [190, 60, 0];
    this.grid = dark ? [48, 53, 61] : [228, 230, 234];
  }

  body(body: number): Rgb {
    return body < 0 ? this.faint : bodyColours[body % bodyColours.length];
  }

  /** Of line number k in a plot. */
  line(k: number): string {
    const colour = bodyColours[k % bodyColours.length];
    return css(this.dark ? mix(colour, [255, 255, 255], 0.25) : mix(colour, [0, 0, 0], 0.1));
  }

  edge(role: string, body: number): string {
    // The rim of a wheel is drawn apart from its area.
    if (role === "wheel") return this.fill(role, body);
    return this.remember("edge", role, body, () => {
      if (ofBody.has(role)) return mix(this.body(body), this.ink, this.dark ? 0.35 : 0.3);
      if (role === "driver") return this.dark ? [255, 120, 120] : [176, 42, 42];
      if (role === "support" || role === "guide") return mix(this.faint, this.ink, 0.2);
      if (role === "measure") return this.faint;
      return this.ink;
    });
  }

  fill(role: string, body: number): string {
    return this.remember("fill", role, body, () => {
      if (role === "gear" || role === "wheel") return mix(this.body(body), this.paper, 0.82);
      if (ofBody.has(role)) return mix(this.body(body), this.paper, this.dark ? 0.5 : 0.6);
      if (role === "driver") return this.dark ? [255, 120, 120] : [176, 42, 42];
      if (role === "support" || role === "rod") return mix(this.faint, this.paper, 0.65);
      return this.paper;
    });
  }

  private remember(what: string, role: string, body: number, make: () => Rgb): string {
    const key = `${what} ${role} ${ofBody.has(role) ? (body < 0 ? -1 : body % bodyColours.length) : 0}`;
    let colour = this.known.get(key);
    if (colour === undefined) {
      colour = css(make());
      this.known.set(key, colour);
    }
    return colour;
  }
}
