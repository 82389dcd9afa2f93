// The gallery's first page: a card for each scenario, and a search.
import { h } from "../elements";
import { beginning } from "./description";

/** A scenario in the reply to {"do":"scenarios"}. */
export interface Entry {
  name: string;
  title: string;
  description: string;
  particles: number | null;
  steps: number | null;
  dimension: number | null;
  picture: string | null;
  /** Saved by the user, not shipped. */
  own?: boolean;
}

const counted = (count: number, what: string) => `${count.toLocaleString("en-US")} ${what}${count === 1 ? "" : "s"}`;

/** "2D · 250 particles · 2,000 steps": as far as known. */
export function facts({ dimension, particles, steps }: Entry): string {
  return [
    dimension && `${dimension}D`,
    particles && counted(particles, "particle"),
    steps && counted(steps, "step"),
  ]
    .filter(Boolean)
    .join(" · ");
}

/** A picture of the gallery, with the token that the server requires; an empty square if there is none. */
export function picture(entry: Pick<Entry, "picture">): HTMLElement {
  const frame = h("div", { class: "gallery-picture", "aria-hidden": "true" });
  if (entry.picture) {
    const token = new URLSearchParams(location.search).get("token") ?? "";
    const address = `${entry.picture}?token=${encodeURIComponent(token)}`;
    frame.append(h("img", { alt: "", loading: "lazy", decoding: "async", src: address, error: () => frame.replaceChildren() }));
  }
  return frame;
}

/** Scenarios, whose cards open their pages, or runs, whose cards show them. */
export interface Kind {
  one: string;
  many: string;
  show?: (name: string) => void;
}

function card(entry: Entry, { show }: Kind): HTMLElement {
  return h(
    "li",
    { "data-scenario": entry.name },
    h(
      "a",
      {
        class: "gallery-card",
        href: show ? "#" : `#${encodeURIComponent(entry.name)}`,
        click: (event: Event) => {
          if (!show) return;
          event.preventDefault();
          show(entry.name);
        },
      },
      picture(entry),
      h(
        "div",
        { class: "gallery-words" },
        h("h2", {}, entry.title || entry.name),
        h("p", { class: "gallery-facts" }, h("code", {}, entry.name), entry.own ? h("span", { class: "gallery-own" }, "yours") : null, facts(entry)),
        h("p", { class: "gallery-beginning" }, beginning(entry.description, 190)),
      ),
    ),
  );
}

/** The page; `search`: the previous search text. Reports changes of the search text. */
export function cardsPage(title: string, kind: Kind, entries: Entry[], search: string, searched: (text: string) => void): HTMLElement {
  const items = entries.map((entry) => ({
    item: card(entry, kind),
    words: `${entry.name} ${entry.title} ${entry.description} ${entry.dimension}D`.toLowerCase().replace(/\s+/g, " "),
  }));
  const found = h("p", { class: "gallery-count", role: "status" });
  const none = h("p", { class: "gallery-none", hidden: true });
  const input = h("input", { type: "search", id: "gallery-search", autocomplete: "off", spellcheck: "false", placeholder: "copper, plasma, shock …", value: search });
  const look = () => {
    const wanted = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    for (const { item, words } of items) {
      item.hidden = !wanted.every((word) => words.includes(word));
      if (!item.hidden) ++count;
    }
    found.textContent = wanted.length === 0 ? `${items.length} ${items.length === 1 ? kind.one : kind.many}` : `${count} of ${items.length}`;
    none.hidden = count > 0 || items.length === 0;
    none.textContent = none.hidden ? "" : `No ${kind.one} matches “${input.value.trim()}”.`;
  };
  input.addEventListener("input", () => {
    look();
    searched(input.value);
  });
  look();
  return h(
    "div",
    { class: "gallery-list" },
    h(
      "header",
      {},
      h("h1", { tabindex: -1 }, title),
      h("div", { class: "gallery-find" }, h("label", { for: "gallery-search" }, "Search"), input, found),
    ),
    h("ul", { class: "gallery-cards" }, ...items.map(({ item }) => item)),
    none,
  );
}
