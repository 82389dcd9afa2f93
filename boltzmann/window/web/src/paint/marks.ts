// The marks of a canvas on the GPU. Their arrays are uploaded once and drawn for each paint.
import type { Canvas, Cloud, Mark, Marks } from "../protocol";
import type { Box } from "./figure";
import type { Mapping, Shared } from "./gl";
import type { Look } from "./look";
import { parse, shown, type Rgba, type Theme } from "./theme";
import type { Trail } from "./trails";

/** True for marks that the GPU draws; the others are paths, texts and images of the 2D context. */
export function onGpu(mark: Mark): mark is Cloud | Marks {
  return !["curve", "text", "image"].includes(mark.kind);
}

interface Slot {
  mark: Cloud | Marks;
  buffers: WebGLBuffer[];
  count: number;
  /** For a cloud, in units of the x axis. */
  largest: number;
}

/** The layout of an attribute in a buffer: offset and stride in bytes. */
interface Source {
  buffer: WebGLBuffer | undefined;
  size: number;
  at: number;
  stride: number;
  bytes?: boolean;
}

export interface Scene {
  look: Look;
  theme: Theme;
  maps: Record<string, string[]>;
  width: number;
  height: number;
  /** The drawing region of the pane. */
  clip: Box;
  /** Device pixels per pixel of a picture of 1200 x 900; per pixel of one of its texts. */
  unit: number;
  textUnit: number;
  space: boolean;
  /** Temporarily draw only one of this number of particles. */
  coarse: number;
}

const emptyColour: Rgba = [0, 0, 0, 1];

export class GpuMarks {
  private slots: (Slot | null)[] = [];
  private generation = 0;

  constructor(private readonly shared: Shared) {}

  /** Uploads the arrays of a canvas to the GPU; slot k belongs to its mark k. */
  upload(canvas: Canvas) {
    const { gl } = this.shared;
    if (this.generation !== this.shared.generation) this.slots = [];
    this.generation = this.shared.generation;
    this.slots
      .splice(canvas.marks.length)
      .forEach((slot) => slot?.buffers.forEach((buffer) => gl.deleteBuffer(buffer)));
    canvas.marks.forEach((mark, k) => {
      const old = this.slots[k]?.buffers ?? [];
      const arrays: ArrayBufferView[] = !onGpu(mark)
        ? []
        : mark.kind === "cloud"
          ? [mark.positions, mark.values ?? new Float32Array(0), mark.diameters ?? new Float32Array(0)]
          : [mark.data, mark.colours];
      old.splice(arrays.length).forEach((buffer) => gl.deleteBuffer(buffer));
      const buffers = arrays.map((array, i) => {
        const buffer = old[i] ?? gl.createBuffer();
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ARRAY_BUFFER, array, gl.STREAM_DRAW);
        return buffer;
      });
      if (!onGpu(mark)) {
        this.slots[k] = null;
        return;
      }
      let largest = 0;
      if (mark.kind === "cloud") {
        largest = mark.diameter;
        for (const diameter of mark.diameters ?? []) if (diameter > largest) largest = diameter;
      }
      this.slots[k] = { mark, buffers, count: mark.kind === "cloud" ? mark.count : mark.colours.length, largest };
    });
  }

  dispose() {
    for (const slot of this.slots) slot?.buffers.forEach((buffer) => this.shared.gl.deleteBuffer(buffer));
    this.slots = [];
  }

  /**
   * Draws every `every`-th mark from `first` on. Clouds use points, because without a graphics card quads, which are
   * instances, are drawn one by one and a hundred times slower.
   */
  private draw(sources: (Source | null)[], count: number, quads: boolean, every = 1, first = 0) {
    const { gl } = this.shared;
    sources.forEach((source, place) => {
      if (!source) {
        gl.disableVertexAttribArray(place);
        return;
      }
      const { buffer, size, at, stride, bytes } = source;
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer ?? null);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(
        place,
        size,
        bytes ? gl.UNSIGNED_BYTE : gl.FLOAT,
        bytes === true,
        stride * every,
        at + stride * first,
      );
      gl.vertexAttribDivisor(place, quads ? 1 : 0);
    });
    const some = Math.ceil((count - first) / every);
    if (some <= 0) return;
    if (quads) gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, some);
    else gl.drawArrays(gl.POINTS, 0, some);
  }

  /** margin: pixels around the pane in which points may have their centres; elsewhere WebGL drops the whole point. */
  private values(scene: Scene, mapping: Mapping, margin = 0) {
    const { theme, width, height } = scene;
    this.shared.gl.viewport(-margin, -margin, width + 2 * margin, height + 2 * margin);
    return {
      margin,
      scale: mapping.scale,
      origin: mapping.origin,
      logs: mapping.logs,
      matrix: mapping.matrix,
      size: [width, height],
      unit: scene.unit,
      fade: scene.look.fade,
      ink: theme.ink,
      paper: theme.paper,
      rim: [theme.rim, theme.rimStrength],
    };
  }

  /** pass: 0 all, 1 opaque parts, 2 soft edges (gl.ts). Returns the number drawn. */
  drawDiscs(k: number, scene: Scene, pass: number): number {
    const slot = this.slots[k];
    if (!slot) return 0;
    const { gl, discs } = this.shared;
    const { mark, buffers, count } = slot;
    const { look, unit } = scene;
    gl.depthMask(pass === 1);
    if (mark.kind !== "cloud") {
      const circles = mark.kind === "circle";
      const stride = circles ? 24 : 16;
      const data = (at: number, size: number): Source => ({ buffer: buffers[0], size, at, stride });
      gl.vertexAttrib2f(4, 0, 1);
      discs.use({
        ...this.values(scene, look.unit),
        toRadius: circles ? look.perUnit : unit / 2,
        fade: circles ? look.fade : 0,
        quads: 1,
        sized: circles ? 1 : 0,
        useMap: 0,
        shaded: 0,
        opacity: 1,
        pass,
      });
      this.draw(
        [
          data(0, 3),
          null,
          data(12, 1),
          { buffer: buffers[1], size: 4, at: 0, stride: 4, bytes: true },
          circles ? data(16, 2) : null,
        ],
        count,
        true,
      );
      return count;
    }
    const given = slot.largest > 0;
    // In a space, points scale with the camera.
    const sized = given || scene.space;
    const perSize = given ? look.perX : scene.space ? look.perPoint : unit;
    const mapping = look.cloud(mark);
    const colour = mark.values ? emptyColour : parse(mark.colour);
    gl.vertexAttrib1f(2, given ? mark.diameter : mark.size);
    gl.vertexAttrib4f(3, ...colour);
    gl.vertexAttrib2f(4, 0, -1);
    const largest = perSize * (given ? slot.largest : mark.size);
    const quads = largest > this.shared.largestPoint || (given && mapping.logs[0] > 0);
    discs.use({
      ...this.values(scene, mapping, quads ? 0 : Math.ceil(largest / 2) + 1),
      // If the colour represents a value, fading is weak, so that the colour bar remains readable.
      fade: mark.values ? 0.4 * look.fade : look.fade,
      toRadius: perSize / 2,
      quads: quads ? 1 : 0,
      sized: sized ? 1 : 0,
      useMap: mark.values ? 1 : 0,
      mapRow: this.shared.mapRow(scene.maps, mark.map),
      shaded: mark.shaded ? 1 : 0,
      opacity: 1,
      pass,
    });
    const { dimension } = mark;
    const scalar = (buffer: WebGLBuffer | undefined): Source => ({ buffer, size: 1, at: 0, stride: 4 });
    const sources = [
      { buffer: buffers[0], size: dimension, at: 0, stride: 4 * dimension },
      mark.values ? scalar(buffers[1]) : null,
      mark.diameters ? scalar(buffers[2]) : null,
      null,
      null,
    ];
    // For many discs in a space, draw a sparse sample first, so that it hides most of the others before they are
    // shaded.
    const coarse = count > 20000 ? scene.coarse : 1;
    const parts = scene.space && count > 5000 ? 16 : coarse;
    for (let first = 0; first < parts; first += coarse) this.draw(sources, count, quads, parts, first);
    return count;
  }

  drawStrokes(k: number, scene: Scene) {
    const slot = this.slots[k];
    if (!slot || slot.mark.kind === "cloud") return;
    const data = (at: number, size: number): Source => ({ buffer: slot.buffers[0], size, at, stride: 28 });
    this.shared.gl.depthMask(false);
    this.shared.strokes.use({ ...this.values(scene, scene.look.unit), arrows: slot.mark.kind === "arrow" ? 1 : 0 });
    this.draw(
      [data(0, 3), data(12, 3), data(24, 1), { buffer: slot.buffers[1], size: 4, at: 0, stride: 4, bytes: true }, null],
      slot.count,
      true,
    );
  }

  drawTrail(trail: Trail, scene: Scene) {
    const { gl, discs } = this.shared;
    gl.depthMask(false);
    gl.vertexAttrib1f(2, 3.4);
    gl.vertexAttrib4f(3, ...shown(parse(trail.colour), scene.theme));
    gl.vertexAttrib2f(4, 0, -1);
    discs.use({
      ...this.values(scene, scene.look.cloud(trail)),
      toRadius: scene.unit / 2,
      quads: 0,
      sized: 0,
      shaded: 0,
      pass: 0,
      opacity: 0.55,
      useMap: trail.coloured ? 1 : 0,
      mapRow: this.shared.mapRow(scene.maps, trail.map),
    });
    this.draw(
      [
        { buffer: trail.buffer, size: trail.dimension, at: 0, stride: 16 },
        trail.coloured ? { buffer: trail.buffer, size: 1, at: 12, stride: 16 } : null,
        null,
        null,
        null,
      ],
      trail.count,
      false,
    );
  }
}
