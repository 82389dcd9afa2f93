// The selected particle: a card with its fields at the current step.
import { h, iconButton } from "./elements";
import type { Update } from "./protocol";
import type { Session } from "./session";

export class Card {
  readonly element = h("section", { id: "card", "aria-label": "selected particle", hidden: true });
  private readonly title = h("h2", {});
  private readonly body = h("tbody");
  private readonly follow = h(
    "button",
    { type: "button", id: "card-follow", click: () => this.session.choose({ following: !this.session.following }) },
    "Follow",
  );
  private names = "";
  private closed = false;

  constructor(private readonly session: Session) {
    const copy = h("button", { type: "button", id: "card-copy", click: () => void this.copy(copy) }, "Copy");
    this.element.append(
      h(
        "header",
        {},
        this.title,
        iconButton("close", "close (Esc)", () => this.close(), { id: "card-close" }),
      ),
      h("div", { class: "scroll" }, h("table", {}, this.body)),
      h("div", { class: "row" }, this.follow, copy),
    );
    session.on("update", ({ selected }) => this.show(selected));
    session.on("choice", () => this.follow.setAttribute("aria-pressed", String(session.following)));
    session.on("hello", () => (this.closed = false));
  }

  /** Returns false if it was not open. */
  close(): boolean {
    if (this.element.hidden) return false;
    this.element.hidden = true;
    this.closed = true;
    if (this.session.following) this.session.choose({ following: false });
    void this.session.command({ do: "select" });
    return true;
  }

  private show(selected: Update["selected"]): void {
    if (!selected) {
      this.element.hidden = true;
      this.closed = false;
      return;
    }
    const name = `${selected.ensemble} ${selected.particle}`;
    if (this.closed && name === this.element.dataset.particle) return; // a pending update
    this.closed = false;
    this.element.hidden = false;
    this.element.dataset.particle = name;
    this.title.textContent = name;
    const names = selected.fields.map((field) => field.name).join();
    if (names !== this.names) {
      this.names = names;
      this.body.replaceChildren(
        ...selected.fields.map(({ name, label }) =>
          h("tr", { "data-field": name }, h("th", { scope: "row" }, label || name), h("td", {})),
        ),
      );
    }
    selected.fields.forEach(({ value }, k) => {
      const cell = this.body.rows[k].cells[1];
      if (cell.textContent !== value) cell.textContent = value;
    });
  }

  private async copy(button: HTMLElement): Promise<void> {
    const selected = this.session.update?.selected;
    if (!selected) return;
    const lines = selected.fields.map(({ label, name, value }) => `${label || name}\t${value}`);
    const text = [`${selected.ensemble}\t${selected.particle}`, `step\t${this.session.update?.step}`, ...lines].join(
      "\n",
    );
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = "Copied";
    } catch {
      button.textContent = "Can't copy";
    }
    setTimeout(() => (button.textContent = "Copy"), 1500);
  }
}
