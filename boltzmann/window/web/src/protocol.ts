// The messages of protocol.md as types, and the decoder of binary ones.

/** An array in the payload of a binary message. */
export interface Stored {
  at: number;
  count: number;
  as: "f32" | "f64" | "u32" | "u8";
}
export type Numbers = Float32Array | Float64Array | Uint32Array | Uint8Array;

export interface Axis {
  label: string;
  unit: string;
  factor: number;
  logarithmic: boolean;
  low: number;
  high: number;
}

export interface ColourBar {
  label: string;
  unit: string;
  low: number;
  high: number;
  factor: number;
  map: string;
}

export interface Cloud {
  kind: "cloud";
  count: number;
  dimension: 2 | 3;
  positions: Float32Array;
  origin: [number, number, number];
  scale: [number, number, number];
  values?: Float32Array;
  map: string;
  colour: string;
  diameters?: Float32Array;
  diameter: number;
  size: number;
  shaded: boolean;
  ensemble: string;
  numbers?: Uint32Array;
  stride: number;
}
export interface Marks {
  kind: "circle" | "point" | "line" | "arrow";
  data: Float32Array;
  colours: Uint32Array;
}
export interface Curve {
  kind: "curve";
  x: Float32Array;
  y: Float32Array;
  z?: Float32Array;
  label: string;
  width: number;
  colour: string;
  dashed: boolean;
}
export interface Texts {
  kind: "text";
  data: Float32Array;
  colours: Uint32Array;
  texts: string[];
}
export interface Image {
  kind: "image";
  x0: number;
  y0: number;
  x1: number;
  y1: number;
  columns: number;
  rows: number;
  pixels: Uint8Array;
}
export type Mark = Cloud | Marks | Curve | Texts | Image;

export interface Canvas {
  title: string;
  notes: string[];
  grid: boolean;
  frame: boolean;
  equal_aspect: boolean;
  x: Axis;
  y: Axis;
  z?: Axis;
  azimuth?: number;
  elevation?: number;
  half?: number;
  legend: { label: string; colour: string }[];
  bars: ColourBar[];
  marks: Mark[];
}

export interface View {
  id: number;
  diagnosis: string;
  drawing?: string;
  x?: string;
  y?: string;
  colour?: string;
  size?: string;
  low?: number | null;
  high?: number | null;
  logarithmic?: boolean;
  slice?: string;
  at?: number | null;
  cells?: number | null;
  bins?: number | null;
  levels?: number | number[] | null;
  weight?: string;
  range?: number | null;
  trace?: boolean;
  streaklines?: boolean;
  gap?: number | null;
  vectors?: string;
  azimuth?: number;
  elevation?: number;
  most?: number;
  region?: [number, number][];
  x_range?: [number, number];
  y_range?: [number, number];
}

/** An available diagnosis, as defined by the scenario or the program. */
export interface Diagnosis extends Omit<View, "id" | "diagnosis"> {
  name: string;
  drawing: string;
}

/** An option of a drawing: a key of a view, its description, and its allowed words (none: any). */
export interface Option {
  key: string;
  doc: string;
  words: string[];
}

export interface Quantity {
  name: string;
  label: string;
  unit: string;
}

export interface Hello {
  type: "hello";
  kind: "live" | "replay" | "gallery";
  /** The gallery shows stored runs. */
  runs?: boolean;
  /** A stored run embedded in the page, whose views can't be changed. */
  recording?: boolean;
  title: string;
  description: string;
  name: string;
  dimension: number;
  planned: number;
  folder: string;
  box: { low: number[]; high: number[]; boundary: string[] };
  length_unit: string;
  length_factor: number;
  time_unit: string;
  step_size: string;
  step_size_number: number;
  steps_per_frame: number;
  ensembles: { name: string; class: string; size: number; colour: string; quantities: Quantity[] }[];
  quantities: Quantity[];
  vectors: string[];
  diagnoses: Diagnosis[];
  drawings: Record<string, Option[]>;
  columns: { name: string; unit: string }[];
  /** Empty if possible; otherwise the reason why not. */
  can: { rewind: string; step_size: string; checkpoint: string; seek: string; quit: string };
  maps: Record<string, string[]>;
  colours: string[];
}

export interface Update {
  type: "update";
  state: "paused" | "playing" | "rewinding" | "done" | "failed" | "ended";
  step: number;
  time: string;
  time_number: number;
  planned: number;
  steps_per_second: number;
  steps_per_frame: number;
  /** Absent in a replay. */
  step_size?: string;
  step_size_number?: number;
  frame?: number;
  frames?: number;
  message: string;
  missed: null | { position: number; velocity: number; text: string };
  viewers: number;
  selected: null | {
    ensemble: string;
    particle: number;
    position: number[];
    fields: { name: string; label: string; value: string }[];
  };
  table?: { number: number; from: number; rows: number; values: Float64Array };
  views: { id: number; canvas?: Canvas; error?: string }[];
}

export interface Reply {
  type: "reply";
  id: number;
  ok?: boolean;
  error?: string;
  [more: string]: unknown;
}
export interface Bye {
  type: "bye";
  message: string;
}
export type Message = Hello | Update | Reply | Bye;

const kinds = { f32: Float32Array, f64: Float64Array, u32: Uint32Array, u8: Uint8Array } as const;

function stored(value: unknown): value is Stored {
  return typeof value === "object" && value !== null && "at" in value && "count" in value && "as" in value;
}

/** The header of a binary message, with stored arrays in place of their descriptions. Throws for a damaged one. */
export function decode(bytes: ArrayBuffer): Message {
  const length = new DataView(bytes).getUint32(0, true);
  const payload = 4 + length;
  const text = new TextDecoder().decode(new Uint8Array(bytes, 4, length));
  return JSON.parse(text, (_key, value: unknown) =>
    stored(value) ? new kinds[value.as](bytes, payload + value.at, value.count) : value,
  ) as Message;
}
