// Creates elements of the page in one expression, and the icons of its buttons.

export type Child = Node | string | null | false;
type Attributes = Record<string, string | number | boolean | ((event: never) => void)>;

/** An element with attributes (functions: listeners, true: present, false: omitted) and children (null: omitted). */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes))
    if (typeof value === "function") element.addEventListener(name, value as EventListener);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false) element.setAttribute(name, String(value));
  element.append(...given(children));
  return element;
}

/** Replaces the children of an element. */
export function fill(element: Element, ...children: Child[]): void {
  element.replaceChildren(...given(children));
}

function given(children: Child[]): (Node | string)[] {
  return children.filter((child): child is Node | string => child !== null && child !== false);
}

// Paths on a grid of 16 x 16; filled, except those that begin with "~", which are stroked.
const paths = {
  play: "M4 2.5v11l9.5-5.5z",
  step: "M3 2.5v11l7-5.5zM11.5 2.5h2v11h-2z",
  back: "M13 2.5v11l-7-5.5zM2.5 2.5h2v11h-2z",
  rewind: "M8 2.5v11l-7-5.5zM15 2.5v11l-7-5.5z",
  stop: "M3 3h10v10h-10z",
  quit: "~M8 1.8v6M4.6 3.7a5.5 5.5 0 1 0 6.8 0",
  popup:
    "~M1.5 4.5h7M12.5 4.5h2M1.5 11.5h2M7.5 11.5h7M10.5 2.5a2 2 0 1 1 0 4a2 2 0 1 1 0-4M5.5 9.5a2 2 0 1 1 0 4a2 2 0 1 1 0-4",
  close: "~M3.5 3.5l9 9M12.5 3.5l-9 9",
  add: "~M8 2.5v11M2.5 8h11",
  whole: "~M2 6v-4h4M10 2h4v4M14 10v4h-4M6 14h-4v-4",
  save: "~M8 2v8M4.5 7l3.5 3.5l3.5-3.5M2.5 13.5h11",
  record: "M8 3.5a4.5 4.5 0 1 1 0 9a4.5 4.5 0 1 1 0-9",
  viewers: "~M1.2 8c3-5.3 10.6-5.3 13.6 0c-3 5.3-10.6 5.3-13.6 0M8 6a2 2 0 1 1 0 4a2 2 0 1 1 0-4",
  help: "~M5.4 5.6c0-3.8 5.4-3.6 5.2-.4c-.1 2-2.6 2-2.6 4.3M8 12.4v.9",
} as const;
export type IconName = keyof typeof paths;

export function icon(name: IconName): SVGSVGElement {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("aria-hidden", "true");
  svg.setAttribute("class", "icon");
  const path = document.createElementNS(space, "path");
  const lines = paths[name].startsWith("~");
  path.setAttribute("d", paths[name].replace("~", ""));
  if (lines) path.setAttribute("class", "lines");
  svg.append(path);
  return svg;
}

/** A button with only an icon; the text is its accessible name and tooltip. */
export function iconButton(name: IconName, words: string, press: () => void, more: Attributes = {}): HTMLButtonElement {
  return h(
    "button",
    { type: "button", class: "small", title: words, "aria-label": words, click: press, ...more },
    icon(name),
  );
}

/** Offers a file for download. */
export function download(name: string, content: Blob): void {
  const address = URL.createObjectURL(content);
  h("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** Permanently in this browser, or until this page is closed. */
type Keeping = "localStorage" | "sessionStorage";

/** A stored choice of the user; nothing if the browser stores nothing. */
export function remembered(key: string, where: Keeping = "localStorage"): string | null {
  try {
    return window[where].getItem(`boltzmann.${key}`);
  } catch {
    return null;
  }
}
export function remember(key: string, value: string, where: Keeping = "localStorage"): void {
  try {
    window[where].setItem(`boltzmann.${key}`, value);
  } catch {
    // If the browser stores nothing, the choice is valid until the page is closed.
  }
}

/** 51234.5 as "51,000": two significant digits, as many as can be read while the number changes. */
export function roughly(value: number): string {
  if (!(value > 0)) return "0";
  const digits = value < 10 ? 1 : 0;
  const unit = 10 ** Math.max(0, Math.floor(Math.log10(value)) - 1);
  return (Math.round(value / unit) * unit).toLocaleString("en-US", { maximumFractionDigits: digits });
}
