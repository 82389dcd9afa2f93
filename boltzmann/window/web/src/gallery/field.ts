// One parameter in the form: its input, what is allowed, what is wrong, and the way back to what the scenario has.
import { h } from "../elements";
import { limits, shown, typed, wrong, type Parameter } from "./parameter";

type Input = HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement;

export class Field {
  readonly element: HTMLElement;
  private readonly input: Input;
  private readonly back: HTMLButtonElement;
  private readonly trouble: HTMLElement;
  /** What the scenario has, as it is shown. */
  readonly original: string;
  private told = "";

  constructor(
    readonly parameter: Parameter,
    number: number,
    private readonly edited: (field: Field) => void,
  ) {
    const id = `parameter-${number}`;
    this.original = shown(parameter);
    this.input = this.makeInput(id);
    this.write(this.original);
    this.back = h("button", { type: "button", class: "gallery-back-to", click: () => this.reset() });
    this.back.hidden = true;
    this.trouble = h("p", { class: "gallery-trouble", id: `${id}-trouble`, "aria-live": "polite" });
    const hint = this.hint();
    this.input.setAttribute("aria-describedby", hint ? `${id}-hint ${id}-trouble` : `${id}-trouble`);
    const label = h("label", { for: id }, parameter.name.replace(/_/g, " "));
    this.element = h(
      "div",
      { class: "gallery-field", "data-path": parameter.path, "data-kind": parameter.kind },
      h("div", { class: "gallery-label" }, label, this.back),
      h("div", { class: "gallery-input" }, this.input),
      hint ? h("p", { class: "gallery-hint", id: `${id}-hint` }, hint) : null,
      this.trouble,
    );
    this.input.addEventListener("input", () => {
      this.told = "";
      this.update();
      this.edited(this);
    });
    this.update();
  }

  get text(): string {
    return this.input instanceof HTMLInputElement && this.input.type === "checkbox" ? String(this.input.checked) : this.input.value;
  }
  get changed(): boolean {
    return this.text !== this.original;
  }
  /** What the user has typed, as TOML. */
  get toml(): string {
    return typed(this.parameter, this.text);
  }
  /** What the page itself sees to be wrong. */
  get wrong(): string {
    return this.changed ? wrong(this.parameter, this.text) : "";
  }
  get troubled(): boolean {
    return this.wrong !== "" || this.told !== "";
  }
  /** What the window has said about it; empty: nothing. */
  tell(error: string): void {
    this.told = error;
    this.update();
  }
  /** As the user had it before. */
  restore(text: string): void {
    this.write(text);
    this.update();
  }
  focus(): void {
    this.input.focus();
  }

  private reset(): void {
    this.write(this.original);
    this.told = "";
    this.update();
    this.edited(this);
    this.input.focus();
  }

  private makeInput(id: string): Input {
    const { kind, words } = this.parameter;
    if (kind === "boolean") return h("input", { type: "checkbox", id });
    if (kind === "word" && words.length > 0) {
      const known = words.includes(this.original) ? words : [this.original, ...words];
      return h("select", { id }, ...known.map((word) => h("option", { value: word }, word)));
    }
    if (this.original.includes("\n")) return h("textarea", { id, rows: Math.min(8, this.original.split("\n").length + 1), spellcheck: "false" });
    const mode = kind === "integer" ? "numeric" : "text";
    return h("input", { type: "text", id, inputmode: mode, autocomplete: "off", spellcheck: "false", autocapitalize: "off" });
  }

  private write(text: string): void {
    if (this.input instanceof HTMLInputElement && this.input.type === "checkbox") this.input.checked = text === "true";
    else this.input.value = text;
  }

  /** The comment of the scenario, the limits, the units. */
  private hint(): string {
    const { comment, units, kind } = this.parameter;
    const allowed = kind === "vector" ? "" : limits(this.parameter);
    return [comment, allowed, units.length > 0 ? `in ${units.join(", ")}` : ""].filter(Boolean).join(" · ");
  }

  private update(): void {
    const { changed } = this;
    const trouble = this.wrong || this.told;
    this.element.dataset.changed = String(changed);
    this.back.hidden = !changed;
    const short = this.original.length > 24 ? `${this.original.slice(0, 22).trimEnd()} …` : this.original;
    this.back.textContent = this.parameter.kind === "boolean" ? (this.original === "true" ? "back to yes" : "back to no") : `back to ${short || "nothing"}`;
    this.trouble.textContent = trouble;
    this.input.setAttribute("aria-invalid", String(trouble !== ""));
  }
}
