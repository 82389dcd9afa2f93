// The gallery: every shipped scenario as a card, and the page of the selected one. Its name is part of the address, so
// that the browser's "back" works.
import { h } from "../elements";
import type { Hello } from "../protocol";
import { cardsPage, type Entry, type Kind } from "./cards";
import "./gallery.css";
import { ScenarioPage, type Edits, type Say, type Scenario } from "./scenario";

// State that is kept during a run, which replaces the gallery until it quits: input and search text.
const memory = { search: "", edits: new Map<string, Edits>() };

function chosen(): string {
  try {
    return decodeURIComponent(location.hash.slice(1));
  } catch {
    return "";
  }
}

/** Shows the gallery in `host`; the returned function removes it. Reports when another page of it is opened. */
export function showGallery(host: HTMLElement, say: Say, hello: Hello, turnedPage: () => void): () => void {
  const root = h("div", { class: "gallery", "data-page": "" });
  let entries: Entry[] | null = null;
  let page: ScenarioPage | null = null;
  let before = "";
  let turn = 0;
  let gone = false;

  function put(kind: string, ...content: HTMLElement[]): void {
    root.dataset.page = kind;
    root.replaceChildren(...content);
  }
  function failed(error: string): void {
    const again = h("button", { type: "button", click: () => void show() }, "Try again");
    put("failed", h("p", { class: "gallery-trouble", role: "alert" }, error), again);
    if (!hello.runs) root.append(h("a", { class: "gallery-back", href: "#" }, "‹ All scenarios"));
  }

  const scenarios: Kind = { one: "scenario", many: "scenarios" };
  const runs: Kind = {
    one: "run",
    many: "runs",
    show: async (name) => {
      const reply = await say({ do: "run", name });
      if (reply.error && !gone) failed(reply.error);
    },
  };

  async function show(): Promise<void> {
    const mine = ++turn;
    const late = () => gone || mine !== turn;
    const name = chosen();
    page?.leave();
    page = null;
    if (!entries) {
      if (!root.firstChild) put("waiting", h("p", { class: "gallery-waiting", role: "status" }, hello.runs ? "The runs are being read …" : "The scenarios are being read …"));
      const reply = await say({ do: "scenarios" });
      if (late()) return;
      if (reply.error) return failed(reply.error);
      entries = reply.scenarios as Entry[];
    }
    if (name === "") {
      put("list", cardsPage(hello.title || "Scenarios", hello.runs ? runs : scenarios, entries, memory.search, (text) => (memory.search = text)));
      // The card that had the focus before a scenario was opened.
      const card = before && root.querySelector<HTMLElement>(`[data-scenario="${CSS.escape(before)}"] a`);
      if (card) {
        card.scrollIntoView({ block: "center" });
        card.focus({ preventScroll: true });
      }
      before = "";
      return;
    }
    const reply = await say({ do: "scenario", name });
    if (late()) return;
    if (reply.error) return failed(reply.error);
    before = name;
    const edits = memory.edits.get(name) ?? new Map<string, string>();
    memory.edits.set(name, edits);
    const entry = entries.find((one) => one.name === name);
    page = new ScenarioPage(reply as unknown as Scenario, entry, say, edits, () => (entries = null));
    put("scenario", page.element);
    root.scrollIntoView({ block: "start" });
    root.querySelector("h1")?.focus({ preventScroll: true });
  }

  const turned = () => {
    turnedPage();
    void show();
  };
  addEventListener("hashchange", turned);
  host.append(root);
  void show();
  return () => {
    gone = true;
    page?.leave();
    removeEventListener("hashchange", turned);
    root.remove();
  };
}
