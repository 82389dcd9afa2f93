// Measured quantities against time: curves of selected columns of the table, one axis per unit.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { h } from "./elements";
import type { Hello } from "./protocol";
import type { Rows } from "./rows";

/** A number in conventional notation: 0.25, 1,200, 3.1·10⁻⁷; `digits` decimal places of the leading digit. */
export function written(value: number, digits: number): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const power = Math.floor(Math.log10(Math.abs(value)) + 1e-9);
  if (power > -4 && power < 6) {
    const places = Math.min(12, Math.max(0, digits - power));
    return value.toFixed(places).replace("-", "−");
  }
  const mantissa = (value / 10 ** power).toFixed(Math.min(12, Math.max(0, digits))).replace("-", "−");
  const raised = String(power)
    .replace("-", "⁻")
    .replace(/\d/g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(digit)]);
  return `${mantissa}·10${raised}`;
}

/** Numbers at ticks that are `increment` apart. */
function ticks(values: (number | null)[], increment: number): string[] {
  const step = Math.floor(Math.log10(increment || 1) + 1e-9);
  return values.map((value) => {
    if (value === null) return "";
    if (Math.abs(value) < increment * 1e-6) return "0";
    return written(value, Math.max(0, Math.floor(Math.log10(Math.abs(value)) + 1e-9) - step));
  });
}

/** Ticks of any size; uPlot's own are limited to 1e16. */
const even: Pick<uPlot.Axis, "incrs" | "splits"> = {
  incrs: (_plot, _axis, low, high) => {
    const power = Math.floor(Math.log10(high - low || 1));
    return [-4, -3, -2, -1, 0, 1].flatMap((p) => [1, 2, 2.5, 5].map((factor) => factor * 10 ** (power + p)));
  },
  splits: (_plot, _axis, low, high, increment) => {
    const first = Math.ceil(low / increment - 1e-9);
    const count = Math.floor(high / increment + 1e-9) - first + 1;
    return Array.from({ length: Math.min(Math.max(count, 0), 1000) }, (_, k) => (first + k) * increment);
  },
};

export interface PlotOptions {
  /** The columns of a diagnosis, comma-separated; empty: those with the unit of the first one. */
  chosen: string;
  logarithmic: boolean;
}

export class TablePlot {
  private readonly host = h("div", { class: "curves", tabindex: 0, role: "group" });
  private readonly list = h("div", { class: "columns", role: "group", "aria-label": "columns shown" });
  private readonly values: HTMLElement[] = [];
  private readonly shown: boolean[];
  private plot: uPlot | null = null;
  private zoomed = false;
  private timer = 0;
  private drawnAt = 0;
  private readonly size: ResizeObserver;
  /** Called after the curves are painted. */
  onpaint: () => void = () => {};

  constructor(
    place: HTMLElement,
    private readonly hello: Hello,
    private readonly rows: Rows,
    private options: PlotOptions,
  ) {
    const wanted = options.chosen.split(",").map((word) => word.trim());
    const columns = hello.columns;
    this.shown = columns.map(({ name, unit }) => (options.chosen ? wanted.includes(name) : unit === columns[0].unit));
    if (!options.chosen)
      columns.forEach((_, c) => (this.shown[c] &&= this.shown.slice(0, c).filter(Boolean).length < 6));
    columns.forEach((column, c) => this.list.append(this.chip(column, c)));
    this.host.setAttribute("aria-label", `measured quantities against time (${hello.time_unit})`);
    this.host.addEventListener("keydown", (event) => this.key(event));
    place.append(this.host, this.list);
    if (!columns.length) this.host.append(h("p", { class: "empty" }, "This run measures nothing: there is no table."));
    this.size = new ResizeObserver(() => this.resize());
    this.size.observe(this.host);
    this.make();
  }

  /** The canvas of the curves, to be recorded or saved. */
  get element(): HTMLCanvasElement | null {
    return this.plot?.ctx.canvas ?? null;
  }

  /** Called when rows were added. Many rows are drawn five times a second. */
  show(): void {
    if (this.timer) return;
    const pause = this.rows.count > 5000 ? Math.max(0, 200 - (performance.now() - this.drawnAt)) : 0;
    const paint = () => {
      this.timer = 0;
      this.paint();
    };
    this.timer = pause ? window.setTimeout(paint, pause) : requestAnimationFrame(paint);
  }

  logarithmic(on: boolean): void {
    if (on === this.options.logarithmic) return;
    this.options = { ...this.options, logarithmic: on };
    this.make();
  }

  /** Applies the colours of the theme. */
  theme(): void {
    this.make();
  }

  reset(): void {
    this.zoomed = false;
    this.paint();
  }

  dispose(): void {
    clearTimeout(this.timer);
    cancelAnimationFrame(this.timer);
    this.size.disconnect();
    this.plot?.destroy();
    this.host.remove();
    this.list.remove();
  }

  private colour(c: number): string {
    const colours = this.hello.colours;
    return colours.length ? colours[c % colours.length] : "#3b6fd4";
  }

  private chip({ name, unit }: { name: string; unit: string }, c: number): HTMLElement {
    const value = h("span", { class: "value" });
    this.values.push(value);
    const box = h("input", {
      type: "checkbox",
      "data-column": name,
      change: () => {
        this.shown[c] = box.checked;
        this.make();
      },
    });
    box.checked = this.shown[c];
    const swatch = h("span", { class: "swatch" });
    swatch.style.background = this.colour(c);
    return h(
      "label",
      { class: "chip" },
      box,
      swatch,
      h("span", { class: "name" }, name),
      value,
      h("span", { class: "unit" }, unit),
    );
  }

  private make(): void {
    this.plot?.destroy();
    this.plot = null;
    const { columns, time_unit } = this.hello;
    const { width, height } = this.host.getBoundingClientRect();
    if (!columns.length || width < 40 || height < 40) return;
    const style = getComputedStyle(this.host);
    const [ink, quiet, line, paper] = ["--ink", "--quiet", "--line", "--paper"].map((name) =>
      style.getPropertyValue(name),
    );
    const font = `12px ${style.fontFamily}`;
    const units = [...new Set(columns.filter((_, c) => this.shown[c]).map(({ unit }) => unit))];
    const distr = this.options.logarithmic ? 3 : 1;
    const axis = {
      stroke: ink,
      font,
      labelFont: `13px ${style.fontFamily}`,
      ticks: { stroke: quiet, size: 5, width: 1 },
      border: { show: true, stroke: quiet, width: 1 },
      labelSize: 22,
      gap: 4,
    };
    const beside = (unit: string, k: number): uPlot.Axis => ({
      ...axis,
      scale: `unit ${unit}`,
      side: k % 2 ? 1 : 3,
      space: 38,
      grid: { show: k === 0, stroke: line, width: 1 },
      label: this.title(unit, height),
      ...(distr === 3 ? {} : even),
      size: (_plot, values) => 14 + 7.6 * Math.max(2, ...(values ?? []).map((value) => value?.length ?? 0)),
      values: (_plot, splits, _axis, _space, increment) =>
        distr === 3
          ? splits.map((value) => (Math.abs(Math.log10(value) % 1) < 1e-9 ? written(value, 0) : ""))
          : ticks(splits, increment),
    });
    const range = (_plot: uPlot, low: number | null, high: number | null): uPlot.Range.MinMax => {
      if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high))
        return distr === 3 ? [1, 10] : [0, 1];
      if (distr === 3) return [10 ** Math.floor(Math.log10(low)), 10 ** Math.ceil(Math.log10(high) || 1)];
      // A constant is a line in the middle: rounding errors must not be magnified to a curve.
      const least = 1e-9 * Math.max(Math.abs(low), Math.abs(high));
      const margin = high - low > least ? 0.06 * (high - low) : Math.max(0.05 * Math.abs(high), least) || 1;
      return [low - margin, high + margin];
    };
    this.plot = new uPlot(
      {
        width,
        height,
        padding: [14, units.length > 1 ? 4 : 18, 0, 4],
        legend: { show: false },
        cursor: { drag: { x: true, y: true, uni: 40 }, points: { size: 7 }, lock: false },
        scales: {
          x: { time: false, range: (_plot, low, high) => (low < high ? [low, high] : [low ?? 0, (low ?? 0) + 1]) },
          ...Object.fromEntries(units.map((unit) => [`unit ${unit}`, { distr, range } as uPlot.Scale])),
        },
        axes: [
          {
            ...axis,
            size: 34,
            space: 84,
            ...even,
            grid: { stroke: line, width: 1 },
            label: time_unit ? `time (${time_unit})` : "time",
            values: (_plot, splits, _axis, _space, increment) => ticks(splits, increment),
          },
          ...units.map(beside),
        ],
        series: [
          {},
          ...columns.map(({ name, unit }, c) => ({
            label: name,
            show: this.shown[c],
            scale: this.shown[c] ? `unit ${unit}` : `unit ${units[0] ?? ""}`,
            stroke: this.colour(c),
            width: 1.75,
            points: { size: 4 },
          })),
        ],
        hooks: {
          drawClear: [
            ({ ctx }) => {
              ctx.fillStyle = paper;
              ctx.fillRect(0, 0, ctx.canvas.width, ctx.canvas.height);
            },
          ],
          setCursor: [() => this.read()],
          setSelect: [({ select }) => void (this.zoomed ||= select.width > 0)],
        },
      },
      this.data(),
      this.host,
    );
    this.plot.over.addEventListener("dblclick", () => (this.zoomed = false));
    this.read();
  }

  /** The title of the axis of a unit: the name of the quantity, if it is the only one and fits. */
  private title(unit: string, height: number): string {
    const names = this.hello.columns
      .filter((column, c) => this.shown[c] && column.unit === unit)
      .map(({ name }) => name);
    const fits = names.length === 1 && 8 * (names[0].length + unit.length) < height - 70;
    const name = fits ? names[0] : "";
    return unit ? (name ? `${name} (${unit})` : `(${unit})`) : name;
  }

  private data(): uPlot.AlignedData {
    const least = this.options.logarithmic ? Number.MIN_VALUE : -Infinity;
    const columns = this.hello.columns.map((_, c) => {
      const values = this.rows.column(c + 2);
      // Values that are missing (or can't be drawn) are gaps.
      const whole = values.every((value) => value >= least);
      return whole ? values : Array.from(values, (value) => (value >= least ? value : null));
    });
    return [this.rows.column(1), ...columns];
  }

  private paint(): void {
    this.drawnAt = performance.now();
    if (!this.plot) {
      this.make();
    } else {
      this.plot.setData(this.data(), !this.zoomed);
      if (this.zoomed) this.plot.redraw(true);
      this.read();
    }
    this.onpaint();
  }

  /** Shows the values at the cursor, or the last ones, beside the names. */
  private read(): void {
    const at = this.plot?.cursor.idx ?? this.rows.count - 1;
    this.values.forEach((value, c) => {
      const number = at >= 0 ? this.rows.column(c + 2)[at] : NaN;
      value.textContent = this.shown[c] && number !== undefined ? written(number, 4) : "";
    });
  }

  private resize(): void {
    const { width, height } = this.host.getBoundingClientRect();
    if (!this.plot) this.make();
    else if (width > 40 && height > 40) this.plot.setSize({ width, height });
  }

  private key(event: KeyboardEvent): void {
    const plot = this.plot;
    const { min, max } = plot?.scales.x ?? {};
    if (!plot || min === undefined || max === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    const middle = (min + max) / 2;
    const half = (max - min) / 2;
    const to = (low: number, high: number) => {
      this.zoomed = true;
      plot.setScale("x", { min: low, max: high });
    };
    if (event.key === "+" || event.key === "=") to(middle - half / 1.4, middle + half / 1.4);
    else if (event.key === "-") to(middle - half * 1.4, middle + half * 1.4);
    else if (event.key === "ArrowLeft") to(min - half / 5, max - half / 5);
    else if (event.key === "ArrowRight") to(min + half / 5, max + half / 5);
    else if (event.key === "0" || event.key === "Home") this.reset();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
