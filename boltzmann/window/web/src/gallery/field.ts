// One parameter in the form: its input, limits, errors, and a reset to the value of the scenario. A key that the
// scenario does not have is empty until it is set; clearing an input removes the key.
import { h } from "../elements";
import { drawn, type Curve } from "./curve";
import { limits, shown, typed, wrong, type Parameter } from "./parameter";

type Input = HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement;

const longest = 24; // greatest number of letters of an input or a button

export class Field {
  readonly element: HTMLElement;
  private readonly input: Input;
  private readonly back: HTMLButtonElement;
  private readonly trouble: HTMLElement;
  private readonly help: HTMLElement;
  private curve: HTMLElement | null = null;
  /** The value of the scenario, as displayed. */
  readonly original: string;
  private told = "";

  constructor(
    public parameter: Parameter,
    number: number,
    private readonly absent: boolean,
    private readonly edited: (field: Field) => void,
  ) {
    const id = `parameter-${number}`;
    this.original = absent ? "" : shown(parameter);
    this.input = this.makeInput(id);
    this.write(this.original);
    this.back = h("button", { type: "button", class: "gallery-back-to", click: () => this.reset() });
    this.back.hidden = true;
    this.trouble = h("p", { class: "gallery-trouble", id: `${id}-trouble`, "aria-live": "polite" });
    this.help = h("p", { class: "gallery-hint", id: `${id}-hint` }, h("span", {}));
    this.tellHint();
    this.input.setAttribute("aria-describedby", `${id}-hint ${id}-trouble`);
    const label = h("label", { for: id }, parameter.name.replace(/_/g, " "));
    this.element = h(
      "div",
      { class: "gallery-field", "data-path": parameter.path, "data-kind": parameter.kind },
      h("div", { class: "gallery-label" }, label, this.back),
      h("div", { class: "gallery-input" }, this.input),
      this.trouble,
      this.help,
    );
    this.input.addEventListener("input", () => {
      this.told = "";
      this.update();
      this.edited(this);
    });
    this.update();
  }

  get text(): string {
    return this.input.value;
  }
  get changed(): boolean {
    return this.text !== this.original;
  }
  /** The user's input as TOML; null: the key is removed. */
  get toml(): string | null {
    return this.text.trim() === "" ? null : typed(this.parameter, this.text);
  }
  /** An error that the page itself detects. */
  get wrong(): string {
    return this.changed ? wrong(this.parameter, this.text) : "";
  }
  get troubled(): boolean {
    return this.wrong !== "" || this.told !== "";
  }
  /** The error reported by the window; empty: none. */
  tell(error: string): void {
    this.told = error;
    this.update();
  }
  /** Updates the description, limits and units, which may depend on the law. */
  describe({ doc, unit, units, low, high, low_excluded, otherwise }: Parameter): void {
    this.parameter = { ...this.parameter, doc, unit, units, low, high, low_excluded, otherwise };
    this.tellHint();
    this.update();
  }
  /** Shows the curve of a typed law; null: unknown. */
  draw(curve: Curve | null): void {
    this.curve?.remove();
    this.curve = curve && drawn(curve);
    if (this.curve) this.trouble.after(this.curve);
  }
  /** Restores the user's input. */
  restore(text: string): void {
    this.write(text);
    this.update();
  }
  focus(): void {
    this.element.closest("details")?.setAttribute("open", "");
    this.input.focus();
  }
  /** The behaviour without the key. */
  private get otherwise(): string {
    const { kind, value, otherwise } = this.parameter;
    if (kind === "boolean" && value !== "") return value === "true" ? "yes" : "no";
    return value === "" ? otherwise : shown(this.parameter);
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
    const short = this.absent && this.otherwise.length <= longest ? this.otherwise : "";
    const choice = (labels: Record<string, string>, ...values: string[]) =>
      h("select", { id }, ...values.map((value) => h("option", { value }, labels[value] ?? value)));
    const none = short ? `default: ${short}` : "not set";
    if (kind === "boolean") return choice({ "": none, true: "yes", false: "no" }, "", "true", "false");
    if (kind === "word" && words.length > 0) return choice({ "": none }, ...new Set(["", this.original, ...words]));
    if (this.original.includes("\n")) return h("textarea", { id, rows: Math.min(8, this.original.split("\n").length + 1), spellcheck: "false" });
    const mode = kind === "integer" ? "numeric" : "text";
    return h("input", { type: "text", id, inputmode: mode, placeholder: short, autocomplete: "off", spellcheck: "false", autocapitalize: "off" });
  }

  private write(text: string): void {
    this.input.value = text;
  }

  /**
   * The comment of the scenario, the description of the key, the limits, the units, and a default too long for the
   * input.
   */
  private hint(): string {
    const { comment, doc, units, kind } = this.parameter;
    const allowed = kind === "vector" ? "" : limits(this.parameter);
    const otherwise = this.absent && this.otherwise.length > longest ? `default: ${this.otherwise}` : "";
    return [comment, doc, allowed, units.length > 0 ? `in ${units.join(", ")}` : "", otherwise].filter(Boolean).join(" · ");
  }

  private tellHint(): void {
    const hint = this.hint();
    this.help.hidden = hint === "";
    this.help.title = hint;
    this.help.firstElementChild!.textContent = hint;
  }

  private update(): void {
    const { changed } = this;
    const trouble = this.wrong || this.told;
    this.element.dataset.changed = String(changed);
    this.back.hidden = !changed;
    const short = this.original.length > longest ? `${this.original.slice(0, longest - 2).trimEnd()} …` : this.original;
    const before = this.parameter.kind === "boolean" ? (this.original === "true" ? "yes" : "no") : short || "nothing";
    this.back.textContent = this.absent ? "leave out" : `back to ${before}`;
    this.trouble.textContent = trouble;
    this.input.setAttribute("aria-invalid", String(trouble !== ""));
  }
}
