// Whether the page puts what stands around a drawing where pictures do: tests/window/layouts.json.
// Usage: node layout.mjs LAYOUT_MODULE CASES
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [, , module, path] = process.argv;
const { View, Pen, themes, css } = await import(pathToFileURL(module));
const cases = JSON.parse(readFileSync(path, "utf8"));
if (cases.length < 8) throw new Error(`${path} has only ${cases.length} cases`);
globalThis.window = { devicePixelRatio: 1 };
const theme = themes.light;

/** Lines, boxes and discs as a context is asked for them, sorted by what they are. */
class Context {
  grid = [];
  rims = [];
  marks = [];
  keys = [];
  dashes = [];
  beginPath() {
    this.path = [];
  }
  moveTo(x, y) {
    this.from = [x, y];
  }
  lineTo(x, y) {
    this.path.push([...this.from, x, y]);
  }
  setLineDash(dashes) {
    this.dashes = dashes;
  }
  strokeRect(...box) {
    this.rims.push(box);
    this.rimWidth = this.lineWidth;
  }
  stroke() {
    if (this.under) this.grid.push(...this.path);
    else if (this.lineCap === "butt" && this.lineWidth === this.rimWidth) this.marks.push(...this.path);
    else this.keys.push(...this.path.map((line) => [line, true, this.dashes.length > 0]));
  }
  arc(x, y) {
    this.keys.push([[x, y, x, y], false, false]);
  }
  fill() {}
  fillRect() {}
}

/** Letters half as wide as they are high, bold ones somewhat more. */
class Ruler extends Pen {
  texts = [];
  notes = [];
  width(markup, size, bold = false) {
    return (bold ? 0.55 : 0.5) * size * [...markup].length;
  }
  draw(markup, x, y, size, align = 0, bold = false, rotated = false) {
    const quiet = this.context.fillStyle === css(theme.quiet);
    if (markup) (quiet ? this.notes : this.texts).push([markup, [x, y, size, align], bold, rotated]);
  }
}

function planned({ pane: [clientWidth, clientHeight], canvas }) {
  const context = new Context();
  const pen = new Ruler(context);
  const view = new View({ clientWidth, clientHeight }, pen, { [canvas.bars[0]?.map]: ["#000000"] }, theme);
  view.show(canvas);
  const { figure, textUnit } = view.layout();
  context.under = true;
  figure.drawUnder();
  context.under = false;
  figure.drawOver();
  const { left, top, width, height } = figure.box;
  const { grid, rims, marks, keys } = context;
  return { unit: textUnit, box: [left, top, width, height], grid, rims, marks, keys, texts: pen.texts, notes: pen.notes };
}

const same = (a, b) =>
  Array.isArray(a)
    ? a.length === b.length && a.every((one, i) => same(one, b[i]))
    : typeof a === "number"
      ? Math.abs(a - b) < 1e-3
      : a === b;
let wrong = 0;
cases.forEach((one, i) => {
  const now = planned(one);
  for (const key of Object.keys(now))
    if (!same(now[key], one[key])) {
      ++wrong;
      console.log(`case ${i}: ${key} ${JSON.stringify(now[key])}, pictures have ${JSON.stringify(one[key])}`);
    }
});
if (wrong > 0) process.exit(1);
console.log(`layouts of ${cases.length} figures are those of pictures`);
