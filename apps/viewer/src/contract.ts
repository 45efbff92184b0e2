// The data of a page, version 1, as the library writes it. What each field means: apps/manual/viewer.md.

export interface PackedNumbers {
  type: "float32" | "float64";
  data: string;
}

export interface PackedFrames {
  type: "float32" | "uint16";
  step: [number, number, number];
  base: PackedNumbers;
  data: string;
}

export interface Line {
  role: string;
  points: number[];
  radius?: number;
  closed?: boolean;
  filled?: boolean;
  width?: number;
}

/** anchor, symbol, element, body i, x, y, body j, x, y; of a rope the number of its way in place of body i */
export type Shape = [number, number, number, number, number, number, number, number, number];

/** Names of bodies, elements and points: the page's own, and a drawing's where its model has others. */
export interface Names {
  bodies: string[];
  elements: { types: string[]; type: number[]; name: string[] };
  points: { body: number[]; name: string[]; at: number[] };
}

export interface Rope {
  /** Body, x, y and radius of each, the radius positive where the circle is on the left of the rope. */
  nodes: number[];
  /** The last node belongs to the next part of the rope. */
  leads_on: boolean;
}

export interface Drawing extends Partial<Names> {
  symbols: { lines: Line[] }[];
  shapes: Shape[];
  loads: { element: number; body: number; point: [number, number]; in_body_axes: boolean }[];
  ropes?: Rope[];
  typical_length: number;
  given: number[];
}

export interface Column {
  name: string;
  unit: string;
  /** Where the values number words: these. */
  words?: Record<string, string>;
  values: PackedNumbers;
}

export interface Measure {
  name: string;
  unit: string;
  value: number | null;
  t?: number;
  gradient?: Record<string, number | null>;
}

export interface Poses {
  count: number;
  total: number;
  stride: number;
  /** Whether velocities and forces were kept, where the analysis gives them. */
  arrows: boolean;
  t: PackedNumbers;
  frames: PackedFrames;
  velocities?: PackedNumbers;
  reactions?: { elements: number[]; values: PackedNumbers };
  loads?: PackedNumbers;
}

/** A design of an optimisation or a sweep: its analyses with its values of parameters. */
export interface Design {
  name: string;
  /** Its row of the analysis, where it has one. */
  row?: number;
  values: Record<string, number>;
  analyses: Analysis[];
}

export interface ShownUnit {
  unit: string;
  /** Number in this unit = factor x number in SI. */
  factor: number;
}

export type FieldRecord = Record<string, unknown>;

export interface Analysis {
  type: string;
  status: string;
  message: string;
  warnings: string[];
  seconds: number;
  dof?: number;
  mobility?: number;
  redundant: string[];
  set: Record<string, number>;
  fields: Record<string, unknown>;
  measures: Measure[];
  drawing: number;
  rows: { count: number; total: number; stride: number };
  columns: Column[];
  poses: Poses;
  shapes: PackedNumbers[];
  designs?: Design[];
}

export interface PageData extends Names {
  catena_view: number;
  version: string;
  scene: string;
  description: string;
  gravity: [number, number];
  parameters: Record<string, number>;
  /** By the SI unit in which the data have the numbers. */
  units: Record<string, ShownUnit>;
  drawings: Drawing[];
  analyses: Analysis[];
  notes: string[];
}
