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

export interface Drawing {
  symbols: { lines: Line[] }[];
  shapes: Shape[];
  loads: { element: number; body: number; point: [number, number]; in_body_axes: boolean }[];
  typical_length: number;
  given: number[];
}

export interface Column {
  name: string;
  unit: string;
  values: PackedNumbers;
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
  drawing: number;
  rows: { count: number; total: number; stride: number };
  columns: Column[];
  poses: Poses;
  shapes: PackedNumbers[];
}

export interface PageData {
  catena_view: number;
  version: string;
  scene: string;
  description: string;
  gravity: [number, number];
  parameters: Record<string, number>;
  bodies: string[];
  elements: { types: string[]; type: number[]; name: string[] };
  points: { body: number[]; name: string[]; at: number[] };
  drawings: Drawing[];
  analyses: Analysis[];
  notes: string[];
}
