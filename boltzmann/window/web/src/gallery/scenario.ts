// The page of one scenario: picture, text, its parameters as a form that is checked during input, RUN and SAVE AS.
import type { Words } from "../connection";
import { h } from "../elements";
import type { Reply } from "../protocol";
import { facts, picture, type Entry } from "./cards";
import { paragraphs } from "./description";
import { Field } from "./field";
import type { Curve } from "./curve";
import { More } from "./more";
import type { Parameter } from "./parameter";

export type Say = (message: Words) => Promise<Reply>;

/** The reply to {"do":"scenario"}. */
export interface Scenario {
  name: string;
  title: string;
  description: string;
  text: string;
  parameters: Parameter[];
  /** Further keys of its tables. */
  absent: Parameter[];
  /** The curves of its typed laws. */
  curves?: Curve[];
  /** For a saved one: its errors. */
  errors?: Trouble[];
}

/** The user's input in the form of a scenario: path -> text. Kept while the page is open. */
export type Edits = Map<string, string>;

interface Trouble {
  path: string | null;
  message: string;
}

const pause = 400; // milliseconds without typing before a check is requested

/** "ensembles.atoms" as a heading. */
function heading(table: string): string {
  return table.replace(/_/g, " ").replace(/\./g, " · ");
}

export class ScenarioPage {
  readonly element: HTMLElement;
  private readonly present: Field[];
  private readonly groups = new Map<string, HTMLElement>();
  private readonly more = new Map<string, More>();
  /** Required keys that are missing. */
  private needed: Field[] = [];
  private readonly form = h("form", { class: "gallery-form", novalidate: true });
  private readonly general = h("p", { class: "gallery-trouble", id: "gallery-trouble", role: "alert" });
  private readonly state = h("p", { class: "gallery-state", id: "gallery-state", role: "status" });
  private readonly out = h("input", { type: "text", id: "gallery-out", autocomplete: "off", spellcheck: "false", "aria-describedby": "gallery-out-hint" });
  private readonly runButton = h("button", { type: "submit", id: "gallery-run", class: "gallery-main" }, "RUN");
  private readonly saveButton = h("button", { type: "button", id: "gallery-save", "aria-expanded": "false", "aria-controls": "gallery-saving" }, "SAVE AS …");
  private readonly allBack = h("button", { type: "button", id: "gallery-all-back", class: "gallery-back-to" }, "all back");
  private readonly results = this.makeResults();
  private made = 0;
  private timer = 0;
  private asked = 0;
  private errors = 0;
  private gone = false;

  constructor(
    private readonly scenario: Scenario,
    entry: Entry | undefined,
    private readonly say: Say,
    private readonly edits: Edits,
    private readonly saved: () => void,
  ) {
    const { name, title, description, text, parameters, absent } = scenario;
    this.form.append(this.results);
    this.present = parameters.map((parameter) => this.field(parameter, false));
    for (const { element, parameter } of this.present) this.group(parameter.group).querySelector(".gallery-fields")!.append(element);
    this.offer(absent);
    this.form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.run();
    });
    this.allBack.addEventListener("click", () => {
      for (const field of this.fields) field.restore(field.original);
      this.edits.clear();
      this.edited();
      this.fields[0]?.focus();
    });
    this.form.append(this.bar());
    this.element = h(
      "article",
      { class: "gallery-scenario", "data-name": name },
      h("a", { class: "gallery-back", href: "#" }, "‹ All scenarios"),
      h(
        "header",
        {},
        h(
          "div",
          {},
          h("h1", { tabindex: -1 }, title || name),
          h("p", { class: "gallery-facts" }, h("code", {}, name), entry?.own ? h("span", { class: "gallery-own" }, "yours") : null, entry ? facts(entry) : null),
          h("div", { class: "gallery-text" }, ...paragraphs(description)),
        ),
        entry?.picture ? picture(entry) : null,
      ),
      parameters.length > 0 ? h("h2", {}, "Parameters") : null,
      parameters.some(({ kind }) => kind === "quantity")
        ? h("p", { class: "gallery-hint" }, "Write quantities with a unit, “2 fs”; plain numbers are in the scenario's units. Clear a field to use the default.")
        : null,
      this.form,
      h("details", { class: "gallery-toml" }, h("summary", {}, "The scenario file (TOML)"), h("pre", { tabindex: 0 }, text)),
    );
    if (scenario.errors) this.show({ type: "reply", id: 0, errors: scenario.errors });
    this.draw(scenario.curves ?? []);
    this.tellState();
    if (this.changed.length > 0) this.edited();
  }

  /** Stops all requests and updates. */
  leave(): void {
    this.gone = true;
    clearTimeout(this.timer);
  }

  private get changed(): Field[] {
    return this.fields.filter((field) => field.changed);
  }
  private get set(): Record<string, string | null> {
    return Object.fromEntries(this.changed.map((field) => [field.parameter.path, field.toml]));
  }
  private get locallyWrong(): Field[] {
    return this.fields.filter((field) => field.wrong !== "");
  }

  private get fields(): Field[] {
    return [...this.present, ...this.needed, ...[...this.more.values()].flatMap(({ fields }) => fields)];
  }

  /** Restores the user's input, if the page was left. */
  private field(parameter: Parameter, absent: boolean): Field {
    const field = new Field(parameter, this.made++, absent, () => this.edited());
    const before = this.edits.get(parameter.path);
    if (before !== undefined) field.restore(before);
    return field;
  }

  /** The part of the form for a top-level table; title and text follow all tables. */
  private group(name: string): HTMLElement {
    const known = this.groups.get(name);
    if (known) return known;
    const made = h("fieldset", { "data-group": name }, h("legend", {}, heading(name) || "title and text"), h("div", { class: "gallery-fields" }));
    this.groups.set(name, made);
    this.form.insertBefore(made, (name !== "" && this.groups.get("")) || this.results);
    return made;
  }

  /** Further keys of tables; tables that are not in the reply are unchanged. */
  private offer(absent: Parameter[]): void {
    const tables = new Map<string, Parameter[]>();
    const own = new Set(this.present.map(({ parameter }) => parameter.path)); // removed by an empty field
    const others = absent.filter(({ path }) => !own.has(path));
    this.need(others.filter(({ otherwise }) => otherwise === "needed"));
    for (const key of others.filter(({ otherwise }) => otherwise !== "needed")) {
      const table = key.path.slice(0, key.path.lastIndexOf("."));
      tables.set(table, [...(tables.get(table) ?? []), key]);
    }
    for (const [table, keys] of tables) {
      let more = this.more.get(table);
      if (!more) {
        const { group } = keys[0];
        more = new More(table, heading(table.slice(group.length + 1)));
        this.more.set(table, more);
        this.group(group).append(more.element);
      }
      more.offer(keys, (key) => this.field(key, true));
    }
  }

  /** Adds required keys to the form of their tables. */
  private need(keys: Parameter[]): void {
    const wanted = new Set(keys.map(({ path }) => path));
    for (const field of this.needed) if (!wanted.has(field.parameter.path) && !field.changed) field.element.remove();
    this.needed = this.needed.filter((field) => wanted.has(field.parameter.path) || field.changed);
    for (const key of keys) {
      const known = this.fields.find((field) => field.parameter.path === key.path);
      if (known) {
        known.describe(key);
        continue;
      }
      const table = key.path.slice(0, key.path.lastIndexOf(".") + 1);
      const beside = [...this.present, ...this.needed].filter((field) => field.parameter.path.startsWith(table)).pop();
      const made = this.field(key, true);
      if (beside) beside.element.after(made.element);
      else this.group(key.group).querySelector(".gallery-fields")!.append(made.element);
      this.needed.push(made);
    }
  }

  /** Updates the descriptions of the present keys. */
  private describe(parameters: Parameter[]): void {
    for (const field of this.present) {
      const now = parameters.find(({ path }) => path === field.parameter.path);
      if (now) field.describe(now);
    }
  }

  private makeResults(): HTMLElement {
    return h(
      "fieldset",
      {},
      h("legend", {}, "results"),
      h(
        "div",
        { class: "gallery-fields" },
        h(
          "div",
          { class: "gallery-field" },
          h("div", { class: "gallery-label" }, h("label", { for: "gallery-out" }, "folder")),
          h("div", { class: "gallery-input" }, this.out),
          h("p", { class: "gallery-hint", id: "gallery-out-hint" }, "for pictures, tables and the trajectory; left empty: a new one in results/"),
        ),
      ),
    );
  }

  private bar(): HTMLElement {
    const name = h("input", { type: "text", id: "gallery-as", autocomplete: "off", spellcheck: "false", autocapitalize: "off", value: `my-${this.scenario.name.replace(/^my-/, "")}` });
    const answer = h("p", { class: "gallery-answer", id: "gallery-answer", role: "status" });
    const save = h("button", { type: "button", id: "gallery-save-now" }, "Save");
    const replace = h("button", { type: "button", id: "gallery-replace", hidden: true }, "Replace it");
    const saving = h(
      "div",
      { id: "gallery-saving", class: "gallery-saving", hidden: true },
      h("label", { for: "gallery-as" }, "Name"),
      h("span", { class: "gallery-file" }, name, h("span", { "aria-hidden": "true" }, ".toml")),
      save,
      replace,
      answer,
    );
    const store = async (over: boolean) => {
      replace.hidden = true;
      answer.className = "gallery-answer";
      answer.textContent = "";
      if (name.value.trim() === "") {
        answer.className = "gallery-answer gallery-trouble";
        answer.textContent = "a name is needed";
        return name.focus();
      }
      const reply = await this.say({ do: "save", name: this.scenario.name, set: this.set, as: name.value.trim(), ...(over ? { replace: true } : {}) });
      if (reply.error) {
        answer.className = "gallery-answer gallery-trouble";
        answer.textContent = reply.error;
        this.show(reply);
        replace.hidden = over || !/\balready\b/.test(reply.error); // "there is a file '…' already"
        if (!replace.hidden) replace.focus();
        return;
      }
      answer.textContent = `Saved: ${String(reply.path)}`;
      this.saved();
    };
    const open = (wanted: boolean) => {
      saving.hidden = !wanted;
      this.saveButton.setAttribute("aria-expanded", String(wanted));
      if (wanted) name.select();
      else this.saveButton.focus();
    };
    this.saveButton.addEventListener("click", () => open(saving.hidden));
    save.addEventListener("click", () => void store(false));
    replace.addEventListener("click", () => void store(true));
    name.addEventListener("input", () => (replace.hidden = true));
    saving.addEventListener("keydown", (event) => {
      if (event.key === "Escape") {
        event.stopPropagation();
        open(false);
      } else if (event.key === "Enter" && event.target === name) {
        event.preventDefault(); // it would trigger RUN
        void store(false);
      }
    });
    return h(
      "div",
      { class: "gallery-bar" },
      this.general,
      saving,
      h(
        "div",
        { class: "gallery-buttons" },
        this.runButton,
        this.saveButton,
        this.state,
        this.allBack,
      ),
    );
  }

  private edited(): void {
    for (const field of this.fields)
      if (field.changed) this.edits.set(field.parameter.path, field.text);
      else this.edits.delete(field.parameter.path);
    for (const more of this.more.values()) more.tell();
    clearTimeout(this.timer);
    ++this.asked; // discard a pending reply, which is outdated
    this.element.dataset.checked = "waiting";
    this.timer = window.setTimeout(() => void this.check(), pause);
    this.tellState();
  }

  private async check(): Promise<void> {
    if (this.locallyWrong.length > 0) {
      this.element.dataset.checked = "errors";
      return;
    }
    const number = ++this.asked;
    this.state.textContent = "checking …";
    const reply = await this.say({ do: "check", name: this.scenario.name, set: this.set });
    if (this.gone || number !== this.asked) return;
    const before = this.changed.length;
    if (Array.isArray(reply.parameters)) this.describe(reply.parameters as Parameter[]);
    if (Array.isArray(reply.absent)) this.offer(reply.absent as Parameter[]);
    this.show(reply);
    this.draw((reply.curves as Curve[] | undefined) ?? []);
    this.element.dataset.checked = reply.error ? "errors" : "ok";
    this.tellState();
    if (this.changed.length > before) this.edited(); // a key that had been set is offered again
  }

  private draw(curves: Curve[]): void {
    for (const field of this.fields) field.draw(curves.find(({ path }) => path === field.parameter.path) ?? null);
  }

  /** Shows the errors of a reply at their fields. */
  private show(reply: Reply): void {
    const list = (Array.isArray(reply.errors) ? reply.errors : []) as Trouble[];
    const elsewhere: string[] = [];
    for (const field of this.fields)
      field.tell(list.filter(({ path }) => path === field.parameter.path).map(({ message }) => message).join("; "));
    for (const { path, message } of list)
      if (!this.fields.some((field) => field.parameter.path === path)) elsewhere.push(path ? `${path}: ${message}` : message);
    if (reply.error && list.length === 0) elsewhere.push(reply.error);
    this.general.textContent = elsewhere.join("\n");
    this.errors = list.length + (reply.error && list.length === 0 ? 1 : 0);
  }

  private tellState(): void {
    const changed = this.changed.length;
    const wrong = this.locallyWrong.length || this.errors;
    const changes = changed === 0 ? "as in the file" : `${changed} changed`;
    this.state.textContent = wrong > 0 ? `${changes}, ${wrong === 1 ? "one error" : `${wrong} errors`}` : changes;
    this.allBack.hidden = changed === 0;
  }

  private async run(): Promise<void> {
    clearTimeout(this.timer);
    const first = this.locallyWrong[0];
    if (first) return first.focus();
    this.runButton.disabled = true;
    this.state.textContent = "starting …";
    const reply = await this.say({ do: "run", name: this.scenario.name, set: this.set, out: this.out.value.trim() });
    if (this.gone) return;
    this.runButton.disabled = false;
    this.show(reply);
    this.tellState();
    if (reply.error) this.fields.find((field) => field.troubled)?.focus();
  }
}
