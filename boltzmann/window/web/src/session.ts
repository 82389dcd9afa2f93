// The state of the page: the last messages of the window, the user's choices, and the listeners for changes.
import { Connection, type ConnectionEvents, type Link, type Words } from "./connection";
import { remember, remembered } from "./elements";
import type { Notices } from "./notices";
import type { Hello, Reply, Update } from "./protocol";
import { Recording, recordingInPage } from "./recording";
import { Rows } from "./rows";

export type Theme = "light" | "dark" | "system";

/** Default members for a gallery's hello. */
const nothing: Hello = {
  type: "hello",
  kind: "gallery",
  title: "",
  description: "",
  name: "",
  dimension: 2,
  planned: 0,
  folder: "",
  box: { low: [], high: [], boundary: [] },
  length_unit: "",
  length_factor: 1,
  time_unit: "",
  step_size: "",
  step_size_number: 0,
  steps_per_frame: 1,
  ensembles: [],
  quantities: [],
  vectors: [],
  diagnoses: [],
  columns: [],
  can: { rewind: "", step_size: "", checkpoint: "", seek: "", quit: "" },
  maps: {},
  colours: [],
  drawings: {},
};

function firstUpper(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

const most_paintable = 200_000;
const least_paintable = 20_000;

interface Changes {
  /** The simulation has changed, or one of its properties. */
  hello: Hello;
  /** A new update has arrived and is not yet painted. */
  update: Update;
  /** The socket is open or not. */
  link: boolean;
  /** A choice: tracks, follow, theme, the most points, the pace. */
  choice: null;
}

export class Session {
  hello: Hello | null = null;
  update: Update | null = null;
  readonly rows = new Rows();
  readonly link: Link;
  /** The window has ended the session. */
  over = false;

  tracking = false;
  following = false;
  theme: Theme;
  /** The user's own limit of points; 0: what the machine can paint. */
  most: number;
  /** The number of points that the machine can paint, as far as known. */
  paintable = most_paintable;

  private readonly listeners: { [K in keyof Changes]: ((what: Changes[K]) => void)[] } = {
    hello: [],
    update: [],
    link: [],
    choice: [],
  };
  private readonly darkSystem = matchMedia("(prefers-color-scheme: dark)");

  constructor(readonly notices: Notices) {
    const theme = remembered("theme");
    this.theme = theme === "light" || theme === "dark" ? theme : "system";
    this.most = Number(remembered("most")) || 0;
    this.darkSystem.addEventListener("change", () => this.chosen());
    this.dress();
    const recording = recordingInPage();
    const events: ConnectionEvents = {
      hello: (hello) => this.greeted(hello),
      update: (update) => this.updated(update),
      bye: ({ message }) => {
        this.over = true;
        notices.set("link", `The window has closed${message ? `: ${message}` : ""}. The last picture stays.`);
        this.tell("link", false);
      },
      opened: () => {
        notices.clear("link");
        this.tell("link", true);
      },
      broken: (seconds, attempt, reason) => {
        const gone = attempt > 5 ? "The window has closed; the last picture stays" : "The connection to the window broke";
        notices.set("link", `${gone}${reason ? ` (${reason})` : ""}. Next try in ${seconds} s.`, "warning", {
          words: "Try now",
          press: () => this.link.retry(),
        });
        this.tell("link", false);
      },
      damaged: (error) => {
        notices.set("reply", `A message of the window was damaged: ${error}`, "error");
        this.ask();
      },
    };
    this.link = recording === null ? new Connection(events) : new Recording(recording, events);
  }

  on<K extends keyof Changes>(what: K, listener: (what: Changes[K]) => void): void {
    this.listeners[what].push(listener);
  }

  /** Requests the next update. */
  ask(): void {
    this.link.next(this.rows.count, this.rows.number);
  }

  /** Sends a command of the user, and clears the error of an earlier one. */
  command(words: Words): Promise<Reply> {
    this.notices.clear("reply");
    return this.tellWindow(words);
  }

  /** Sends a request; a refusal is shown as a message of the page. */
  async tellWindow(words: Words): Promise<Reply> {
    const reply = await this.link.say(words);
    if (reply.error && this.link.connected) this.notices.set("reply", firstUpper(reply.error), "error");
    return reply;
  }

  get dark(): boolean {
    return this.theme === "dark" || (this.theme === "system" && this.darkSystem.matches);
  }

  /** Stores a choice and notifies all listeners. */
  choose(choice: Partial<Pick<Session, "tracking" | "following" | "theme" | "most">>): void {
    Object.assign(this, choice);
    remember("theme", this.theme);
    remember("most", String(this.most));
    this.chosen();
  }

  /** Adapts the limit of points: halves it if painting is slow, doubles it if it is fast. */
  slower(points: number): void {
    const half = Math.max(least_paintable, Math.round(points / 2));
    if (points > least_paintable) this.paint(Math.min(this.paintable, half));
  }
  faster(): void {
    this.paint(Math.min(most_paintable, this.paintable * 2));
  }
  private paint(paintable: number): void {
    if (paintable === this.paintable) return;
    this.paintable = paintable;
    this.chosen();
  }

  private chosen(): void {
    this.dress();
    this.tell("choice", null);
  }

  private dress(): void {
    document.documentElement.dataset.theme = this.dark ? "dark" : "light";
  }

  private tell<K extends keyof Changes>(what: K, value: Changes[K]): void {
    for (const listener of this.listeners[what]) listener(value);
  }

  private greeted(words: Partial<Hello>): void {
    const hello = { ...nothing, ...words };
    if (hello.kind !== this.hello?.kind || hello.name !== this.hello.name) this.update = null;
    this.hello = hello;
    this.rows.forget(); // another table may have the same number
    for (const matter of ["run", "missed", "reply"] as const) this.notices.clear(matter); // of what was shown before
    this.tell("hello", hello);
    queueMicrotask(() => this.ask()); // after the panes have sent their views
  }

  private updated(update: Update): void {
    this.update = update;
    this.paced(update);
    if (update.table && !this.rows.take(update.table)) this.rows.forget();
    if (update.message)
      this.notices.set("run", firstUpper(update.message), update.state === "failed" ? "error" : "info");
    else this.notices.clear("run");
    if (update.missed) this.notices.set("missed", firstUpper(update.missed.text));
    else this.notices.clear("missed");
    this.tell("update", update);
    this.painted();
  }

  /** Another client has set another step size or pace. */
  private paced({ steps_per_frame, step_size, step_size_number }: Update): void {
    const { hello } = this;
    if (!hello) return;
    const now = { steps_per_frame, step_size: step_size ?? hello.step_size };
    if (now.steps_per_frame === hello.steps_per_frame && now.step_size === hello.step_size) return;
    Object.assign(hello, now, step_size_number === undefined ? {} : { step_size_number });
    this.chosen();
  }

  /** Requests the next update when this one is on the screen; a hidden page requests two per second. */
  private painted(): void {
    let asked = false;
    const once = () => {
      if (asked) return;
      asked = true;
      this.ask();
    };
    if (!document.hidden) requestAnimationFrame(once); // after the panes' own callbacks
    setTimeout(once, document.hidden ? 500 : 3000);
  }
}
