// Whether the page draws the outline of a box, and names its axes, where pictures do: tests/pictures/outlines.json.
// Usage: node outline.mjs OUTLINE_MODULE CASES
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [, , module, path] = process.argv;
const { Outline, Space, themes } = await import(pathToFileURL(module));
const cases = JSON.parse(readFileSync(path, "utf8"));
if (cases.length < 20) throw new Error(`${path} has only ${cases.length} cases`);

// A pane of so many pixels for half the longest side: edges are neither thin nor so long that more ticks fit.
const scale = 400;
const middle = 1000;

/** What a pen is asked for: lines with the strength of their ink, and texts. */
function drawn({ camera: [azimuth, elevation], box }) {
  const lines = [];
  const texts = [];
  let from;
  const context = {
    beginPath() {},
    moveTo: (x, y) => (from = [x, y]),
    lineTo(x, y) {
      const [a, b, c, d] = [from[0] - middle, middle - from[1], x - middle, middle - y].map((v) => v / scale);
      lines.push([a, b, c, d, Number(this.strokeStyle.match(/([\d.]+)\)$/)[1])]);
    },
    stroke() {},
  };
  const pen = { context, width: (text, font) => 0.5 * font * text.length, draw: (text) => texts.push(text) };
  const axes = ["x", "y", "z"].map((label, i) => {
    const [low, high] = box[i];
    return { label, unit: label === "z" ? "" : "m", factor: 1, logarithmic: false, low, high };
  });
  const space = new Space(axes, undefined, { azimuth, elevation }, 1);
  const outline = new Outline(space, space.look(scale, middle, middle), pen, themes.light, 1, 2 * middle, 2 * middle);
  outline.drawBehind();
  outline.drawBefore();
  outline.nameAxes();
  const ticks = lines.splice(12).map(([a, b, c, d]) => {
    const length = Math.hypot(c - a, d - b);
    return [a, b, (c - a) / length, (d - b) / length];
  });
  return { edges: lines, ticks, texts };
}

const same = (a, b) =>
  Array.isArray(a)
    ? a.length === b.length && a.every((one, i) => same(one, b[i]))
    : typeof a === "number"
      ? Math.abs(a - b) < 2e-6
      : a === b;
let wrong = 0;
for (const one of cases) {
  const now = drawn(one);
  for (const key of Object.keys(now))
    if (!same(now[key], one[key])) {
      ++wrong;
      console.log(`camera ${one.camera}: ${key} ${JSON.stringify(now[key])}, pictures have ${JSON.stringify(one[key])}`);
    }
}
if (wrong > 0) process.exit(1);
console.log(`outlines of ${cases.length} boxes are those of pictures`);
