// A recording: a stored run whose frames are embedded in the page. It answers like a window, from memory, without a
// socket.
import type { ConnectionEvents, Link, Words } from "./connection";
import { written } from "./plot";
import { decode, type Axis, type Canvas, type Cloud, type Hello, type Reply, type Update, type View } from "./protocol";

/** The embedded data, as JSON; binary messages are base64. */
interface Recorded {
  hello: Hello;
  /** The views of each update, by id. */
  views: View[];
  message: string;
  /** {"table": ...}; empty if there are no measurements. */
  table: string;
  updates: string[];
}

const fastest = 240; // frames per second
const of_page = ["id", "diagnosis", "most", "region"]; // what a page may say of a view that can't be changed

/** The text of the recording in this page; null if there is none, and so a window. */
export function recordingInPage(): string | null {
  return document.getElementById("recording")?.textContent ?? null;
}

function bytes(base64: string): ArrayBuffer {
  return Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)).buffer;
}

function amount(place: number, { label, unit, factor }: Axis): { name: string; label: string; value: string } {
  return { name: label, label, value: `${written(place * factor, 4)}${unit ? ` ${unit}` : ""}` };
}

/** The index of a particle in a cloud; -1 if it is missing. */
function placeIn(cloud: Cloud, particle: number): number {
  const here = cloud.numbers ? cloud.numbers.indexOf(particle) : particle;
  return here < cloud.count ? here : -1;
}

export class Recording implements Link {
  connected = false;
  private recorded!: Recorded;
  private table: Update["table"];
  private number = 0;
  private frame = 0;
  private direction: -1 | 0 | 1 = 0;
  private rate = 25;
  private due = 0;
  private timer = 0;
  private views: View[] = [];
  /** By the id of a view: the last frame that was shown. */
  private readonly shown = new Map<number, number>();
  private selected: { ensemble: string; particle: number } | null = null;
  /** The pending request for an update, and the number of known rows of the table. */
  private asked: { rows: number; table: number } | null = null;
  private news = true;

  constructor(
    text: string,
    private readonly events: ConnectionEvents,
  ) {
    queueMicrotask(() => this.open(text)); // after all parts of the page have added listeners
  }

  say({ do: what, ...more }: Words): Promise<Reply> {
    const id = ++this.number;
    let error: string | undefined;
    try {
      this.perform(what, more);
    } catch (failure) {
      error = (failure as Error).message;
    }
    this.tell();
    return Promise.resolve(error === undefined ? { type: "reply", id, ok: true } : { type: "reply", id, error });
  }

  next(rows: number, table: number): void {
    if (!this.connected) return;
    this.asked = { rows, table };
    if (this.news) queueMicrotask(() => this.answer());
  }

  retry(): void {}

  private open(text: string): void {
    try {
      this.recorded = JSON.parse(text) as Recorded;
      if (this.recorded.table) this.table = (decode(bytes(this.recorded.table)) as Update).table;
    } catch (error) {
      return this.events.damaged(String(error));
    }
    this.connected = true;
    this.rate = this.recorded.hello.steps_per_frame;
    this.events.opened();
    this.events.hello(this.recorded.hello);
  }

  private get last(): number {
    return this.recorded.updates.length - 1;
  }

  private perform(what: string, more: Record<string, unknown>): void {
    if (!this.connected) throw new Error("the recording in this page is damaged");
    switch (what) {
      case "views":
        return this.show(more.views as View[]);
      case "play":
        if (this.frame === this.last) this.frame = 0;
        return this.go(1);
      case "rewind":
        if (this.frame === 0) throw new Error("this is the first frame");
        return this.go(-1);
      case "stop":
        return this.go(0);
      case "step":
        this.go(0);
        this.frame = Math.min(this.last, Math.max(0, this.frame + Number(more.steps ?? 1)));
        return;
      case "seek":
        if (!(Number(more.frame) >= 0 && Number(more.frame) <= this.last))
          throw new Error(`there are frames 0 to ${this.last}`);
        this.frame = Math.floor(Number(more.frame));
        return;
      case "set":
        if (!(Number(more.steps_per_frame) > 0))
          throw new Error(
            `this is a recording: it shows up to ${fastest} frames per second, and nothing else can be set`,
          );
        this.rate = Math.min(fastest, Number(more.steps_per_frame));
        return;
      case "select":
        return this.select(more as { ensemble?: string; particle?: number });
    }
    throw new Error(
      `this is a recording: it can't '${what}'; it takes play, step, rewind, stop, seek, set, select and views`,
    );
  }

  private show(views: View[]): void {
    for (const { id, diagnosis } of this.views)
      if (!views.some((view) => view.id === id && view.diagnosis === diagnosis)) this.shown.delete(id);
    this.views = views;
    const recorded = (view: View) => this.recorded.views.some(({ diagnosis }) => diagnosis === view.diagnosis);
    const changed = (view: View) =>
      Object.entries(view).some(([key, value]) => value !== undefined && !of_page.includes(key));
    if (views.some((view) => recorded(view) && changed(view)))
      throw new Error("this is a recording: how a picture is drawn can't be changed");
  }

  private select({ ensemble, particle }: { ensemble?: string; particle?: number }): void {
    this.selected = ensemble === undefined || particle === undefined ? null : { ensemble, particle };
    if (!this.selected || this.told(this.drawn())) return;
    this.selected = null;
    throw new Error(`this is a recording: particle ${particle} of '${ensemble}' is not in it`);
  }

  /** Plays in a direction; 0: stops. */
  private go(direction: -1 | 0 | 1): void {
    clearTimeout(this.timer);
    this.direction = direction;
    this.due = performance.now();
    if (direction) this.wait();
  }

  private wait(): void {
    const now = performance.now();
    this.due = Math.max(this.due + 1000 / this.rate, now);
    this.timer = window.setTimeout(() => {
      const wanted = this.frame + this.direction;
      if (wanted < 0 || wanted > this.last) this.direction = 0;
      else this.frame = wanted;
      if (this.direction) this.wait();
      this.tell();
    }, this.due - now);
  }

  /** Sends an update if the page waits for one. */
  private tell(): void {
    this.news = true;
    if (this.asked) queueMicrotask(() => this.answer());
  }

  private answer(): void {
    if (!this.asked || !this.news) return;
    const { rows, table } = this.asked;
    this.asked = null;
    this.news = false;
    try {
      this.events.update(this.update(rows, table));
    } catch (error) {
      this.events.damaged(String(error));
    }
  }

  private drawn(): Update {
    return decode(bytes(this.recorded.updates[this.frame])) as Update;
  }

  private update(rows: number, table: number): Update {
    const { frame, direction, recorded } = this;
    const update = this.drawn();
    const known = this.table && table === this.table.number && rows === this.table.rows;
    return {
      ...update,
      state: direction > 0 ? "playing" : direction < 0 ? "rewinding" : frame === this.last ? "done" : "paused",
      steps_per_frame: this.rate,
      frame,
      frames: recorded.updates.length,
      message: recorded.message,
      selected: this.told(update),
      table: known ? undefined : this.table,
      views: this.views.flatMap((view) => this.one(view, update)),
    };
  }

  /** The new data of a view; the page itself draws those of the table. */
  private one({ id, diagnosis }: View, update: Update): Update["views"] {
    if (this.shown.get(id) === this.frame) return [];
    this.shown.set(id, this.frame);
    const recorded = this.recorded.views.find((view) => view.diagnosis === diagnosis);
    const found = recorded && update.views.find((view) => view.id === recorded.id);
    return found ? [{ ...found, id }] : [];
  }

  /** The position of the selected particle on the axes of each picture, and its value there. */
  private told({ views }: Update): Update["selected"] {
    if (!this.selected) return null;
    const { ensemble, particle } = this.selected;
    const fields = new Map<string, { name: string; label: string; value: string }>();
    let position: number[] = [];
    for (const { id, canvas } of views)
      for (const mark of canvas?.marks ?? []) {
        if (mark.kind !== "cloud" || mark.ensemble !== ensemble) continue;
        const here = placeIn(mark, particle);
        if (here < 0) continue;
        const place = Array.from(
          { length: mark.dimension },
          (_, a) => mark.origin[a] + mark.scale[a] * mark.positions[here * mark.dimension + a],
        );
        for (const field of this.fields(canvas as Canvas, place, mark.values?.[here])) fields.set(field.label, field);
        const name = this.recorded.views.find((view) => view.id === id)?.diagnosis;
        const drawing = this.recorded.hello.diagnoses.find((one) => one.name === name)?.drawing;
        if (drawing === "cartesian") position = place;
      }
    return fields.size ? { ensemble, particle, position, fields: [...fields.values()] } : null;
  }

  private fields({ x, y, z, bars }: Canvas, place: number[], value?: number) {
    const axes = [x, y, ...(z ? [z] : [])].slice(0, place.length).map((axis, a) => amount(place[a], axis));
    if (value === undefined || !bars[0] || !Number.isFinite(value)) return axes;
    const { low, high } = bars[0];
    const field = amount(low + value * (high - low), { ...bars[0], logarithmic: false });
    const beyond = value >= 1 ? "≥ " : value <= 0 ? "≤ " : ""; // the colours end there, not the values
    return [...axes, { ...field, value: beyond + field.value }];
  }
}
