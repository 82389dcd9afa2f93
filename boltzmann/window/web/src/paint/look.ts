// Maps coordinates to pixels: the visible range of flat axes, or a camera with parallel projection for a space.
import type { Axis, Canvas, Cloud } from "../protocol";
import type { Box } from "./figure";
import { mapped, type Mapping } from "./gl";

export type Span = [number, number];
export type Place3 = [number, number, number];

export interface Camera {
  /** Degrees: around the z axis (0: along x), above the xy plane (90: from above). */
  azimuth: number;
  elevation: number;
}

export interface Look {
  /** Mappings to pixels from the lower left: from unit coordinates of marks, and from coordinates of the axes. */
  unit: Mapping;
  coordinates: Mapping;
  cloud(cloud: Pick<Cloud, "origin" | "scale">): Mapping;
  /** Pixels per unit of the x axis (on a logarithmic one per decade), and per unit coordinate of x. */
  perX: number;
  perUnit: number;
  /** In a space: scale of the size of points. */
  perPoint: number;
  fade: number;
}

/** The fraction of paper colour that is mixed into the farthest corner of the box. */
const mostFade = 0.5;

/** The axis' range as drawn: logarithms on a logarithmic axis. */
export function spread(axis: Axis): Span {
  const { low, high } = axis;
  if (axis.logarithmic) return low > 0 && high > low ? [Math.log10(low), Math.log10(high)] : [0, 1];
  return low < high ? [low, high] : [0, 1];
}

/** With equal scales, a system much longer than high would be too thin: it is padded. */
export function wholeRanges(canvas: Canvas): { x: Span; y: Span } {
  const thinnest = 0.12;
  const x = spread(canvas.x);
  const y = spread(canvas.y);
  if (hasEqualAspect(canvas)) {
    const widen = (range: Span, to: number) => {
      const more = Math.max((to - (range[1] - range[0])) / 2, 0);
      range[0] -= more;
      range[1] += more;
    };
    widen(y, thinnest * (x[1] - x[0]));
    widen(x, thinnest * (y[1] - y[0]));
  }
  return { x, y };
}

export function hasEqualAspect(canvas: Canvas): boolean {
  return canvas.equal_aspect && !canvas.x.logarithmic && !canvas.y.logarithmic;
}

/** height: of the whole pane, because a Mapping counts from its lower left. */
export function flatLook(canvas: Canvas, box: Box, view: { x: Span; y: Span }, height: number): Look {
  const per = [box.width / (view.x[1] - view.x[0]), box.height / (view.y[1] - view.y[0])] as const;
  const start = [box.left, height - box.top - box.height] as const;
  const low = [view.x[0], view.y[0]] as const;
  const mapping = (origin: readonly number[], scale: readonly number[], logs: readonly boolean[]): Mapping => {
    const result: Mapping = {
      scale: [1, 1, 0],
      origin: [0, 0, 0],
      logs: [0, 0],
      matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1],
    };
    for (const i of [0, 1] as const) {
      const o = origin[i] ?? 0;
      const s = scale[i] ?? 1;
      if (logs[i]) {
        result.logs[i] = 1;
        result.scale[i] = s;
        result.origin[i] = o;
        result.matrix[5 * i] = per[i];
        result.matrix[12 + i] = start[i] - low[i] * per[i];
      } else {
        // Multiplied here, in double precision.
        result.scale[i] = s * per[i];
        result.origin[i] = start[i] + (o - low[i]) * per[i];
      }
    }
    return result;
  };
  const x = spread(canvas.x);
  const y = spread(canvas.y);
  const logs = [canvas.x.logarithmic, canvas.y.logarithmic];
  return {
    unit: mapping([x[0], y[0]], [x[1] - x[0], y[1] - y[0]], []),
    coordinates: mapping([0, 0], [1, 1], logs),
    cloud: (cloud) => mapping(cloud.origin, cloud.scale, logs),
    perX: per[0],
    perUnit: per[0] * (x[1] - x[0]),
    perPoint: 0,
    fade: 0,
  };
}

const radians = Math.PI / 180;
const dot = (a: Place3, b: Place3) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** The box of a space and the directions of a camera. Positions are unit coordinates: (coordinate - middle) / half. */
export class Space {
  readonly middle: Place3;
  readonly half: number;
  /** Half of the box's sides in unit coordinates. */
  readonly sides: Place3;
  readonly right: Place3;
  readonly up: Place3;
  readonly near: Place3;

  constructor(
    readonly axes: [Axis, Axis, Axis],
    half: number | undefined,
    readonly camera: Camera,
    /** The scale of texts relative to the box, compared with a picture of 1200 x 900. */
    readonly crowding: number,
  ) {
    const widths = axes.map((axis) => Math.abs(axis.high - axis.low));
    this.half = half || Math.max(...widths) / 2 || 1;
    this.middle = axes.map((axis) => (axis.low + axis.high) / 2) as Place3;
    this.sides = widths.map((width) => width / 2 / this.half) as Place3;
    const [ca, sa] = [Math.cos(camera.azimuth * radians), Math.sin(camera.azimuth * radians)];
    const [ce, se] = [Math.cos(camera.elevation * radians), Math.sin(camera.elevation * radians)];
    this.right = [-sa, ca, 0];
    this.up = [-ca * se, -sa * se, ce];
    this.near = [ca * ce, sa * ce, se];
  }

  place(coordinates: readonly number[]): Place3 {
    return this.middle.map((middle, i) => ((coordinates[i] ?? middle) - middle) / this.half) as Place3;
  }
  project(place: Place3): { right: number; up: number; near: number } {
    return { right: dot(this.right, place), up: dot(this.up, place), near: dot(this.near, place) };
  }
  /** A position in the camera's plane through the middle of the box. */
  inPlane(right: number, up: number): Place3 {
    return this.right.map((r, i) => r * right + (this.up[i] ?? 0) * up) as Place3;
  }
  private reach(direction: Place3): number {
    return direction.reduce((sum, d, i) => sum + Math.abs(d) * (this.sides[i] ?? 0), 0);
  }
  /** The range of the picture, with space for the names of the axes. */
  ranges(): { right: Span; up: Span; size: number } {
    const r = this.reach(this.right);
    const u = this.reach(this.up);
    const size = 2 * Math.max(r, u);
    const room = size * this.crowding;
    return { right: [-r - 0.1 * room, r + 0.07 * room], up: [-u - 0.07 * room, u + 0.07 * room], size };
  }

  /** per: pixels per unit coordinate. x, y: the middle of the box, in pixels from the lower left. */
  look(per: number, x: number, y: number): Look {
    const depth = this.reach(this.near) || 1;
    const ranges = this.ranges();
    const screen = Math.max(ranges.right[1] - ranges.right[0], ranges.up[1] - ranges.up[0]);
    const matrix: number[] = [];
    for (const i of [0, 1, 2] as const)
      matrix.push(this.right[i] * per, this.up[i] * per, -this.near[i] / (2 * depth), 0);
    matrix.push(x, y, 0.5, 1);
    const mapping = (origin: readonly number[], scale: readonly number[]): Mapping => ({
      scale: scale.map((s) => s / this.half) as Place3,
      origin: this.place(origin),
      logs: [0, 0],
      matrix,
    });
    return {
      unit: { scale: [1, 1, 1], origin: [0, 0, 0], logs: [0, 0], matrix },
      coordinates: mapping([0, 0, 0], [1, 1, 1]),
      cloud: (cloud) => mapping(cloud.origin, cloud.scale),
      perX: per / this.half,
      perUnit: per,
      perPoint: (per * screen) / 850,
      fade: mostFade,
    };
  }

  /** The part of the box, in coordinates, inside a rectangle of the picture; null if it is empty. */
  visible(right: Span, up: Span): [Span, Span, Span] | null {
    // Each corner of the visible part is on a face of the box, cut by the rectangle's four planes.
    const cuts: [Place3, number][] = [
      [this.right, right[1]],
      [this.right.map((v) => -v) as Place3, -right[0]],
      [this.up, up[1]],
      [this.up.map((v) => -v) as Place3, -up[0]],
    ];
    const found: [Span, Span, Span] = [
      [Infinity, -Infinity],
      [Infinity, -Infinity],
      [Infinity, -Infinity],
    ];
    for (let axis = 0; axis < 3; ++axis)
      for (const end of [-1, 1]) {
        let face = [
          [-1, -1],
          [1, -1],
          [1, 1],
          [-1, 1],
        ].map(([a = 0, b = 0]) => {
          const corner: Place3 = [0, 0, 0];
          corner[axis] = end * (this.sides[axis] ?? 0);
          corner[(axis + 1) % 3] = a * (this.sides[(axis + 1) % 3] ?? 0);
          corner[(axis + 2) % 3] = b * (this.sides[(axis + 2) % 3] ?? 0);
          return corner;
        });
        for (const [normal, most] of cuts) {
          const kept: Place3[] = [];
          face.forEach((a, i) => {
            const b = face[(i + 1) % face.length] ?? a;
            const [da, db] = [dot(normal, a) - most, dot(normal, b) - most];
            if (da <= 0) kept.push(a);
            if (da < 0 !== db < 0 && da !== db)
              kept.push(a.map((v, k) => v + ((b[k] ?? 0) - v) * (da / (da - db))) as Place3);
          });
          face = kept;
        }
        for (const corner of face)
          found.forEach((span, i) => {
            const value = (this.middle[i] ?? 0) + (corner[i] ?? 0) * this.half;
            span[0] = Math.min(span[0], value);
            span[1] = Math.max(span[1], value);
          });
      }
    return found[0][0] <= found[0][1] ? found : null;
  }
}

/** A position in pixels of the pane, from its upper left. */
export function toPane(mapping: Mapping, height: number, place: readonly number[]): [number, number, number] {
  const [x, y, far] = mapped(mapping, place[0] ?? 0, place[1] ?? 0, place[2] ?? 0);
  return [x, height - y, far];
}
