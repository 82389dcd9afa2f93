// Further keys of a table of the scenario: collapsed in one line, and written to the file when they are set.
import { h } from "../elements";
import type { Field } from "./field";
import type { Parameter } from "./parameter";

export class More {
  readonly element: HTMLDetailsElement;
  fields: Field[] = [];
  private readonly list = h("div", { class: "gallery-fields" });
  private readonly count = h("span", {});
  private readonly set = h("span", { class: "gallery-set" });

  /** `within`: the table of its group; "": the group's own. */
  constructor(table: string, within: string) {
    const summary = h("summary", {}, this.count, within ? h("span", {}, ` of ${within}`) : null, this.set);
    this.element = h("details", { class: "gallery-more", "data-table": table }, summary, this.list);
  }

  /**
   * Sets the keys that the table can currently have. Keys that are set stay, and nothing moves, because the user may be
   * typing.
   */
  offer(keys: Parameter[], make: (key: Parameter) => Field): void {
    const offered = new Set(keys.map(({ path }) => path));
    for (const field of this.fields) if (!offered.has(field.parameter.path) && !field.changed) field.element.remove();
    this.fields = this.fields.filter((field) => offered.has(field.parameter.path) || field.changed);
    for (const field of this.fields) {
      const now = keys.find(({ path }) => path === field.parameter.path);
      if (now) field.describe(now);
    }
    const known = new Set(this.fields.map((field) => field.parameter.path));
    const added = keys.filter(({ path }) => !known.has(path)).map(make);
    this.list.append(...added.map((field) => field.element));
    this.fields.push(...added);
    if (added.some((field) => field.changed)) this.element.open = true;
    this.tell();
  }

  /** Updates the number of keys and of those that are set. */
  tell(): void {
    const { length } = this.fields;
    const set = this.fields.filter((field) => field.changed).length;
    this.element.hidden = length === 0;
    this.count.textContent = `${length} more key${length === 1 ? "" : "s"}`;
    this.set.textContent = set > 0 ? `${set} set` : "";
  }
}
