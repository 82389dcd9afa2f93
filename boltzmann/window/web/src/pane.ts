// One pane: a diagnosis, the user's changes to it, and the painter or the plot that shows it.
import { h, iconButton } from "./elements";
import { Painter } from "./paint/painter";
import { TablePlot } from "./plot";
import type { Canvas, Diagnosis, Update, View } from "./protocol";
import { Movie } from "./movie";
import type { Session } from "./session";

/** The properties of a diagnosis that the user can change. */
export type ViewChanges = Omit<View, "id" | "diagnosis" | "most" | "region" | "azimuth" | "elevation">;

/** Events of a pane. */
export interface PaneEvents {
  /** The view to be sent by the window has changed. */
  changed(): void;
  activated(pane: Pane): void;
  closed(pane: Pane): void;
  saved(pane: Pane): void;
  /** A movie starts or ends. */
  recorded(): void;
}

const slow = 80; // milliseconds per paint, three times in a row
const quick = 12; // milliseconds per paint, a hundred times in a row
const pause = 150; // milliseconds without movement before another region is requested

export class Pane {
  readonly element: HTMLElement;
  readonly chooser: HTMLSelectElement;
  canvas: Canvas | null = null;
  painter: Painter | null = null;
  plot: TablePlot | null = null;
  readonly movie = new Movie(() => this.marked());
  private readonly board = h("div", { class: "board" });
  private readonly fault = h("p", { class: "fault", role: "alert", hidden: true });
  private readonly count = h("span", { class: "count" });
  private readonly recording: HTMLButtonElement;
  private readonly close: HTMLButtonElement;
  private region: [number, number][] | undefined;
  private frames = 0;
  private readonly steps = new WeakMap<Canvas, number>();
  private paintedCanvas: Canvas | null = null;
  private slowPaints = 0;
  private quickPaints = 0;
  private moveTimer = 0;
  private selectedAt: number[] | null = null;
  private held = "";
  private columns = "";
  private plotted = ""; // the diagnosis whose quantities the plot shows

  constructor(
    private readonly session: Session,
    readonly id: number,
    public diagnosis: string,
    private readonly events: PaneEvents,
    public changes: ViewChanges = {},
  ) {
    this.chooser = h("select", {
      id: `pane-${id}-chooser`,
      "aria-label": `diagnosis of pane ${id}`,
      change: () => this.show(this.chooser.value),
    });
    this.recording = iconButton("record", "record a movie of this pane", () => this.record(), {
      class: "small record",
    });
    this.close = iconButton("close", "take this pane away", () => events.closed(this), { class: "small close" });
    this.element = h(
      "section",
      {
        class: "pane",
        "data-view": id,
        pointerdown: () => events.activated(this),
        focusin: () => events.activated(this),
      },
      h(
        "header",
        {},
        h("span", { class: "number", "aria-hidden": "true" }, String(id)),
        this.chooser,
        this.count,
        h("span", { class: "space" }),
        iconButton("whole", "the whole view", () => this.reset(), { class: "small whole" }),
        iconButton("save", "save a picture", () => events.saved(this), { class: "small save" }),
        this.recording,
        this.close,
      ),
      this.board,
      this.fault,
    );
    this.greet();
  }

  /** Called when the window has sent its list of diagnoses. */
  greet(): void {
    const names = this.session.hello?.diagnoses.map(({ name }) => name) ?? [];
    this.chooser.replaceChildren(...names.map((name) => h("option", { value: name }, name)));
    if (!names.includes(this.diagnosis)) {
      this.diagnosis = names[0] ?? "";
      this.changes = {};
    }
    const columns = JSON.stringify([this.hello?.columns, this.hello?.time_unit]);
    if (columns !== this.columns) {
      this.plot?.dispose();
      this.plot = null;
    }
    this.columns = columns;
    this.build();
  }

  get drawing(): string {
    return this.own.drawing ?? "";
  }

  /** True for a picture much wider than high with equal scales: it needs a row of its own. */
  get wide(): boolean {
    const { x, y, z, equal_aspect } = this.canvas ?? {};
    return !!x && !!y && !z && !!equal_aspect && x.high - x.low > 2.2 * (y.high - y.low);
  }

  /** The single canvas with the whole contents of the pane. */
  get picture(): HTMLCanvasElement | null {
    return this.painter?.element ?? this.plot?.element ?? null;
  }

  /** Shows another diagnosis. */
  show(diagnosis: string): void {
    this.diagnosis = diagnosis;
    this.changes = {};
    this.region = undefined;
    this.canvas = null;
    this.build();
    this.painter?.reset();
    this.events.changed();
  }

  /** Changes properties of the diagnosis; undefined restores the default. */
  change(changes: ViewChanges): void {
    // The ends belong to another quantity.
    if ("colour" in changes) changes = { low: undefined, high: undefined, ...changes };
    if ("y" in changes) {
      const end = changes.y === this.own.y ? undefined : null;
      changes = { low: end, high: end, ...changes };
    }
    this.changes = { ...this.changes, ...changes };
    this.plot?.logarithmic(this.has("logarithmic") === true);
    this.events.changed();
  }

  /** The diagnosis as defined by the scenario or the program. */
  get own(): Partial<Diagnosis> {
    return this.session.hello?.diagnoses.find(({ name }) => name === this.diagnosis) ?? {};
  }

  /** The user's value, or the default of the diagnosis. */
  has<K extends keyof ViewChanges>(key: K): ViewChanges[K] {
    const { changes, own } = this;
    if (changes[key] !== undefined) return changes[key];
    const end = key === "low" || key === "high"; // of the diagnosis' own colours only
    return end && (changes.colour ?? own.colour) !== own.colour ? undefined : own[key];
  }

  /** The view to be sent by the window. */
  view(): View {
    const view: View = { id: this.id, diagnosis: this.diagnosis, ...this.changes, most: this.most };
    if (this.region) view.region = this.region;
    return view;
  }

  /** The same with the current camera and all particles: for a picture. */
  viewAsSeen(): View {
    const view: View = { id: this.id, diagnosis: this.diagnosis, ...this.changes };
    const seen = this.painter?.ranges();
    if (seen?.azimuth !== undefined) view.azimuth = seen.azimuth;
    if (seen?.elevation !== undefined) view.elevation = seen.elevation;
    if (seen?.zoomed) {
      view.x_range = seen.right ?? seen.x;
      view.y_range = seen.up ?? seen.y;
    }
    return view;
  }

  reset(): void {
    this.painter?.reset();
    this.plot?.reset();
    this.moved();
  }

  /** Applies the selected options of the page: tracks, following and colours. */
  choose(): void {
    this.painter?.theme(this.session.dark ? "dark" : "light");
    this.painter?.track(this.session.tracking);
    this.plot?.theme();
    this.hold();
  }

  update(update: Update): void {
    if (this.plot && update.table) this.plot.show();
    const mine = update.views.find(({ id }) => id === this.id);
    if (mine && !this.plot) {
      this.fault.hidden = mine.error === undefined;
      this.fault.textContent = mine.error ?? "";
      // Clear it, so that no picture of another diagnosis remains behind the error.
      this.board.classList.toggle("blank", mine.error !== undefined && this.canvas === null);
      if (mine.canvas) {
        this.canvas = mine.canvas;
        this.steps.set(mine.canvas, update.step);
        this.head();
        this.painter?.show(mine.canvas);
      }
    }
    this.find(update);
  }

  /** Updates the pane for its place among the others. */
  stand(active: boolean, alone: boolean): void {
    this.element.classList.toggle("active", active && !alone);
    this.close.hidden = alone;
  }

  focus(): void {
    (this.board.querySelector<HTMLElement>("[tabindex='0']") ?? this.chooser).focus();
  }

  record(): void {
    if (this.movie.running) return this.movie.stop();
    const fault = this.movie.start(this.picture, `${this.fileName()}.webm`);
    if (fault) this.session.notices.set("reply", fault, "warning");
  }

  /** The name of a file of this pane, without its extension. */
  fileName(): string {
    const { hello, update } = this.session;
    const plain = (text: string) =>
      text
        .toLowerCase()
        .replace(/[^a-z0-9]+/g, "-")
        .replace(/^-|-$/g, "");
    return [plain(hello?.name ?? ""), plain(this.diagnosis), `step-${update?.step ?? 0}`].filter(Boolean).join("-");
  }

  dispose(): void {
    clearTimeout(this.moveTimer);
    this.movie.stop();
    this.painter?.dispose();
    this.plot?.dispose();
    this.element.remove();
  }

  private get most(): number {
    return this.session.most || this.session.paintable;
  }

  private build(): void {
    const { hello, session } = this;
    this.chooser.value = this.diagnosis;
    this.board.classList.remove("blank");
    this.element.dataset.diagnosis = this.diagnosis;
    this.element.dataset.drawing = this.drawing;
    this.element.setAttribute("aria-label", `pane ${this.id}: ${this.diagnosis}`);
    this.fault.hidden = true;
    if (!hello) return;
    const table = this.drawing === "table";
    if (table ? this.painter || this.plotted !== this.diagnosis : this.plot) {
      this.movie.stop();
      this.painter?.dispose();
      this.plot?.dispose();
      this.painter = this.plot = null;
      this.board.replaceChildren();
    }
    if (table && !this.plot) {
      this.plotted = this.diagnosis;
      this.plot = new TablePlot(this.board, hello, session.rows, {
        chosen: this.own.y ?? "",
        logarithmic: this.has("logarithmic") === true,
      });
      this.plot.onpaint = () => this.counted(session.rows.count, "row", "rows");
      this.plot.show();
    }
    if (!table && !this.painter) {
      this.held = "";
      this.painter = new Painter(this.board, { maps: hello.maps, theme: session.dark ? "dark" : "light" });
      this.painter.onview = () => this.moved();
      this.painter.onpaint = (canvas) => this.painted(canvas);
      this.painter.onpick = (hit) => void session.command(hit ? { do: "select", ...hit } : { do: "select" });
      this.painter.track(session.tracking);
    }
  }

  private get hello() {
    return this.session.hello;
  }

  private painted(canvas: Canvas): void {
    const { points, milliseconds } = this.painter?.drawn ?? { points: 0, milliseconds: 0 };
    const again = canvas === this.paintedCanvas; // only the camera or the marks have changed
    this.paintedCanvas = canvas;
    const cloud = canvas.marks.some(({ kind }) => kind === "cloud");
    this.counted(points, cloud ? "point" : "", cloud ? "points" : "", !again);
    const box = this.painter?.frameBox();
    if (box) this.element.dataset.box = [box.left, box.top, box.width, box.height].map((v) => v.toFixed(2)).join(" ");
    if (again) return;
    this.element.dataset.step = String(this.steps.get(canvas));
    this.element.dataset.milliseconds = String(Math.round(milliseconds));
    this.slowPaints = milliseconds > slow ? this.slowPaints + 1 : 0;
    this.quickPaints = milliseconds < quick ? this.quickPaints + 1 : 0;
    const thinned = this.canvas?.marks.some((mark) => mark.kind === "cloud" && mark.stride > 1);
    if (this.slowPaints === 3) this.session.slower(points);
    else if (this.quickPaints === 100 && thinned) this.session.faster();
    else return;
    this.slowPaints = this.quickPaints = 0;
  }

  /** Shows the number of painted elements; nothing if they have no name. */
  private counted(number: number, one: string, many: string, fresh = true): void {
    this.element.dataset.points = String(number);
    if (fresh) this.element.dataset.frames = String(++this.frames);
    const name = number === 1 ? one : many;
    this.count.textContent = number && name ? `${number.toLocaleString("en-US")} ${name}` : "";
  }

  /** The user has moved the camera: schedules a request for the visible region, unless everything is available. */
  private moved(): void {
    clearTimeout(this.moveTimer);
    this.moveTimer = window.setTimeout(() => {
      const region = this.visible();
      if (JSON.stringify(region) === JSON.stringify(this.region)) return;
      this.region = region;
      this.events.changed();
    }, pause);
  }

  /** The visible region with a margin of a quarter; nothing if everything is sent anyway. */
  private visible(): [number, number][] | undefined {
    const all = this.hello?.ensembles.reduce((sum, { size }) => sum + size, 0) ?? 0;
    const seen = this.painter?.ranges();
    const follows = this.session.following; // the region moves with each frame
    if (!seen?.zoomed || follows || all <= this.most || !this.canvas?.marks.some(({ kind }) => kind === "cloud"))
      return undefined;
    const axes = seen.z ? [seen.x, seen.y, seen.z] : [seen.x, seen.y];
    return axes.map(([low, high]) => [low - (high - low) / 4, high + (high - low) / 4]);
  }

  /** Finds the selected particle in this pane's drawing. */
  private find({ selected }: Update): void {
    let place: number[] | null = null;
    for (const mark of (selected && this.canvas?.marks) || []) {
      if (mark.kind !== "cloud" || mark.ensemble !== selected?.ensemble) continue;
      const here = mark.numbers ? mark.numbers.indexOf(selected.particle) : selected.particle;
      if (!Number.isInteger(here) || here < 0 || here >= mark.count) continue;
      place = Array.from({ length: mark.dimension }, (_, axis) => {
        return mark.origin[axis] + mark.scale[axis] * mark.positions[here * mark.dimension + axis];
      });
    }
    if (!place && selected && this.drawing === "cartesian") place = selected.position.slice(0, this.hello?.dimension);
    this.selectedAt = place;
    this.hold();
  }

  private hold(): void {
    const held = JSON.stringify([this.selectedAt, this.session.following]);
    if (held === this.held && !this.selectedAt) return;
    this.held = held;
    this.painter?.mark(this.selectedAt);
    this.painter?.follow(this.session.following ? this.selectedAt : null);
  }

  /** The page's bar shows simulation and step, so the picture's title is needed only in a movie. */
  private head(): void {
    const title = this.hello?.title ?? "";
    this.painter?.head(this.movie.running || !title || !this.canvas?.title.startsWith(title));
  }

  private marked(): void {
    this.head();
    this.recording.setAttribute("aria-pressed", String(this.movie.running));
    this.recording.title = this.movie.running ? "end the movie and save it" : "record a movie of this pane";
    this.element.classList.toggle("recording", this.movie.running);
    this.events.recorded();
  }
}
