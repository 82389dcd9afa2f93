// The text of a scenario as paragraphs; indented lines are preformatted.
import { h } from "../elements";

/** Paragraphs are separated by empty lines. A paragraph of indented lines is preformatted. */
export function paragraphs(text: string): HTMLElement[] {
  const made: HTMLElement[] = [];
  let lines: string[] = [];
  let indented = false;
  const end = () => {
    while (lines.length > 0 && lines[lines.length - 1] === "") lines.pop();
    if (lines.length > 0 && indented) {
      const margin = Math.min(...lines.filter((line) => line !== "").map((line) => line.search(/\S/)));
      made.push(h("pre", {}, lines.map((line) => line.slice(margin)).join("\n")));
    } else if (lines.length > 0) {
      made.push(h("p", {}, lines.join(" ")));
    }
    lines = [];
  };
  for (const line of text.replace(/\t/g, "    ").split("\n").map((one) => one.trimEnd())) {
    const inner = line.startsWith("  ");
    if (line === "" && !indented) end();
    else if (line !== "" && inner !== indented && lines.length > 0) end();
    if (lines.length === 0) indented = inner;
    if (line !== "" || lines.length > 0) lines.push(indented ? line : line.trim());
  }
  end();
  return made;
}

/** The first sentences, up to this number of characters; a longer first sentence is cut between words. */
export function beginning(text: string, most: number): string {
  const first = text.split(/\n\s*\n/)[0].replace(/\s+/g, " ").trim();
  const sentences = first.split(/(?<=[.!?])\s+(?=[A-Z(])/);
  let kept = sentences.shift() ?? "";
  for (const sentence of sentences) {
    if (kept.length + 1 + sentence.length > most) break;
    kept += ` ${sentence}`;
  }
  if (kept.length <= most) return kept;
  return `${kept.slice(0, kept.lastIndexOf(" ", most)).replace(/[,;:]$/, "")} …`;
}
