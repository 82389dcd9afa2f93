// The panes side by side: one to six. One of them is active: keys and panel apply to it.
import { h, remember, remembered } from "./elements";
import { Pane, type ViewChanges } from "./pane";
import type { Session } from "./session";

export const most_panes = 6;

/** The stored state of a pane across reloads of the page. */
interface Kept {
  id: number;
  diagnosis: string;
  changes: ViewChanges;
}

export class Panes {
  readonly element = h("main", { id: "panes", "aria-label": "diagnoses" });
  list: Pane[] = [];
  active!: Pane;
  private saying = false;
  private said = "";
  private shown = "";
  private listeners: (() => void)[] = [];

  constructor(
    private readonly session: Session,
    private readonly save: (pane: Pane) => void,
  ) {
    session.on("hello", () => this.greet());
    session.on("update", (update) => {
      this.list.forEach((pane) => pane.update(update));
      this.lay();
    });
    session.on("choice", () => {
      this.list.forEach((pane) => pane.choose());
      this.changed(); // the limit of points may have changed
    });
  }

  /** Called when panes are added or removed, or another is active or shows something else. */
  onchange(listener: () => void): void {
    this.listeners.push(listener);
  }

  /** Adds a pane with a diagnosis that no other pane shows. */
  add(diagnosis = this.unseen()): void {
    if (this.list.length >= most_panes) return;
    let id = 1;
    while (this.list.some((pane) => pane.id === id)) ++id;
    this.put({ id, diagnosis, changes: {} });
    this.changed();
  }

  private put({ id, diagnosis, changes }: Kept): void {
    const events = {
      changed: () => this.changed(),
      activated: (other: Pane) => this.activate(other),
      closed: (other: Pane) => this.remove(other),
      saved: (other: Pane) => this.save(other),
      recorded: () => this.arrange(),
    };
    const pane = new Pane(this.session, id, diagnosis, events, changes);
    this.list.push(pane);
    this.list.sort((a, b) => a.id - b.id);
    const after = this.list[this.list.indexOf(pane) + 1];
    this.element.insertBefore(pane.element, after?.element ?? null);
    this.active = pane;
  }

  remove(pane = this.active): void {
    if (this.list.length < 2) return;
    const at = this.list.indexOf(pane);
    this.list.splice(at, 1);
    pane.dispose();
    if (this.active === pane) this.active = this.list[Math.max(0, at - 1)];
    this.changed();
  }

  activate(pane: Pane | undefined): void {
    if (!pane || pane === this.active) return;
    this.active = pane;
    this.arrange();
  }

  /** Removes all panes, before another simulation. */
  clear(): void {
    this.list.forEach((pane) => pane.dispose());
    this.list = [];
  }

  private greet(): void {
    const { kind, name } = this.session.hello ?? {};
    this.said = "";
    if (this.shown !== `${kind} ${name}`) this.clear();
    this.shown = `${kind} ${name}`;
    if (kind === "gallery") return;
    if (this.list.length > 0) this.list.forEach((pane) => pane.greet());
    else this.kept().forEach((pane) => this.put(pane));
    if (this.list.length === 0) return this.add(this.session.hello?.diagnoses[0]?.name);
    this.changed();
  }

  /** The stored panes of this simulation, as far as their diagnoses still exist. */
  private kept(): Kept[] {
    const names = this.session.hello?.diagnoses.map(({ name }) => name) ?? [];
    try {
      const all = JSON.parse(remembered(`panes.${this.shown}`, "sessionStorage") ?? "[]") as Kept[];
      return all.filter(({ diagnosis }) => names.includes(diagnosis)).slice(0, most_panes);
    } catch {
      return [];
    }
  }

  private keep(): void {
    const all: Kept[] = this.list.map(({ id, diagnosis, changes }) => ({ id, diagnosis, changes }));
    remember(`panes.${this.shown}`, JSON.stringify(all), "sessionStorage");
  }

  private unseen(): string {
    const names = this.session.hello?.diagnoses.map(({ name }) => name) ?? [];
    const shown = this.list.map(({ diagnosis }) => diagnosis);
    return names.find((name) => !shown.includes(name)) ?? names[0] ?? "";
  }

  /** Sends the views to the window, once for all simultaneous changes. */
  private changed(): void {
    this.arrange();
    if (this.saying || this.list.length === 0) return;
    this.saying = true;
    queueMicrotask(() => {
      this.saying = false;
      this.keep();
      const views = this.list.map((pane) => pane.view());
      const words = JSON.stringify(views);
      if (!this.session.link.connected || views.length === 0 || words === this.said) return;
      this.said = words;
      void this.session.tellWindow({ do: "views", views });
    });
  }

  private lay(): void {
    this.element.dataset.count = String(this.list.length);
    this.element.classList.toggle("in-rows", this.list[0]?.wide ?? false);
  }

  private arrange(): void {
    this.lay();
    for (const pane of this.list) pane.stand(pane === this.active, this.list.length === 1);
    for (const listener of this.listeners) listener();
  }
}
