// TRACK: where particles were in the frames before, as small faint points in buffers that stay on the GPU.
import type { Cloud } from "../protocol";
import type { Shared } from "./gl";

export interface Trail {
  cloud: Cloud; // its arrays emptied
  buffer: WebGLBuffer;
  count: number;
  coloured: boolean;
}

const mostFrames = 400, mostPoints = 4e6, mostAtOnce = 20000;

export class Trails {
  /** The clouds of each frame kept. */
  readonly frames: Trail[][] = [];
  /** Frames that were kept since the last clear, also those that have gone since. */
  count = 0;
  private points = 0;

  add(shared: Shared, clouds: Cloud[]) {
    const gl = shared.gl;
    const all = clouds.reduce((sum, cloud) => sum + cloud.count, 0);
    // The same particles in every frame: those whose number is a multiple of a power of two.
    let thinning = 1;
    while (all / thinning > mostAtOnce) thinning *= 2;
    const frame: Trail[] = [];
    for (const cloud of clouds) {
      const room = new Float32Array(4 * Math.min(cloud.count, cloud.numbers ? cloud.count : Math.ceil(cloud.count / thinning)));
      const { positions, values, numbers, dimension } = cloud;
      let count = 0;
      const keep = (k: number) => {
        for (let d = 0; d < dimension; ++d) room[4 * count + d] = positions[k * dimension + d] as number;
        room[4 * count + 3] = values ? (values[k] as number) : 0;
        ++count;
      };
      if (numbers) {
        for (let k = 0; k < cloud.count; ++k) if ((numbers[k] as number) % thinning === 0) keep(k);
      } else {
        for (let k = 0; k < cloud.count; k += thinning) keep(k);
      }
      const buffer = gl.createBuffer();
      if (!count || !buffer) continue;
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, room.subarray(0, 4 * count), gl.STATIC_DRAW);
      const empty = new Float32Array(0);
      frame.push({ cloud: { ...cloud, positions: empty, values: empty, diameters: empty, numbers: new Uint32Array(0) }, buffer, count, coloured: values !== undefined });
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
