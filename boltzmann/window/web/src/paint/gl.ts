// One WebGL2 context for all panes of a page, with its programs and colour tables. Browsers limit the number of
// contexts.
// Arrays are drawn as received. A Mapping converts them to pixels: coordinate = origin + scale * number, then an
// optional logarithm, then a matrix.

const common = `#version 300 es
precision highp float;
precision highp int;
uniform vec3 scale, origin;
uniform vec2 logs, size;
uniform mat4 matrix;
uniform float unit, fade, margin;
uniform vec4 ink, paper;
vec3 pixels(vec3 place) {
  vec3 q = place * scale + origin;
  if (logs.x > 0.) q.x = log2(q.x) * .30102999566;
  if (logs.y > 0.) q.y = log2(q.y) * .30102999566;
  return (matrix * vec4(q, 1)).xyz;
}
bool visible(vec3 p) { return abs(p.x) < 1e8 && abs(p.y) < 1e8 && abs(p.z) < 1e8; }
vec4 toClip(vec2 p, float far) { return vec4((p + margin) / (size + 2. * margin) * 2. - 1., clamp((far - .5) / 4., -.99, .99), 1); }
vec3 inked(vec3 c) { return all(lessThan(abs(c * 255. - 1.), vec3(.5))) ? ink.rgb : c; }
vec3 faded(vec3 c, float depth) { return mix(c, paper.rgb, clamp(depth, 0., 1.) * fade); }
`;

// Coverage of a disc decreases from 1 to 0 over one pixel at the rim, which adds pi / 12 to the area; the radius is
// reduced to compensate. Discs smaller than a pixel are drawn as faint discs of the smallest size (figure_paint.cpp).
const discVertex = `${common}
layout(location = 0) in vec3 place;
layout(location = 1) in float value;
layout(location = 2) in float diameter;
layout(location = 3) in vec4 colour;
layout(location = 4) in vec2 flags;
uniform float toRadius, quads, sized, mapRow, useMap, shaded, opacity;
uniform vec2 rim;
uniform sampler2D maps;
flat out vec2 centre;
flat out vec4 fill, edge, shape;
void main() {
  vec3 p = pixels(place);
  float r = diameter * toRadius;
  if (sized > 0. && logs.x > 0.) r *= .4343 / (place.x * scale.x + origin.x);
  vec4 c = colour;
  if (useMap > 0.) {
    bool none = (floatBitsToUint(value) & 0x7fffffffu) > 0x7f800000u;
    c.rgb = none ? vec3(158. / 255.) : texture(maps, vec2((clamp(value, 0., 1.) * 255. + .5) / 256., mapRow)).rgb;
  }
  c.a *= opacity;
  float strength = r < .65 ? r * r / .4225 : 1.;
  if (!visible(p) || !(strength > 0.)) {
    gl_Position = vec4(2, 2, 2, 1);
    gl_PointSize = 1.;
    return;
  }
  int flag = int(flags.y);
  bool hollow = sized > 0. && flag >= 0 && (flag & 1) == 0;
  bool rimmed = sized > 0. && r >= 3. * unit;
  bool ball = rimmed && !hollow && (flag < 0 ? shaded > 0. : (flag & 2) != 0);
  float wide = hollow ? 1.6 * unit : rimmed ? clamp(.09 * r, .8 * unit, 1.5 * unit) : 0.;
  r = sqrt(max(r, .65) * max(r, .65) - 1. / 12.);
  c.rgb = inked(c.rgb);
  edge = vec4(hollow ? c.rgb : mix(c.rgb, vec3(rim.x), rim.y), c.a);
  fill = c;
  fill.rgb = mix(faded(fill.rgb, p.z), paper.rgb, .5 * flags.x);
  edge.rgb = mix(faded(edge.rgb, p.z), paper.rgb, .5 * flags.x);
  shape = vec4(r, wide, strength, hollow ? 2 : ball ? 1 : 0);
  centre = p.xy;
  vec2 corner = quads > 0. ? vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2. - 1. : vec2(0);
  gl_Position = toClip(p.xy + corner * (r + 1.), p.z);
  gl_PointSize = 2. * ceil(r + 1.);
}`;

// pass 0: everything, in drawing order. In a space, pass 1: opaque parts, with depth; then 2: the soft edges. Light
// comes from the upper left.
const discFragment = `#version 300 es
precision highp float;
flat in vec2 centre;
flat in vec4 fill, edge, shape;
uniform float pass;
out vec4 pixel;
void main() {
  float r = shape.x;
  vec2 d = gl_FragCoord.xy - centre;
  float far = length(d), cover = clamp(r + .5 - far, 0., 1.) * shape.z;
  if (cover <= 0.) discard;
  vec4 c = fill;
  float inside = clamp(r - shape.y + .5 - far, 0., 1.);
  if (shape.w > 1.5) {
    c = edge;
    cover *= 1. - inside;
  } else {
    if (shape.w > .5) {
      float t = length(d / r + vec2(.34, -.34)) / 1.42;
      c.rgb = t < .5 ? mix(mix(c.rgb, vec3(1), .42), c.rgb, 2. * t) : mix(c.rgb, c.rgb * .55, min(2. * t - 1., 1.));
    }
    if (shape.y > 0.) c.rgb = mix(edge.rgb, c.rgb, inside);
  }
  float a = cover * c.a;
  if (pass > 0.) {
    bool covers = a >= mix(.5, .995, smoothstep(1., 3., r));
    if (covers != (pass < 1.5)) discard;
    if (covers) a = 1.;
  }
  pixel = vec4(c.rgb * a, a);
}`;

const strokeVertex = `${common}
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in float width;
layout(location = 3) in vec4 colour;
uniform float arrows;
out vec2 along;
flat out vec4 paint, shape;
void main() {
  vec3 a = pixels(from), b = pixels(to);
  vec2 way = b.xy - a.xy;
  float far = length(way), wide = width * unit, head = 0.;
  if (!visible(a) || !visible(b) || (arrows > 0. && far < .25)) {
    gl_Position = vec4(2, 2, 2, 1);
    return;
  }
  if (arrows > 0.) {
    head = min((5. + 4. * width) * unit, .55 * far);
    wide = min(wide, .36 * head);
  }
  float strength = min(wide, 1.);
  wide = max(wide, 1.);
  vec2 u = far > 0. ? way / far : vec2(1, 0), corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  float pad = max(wide / 2., .4 * head) + 1.;
  along = vec2(mix(-pad, far + pad, corner.x), mix(-pad, pad, corner.y));
  shape = vec4(far, wide / 2., head, 0);
  paint = vec4(inked(colour.rgb), colour.a * strength);
  gl_Position = toClip(a.xy + u * along.x + vec2(-u.y, u.x) * along.y, mix(a.z, b.z, corner.x));
}`;

const strokeFragment = `#version 300 es
precision highp float;
in vec2 along;
flat in vec4 paint, shape;
out vec4 pixel;
void main() {
  float head = shape.z, end = shape.x - .85 * head, side = abs(along.y);
  float cover = clamp(shape.y + .5 - length(vec2(along.x - clamp(along.x, 0., end), side)), 0., 1.);
  if (head > 0.) {
    float tip = shape.x - along.x;
    float inside = min((.4 * tip - side) / 1.077, (.82 * head + .45 * side - tip) / 1.0966);
    cover = max(cover, clamp(inside + .5, 0., 1.));
  }
  float a = cover * paint.a;
  if (a <= 0.) discard;
  pixel = vec4(paint.rgb * a, a);
}`;

export interface Mapping {
  scale: [number, number, number];
  origin: [number, number, number];
  logs: [number, number];
  matrix: number[];
}

/** The calculation of the shaders: pixels from the lower left, and the depth (0 near, 1 far). */
export function mapped(by: Mapping, x: number, y: number, z: number): [number, number, number] {
  let a = x * by.scale[0] + by.origin[0];
  let b = y * by.scale[1] + by.origin[1];
  const c = z * by.scale[2] + by.origin[2];
  if (by.logs[0]) a = Math.log10(a);
  if (by.logs[1]) b = Math.log10(b);
  const m = by.matrix;
  const row = (i: number) => (m[i] ?? 0) * a + (m[i + 4] ?? 0) * b + (m[i + 8] ?? 0) * c + (m[i + 12] ?? 0);
  return [row(0), row(1), row(2)];
}

export class Program {
  private readonly uniforms = new Map<string, { place: WebGLUniformLocation; type: number }>();
  private readonly program: WebGLProgram;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    vertex: string,
    fragment: string,
  ) {
    const program = gl.createProgram();
    for (const [type, source] of [
      [gl.VERTEX_SHADER, vertex],
      [gl.FRAGMENT_SHADER, fragment],
    ] as const) {
      const shader = gl.createShader(type);
      if (!shader) break; // the context is lost
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      const logs = gl.getAttachedShaders(program)?.map((shader) => gl.getShaderInfoLog(shader)) ?? [];
      throw new Error(`a shader can't be built: ${[gl.getProgramInfoLog(program), ...logs].join(" ")}`);
    }
    this.program = program;
    const count = Number(gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) ?? 0);
    for (let i = 0; i < count; ++i) {
      const info = gl.getActiveUniform(program, i);
      const place = info && gl.getUniformLocation(program, info.name);
      if (place) this.uniforms.set(info.name, { place, type: info.type });
    }
  }

  use(values: Record<string, number | readonly number[]>) {
    const gl = this.gl;
    gl.useProgram(this.program);
    for (const [name, value] of Object.entries(values)) {
      const uniform = this.uniforms.get(name);
      if (!uniform) continue;
      const list = typeof value === "number" ? [value] : value;
      if (uniform.type === gl.FLOAT_MAT4) gl.uniformMatrix4fv(uniform.place, false, list);
      else if (uniform.type === gl.FLOAT_VEC4) gl.uniform4fv(uniform.place, list);
      else if (uniform.type === gl.FLOAT_VEC3) gl.uniform3fv(uniform.place, list);
      else if (uniform.type === gl.FLOAT_VEC2) gl.uniform2fv(uniform.place, list);
      else if (uniform.type === gl.SAMPLER_2D) gl.uniform1i(uniform.place, list[0] ?? 0);
      else gl.uniform1fv(uniform.place, list);
    }
  }
}

export class Shared {
  readonly element = document.createElement("canvas");
  readonly gl: WebGL2RenderingContext;
  discs!: Program;
  strokes!: Program;
  largestPoint = 1;
  /** Counts the contexts of this page: buffers of an earlier one are lost. */
  generation = 0;
  /** Called when the context is restored. */
  readonly restored = new Set<() => void>();
  private maps: Record<string, string[]> | null = null;
  private names: string[] = [];
  private table: WebGLTexture | null = null;

  constructor() {
    const gl = this.element.getContext("webgl2", { antialias: false, powerPreference: "high-performance" });
    if (!gl) throw new Error("no WebGL2");
    this.gl = gl;
    this.build();
    this.element.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.element.addEventListener("webglcontextrestored", () => {
      this.build();
      for (const call of this.restored) call();
    });
  }

  private build() {
    ++this.generation;
    this.maps = this.table = null;
    this.discs = new Program(this.gl, discVertex, discFragment);
    this.strokes = new Program(this.gl, strokeVertex, strokeFragment);
    const sizes = this.gl.getParameter(this.gl.ALIASED_POINT_SIZE_RANGE) as Float32Array | null;
    this.largestPoint = (sizes?.[1] ?? 3) - 3;
    this.gl.enable(this.gl.BLEND);
    this.gl.enable(this.gl.SCISSOR_TEST);
    this.gl.blendFunc(this.gl.ONE, this.gl.ONE_MINUS_SRC_ALPHA);
    this.gl.depthFunc(this.gl.LEQUAL);
  }

  /** Enlarges the drawing buffer for a pane; it never shrinks. */
  grow(width: number, height: number) {
    if (this.element.width < width) this.element.width = width;
    if (this.element.height < height) this.element.height = height;
  }

  /** The row of a map in the colour table, 0..1. */
  mapRow(maps: Record<string, string[]>, name: string): number {
    const gl = this.gl;
    if (maps !== this.maps) {
      this.maps = maps;
      this.names = Object.keys(maps);
      const rows = Math.max(this.names.length, 1);
      const bytes = new Uint8Array(rows * 256 * 4).fill(158);
      this.names.forEach((key, row) =>
        maps[key]?.slice(0, 256).forEach((colour, i) => {
          const rgb = parseInt(colour.slice(1, 7), 16);
          bytes.set([rgb >> 16, (rgb >> 8) & 255, rgb & 255, 255], (row * 256 + i) * 4);
        }),
      );
      gl.deleteTexture(this.table);
      gl.bindTexture(gl.TEXTURE_2D, (this.table = gl.createTexture()));
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, rows, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
      for (const parameter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
        gl.texParameteri(gl.TEXTURE_2D, parameter, gl.LINEAR);
      for (const parameter of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T])
        gl.texParameteri(gl.TEXTURE_2D, parameter, gl.CLAMP_TO_EDGE);
    }
    return (Math.max(this.names.indexOf(name), 0) + 0.5) / Math.max(this.names.length, 1);
  }
}

let only: Shared | null | undefined;

/** The page's single context; null if the browser has no WebGL2. */
export function shared(): Shared | null {
  if (only === undefined)
    try {
      only = new Shared();
    } catch (error) {
      console.error(error);
      only = null;
    }
  return only;
}
