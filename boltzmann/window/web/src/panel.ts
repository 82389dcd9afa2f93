// POPUP: the panel with diagnoses and their options, the steps, tracks, saving, and DONE.
import type { Actions } from "./actions";
import { download, fill, h, icon, iconButton, type Child } from "./elements";
import type { Pane, ViewChanges } from "./pane";
import { most_panes, type Panes } from "./panes";
import { written } from "./plot";
import type { Option, View } from "./protocol";
import { choice, type PictureChoice } from "./saving";
import type { Session, Theme } from "./session";

type Key = keyof ViewChanges;

/** The properties of a drawing that can be changed, in order. The page itself draws tables of diagnoses. */
export function changeable(session: Session, drawing: string): Option[] {
  if (drawing === "table") return [{ key: "logarithmic", doc: "", words: [] }];
  return session.hello?.drawings[drawing] ?? [];
}

/** Steps per frame on the slider. */
const paces = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];
const speeds = [1, 2, 5, 10, 15, 20, 30, 60];

/** A label and its control in one line, with an error below. */
function line(words: string, control: HTMLElement, ...more: Child[]): HTMLElement {
  return h(
    "div",
    { class: "line" },
    h("label", { for: control.id }, words),
    h("div", { class: "control" }, control, ...more),
  );
}

function options(all: [value: string, words: string][], chosen: string): HTMLOptionElement[] {
  const known = all.some(([value]) => value === chosen) ? all : [...all, [chosen, chosen] as [string, string]];
  return known.map(([value, words]) => h("option", { value, selected: value === chosen }, words));
}

function select(
  id: string,
  all: [string, string][],
  chosen: string,
  change: (value: string) => void,
): HTMLSelectElement {
  const element = h("select", { id, change: () => change(element.value) }, ...options(all, chosen));
  return element;
}

function check(id: string, words: string, on: boolean, change: (on: boolean) => void): HTMLElement {
  const box = h("input", { type: "checkbox", id, change: () => change(box.checked) });
  box.checked = on;
  return h("label", { class: "check", for: id }, box, h("span", {}, words));
}

function input(
  id: string,
  value: string,
  change: (value: string) => void,
  more: Record<string, string | number> = {},
): HTMLInputElement {
  const element = h("input", {
    type: "text",
    id,
    value,
    autocomplete: "off",
    spellcheck: "false",
    ...more,
    change: () => {
      element.defaultValue = element.value; // no longer being edited
      change(element.value.trim());
    },
  });
  return element;
}

export class Panel {
  readonly element = h("aside", { id: "panel", "aria-label": "panel", tabindex: -1, hidden: true });
  private readonly shown = h("section", {});
  private readonly view = h("section", {});
  private readonly steps = h("section", {});
  private readonly particle = h("section", {});
  private readonly saving = h("section", {});
  private readonly page = h("section", {});
  private opener: Element | null = null;
  private readonly under = h("p", { class: "quiet under" });
  private readonly ends = new Map<"low" | "high", HTMLInputElement>();

  constructor(
    private readonly session: Session,
    private readonly panes: Panes,
    private readonly actions: () => Actions,
  ) {
    this.element.append(
      h("h2", { class: "unseen" }, "Panel"),
      h("div", { class: "scroll" }, this.shown, this.view, this.steps, this.particle, this.saving, this.page),
      h("footer", {}, h("button", { type: "button", id: "done", class: "primary", click: () => this.close() }, "Done")),
    );
    panes.onchange(() => this.refresh());
    session.on("hello", () => this.refresh());
    session.on("choice", () => this.refresh());
    session.on("update", () => this.follow());
  }

  toggle(): void {
    if (!this.element.hidden) return void this.close();
    this.opener = document.activeElement;
    this.element.hidden = false;
    document.body.classList.add("with-panel");
    this.refresh();
    this.element.focus({ preventScroll: true }); // Tab moves to its first control; keys still work
  }

  /** Returns false if it was not open. */
  close(): boolean {
    if (this.element.hidden) return false;
    const inside = this.element.contains(document.activeElement);
    this.element.hidden = true;
    document.body.classList.remove("with-panel");
    if (inside && this.opener instanceof HTMLElement) this.opener.focus();
    return true;
  }

  /** Rebuilds the sections and preserves the keyboard focus. */
  private refresh(): void {
    if (this.element.hidden || this.panes.list.length === 0) return;
    const had = document.activeElement;
    const inside = this.element.contains(had);
    const typed =
      had instanceof HTMLInputElement && had.type === "text" && had.value !== had.defaultValue ? had.value : null;
    this.fillShown();
    this.fillView();
    this.fillSteps();
    this.fillParticle();
    this.fillSaving();
    this.fillPage();
    this.follow();
    const now = had?.id ? document.getElementById(had.id) : null;
    if (now === had || !inside) return;
    (now ?? this.element).focus({ preventScroll: true });
    if (typed !== null && now instanceof HTMLInputElement) now.value = typed;
  }

  private fillShown(): void {
    const names = this.session.hello?.diagnoses.map(({ name }) => [name, name] as [string, string]) ?? [];
    const alone = this.panes.list.length === 1;
    fill(
      this.shown,
      h("h3", {}, "Diagnoses"),
      ...this.panes.list.map((pane) =>
        h(
          "div",
          { class: `line pane-line${pane === this.panes.active ? " active" : ""}` },
          h(
            "button",
            {
              type: "button",
              class: "number",
              id: `pane-${pane.id}-active`,
              "aria-pressed": String(pane === this.panes.active),
              "aria-label": `pane ${pane.id}: what is below is about it`,
              click: () => this.panes.activate(pane),
            },
            String(pane.id),
          ),
          select(`pane-${pane.id}-diagnosis`, names, pane.diagnosis, (name) => {
            this.panes.activate(pane);
            pane.show(name);
          }),
          alone
            ? null
            : iconButton("close", `take pane ${pane.id} away`, () => this.panes.remove(pane), {
                id: `pane-${pane.id}-remove`,
              }),
        ),
      ),
      this.panes.list.length < most_panes &&
        h(
          "button",
          { type: "button", id: "add-pane", class: "quiet", click: () => this.panes.add() },
          icon("add"),
          "Add a pane",
        ),
    );
    this.shown
      .querySelectorAll("select")
      .forEach((element, k) => element.setAttribute("aria-label", `diagnosis of pane ${this.panes.list[k].id}`));
  }

  private fillView(): void {
    const pane = this.panes.active;
    const options = changeable(this.session, pane.drawing);
    this.ends.clear();
    fill(
      this.view,
      h("h3", {}, this.panes.list.length > 1 ? `${pane.diagnosis} (pane ${pane.id})` : pane.diagnosis),
      ...options.map((option) => this.control(pane, option)),
      !!this.session.hello?.recording &&
        !pane.plot &&
        h("p", { class: "quiet" }, "This is a recording: how it is drawn can't be changed."),
      pane.drawing === "installed" &&
        h("p", { class: "quiet" }, "Drawn by a function of the program: nothing of it can be changed here."),
      pane.plot !== null &&
        h("button", { type: "button", id: "csv", click: () => this.csv(pane) }, icon("save"), "Save the table as CSV"),
      h(
        "button",
        { type: "button", id: "whole", class: "quiet", click: () => pane.reset() },
        icon("whole"),
        "Whole view",
      ),
    );
  }

  private control(pane: Pane, option: Option): Child {
    const element = this.field(pane, option.key as Key, option.words);
    if (element && option.doc) element.title = option.doc.replaceAll("`", "");
    return element;
  }

  private field(pane: Pane, key: Key, words: string[]): HTMLElement | null {
    const { hello } = this.session;
    if (!hello) return null;
    const now = pane.has(key);
    const text = now === undefined || now === null ? "" : String(now);
    const quantities = hello.quantities.map(({ name, label }) => [name, label || name] as [string, string]);
    const places = ["x", "y", "z"]
      .slice(0, hello.dimension)
      .map((axis) => [`position.${axis}`, axis] as [string, string]);
    const id = `view-${key}`;
    const set = (value: View[Key]) => pane.change({ [key]: value });
    switch (key) {
      case "colour":
        return line("Colour", select(id, [["", "by ensemble"], ...quantities], text, set));
      case "size":
        return line("Size", select(id, [["", "the ensemble's"], ...quantities], text, set));
      case "vectors": {
        if (hello.vectors.length === 0) return null;
        return line(
          "Arrows",
          select(id, [["", "none"], ...hello.vectors.map((name) => [name, name] as [string, string])], text, set),
        );
      }
      case "x": {
        if (pane.drawing === "time-series") {
          const columns = hello.columns.map(({ name }) => [name, name] as [string, string]);
          return line("Over", select(id, [["", "time"], ...columns], text === "time" ? "" : text, set));
        }
        if (pane.drawing === "profile" || pane.drawing === "spectrum") {
          const time: [string, string][] = pane.drawing === "spectrum" ? [["time", "time"]] : [];
          return line(
            pane.drawing === "profile" ? "Along" : "Across",
            select(id, [...places, ...time], text || "position.x", set),
          );
        }
        return line("x", select(id, quantities, text, set));
      }
      case "y": {
        if (pane.drawing === "phase-space") return line("y", select(id, quantities, text, set));
        const free = input(id, text, set, { list: `${id}-words` });
        const known =
          pane.drawing === "time-series" ? hello.columns.map(({ name }) => name) : this.words(pane.drawing, text);
        return line(
          "Shows",
          free,
          h("datalist", { id: `${id}-words` }, ...known.map((value) => h("option", { value }))),
        );
      }
      case "low": {
        const drawn = pane.drawing === "cartesian" || pane.drawing === "phase-space";
        if (drawn && !pane.has("colour")) return null; // by ensemble: there is no scale
        const row = line(
          pane.drawing === "profile" ? "Values" : "Colours",
          this.end(pane, "low"),
          "to",
          this.end(pane, "high"),
        );
        row.append(this.under);
        return row;
      }
      case "high":
        return null; // stands beside the lowest
      case "slice":
        if (hello.dimension < 3) return null;
        return line("Slice across", select(id, [["x", "x"], ["y", "y"], ["z", "z"]], text || "z", set)); // prettier-ignore
      case "at":
        return hello.dimension < 3 ? null : this.length("At", id, text, "the middle", set);
      case "range":
        return this.length("Spread over", id, Number(text) > 0 ? text : "", "each one's own", set);
      case "weight":
        return line("Weight", select(id, words.map((name) => [name, name] as [string, string]), text, set)); // prettier-ignore
      case "levels": {
        const shown = Array.isArray(now)
          ? now.map((level) => String(Number((level * this.scale(pane).factor).toPrecision(6)))).join(", ")
          : text;
        const field = input(id, shown, (value) => this.levels(pane, field, value), { placeholder: "automatic" });
        return line("Levels", field);
      }
      case "cells":
      case "bins": {
        const field = input(
          id,
          text,
          (value) => this.number(field, value, (number) => set(number === null ? null : Math.round(number))),
          {
            placeholder: "automatic",
            inputmode: "numeric",
          },
        );
        return line(key === "cells" ? "Cells" : pane.drawing === "profile" ? "Bins at most" : "Bins", field);
      }
      case "logarithmic":
        return check(
          id,
          pane.drawing === "histogram" || pane.drawing === "profile" ? "Logarithmic heights" : "Logarithmic values",
          now === true,
          set,
        );
      case "trace":
        return hello.folder ? check(id, "Tracks through the stored frames", now === true, set) : null;
      case "streaklines": {
        const dye = hello.quantities.some(({ name }) => name === "release");
        const plane = hello.dimension === 2 || (hello.dimension === 3 && pane.drawing === "cartesian");
        return dye && plane ? check(id, "Dye as streaklines", now === true, set) : null;
      }
      case "gap":
        return pane.has("streaklines") ? this.length("Gaps above", id, text, "a tenth of the side", set) : null;
      default:
        return null;
    }
  }

  /** A length, in the unit of the page; empty: null. */
  private length(
    words: string,
    id: string,
    now: string,
    placeholder: string,
    set: (value: number | null) => void,
  ): HTMLElement {
    const { length_factor, length_unit } = this.session.hello ?? { length_factor: 1, length_unit: "" };
    const field = input(
      id,
      now && String(Number(now) * length_factor),
      (value) => this.number(field, value, (number) => set(number === null ? null : number / length_factor)),
      { placeholder, inputmode: "decimal" },
    );
    return line(words, field, h("span", { class: "unit" }, length_unit));
  }

  /** How many, or which, with commas. */
  private levels(pane: Pane, field: HTMLInputElement, value: string): void {
    const numbers = value.split(",").map((part) => Number(part.trim().replace("−", "-")));
    const wrong = value !== "" && !numbers.every(Number.isFinite);
    this.fault(field, wrong ? "number of levels, or a list: 1, 1.5, 2" : "");
    if (wrong) return;
    const { factor } = this.scale(pane);
    const one = numbers.length === 1 && Number.isInteger(numbers[0]);
    pane.change({ levels: value === "" ? null : one ? numbers[0] : numbers.map((level) => level / factor) });
  }

  /** Words that may be meant where any can be written. */
  private words(drawing: string, text: string): string[] {
    const names = this.session.hello?.quantities.map(({ name }) => name) ?? [];
    const known: Record<string, string[]> = {
      mesh: ["density", "potential", "field.x", "field.y", "field.z"],
      profile: ["density", "temperature", ...names],
      spectrum: [...names, ...(this.session.hello?.columns.map(({ name }) => name) ?? [])],
    };
    return [...new Set([text, ...(known[drawing] ?? ["density", ...names])])].filter(Boolean);
  }

  /** In what unit the ends of the colours, or of the values, are told. */
  private scale(pane: Pane): { unit: string; factor: number; low: number; high: number } {
    const { bars, y } = pane.canvas ?? {};
    return bars?.[0] ?? y ?? { unit: "", factor: 1, low: NaN, high: NaN };
  }

  /** The value at an end of the colours, or of the axis of values. */
  private end(pane: Pane, key: "low" | "high"): HTMLInputElement {
    const now = pane.has(key);
    const shown = typeof now === "number" ? String(Number((now * this.scale(pane).factor).toPrecision(6))) : "";
    const take = (number: number | null) =>
      pane.change({ [key]: number === null ? null : number / this.scale(pane).factor });
    const field = input(`view-${key}`, shown, (value) => this.number(field, value, take), {
      inputmode: "decimal",
      "aria-label": key === "low" ? "lowest value" : "highest value",
    });
    this.ends.set(key, field);
    return field;
  }

  /** Takes a number (empty: null), or marks the field as wrong. */
  private number(field: HTMLInputElement, value: string, take: (value: number | null) => void): void {
    const number = value === "" ? null : Number(value.replace("−", "-").replace(",", "."));
    const wrong = number !== null && !Number.isFinite(number);
    this.fault(field, wrong ? "a number; empty: automatic" : "");
    if (!wrong) take(number);
  }

  private fault(field: HTMLElement, text: string): void {
    const control = field.closest(".line");
    control?.querySelector(".fault")?.remove();
    field.toggleAttribute("aria-invalid", text !== "");
    if (text) control?.append(h("p", { class: "fault", role: "alert" }, text));
  }

  private fillSteps(): void {
    const { hello } = this.session;
    if (!hello) return;
    const replay = hello.kind === "replay";
    const size = input(
      "step-size",
      hello.step_size.replace(/ \(.*\)$/, ""),
      (value) => void this.set(size, { step_size: value }),
      {
        "aria-describedby": "step-size-now",
      },
    );
    if (hello.can.step_size) {
      size.disabled = true;
      size.title = hello.can.step_size;
    }
    const scale = replay ? speeds : paces;
    const now = hello.steps_per_frame;
    const number = h("input", {
      type: "number",
      id: "steps-per-frame",
      min: 1,
      step: 1,
      value: now > 0 ? now : "",
      disabled: now === 0,
      change: () => void this.set(number, { steps_per_frame: Math.max(1, Math.round(Number(number.value))) }),
    });
    const nearest = scale.reduce(
      (best, value, k) =>
        Math.abs(Math.log(value / (now || 1))) < Math.abs(Math.log(scale[best] / (now || 1))) ? k : best,
      0,
    );
    const slider = h("input", {
      type: "range",
      id: "steps-slider",
      min: 0,
      max: scale.length - 1,
      value: nearest,
      disabled: now === 0,
      "aria-label": replay ? "frames per second" : "steps per frame",
      input: () => (number.value = String(scale[Number(slider.value)])),
      change: () => void this.set(slider, { steps_per_frame: scale[Number(slider.value)] }),
    });
    fill(
      this.steps,
      h("h3", {}, replay ? "Replay" : "Steps"),
      !replay && line("Step size", size),
      !replay &&
        h(
          "p",
          { class: "quiet", id: "step-size-now" },
          hello.can.step_size || "with a unit, as “2 fs”; plain numbers are in the units of the run",
        ),
      line(replay ? "Frames per second" : "Steps per frame", number),
      h("div", { class: "line" }, slider),
      !replay &&
        check(
          "full-speed",
          "Full speed: frames as they come",
          now === 0,
          (on) => void this.set(number, { steps_per_frame: on ? 0 : 1 }),
        ),
    );
  }

  private async set(field: HTMLElement, what: object): Promise<void> {
    const reply = await this.session.link.say({ do: "set", ...what });
    // The section may have been built anew meanwhile.
    this.fault(document.getElementById(field.id) ?? field, reply.error ?? "");
  }

  private fillParticle(): void {
    const { session } = this;
    const most = input(
      "most",
      session.most ? String(session.most) : "",
      (value) => this.number(most, value, (number) => session.choose({ most: Math.max(0, Math.round(number ?? 0)) })),
      { placeholder: `automatic (${session.paintable.toLocaleString("en-US")})`, inputmode: "numeric" },
    );
    fill(
      this.particle,
      h("h3", {}, "Particles"),
      check("track", "Track: keep what was drawn", session.tracking, (tracking) => session.choose({ tracking })),
      check("follow", "Follow the selected particle", session.following, (following) => session.choose({ following })),
      !session.hello?.recording && line("Points at most", most),
    );
  }

  private fillSaving(): void {
    const { session, panes } = this;
    const shade = choice.dark === undefined ? "page" : choice.dark ? "dark" : "light";
    const why = session.hello?.can.checkpoint ?? "";
    const recording = session.hello?.recording === true;
    const act = (id: string) => () => this.actions().run(id);
    fill(
      this.saving,
      h("h3", {}, "Save"),
      !recording &&
        line(
          "Picture",
          select("save-format", [["png", "PNG"], ["svg", "SVG"], ["pdf", "PDF"]], choice.format, (value) => (choice.format = value as PictureChoice["format"])), // prettier-ignore
          select("save-scale", [["1", "1 ×"], ["2", "2 ×"], ["3", "3 ×"], ["4", "4 ×"]], String(choice.scale), (value) => (choice.scale = Number(value))), // prettier-ignore
        ),
      !recording &&
        line(
          "Colours",
          select("save-dark", [["page", "as the page"], ["light", "light"], ["dark", "dark"]], shade, (value) => (choice.dark = value === "page" ? undefined : value === "dark")), // prettier-ignore
        ),
      h(
        "div",
        { class: "row pair" },
        h("button", { type: "button", id: "save-picture", click: act("picture") }, icon("save"), "Save picture"),
        h(
          "button",
          { type: "button", id: "record", "aria-pressed": String(panes.active.movie.running), click: act("movie") },
          icon("record"),
          panes.active.movie.running ? "End movie" : "Record movie",
        ),
        !recording &&
          h(
            "button",
            {
              type: "button",
              id: "checkpoint",
              "aria-disabled": String(why !== ""),
              title: why || "the whole state, to continue from",
              click: act("checkpoint"),
            },
            icon("save"),
            "Save checkpoint",
          ),
      ),
    );
    this.saving.querySelector("#save-scale")?.setAttribute("aria-label", "size of the picture");
  }

  private fillPage(): void {
    const { session } = this;
    const { title, description, name, folder } = session.hello ?? {};
    const themes: [Theme, string][] = [["light", "Light"], ["dark", "Dark"], ["system", "System"]]; // prettier-ignore
    fill(
      this.page,
      h("h3", {}, "Page"),
      h(
        "fieldset",
        { class: "choice" },
        h("legend", { class: "unseen" }, "colours of the page"),
        ...themes.map(([value, words]) => {
          const radio = h("input", {
            type: "radio",
            name: "theme",
            id: `theme-${value}`,
            value,
            change: () => session.choose({ theme: value }),
          });
          radio.checked = session.theme === value;
          return h("label", { for: `theme-${value}` }, radio, h("span", {}, words));
        }),
      ),
      h(
        "details",
        { id: "about" },
        h("summary", {}, "About this simulation"),
        h("p", {}, h("strong", {}, title || name || "")),
        !!description && h("p", { class: "description" }, description),
        !!folder && h("p", { class: "quiet" }, "Folder: ", h("code", {}, folder)),
      ),
    );
  }

  /** What changes with the frames: the ends of the colours as they are now. */
  private follow(): void {
    if (this.element.hidden || !this.panes.active) return;
    const { low, high, factor, unit } = this.scale(this.panes.active);
    this.under.textContent = `${unit ? `in ${unit}; ` : ""}empty: automatic`;
    const least = 1e-6 * Math.max(Math.abs(low), Math.abs(high)) * factor; // less is what rounding leaves of 0
    for (const [key, field] of this.ends) {
      const value = (key === "low" ? low : high) * factor;
      field.placeholder = Number.isFinite(value) ? written(Math.abs(value) < least ? 0 : value, 1) : "auto";
    }
  }

  private csv(pane: Pane): void {
    const { hello, rows } = this.session;
    const names = hello?.columns.map(({ name, unit }) => (unit ? `${name} (${unit})` : name)) ?? [];
    const time = hello?.time_unit ? `time (${hello.time_unit})` : "time";
    download(`${pane.fileName()}.csv`, new Blob([rows.csv(["step", time, ...names])], { type: "text/csv" }));
  }
}
