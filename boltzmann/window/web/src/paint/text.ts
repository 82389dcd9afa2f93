// Texts with ^{raised} and _{lowered} parts on a 2D context, in device pixels.

const small = 0.7;

function parts(markup: string): { text: string; level: number }[] {
  const found: { text: string; level: number }[] = [];
  let from = 0;
  for (const match of markup.matchAll(/([\^_])\{([^}]*)\}/g)) {
    found.push(
      { text: markup.slice(from, match.index), level: 0 },
      { text: match[2] ?? "", level: match[1] === "^" ? 1 : -1 },
    );
    from = match.index + match[0].length;
  }
  found.push({ text: markup.slice(from), level: 0 });
  return found.filter((part) => part.text);
}

/** The text for screen readers. */
export function plainText(markup: string): string {
  return parts(markup)
    .map((part) => (part.level > 0 ? " to the " : "") + part.text)
    .join("");
}

export class Pen {
  private readonly widths = new Map<string, number>();

  private family = "sans-serif";

  constructor(readonly context: CanvasRenderingContext2D) {}

  /** The font names of the page's CSS; empty before they are known. */
  use(family: string) {
    if (!family || family === this.family) return;
    this.family = family;
    this.widths.clear();
  }

  private choose(size: number, bold: boolean) {
    this.context.font = `${bold ? "bold " : ""}${size}px ${this.family}`;
  }

  private advance(text: string, bold: boolean): number {
    const key = (bold ? "*" : " ") + text;
    let width = this.widths.get(key);
    if (width === undefined) {
      this.choose(100, bold);
      width = this.context.measureText(text).width / 100;
      if (this.widths.size > 2000) this.widths.clear();
      this.widths.set(key, width);
    }
    return width;
  }

  width(markup: string, size: number, bold = false): number {
    let sum = 0;
    for (const { text, level } of parts(markup)) sum += this.advance(text, bold) * (level ? small : 1);
    return sum * size;
  }

  /** align: 0 begins at x, 0.5 is centred there, 1 ends there. y is the base line. */
  draw(markup: string, x: number, y: number, size: number, align = 0, bold = false, rotated = false) {
    const context = this.context;
    context.save();
    context.translate(x, y);
    if (rotated) context.rotate(-Math.PI / 2);
    let at = align && -align * this.width(markup, size, bold);
    for (const { text, level } of parts(markup)) {
      const font = level ? small * size : size;
      this.choose(font, bold);
      context.fillText(text, at, level > 0 ? -0.38 * size : level < 0 ? 0.16 * size : 0);
      at += this.advance(text, bold) * font;
    }
    context.restore();
  }

  /** Breaks the text into lines of at most this width, as far as its words permit. */
  wrapped(markup: string, size: number, most: number, bold = false): string[] {
    const lines: string[] = [];
    let line = "";
    for (const word of markup.split(" ").filter(Boolean)) {
      const longer = line ? line + " " + word : word;
      if (line && this.width(longer, size, bold) > most) {
        lines.push(line);
        line = word;
      } else {
        line = longer;
      }
    }
    return line ? [...lines, line] : lines;
  }
}
