// The message line: errors and notes, one line per matter, until they are resolved or dismissed.
import { h, iconButton } from "./elements";

export type Matter = "link" | "run" | "missed" | "reply";
export type Kind = "info" | "warning" | "error";

const signs: Record<Kind, string> = { info: "", warning: "Note", error: "Error" };

export class Notices {
  readonly element = h("footer", { id: "notices", role: "status", "aria-live": "polite" });
  private readonly lines = new Map<Matter, { text: string; line: HTMLElement }>();
  /** Dismissed messages: the same text is not shown again until the matter has another one. */
  private readonly away = new Map<Matter, string>();

  set(matter: Matter, text: string, kind: Kind = "info", button?: { words: string; press: () => void }): void {
    if (this.lines.get(matter)?.text === text || this.away.get(matter) === text) return;
    this.remove(matter);
    this.away.delete(matter);
    const line = h(
      "p",
      { class: `notice ${kind}`, "data-matter": matter },
      signs[kind] ? h("strong", {}, signs[kind]) : null,
      h("span", {}, text),
      button ? h("button", { type: "button", class: "link", click: button.press }, button.words) : null,
      iconButton("close", "dismiss", () => this.putAway(matter)),
    );
    this.lines.set(matter, { text, line });
    this.element.append(line);
  }

  /** Dismisses a message. */
  putAway(matter: Matter): void {
    const said = this.lines.get(matter);
    if (!said) return;
    this.away.set(matter, said.text);
    this.remove(matter);
  }

  clear(matter: Matter): void {
    this.away.delete(matter);
    this.remove(matter);
  }

  private remove(matter: Matter): void {
    this.lines.get(matter)?.line.remove();
    this.lines.delete(matter);
  }
}
