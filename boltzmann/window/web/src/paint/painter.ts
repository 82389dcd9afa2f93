// One pane of the page: shows a canvas, and rotates, moves and zooms it without requesting another one.
import type { Canvas, Cloud } from "../protocol";
import { drawLine, type Box } from "./figure";
import { steer } from "./gestures";
import { mapped, shared, type Shared } from "./gl";
import { toPane } from "./look";
import { GpuMarks, onGpu, type Scene } from "./marks";
import { Outline } from "./outline";
import { drawCurve, drawImage, drawTexts } from "./paths";
import { Pen, plainText } from "./text";
import { themes, css } from "./theme";
import { Trails } from "./trails";
import { View, type Ranges } from "./view";

export type { Ranges };

export interface Hit {
  ensemble: string;
  particle: number;
}

export class Painter {
  readonly element = document.createElement("canvas");
  /** Called when the user has zoomed, panned or rotated. */
  onview?: () => void;
  /** Called when the user has clicked, with the particle or null. */
  onpick?: (hit: Hit | null) => void;
  /** Called when a picture is complete, including the work of the GPU. */
  onpaint?: (canvas: Canvas) => void;
  /** The number of particles of the last picture, and its time, including that of the GPU. */
  drawn = { points: 0, milliseconds: 0 };

  private readonly context: CanvasRenderingContext2D;
  private readonly pen: Pen;
  private readonly view: View;
  private readonly shared: Shared | null;
  private readonly gpu: GpuMarks | null;
  private readonly trails = new Trails();
  private readonly observer: ResizeObserver;
  private readonly unsteer: () => void;
  private readonly maps: Record<string, string[]>;
  private colours;
  private uploaded: Canvas | null = null;
  private marked: number[] | null = null;
  /** Diameter of the selected particle, in units of the x axis. */
  private ring = 0;
  private tracking = false;
  private trailLayer: HTMLCanvasElement | null = null;
  private trailKey = "";
  private trailCount = 0;

  private request = 0;
  private working = 0;
  private again = false;
  private coarse = 1;
  private slow = 0;
  private rest = 0;

  /** The host must have a size of its own; the painter fills it. */
  constructor(
    private readonly host: HTMLElement,
    options: { maps: Record<string, string[]>; theme: "light" | "dark" },
  ) {
    const { element } = this;
    element.tabIndex = 0;
    element.setAttribute("role", "application");
    element.setAttribute("aria-roledescription", "picture");
    element.style.cssText =
      "position:absolute;inset:0;width:100%;height:100%;display:block;touch-action:none;outline-offset:-2px";
    host.append(element);
    const context = element.getContext("2d", { alpha: false });
    if (!context) throw new Error("this browser has no 2D canvas");
    this.context = context;
    this.pen = new Pen(context);
    this.maps = options.maps;
    this.colours = themes[options.theme];
    this.view = new View(host, this.pen, options.maps, this.colours);
    this.shared = shared();
    this.gpu = this.shared && new GpuMarks(this.shared);
    this.shared?.restored.add(this.restore);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(host);
    this.unsteer = steer(this);
    this.resize();
  }

  /** Shows the next frame. The view is kept, unless the canvas has other axes. */
  show(canvas: Canvas) {
    const before = this.view.canvas;
    if (this.view.show(canvas)) {
      this.marked = null;
      this.ring = 0;
      this.forget();
    } else if (this.tracking && before && this.shared && !this.shared.gl.isContextLost()) {
      this.trails.add(
        this.shared,
        before.marks.filter((mark): mark is Cloud => mark.kind === "cloud"),
      );
    }
    this.element.setAttribute("aria-label", plainText(canvas.title) || "picture");
    this.later();
  }

  theme(theme: "light" | "dark") {
    this.colours = themes[theme];
    this.view.paintOn(this.colours);
    this.later();
  }
  /** Shows or hides the title of the canvas. */
  head(on: boolean) {
    if (on === this.view.headed) return;
    this.view.head(on);
    this.later();
  }
  /** Also called when the pane is added to the page. */
  resize() {
    const style = getComputedStyle(this.host);
    if (style.position === "static") this.host.style.position = "relative";
    this.pen.use(style.fontFamily);
    this.view.paintOn(this.colours);
    this.later();
  }

  get turns(): boolean {
    return this.view.turns;
  }
  /** Restores the default view of the canvas. */
  reset() {
    this.view.reset();
    this.changed();
  }
  zoom(factor: number) {
    this.zoomAt(NaN, NaN, factor, factor);
  }
  /** x, y: CSS pixels of the pane that stay fixed; NaN: its middle. */
  zoomAt(x: number, y: number, factorX: number, factorY: number) {
    this.view.zoomAt(x, y, factorX, factorY);
    this.changed();
  }
  /** Moves the drawing by CSS pixels. */
  pan(dx: number, dy: number) {
    this.view.pan(dx, dy);
    this.changed();
  }
  /** Rotates the camera of a space, in degrees. */
  orbit(azimuth: number, elevation: number) {
    if (!this.turns) return;
    this.view.orbit(azimuth, elevation);
    this.changed();
  }
  /** Keeps a position, in coordinates of the axes, in the middle. */
  follow(place: number[] | null) {
    this.view.follow(place);
    this.later();
  }
  /** Draws a ring around a position. */
  mark(place: number[] | null) {
    this.marked = place;
    this.later();
  }
  /** On: the particles of every frame remain as faint points. Off: removes them. */
  track(on: boolean) {
    this.tracking = on;
    if (!on) this.forget();
    this.later();
  }
  ranges(): Ranges {
    return this.view.ranges();
  }

  /** The particle at a position of the pane, in CSS pixels. */
  pick(x: number, y: number): Hit | null {
    const layout = this.view.layout();
    if (!layout) return null;
    const { canvas, look, scale, height, space } = layout;
    const [px, py] = [x * scale, height - y * scale];
    const tolerance = 9 * scale;
    let best: { cloud: Cloud; k: number; rank: number; diameter: number } | null = null;
    for (const cloud of canvas.marks) {
      if (cloud.kind !== "cloud") continue;
      const by = look.cloud(cloud);
      const { dimension: d, positions, diameters, diameter: common } = cloud;
      for (let k = 0; k < cloud.count; ++k) {
        const at = mapped(
          by,
          positions[d * k] as number,
          positions[d * k + 1] as number,
          d > 2 ? (positions[d * k + 2] as number) : 0,
        );
        const away = Math.hypot(at[0] - px, at[1] - py);
        const diameter = diameters ? (diameters[k] as number) : common;
        const radius = (diameter * look.perX) / 2;
        if (!(away < Math.max(radius, tolerance))) continue;
        // A particle under the pointer precedes those near it; then the nearest in depth, then the last drawn.
        const rank = away < radius ? (space ? at[2] : 0) - 1e6 : away;
        if (!best || rank <= best.rank) best = { cloud, k, rank, diameter };
      }
    }
    if (!best) return null;
    this.ring = best.diameter;
    return { ensemble: best.cloud.ensemble, particle: best.cloud.numbers?.[best.k] ?? best.k };
  }

  click(x: number, y: number) {
    if (this.onpick) this.onpick(this.pick(x, y));
  }

  /** The region of the drawing in the pane, in CSS pixels. */
  frameBox(): Box {
    const layout = this.view.layout();
    if (!layout) return { left: 0, top: 0, width: 0, height: 0 };
    const { figure, scale } = layout;
    const { left, top, width, height } = figure.box;
    return { left: left / scale, top: top / scale, width: width / scale, height: height / scale };
  }

  dispose() {
    cancelAnimationFrame(this.request);
    clearTimeout(this.rest);
    clearTimeout(this.working);
    this.observer.disconnect();
    this.unsteer();
    this.shared?.restored.delete(this.restore);
    this.forget();
    this.gpu?.dispose();
    this.view.canvas = null;
    this.element.remove();
  }

  private readonly restore = () => {
    this.uploaded = null;
    this.forget();
    this.later();
  };

  private forget() {
    if (this.shared) this.trails.clear(this.shared);
    this.trailKey = "";
  }

  private changed() {
    // If painting is slow, fewer particles are drawn while the view moves.
    if (this.slow > 60) {
      this.coarse = Math.min(16, Math.ceil(this.slow / 40));
      clearTimeout(this.rest);
      this.rest = window.setTimeout(() => {
        this.coarse = 1;
        this.later();
      }, 180);
    }
    this.later();
    this.onview?.();
  }

  /**
   * Schedules a paint before the browser's next frame, but not while the GPU is still busy with the previous picture.
   */
  private later() {
    if (this.working) this.again = true;
    else if (!this.request) this.request = requestAnimationFrame(() => this.paint());
  }

  private finish(began: number, canvas: Canvas) {
    this.working = 0;
    const milliseconds = performance.now() - began;
    if (this.coarse === 1) this.slow = milliseconds;
    this.drawn.milliseconds = milliseconds;
    if (this.again) this.later();
    this.again = false;
    this.onpaint?.(canvas);
  }

  /** Waits for the GPU, because its time can't be predicted. */
  private await(began: number, canvas: Canvas) {
    const gl = this.shared?.gl;
    const fence = gl?.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!gl || !fence) return this.finish(began, canvas);
    gl.flush();
    clearTimeout(this.working);
    const look = () => {
      const done = gl.isContextLost() || gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.SIGNALED;
      if (!done && performance.now() - began < 20000) {
        this.working = window.setTimeout(look, 4);
      } else {
        gl.deleteSync(fence);
        this.finish(began, canvas);
      }
    };
    this.working = window.setTimeout(look, 0);
  }

  /** Paints immediately; new canvases are painted automatically. */
  paint() {
    cancelAnimationFrame(this.request);
    this.request = 0;
    const { context, host, element, colours: theme } = this;
    const began = performance.now();
    const layout = this.view.layout();
    if (!layout) {
      element.style.background = css(theme.paper);
      if (!this.view.canvas) element.width = host.clientWidth;
      return;
    }
    const { canvas, figure, look, space, width, height, unit, textUnit } = layout;
    if (element.width !== width) element.width = width;
    if (element.height !== height) element.height = height;
    figure.drawUnder();
    const { clip } = figure;
    const scene: Scene = {
      look,
      theme,
      maps: this.maps,
      width,
      height,
      unit,
      textUnit,
      clip,
      space: space !== null,
      coarse: this.coarse,
    };
    const outline = space && new Outline(space, look, this.pen, theme, textUnit, clip.width, height);
    context.save();
    context.beginPath();
    context.rect(clip.left, clip.top, clip.width, clip.height);
    context.clip();
    outline?.drawBehind();
    const points = this.paintMarks(canvas, scene);
    outline?.drawBefore();
    outline?.nameAxes();
    if (this.marked) this.paintRing(this.marked, scene, layout.scale);
    context.restore();
    figure.drawOver();
    this.drawn = { points, milliseconds: this.drawn.milliseconds };
    this.await(began, canvas);
  }

  private paintMarks(canvas: Canvas, scene: Scene): number {
    const { context, shared, gpu } = this;
    const { clip, look, theme, unit, textUnit, height } = scene;
    const gl = shared && gpu && !shared.gl.isContextLost() ? shared.gl : null;
    if (gl && gpu) {
      shared?.grow(scene.width, height);
      gl.scissor(clip.left, height - clip.top - clip.height, clip.width, clip.height);
      if (this.uploaded !== canvas) gpu.upload(canvas);
      this.uploaded = canvas;
      gl.clearColor(0, 0, 0, 0);
      gl.depthMask(true);
      gl.clear(gl.DEPTH_BUFFER_BIT);
    }
    let points = 0;
    let open = false;
    let waiting: number[] = []; // clouds and circles in space whose soft edges come last
    const begin = () => {
      if (!open) gl?.clear(gl.COLOR_BUFFER_BIT);
      open = true;
    };
    const soften = () => {
      for (const k of waiting) gpu?.drawDiscs(k, scene, 2);
      waiting = [];
    };
    // Copies the output of the GPU into the picture.
    const deliver = (to = context) => {
      soften();
      const { left, top, width: wide, height: tall } = clip;
      if (open && shared)
        to.drawImage(shared.element, left, shared.element.height - height + top, wide, tall, left, top, wide, tall);
      open = false;
    };
    const firstCloud = canvas.marks.findIndex((mark) => mark.kind === "cloud");
    canvas.marks.forEach((mark, k) => {
      if (!onGpu(mark)) {
        deliver();
        if (mark.kind === "curve") drawCurve(mark, look, this.pen, theme, unit, height);
        else if (mark.kind === "text") drawTexts(mark, look, this.pen, theme, textUnit, height);
        else drawImage(mark, look, context, height);
        return;
      }
      if (!gl || !gpu) return;
      if (k === firstCloud && this.trails.frames.length) {
        deliver();
        this.paintTrails(gl, scene, begin, deliver);
      }
      begin();
      if (mark.kind === "line" || mark.kind === "arrow") {
        soften();
        gl.disable(gl.DEPTH_TEST);
        gpu.drawStrokes(k, scene);
        return;
      }
      if (scene.space) {
        gl.enable(gl.DEPTH_TEST);
        waiting.push(k);
      } else {
        gl.disable(gl.DEPTH_TEST);
      }
      points += gpu.drawDiscs(k, scene, scene.space ? 1 : 0);
    });
    deliver();
    if (!shared && canvas.marks.some(onGpu))
      drawLine(
        this.pen,
        "this browser has no WebGL2: particles, lines and arrows can't be drawn",
        theme.quiet,
        clip,
        20 * textUnit,
      );
    return points;
  }

  /** Tracks are kept as an image, to which the newest frame is added while the view does not move. */
  private paintTrails(
    gl: WebGL2RenderingContext,
    scene: Scene,
    begin: () => void,
    deliver: (to: CanvasRenderingContext2D) => void,
  ) {
    const layer = (this.trailLayer ??= document.createElement("canvas"));
    if (layer.width !== scene.width || layer.height !== scene.height) {
      layer.width = scene.width;
      layer.height = scene.height;
      this.trailKey = "";
    }
    const context = layer.getContext("2d");
    if (!context) return;
    const { frames, count } = this.trails;
    const key = JSON.stringify([scene.look.unit, scene.look.coordinates, scene.clip, scene.theme]);
    let fresh = count - this.trailCount;
    // Removed tracks stay on the image until it is redrawn.
    if (key !== this.trailKey || fresh < 0 || (count > frames.length && count % 100 === 0)) {
      context.clearRect(0, 0, layer.width, layer.height);
      fresh = frames.length;
    }
    this.trailKey = scene.coarse > 1 ? "" : key;
    this.trailCount = count;
    if (fresh > 0) {
      begin();
      gl.disable(gl.DEPTH_TEST);
      const some = frames.slice(-fresh).filter((_, i) => i % scene.coarse === 0);
      for (const frame of some) for (const trail of frame) this.gpu?.drawTrail(trail, scene);
      deliver(context);
    }
    this.context.drawImage(layer, 0, 0);
  }

  private paintRing(place: number[], { look, height, space, theme }: Scene, scale: number) {
    const [x, y] = toPane(look.coordinates, height, space ? place : place.slice(0, 2));
    if (!isFinite(x) || !isFinite(y)) return;
    const { context, view } = this;
    const common =
      view.canvas?.marks.map((mark) => (mark.kind === "cloud" && !mark.diameters ? mark.diameter : 0)) ?? [];
    const diameter = this.ring || Math.max(0, ...common);
    const radius = Math.max((diameter * look.perX) / 2 + 3.5 * scale, 8 * scale);
    for (const [colour, wide] of [
      [css(theme.paper, 0.9), 5],
      [theme.accent, 2.5],
    ] as const) {
      context.strokeStyle = colour;
      context.lineWidth = wide * scale;
      context.beginPath();
      context.arc(x, y, radius, 0, 7);
      context.stroke();
    }
  }
}
