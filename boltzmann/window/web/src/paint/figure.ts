// Layout of the elements around a drawing: frame, ticks, titles, legend, colour bars and notes. It is the same as in
// boltzmann/pictures/figure_plan.cpp; tests/window/layouts.json tests both. All lengths are device pixels.
import type { Canvas, ColourBar } from "../protocol";
import { Pen } from "./text";
import { css, parse, shown, type Rgba, type Theme } from "./theme";
import { numberText, ticksBetween, type Ticks } from "./ticks";

export interface Box {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** The displayed range of an axis; for logarithmic ones the values, not their logarithms. */
export interface Range {
  low: number;
  high: number;
  logarithmic: boolean;
  factor: number;
}

export function placeOn(range: Range, value: number): number {
  if (!range.logarithmic) return (value - range.low) / (range.high - range.low);
  return Math.log(value / range.low) / Math.log(range.high / range.low);
}

// Sizes in pixels of a picture of 1200 x 900.
const outerRoom = 20,
  tickText = 20,
  axisTitle = 22,
  headingText = 22.5,
  legendText = 20,
  noteText = 18.5;
const tickLength = 7,
  minorTick = 4,
  tickGap = 6,
  titleGap = 12,
  frameLine = 1.3;
const barGap = 28,
  barWidth = 22,
  legendRow = 31,
  headingRow = 1.4,
  noteRow = 23; // headingRow: in units of its font

const nothing: Ticks = { major: [], minor: [], labels: [], multiplier: "", exponent: 0 };

function titleOf(label: string, unit: string): string {
  if (!unit) return label;
  return label ? `${label} (${unit})` : `(${unit})`;
}

interface Key {
  label: string;
  colour: string;
  line: boolean;
  dashed: boolean;
}

interface Bar {
  bar: ColourBar;
  ticks: Ticks;
  labels: number;
  width: number;
}

export class Figure {
  box: Box;
  /** The space available for the box, which may be smaller to keep its ratio. */
  room: Box;
  /** The space reserved for the labels at y. */
  labels = 0;
  private xTicks = nothing;
  private yTicks = nothing;
  private readonly xTitle: string;
  private readonly yTitle: string;
  private readonly keys: Key[];
  private readonly bars: Bar[];
  private heading: string[] = [];
  private headingFont = 0;
  private notes: string[] = [];
  private keyRows = 0;
  private keysWide = 0;
  private headingGap = 0;
  private notesTop = 0;
  private multiplierBelow = false;

  /**
   * unit: device pixels for one pixel of a picture of 1200 x 900. ratio: width / height of the box; 0: free.
   * leastLabels: minimum space for labels at y. headed: with the title of the canvas.
   */
  constructor(
    private readonly canvas: Canvas,
    private readonly pen: Pen,
    private readonly theme: Theme,
    private readonly maps: Record<string, string[]>,
    private readonly width: number,
    private readonly height: number,
    private readonly unit: number,
    private readonly x: Range,
    private readonly y: Range,
    private readonly ratio: number,
    leastLabels: number,
    private readonly headed: boolean,
  ) {
    const framed = canvas.frame;
    this.xTitle = framed ? titleOf(canvas.x.label, canvas.x.unit) : "";
    this.yTitle = framed ? titleOf(canvas.y.label, canvas.y.unit) : "";
    this.keys = canvas.legend.map((entry) => ({ ...entry, line: false, dashed: false }));
    for (const mark of canvas.marks)
      if (mark.kind === "curve" && mark.label)
        this.keys.push({ label: mark.label, colour: mark.colour, line: true, dashed: mark.dashed });
    this.bars = canvas.bars.map((bar) => ({ bar, ticks: nothing, labels: 0, width: 0 }));
    const outer = this.length(outerRoom);
    this.box = this.room = { left: outer, top: outer, width: width - 2 * outer, height: height - 2 * outer };
    // Margins depend on labels, these on the box, and the box on the margins. Three iterations suffice.
    for (let round = 0; round < 3; ++round) this.plan(leastLabels);
  }

  private length(pixels: number): number {
    return pixels * this.unit;
  }
  private lineWidth(pixels: number): number {
    return Math.max(1, Math.round(this.length(pixels)));
  }
  private crisp(at: number, width: number): number {
    return Math.round(width) % 2 === 1 ? Math.floor(at) + 0.5 : Math.round(at);
  }
  private widest(ticks: Ticks): number {
    return Math.max(0, ...ticks.labels.map((label) => this.pen.width(label, this.length(tickText))));
  }
  private fitted(text: string, font: number, most: number): number {
    const wide = this.pen.width(text, font);
    return wide > most ? (font * most) / wide : font;
  }

  /** The largest number of ticks whose labels don't overlap. */
  private ticksThatFit(range: Range, extent: number, across: boolean, atMostExponent = 400): Ticks {
    for (let most = 8; ; --most) {
      const ticks = ticksBetween(
        range.low * range.factor,
        range.high * range.factor,
        range.logarithmic,
        most,
        atMostExponent,
      );
      for (const values of [ticks.major, ticks.minor]) values.forEach((v, i) => (values[i] = v / range.factor));
      let fits = true;
      let beforeAt = 0;
      let beforeWidth = 0;
      ticks.major.forEach((value, i) => {
        const at = placeOn(range, value) * extent;
        const wide = across
          ? this.pen.width(ticks.labels[i] ?? "", this.length(tickText)) + this.length(16)
          : this.length(1.7 * tickText);
        if (i > 0 && at - beforeAt < (wide + beforeWidth) / 2) fits = false;
        beforeAt = at;
        beforeWidth = wide;
      });
      if (fits || most <= 2) return ticks;
    }
  }

  private chooseTicks() {
    if (!this.canvas.frame) return;
    this.xTicks = this.ticksThatFit(this.x, this.box.width, true);
    this.yTicks = this.ticksThatFit(this.y, this.box.height, false);
    // With equal scales, both use the same power of ten.
    if (!this.ratio || !this.xTicks.multiplier || !this.yTicks.multiplier) return;
    const exponent = Math.min(this.xTicks.exponent, this.yTicks.exponent);
    this.xTicks = this.ticksThatFit(this.x, this.box.width, true, exponent);
    this.yTicks = this.ticksThatFit(this.y, this.box.height, false, exponent);
  }

  private plan(leastLabels: number) {
    const { width, height, canvas, pen } = this;
    const outer = this.length(outerRoom);
    const framed = canvas.frame;
    this.chooseTicks();
    let right = outer;
    const last = this.xTicks.labels.length - 1;
    if (last >= 0) {
      const half = pen.width(this.xTicks.labels[last] ?? "", this.length(tickText)) / 2;
      right = Math.max(
        right,
        half - (1 - placeOn(this.x, this.xTicks.major[last] ?? 0)) * this.box.width + this.length(8),
      );
    }
    let bars = 0;
    for (const bar of this.bars) bars += this.planBar(bar);
    if (bars > 0) right = bars + this.length(12);

    let left = outer;
    const shares = this.yTicks.multiplier.includes(" ");
    this.labels = framed ? Math.max(leastLabels, this.widest(this.yTicks)) : 0;
    if (framed) {
      left = this.length(tickLength + tickGap) + this.labels + outer;
      if (this.yTitle) left += this.length(titleGap + 1.05 * axisTitle) - 0.35 * outer;
      if (this.yTicks.multiplier && !shares)
        left = Math.max(
          left,
          pen.width(this.yTicks.multiplier, this.length(tickText)) + this.length(tickLength) + 0.5 * outer,
        );
    }
    this.planHeading(left, right);
    const headed = this.keys.length > 0 || this.heading.length > 0;
    const anyMultiplier = this.yTicks.multiplier !== "" || this.bars.some((bar) => bar.ticks.multiplier !== "");
    const lifted = this.yTicks.multiplier !== "" && (headed || shares);
    this.headingGap = lifted ? this.length(1.85 * tickText) : this.length(headed ? 8 : 0);
    const top = Math.max(0.8 * outer + this.headingBlock, anyMultiplier ? this.length(2.3 * tickText) : outer);
    const bottom = this.planBelow(left, right);

    const room = { left, top, width: Math.max(width - left - right, 8), height: Math.max(height - top - bottom, 8) };
    const box = { ...room };
    if (this.ratio) {
      box.width = Math.max(Math.min(room.width, room.height * this.ratio), 4);
      box.height = Math.max(Math.min(room.height, room.width / this.ratio), 4);
      box.left += (room.width - box.width) / 2;
      box.top += (room.height - box.height) / 2;
    }
    for (const key of ["left", "top", "width", "height"] as const) box[key] = Math.round(box[key]);
    this.box = box;
    this.room = room;
    const rows = this.notes.length * this.length(noteRow);
    this.notesTop = framed ? box.top + box.height + bottom - outer - rows : height - 0.8 * outer - rows;
  }

  private planBar(plan: Bar): number {
    const { bar } = plan;
    const range = { low: bar.low, high: bar.high, logarithmic: false, factor: bar.factor };
    plan.ticks =
      bar.high > bar.low
        ? this.ticksThatFit(range, this.barBox().height, false)
        : { ...nothing, major: [bar.low], labels: [numberText(bar.low * bar.factor)] };
    plan.labels = this.widest(plan.ticks);
    plan.width = this.length(barGap + barWidth + tickLength + tickGap) + plan.labels;
    if (titleOf(bar.label, bar.unit)) plan.width += this.length(titleGap + 1.15 * axisTitle);
    const multiplier = this.pen.width(plan.ticks.multiplier, this.length(tickText));
    return (plan.width = Math.max(plan.width, this.length(barGap) + multiplier));
  }

  /** Beside a space, whose box changes with the camera, bars keep their place. */
  private barBox(): Box {
    return this.canvas.frame ? this.box : this.room;
  }

  private keyWidth(key: Key): number {
    return this.length(key.line ? 46 : 24) + this.pen.width(key.label, this.length(legendText)) + this.length(30);
  }

  private planHeading(left: number, right: number) {
    const free = this.width - left - right;
    const wide = Math.max(this.ratio ? this.box.width : free, this.length(260));
    let most = Math.max(wide, free);
    this.headingFont = this.length(headingText);
    if (this.unit * 900 > this.width && this.pen.width(this.canvas.title, this.headingFont, true) > most) {
      // A narrow pane has no space for a long title in large letters.
      this.headingFont = this.length(legendText);
      most = this.width - this.length(2 * outerRoom);
    }
    this.heading = this.headed ? this.pen.wrapped(this.canvas.title, this.headingFont, most, true) : [];
    this.keyRows = this.keys.length ? 1 : 0;
    this.keysWide = wide;
    let at = 0;
    for (const key of this.keys) {
      const next = this.keyWidth(key);
      if (at > 0 && at + next - this.length(30) > wide) {
        ++this.keyRows;
        at = 0;
      }
      at += next;
    }
  }

  private get headingBlock(): number {
    return (
      this.heading.length * headingRow * this.headingFont + this.keyRows * this.length(legendRow) + this.headingGap
    );
  }

  /** The height of the elements below the frame. */
  private planBelow(left: number, right: number): number {
    const outer = this.length(outerRoom);
    const framed = this.canvas.frame;
    const wide = Math.max(
      framed ? this.width - Math.max(left, this.box.left) - outer : this.width - 2 * outer,
      this.length(200),
    );
    this.notes = this.canvas.notes.flatMap((note) => this.pen.wrapped(note, this.length(noteText), wide));
    let below = outer + this.notes.length * this.length(noteRow);
    if (!framed) return below;
    below += this.length(tickLength + tickGap + tickText);
    if (this.xTitle || this.xTicks.multiplier) below += this.length(titleGap + axisTitle);
    const multiplier = this.pen.width(this.xTicks.multiplier, this.length(tickText));
    const reach = this.pen.width(this.xTitle, this.length(axisTitle)) / 2 + multiplier + this.length(20);
    this.multiplierBelow =
      this.xTitle !== "" && multiplier > 0 && reach > (this.width - left - right) / 2 && reach > this.box.width / 2;
    if (this.multiplierBelow) below += this.length(1.3 * tickText);
    return this.notes.length ? below + this.length(4) : below;
  }

  /** The region for marks: inside of a frame; without one, outside of headings, bars and notes. */
  get clip(): Box {
    if (this.canvas.frame) return this.box;
    const top = this.heading.length || this.keyRows ? Math.floor(this.room.top) : 0;
    const right = this.bars.length ? Math.ceil(this.room.left + this.room.width + this.length(barGap) / 2) : this.width;
    const bottom = this.notes.length ? Math.ceil(this.notesTop) : this.height;
    return { left: 0, top, width: right, height: bottom - top };
  }

  private at(value: number, across: boolean): number {
    const { left, top, width, height } = this.box;
    return across ? left + placeOn(this.x, value) * width : top + (1 - placeOn(this.y, value)) * height;
  }

  /** Draws the elements under the drawing. */
  drawUnder() {
    const context = this.pen.context;
    context.fillStyle = css(this.theme.paper);
    context.fillRect(0, 0, this.width, this.height);
    if (!this.canvas.frame || !this.canvas.grid) return;
    const { left, top, width, height } = this.box;
    const wide = this.lineWidth(1);
    context.strokeStyle = css(this.theme.grid);
    context.lineWidth = wide;
    context.beginPath();
    for (const tick of this.xTicks.major) {
      const x = this.crisp(this.at(tick, true), wide);
      context.moveTo(x, top);
      context.lineTo(x, top + height);
    }
    for (const tick of this.yTicks.major) {
      const y = this.crisp(this.at(tick, false), wide);
      context.moveTo(left, y);
      context.lineTo(left + width, y);
    }
    context.stroke();
  }

  /** Draws the elements around and over the drawing. */
  drawOver() {
    if (this.canvas.frame) this.drawFrame();
    this.drawHeading();
    let left = this.barBox().left + this.barBox().width;
    for (const bar of this.bars) {
      this.drawBar(bar, left + this.length(barGap));
      left += bar.width;
    }
    this.pen.context.fillStyle = css(this.theme.quiet);
    this.notes.forEach((line, i) =>
      this.pen.draw(
        line,
        this.canvas.frame ? this.box.left : this.length(outerRoom),
        this.notesTop + (i + 1) * this.length(noteRow),
        this.length(noteText),
      ),
    );
  }

  private strokeBox(box: Box, wide: number) {
    const { context } = this.pen;
    const left = this.crisp(box.left, wide);
    const top = this.crisp(box.top, wide);
    const right = this.crisp(box.left + box.width, wide);
    const bottom = this.crisp(box.top + box.height, wide);
    context.strokeStyle = context.fillStyle = css(this.theme.ink);
    context.lineWidth = wide;
    context.lineCap = "butt";
    context.setLineDash([]);
    context.strokeRect(left, top, right - left, bottom - top);
    return { left, top, right, bottom };
  }

  private drawFrame() {
    const { context } = this.pen;
    const wide = this.lineWidth(frameLine);
    const font = this.length(tickText);
    const { left, top, bottom } = this.strokeBox(this.box, wide);
    context.beginPath();
    for (const [ticks, across] of [
      [this.xTicks, true],
      [this.yTicks, false],
    ] as const)
      for (const [values, reach] of [
        [ticks.major, tickLength],
        [ticks.minor, minorTick],
      ] as const)
        for (const value of values) {
          const at = this.crisp(this.at(value, across), wide);
          context.moveTo(across ? at : left, across ? bottom : at);
          context.lineTo(across ? at : left - this.length(reach), across ? bottom + this.length(reach) : at);
        }
    context.stroke();

    const gap = this.length(tickLength + tickGap);
    const row = bottom + gap + 0.76 * font;
    this.xTicks.major.forEach((value, i) =>
      this.pen.draw(this.xTicks.labels[i] ?? "", this.at(value, true), row, font, 0.5),
    );
    const labelRight = left - gap;
    this.yTicks.major.forEach((value, i) =>
      this.pen.draw(this.yTicks.labels[i] ?? "", labelRight, this.at(value, false) + 0.36 * font, font, 1),
    );

    const titleRow = row + this.length(titleGap + axisTitle);
    const xFont = this.fitted(this.xTitle, this.length(axisTitle), this.width - this.length(outerRoom));
    const half = this.pen.width(this.xTitle, xFont) / 2;
    const middle = Math.min(
      Math.max(this.box.left + this.box.width / 2, Math.min(half, this.width / 2)),
      Math.max(this.width - half, this.width / 2),
    );
    this.pen.draw(this.xTitle, middle, titleRow, xFont, 0.5);
    if (this.xTicks.multiplier)
      this.pen.draw(
        this.xTicks.multiplier,
        this.box.left + this.box.width,
        titleRow + (this.multiplierBelow ? 1.3 * font : 0),
        font,
        1,
      );
    const yFont = this.fitted(this.yTitle, this.length(axisTitle), this.height - this.length(outerRoom));
    this.pen.draw(
      this.yTitle,
      labelRight - this.labels - this.length(titleGap),
      this.box.top + this.box.height / 2,
      yFont,
      0.5,
      false,
      true,
    );
    const multiplier = this.yTicks.multiplier;
    if (multiplier.includes(" ")) this.pen.draw(multiplier, labelRight - this.labels, top - this.length(13), font);
    else if (multiplier) this.pen.draw(multiplier, left - this.length(tickLength), top - this.length(15), font, 1);
  }

  private drawHeading() {
    const { pen, theme } = this;
    const { context } = pen;
    const font = this.length(legendText);
    const outer = this.length(outerRoom);
    const left = this.canvas.frame ? this.box.left : outer;
    const top = this.box.top - this.headingBlock;
    let y = this.canvas.frame ? top : Math.min(top, 0.8 * outer);
    context.fillStyle = css(theme.ink);
    const wide = Math.max(...this.heading.map((line) => pen.width(line, this.headingFont, true)));
    for (const line of this.heading) {
      pen.draw(
        line,
        Math.max(Math.min(left, this.width - outer - wide), outer),
        y + 0.8 * this.headingFont,
        this.headingFont,
        0,
        true,
      );
      y += headingRow * this.headingFont;
    }
    let at = 0;
    for (const key of this.keys) {
      const next = this.keyWidth(key);
      if (at > 0 && at + next - this.length(30) > this.keysWide) {
        at = 0;
        y += this.length(legendRow);
      }
      const base = y + 0.8 * font;
      const middle = base - 0.36 * font;
      const colour = shown(parse(key.colour), theme);
      context.fillStyle = context.strokeStyle = css(colour, key.line ? colour[3] : 1);
      context.beginPath();
      if (key.line) {
        context.lineWidth = this.length(3);
        context.lineCap = key.dashed ? "butt" : "round";
        context.setLineDash(key.dashed ? [this.length(8), this.length(6)] : []);
        context.moveTo(left + at, middle);
        context.lineTo(left + at + this.length(36), middle);
        context.stroke();
        context.setLineDash([]);
      } else {
        context.arc(left + at + this.length(8), middle, this.length(7.5), 0, 7);
        context.fill();
      }
      context.fillStyle = css(theme.ink);
      pen.draw(key.label, left + at + this.length(key.line ? 46 : 24), base, font);
      at += next;
    }
  }

  private drawBar({ bar, ticks, labels }: Bar, from: number) {
    const { context } = this.pen;
    const wide = this.lineWidth(frameLine);
    const font = this.length(tickText);
    const beside = this.barBox();
    const area = {
      left: Math.round(from),
      top: Math.round(beside.top),
      width: Math.round(this.length(barWidth)),
      height: Math.round(beside.height),
    };
    const map = this.maps[bar.map] ?? ["#9e9e9e"];
    const some = bar.high > bar.low;
    // Pixel row by pixel row, so that no seams are visible.
    for (let row = 0; row < area.height; ++row) {
      const level = some ? 1 - (row + 0.5) / area.height : 0.5;
      context.fillStyle = map[Math.min(Math.floor(level * map.length), map.length - 1)] ?? "";
      context.fillRect(area.left, area.top + row, area.width, 1);
    }
    const { left, top, right } = this.strokeBox(area, wide);
    const height = (value: number) =>
      area.top + area.height * (some ? 1 - (value - bar.low) / (bar.high - bar.low) : 0.5);
    context.beginPath();
    for (const [values, reach] of [
      [ticks.major, tickLength],
      [ticks.minor, minorTick],
    ] as const)
      for (const value of values) {
        const y = this.crisp(height(value), wide);
        context.moveTo(right, y);
        context.lineTo(right + this.length(reach), y);
      }
    context.stroke();
    const labelRight = right + this.length(tickLength + tickGap) + labels;
    ticks.major.forEach((value, i) =>
      this.pen.draw(ticks.labels[i] ?? "", labelRight, height(value) + 0.36 * font, font, 1),
    );
    this.pen.draw(ticks.multiplier, left, top - this.length(15), font);
    const title = titleOf(bar.label, bar.unit);
    const titleFont = this.fitted(title, this.length(axisTitle), this.height - this.length(outerRoom));
    this.pen.draw(
      title,
      labelRight + this.length(titleGap + 0.8 * axisTitle),
      beside.top + beside.height / 2,
      titleFont,
      0.5,
      false,
      true,
    );
  }
}

/** A line of text in the middle, in place of a drawing that is not possible. */
export function drawLine(pen: Pen, text: string, colour: Rgba, box: Box, size: number) {
  const lines = pen.wrapped(text, size, 0.9 * box.width);
  pen.context.fillStyle = css(colour);
  lines.forEach((line, i) =>
    pen.draw(
      line,
      box.left + box.width / 2,
      box.top + box.height / 2 + (i - (lines.length - 1) / 2) * 1.4 * size,
      size,
      0.5,
    ),
  );
}
