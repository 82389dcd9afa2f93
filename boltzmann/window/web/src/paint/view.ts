// The displayed part of a canvas and its camera: zoom, pan, rotation, following; and the resulting layout.
import type { Canvas } from "../protocol";
import { Figure, type Range } from "./figure";
import {
  flatLook,
  hasEqualAspect,
  Space,
  toPane,
  wholeRanges,
  type Camera,
  type Look,
  type Place3,
  type Span,
} from "./look";
import type { Pen } from "./text";
import type { Theme } from "./theme";

/** The visible ranges, in coordinates of the canvas' axes. */
export interface Ranges {
  x: Span;
  y: Span;
  /** In a space: the visible part of the box in x, y and z. */
  z?: Span;
  /** In a space: the ranges of the projected picture (Projection in canvas.hpp), and its camera in degrees. */
  right?: Span;
  up?: Span;
  azimuth?: number;
  elevation?: number;
  /** True if only a part is visible. */
  zoomed: boolean;
}

/** The layout of a canvas in a pane; lengths are device pixels. */
export interface Layout {
  canvas: Canvas;
  figure: Figure;
  look: Look;
  space: Space | null;
  width: number;
  height: number;
  /** Device pixels per CSS pixel; per pixel of a picture of 1200 x 900; per pixel of one of its texts. */
  scale: number;
  unit: number;
  textUnit: number;
}

interface FlatView {
  x: Span;
  y: Span;
}
interface SpaceView {
  /** The centre of the view, in unit coordinates. */
  target: Place3;
  /** Pixels per unit coordinate, relative to the smaller side of the available space. */
  scale: number;
}

/** Minimum scale of marks, minimum and maximum scale of texts, in CSS pixels: numbers at ticks have 20. */
const leastUnit = 0.58;
const leastText = 0.6;
const mostText = 0.75;

const around = (middle: number, width: number): Span => [middle - width / 2, middle + width / 2];
const between = (value: number, low: number, high: number) => Math.min(Math.max(value, low), high);
/** Converts a coordinate, which may be a logarithm, to the value. */
const valueOf = (at: number, logarithmic: boolean) => (logarithmic ? 10 ** at : at);
const stronger = (a: number, b: number) => (Math.abs(Math.log(a)) > Math.abs(Math.log(b)) ? a : b);
const moved = (place: Place3, by: Place3, sign: number) => place.map((p, i) => p + sign * (by[i] as number)) as Place3;

/** The properties that must stay the same to keep the view for the next canvas. */
function kindOf(canvas: Canvas): string {
  return (
    [canvas.x, canvas.y, canvas.z].map((axis) => axis && [axis.label, axis.unit, axis.logarithmic].join()).join(";") +
    canvas.equal_aspect
  );
}

export class View {
  canvas: Canvas | null = null;
  /** In coordinates of the axes. */
  followed: number[] | null = null;
  /** True: with the title of the canvas. */
  headed = true;
  private kind = "";
  private flat: FlatView | null = null;
  private space: SpaceView | null = null;
  private camera: Camera | null = null;
  private labels = 0;
  private planned: Layout | null = null;

  constructor(
    private readonly host: HTMLElement,
    private readonly pen: Pen,
    private readonly maps: Record<string, string[]>,
    private theme: Theme,
  ) {}

  /** Returns true if this canvas has other axes, so that the view is reset. */
  show(canvas: Canvas): boolean {
    const kind = kindOf(canvas);
    const other = kind !== this.kind;
    if (other) this.flat = this.space = this.camera = this.followed = null;
    this.kind = kind;
    this.canvas = canvas;
    this.planned = null;
    return other;
  }
  paintOn(theme: Theme) {
    this.theme = theme;
    this.planned = null;
  }
  head(on: boolean) {
    this.headed = on;
    this.planned = null;
  }
  follow(place: number[] | null) {
    this.followed = place;
    this.planned = null;
  }
  reset() {
    this.flat = this.space = this.camera = this.planned = null;
  }

  get turns(): boolean {
    return !!this.canvas?.z;
  }

  /** x, y: CSS pixels of the pane that stay fixed; NaN: its middle. */
  zoomAt(x: number, y: number, factorX: number, factorY: number) {
    const layout = this.layout();
    if (!layout) return;
    const { canvas, figure, look, space, scale } = layout;
    const free = this.followed || !isFinite(x) || !isFinite(y);
    if (space) {
      const view = this.seenSpace(layout);
      const next = between(view.scale * stronger(factorX, factorY), 1e-3, 1e5);
      const { room } = figure;
      const way = free ? 0 : (1 - view.scale / next) / look.perUnit;
      const step = space.inPlane(
        (x * scale - room.left - room.width / 2) * way || 0,
        (room.top + room.height / 2 - y * scale) * way || 0,
      );
      this.space = { scale: next, target: moved(view.target, step, 1) };
    } else {
      const view = this.seenFlat(canvas);
      if (hasEqualAspect(canvas)) factorX = factorY = stronger(factorX, factorY);
      const whole = wholeRanges(canvas);
      const { box } = figure;
      const zoomed = (span: Span, of: Span, fraction: number, factor: number): Span => {
        const width = span[1] - span[0];
        const all = of[1] - of[0];
        const next = between(width / factor, 1e-6 * all, 50 * all);
        const low = span[0] + between(fraction, 0, 1) * (width - next);
        return [low, low + next];
      };
      this.flat = {
        x: zoomed(view.x, whole.x, free ? 0.5 : (x * scale - box.left) / box.width, factorX),
        y: zoomed(view.y, whole.y, free ? 0.5 : 1 - (y * scale - box.top) / box.height, factorY),
      };
    }
    this.planned = null;
  }

  /** Moves the drawing by CSS pixels. */
  pan(dx: number, dy: number) {
    const layout = this.layout();
    if (!layout) return;
    const { canvas, figure, look, space, scale } = layout;
    if (space) {
      const view = this.seenSpace(layout);
      const per = scale / look.perUnit;
      this.space = { scale: view.scale, target: moved(view.target, space.inPlane(dx * per, -dy * per), -1) };
    } else {
      const view = this.seenFlat(canvas);
      const shifted = (span: Span, pixels: number, of: number): Span => {
        const way = ((span[1] - span[0]) * pixels * scale) / of;
        return [span[0] + way, span[1] + way];
      };
      this.flat = { x: shifted(view.x, -dx, figure.box.width), y: shifted(view.y, dy, figure.box.height) };
    }
    this.planned = null;
  }

  /** Rotates the camera, in degrees. */
  orbit(azimuth: number, elevation: number) {
    const camera = this.seenCamera();
    this.camera = {
      azimuth: (((camera.azimuth + azimuth) % 360) + 360) % 360,
      elevation: between(camera.elevation + elevation, -90, 90),
    };
    this.planned = null;
  }

  ranges(): Ranges {
    const layout = this.layout();
    if (!layout) return { x: [0, 1], y: [0, 1], zoomed: false };
    const { canvas, figure, look, space, height } = layout;
    if (!space) {
      const view = this.seenFlat(canvas);
      const values = (span: Span, logarithmic: boolean): Span => [
        valueOf(span[0], logarithmic),
        valueOf(span[1], logarithmic),
      ];
      return {
        x: values(view.x, canvas.x.logarithmic),
        y: values(view.y, canvas.y.logarithmic),
        zoomed: this.flat !== null || this.followed !== null,
      };
    }
    const zoomed = this.space !== null || this.followed !== null;
    const start = toPane(look.unit, height, [0, 0, 0]);
    // The extent of a rectangle of the pane, in unit coordinates of the camera's plane.
    const right = (left: number, width: number): Span => [
      (left - start[0]) / look.perUnit,
      (left + width - start[0]) / look.perUnit,
    ];
    const up = (top: number, tall: number): Span => [
      (start[1] - top - tall) / look.perUnit,
      (start[1] - top) / look.perUnit,
    ];
    const { clip } = figure;
    const shown = zoomed ? figure.room : figure.box;
    const [x, y, z] =
      space.visible(right(clip.left, clip.width), up(clip.top, clip.height)) ??
      space.axes.map((axis): Span => [axis.low, axis.high]);
    const centre = space.project(space.middle);
    const absolute = (span: Span, at: number): Span => [at + span[0] * space.half, at + span[1] * space.half];
    return {
      x: x as Span,
      y: y as Span,
      z: z as Span,
      right: absolute(right(shown.left, shown.width), centre.right),
      up: absolute(up(shown.top, shown.height), centre.up),
      ...space.camera,
      zoomed,
    };
  }

  private seenCamera(): Camera {
    return this.camera ?? { azimuth: this.canvas?.azimuth ?? 35, elevation: this.canvas?.elevation ?? 22 };
  }

  private seenFlat(canvas: Canvas): FlatView {
    const whole = wholeRanges(canvas);
    const view = { ...(this.flat ?? whole) };
    if (this.flat && hasEqualAspect(canvas))
      view.y = around(
        (view.y[0] + view.y[1]) / 2,
        ((view.x[1] - view.x[0]) * (whole.y[1] - whole.y[0])) / (whole.x[1] - whole.x[0]),
      );
    const centred = (span: Span, at: number | undefined, logarithmic: boolean): Span => {
      const middle = at === undefined ? NaN : logarithmic ? Math.log10(at) : at;
      return isFinite(middle) ? around(middle, span[1] - span[0]) : span;
    };
    view.x = centred(view.x, this.followed?.[0], canvas.x.logarithmic);
    view.y = centred(view.y, this.followed?.[1], canvas.y.logarithmic);
    return view;
  }

  private seenSpace({ figure: { room }, look, space, height }: Layout): SpaceView {
    if (this.space) return this.space;
    const start = toPane(look.unit, height, [0, 0, 0]);
    const right = (room.left + room.width / 2 - start[0]) / look.perUnit;
    const up = (start[1] - room.top - room.height / 2) / look.perUnit;
    return { target: space?.inPlane(right, up) ?? [0, 0, 0], scale: look.perUnit / Math.min(room.width, room.height) };
  }

  /** The current layout of the canvas; null if there is none or no space for it. */
  layout(): Layout | null {
    const { canvas, host, planned } = this;
    const scale = window.devicePixelRatio || 1;
    const width = Math.round(host.clientWidth * scale);
    const height = Math.round(host.clientHeight * scale);
    if (!canvas || width < 2 || height < 2) return null;
    if (planned && planned.width === width && planned.height === height && planned.scale === scale) return planned;
    const fitting = Math.sqrt((host.clientWidth * host.clientHeight) / 1.08e6);
    const unit = Math.max(fitting, leastUnit) * scale;
    // In a small pane texts stay readable; in a large one the drawing uses the space.
    const text = between(fitting, leastText, mostText);
    const textUnit = text * scale;
    const size = { canvas, width, height, scale, unit, textUnit };
    const figure = (x: Range, y: Range, ratio: number) =>
      new Figure(
        canvas,
        this.pen,
        this.theme,
        this.maps,
        width,
        height,
        textUnit,
        x,
        y,
        ratio,
        this.flat ? this.labels * textUnit : 0,
        this.headed,
      );
    if (canvas.z) {
      const space = new Space([canvas.x, canvas.y, canvas.z], canvas.half, this.seenCamera(), text / fitting);
      const { right, up } = space.ranges();
      const none = { low: 0, high: 1, logarithmic: false, factor: 1 };
      const around = figure(none, none, (right[1] - right[0]) / (up[1] - up[0]));
      const { box, room } = around;
      let per = box.width / (right[1] - right[0]);
      let x = box.left - right[0] * per;
      let y = height - box.top - box.height - up[0] * per;
      if (this.space || this.followed) {
        if (this.space) per = this.space.scale * Math.min(room.width, room.height);
        const target = space.project(this.followed ? space.place(this.followed) : (this.space?.target ?? [0, 0, 0]));
        x = room.left + room.width / 2 - target.right * per;
        y = height - room.top - room.height / 2 - target.up * per;
      }
      return (this.planned = { ...size, figure: around, look: space.look(per, x, y), space });
    }
    const view = this.seenFlat(canvas);
    const range = (span: Span, { logarithmic, factor }: Canvas["x"]): Range => ({
      low: valueOf(span[0], logarithmic),
      high: valueOf(span[1], logarithmic),
      logarithmic,
      factor,
    });
    const whole = wholeRanges(canvas);
    const ratio = hasEqualAspect(canvas) ? (whole.x[1] - whole.x[0]) / (whole.y[1] - whole.y[0]) : 0;
    const frame = figure(range(view.x, canvas.x), range(view.y, canvas.y), ratio);
    // During zoom, longer labels may shift the frame, but shorter ones don't shift it back.
    this.labels = frame.labels / textUnit;
    return (this.planned = { ...size, figure: frame, look: flatLook(canvas, frame.box, view, height), space: null });
  }
}
