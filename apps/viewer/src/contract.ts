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

/** anchor, symbol, element, body i, x, y, body j, x, y */
export type Shape = [number, number, number, number, number, number, number, number, number];

/** Names of bodies, elements and points: the page's own, and a drawing's where its model has others. */
export interface Names {
  bodies: string[];
  elements: { types: string[]; type: number[]; name: string[] };
  points: { body: number[]; name: string[]; at: number[] };
}

export interface Drawing extends Partial<Names> {
  symbols: { lines: Line[] }[];
  shapes: Shape[];
  loads: { element: number; body: number; point: [number, number]; in_body_axes: boolean }[];
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
  t: PackedNumbers;
  frames: PackedFrames;
  velocities?: PackedNumbers;
  reactions?: { elements: number[]; values: PackedNumbers };
  loads?: PackedNumbers;
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
}

export interface PageData extends Names {
  catena_view: number;
  version: string;
  scene: string;
  description: string;
  gravity: [number, number];
  parameters: Record<string, number>;
  drawings: Drawing[];
  analyses: Analysis[];
  notes: string[];
}
