// TRACK: earlier positions of particles, as small faint points in buffers that stay on the GPU.
import type { Cloud } from "../protocol";
import type { Shared } from "./gl";

/** The particles of one frame with the same style: x, y, z and the value of each. */
export interface Trail extends Pick<Cloud, "colour" | "map" | "dimension" | "origin" | "scale"> {
  buffer: WebGLBuffer;
  count: number;
  coloured: boolean;
}

const mostFrames = 400,
  mostPoints = 4e6,
  mostAtOnce = 20000;

export class Trails {
  /** The clouds of each stored frame. */
  readonly frames: Trail[][] = [];
  /** The number of frames stored since the last clear, including discarded ones. */
  count = 0;
  private points = 0;

  add(shared: Shared, clouds: Cloud[]) {
    const gl = shared.gl;
    const all = clouds.reduce((sum, cloud) => sum + cloud.count, 0);
    // The same particles in every frame: those whose number is a multiple of a power of two.
    let thinning = 1;
    while (all / thinning > mostAtOnce) thinning *= 2;
    // One buffer per style, because particles may come in many small clouds.
    const groups = new Map<string, Cloud[]>();
    for (const cloud of clouds) {
      const { colour, map, dimension, origin, scale, values } = cloud;
      const key = JSON.stringify([colour, map, dimension, origin, scale, values !== undefined]);
      groups.set(key, [...(groups.get(key) ?? []), cloud]);
    }
    const frame: Trail[] = [];
    for (const alike of groups.values()) {
      const numbers: number[] = [];
      for (const { count, positions, values, numbers: names, dimension } of alike)
        for (let k = 0; k < count; k += names ? 1 : thinning) {
          if (names && (names[k] as number) % thinning) continue;
          for (let d = 0; d < 3; ++d) numbers.push(d < dimension ? (positions[k * dimension + d] as number) : 0);
          numbers.push(values ? (values[k] as number) : 0);
        }
      const buffer = gl.createBuffer();
      const [cloud] = alike;
      if (!numbers.length || !buffer || !cloud) continue;
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.STATIC_DRAW);
      const { colour, map, dimension, origin, scale } = cloud;
      const count = numbers.length / 4;
      frame.push({ colour, map, dimension, origin, scale, buffer, count, coloured: cloud.values !== undefined });
      this.points += count;
    }
    if (!frame.length) return;
    this.frames.push(frame);
    ++this.count;
    while (this.frames.length > mostFrames || (this.points > mostPoints && this.frames.length > 1)) this.drop(shared);
  }

  private drop(shared: Shared) {
    for (const trail of this.frames.shift() ?? []) {
      shared.gl.deleteBuffer(trail.buffer);
      this.points -= trail.count;
    }
  }

  clear(shared: Shared) {
    while (this.frames.length) this.drop(shared);
    this.count = 0;
    this.points = 0;
  }
}
