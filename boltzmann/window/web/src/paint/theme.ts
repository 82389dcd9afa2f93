// The colours of a picture on light and on dark paper, as in boltzmann/pictures/figure.cpp.

export type Rgba = readonly [number, number, number, number];

export interface Theme {
  /** 0..1 each. */
  paper: Rgba;
  ink: Rgba;
  quiet: Rgba;
  grid: Rgba;
  /** The colour mixed into the rim of a disc, and its fraction. */
  rim: number;
  rimStrength: number;
  accent: string;
}

export const themes: Record<"light" | "dark", Theme> = {
  light: {
    paper: [1, 1, 1, 1],
    ink: [0.11, 0.12, 0.14, 1],
    quiet: [0.36, 0.38, 0.42, 1],
    grid: [0.9, 0.91, 0.92, 1],
    rim: 0,
    rimStrength: 0.42,
    accent: "#d3145a",
  },
  dark: {
    paper: [0.075, 0.085, 0.105, 1],
    ink: [0.9, 0.91, 0.93, 1],
    quiet: [0.62, 0.65, 0.7, 1],
    grid: [0.17, 0.185, 0.215, 1],
    rim: 1,
    rimStrength: 0.22,
    accent: "#ff5c93",
  },
};

export function css(colour: Rgba, alpha = colour[3]): string {
  const byte = (v: number) => Math.round(v * 255);
  return `rgba(${byte(colour[0])},${byte(colour[1])},${byte(colour[2])},${alpha})`;
}

/** "#rrggbb" or "#rrggbbaa". */
export function parse(text: string): Rgba {
  const byte = (at: number) => (at < text.length ? parseInt(text.slice(at, at + 2), 16) / 255 : 1);
  return [byte(1), byte(3), byte(5), byte(7)];
}

/** #010101 represents the ink of the paper. */
export function shown(colour: Rgba, theme: Theme): Rgba {
  const isInk = colour.slice(0, 3).every((v) => Math.abs(v * 255 - 1) < 0.5);
  return isInk ? [theme.ink[0], theme.ink[1], theme.ink[2], colour[3]] : colour;
}

/** A colour of a u32 array: bytes r, g, b, a. */
export function unpacked(colour: number): Rgba {
  return [(colour & 255) / 255, ((colour >>> 8) & 255) / 255, ((colour >>> 16) & 255) / 255, (colour >>> 24) / 255];
}
