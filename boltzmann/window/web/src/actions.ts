// All actions of the user, defined once. The buttons of the bar, the keys, and the help are generated from this table.
import type { IconName } from "./elements";
import type { Pane } from "./pane";
import { most_panes, type Panes } from "./panes";
import { changeable } from "./panel";
import type { Session, Theme } from "./session";
import { savePicture } from "./saving";

export interface Action {
  id: string;
  /** The label of the button and of the help. */
  words: string;
  help: string;
  /** As in KeyboardEvent.key; the first is shown. */
  keys: string[];
  /** For a button on the bar. */
  icon?: IconName;
  /** Why it is disabled; empty if it is enabled. */
  why?: () => string;
  run: (key?: string) => void;
}

/** Elements in front of the page that can be shown and hidden. */
export interface Parts {
  panel: { toggle(): void; close(): boolean };
  card: { close(): boolean };
  help: { toggle(): void };
  quit: { ask(): void };
}

export interface Actions {
  list: Action[];
  of(id: string): Action;
  run(id: string): void;
}

/** The next element of a cyclic list. */
export function after<T>(all: readonly T[], one: T, way = 1): T {
  return all[(all.indexOf(one) + way + all.length) % all.length];
}

export function makeActions(session: Session, panes: Panes, parts: Parts): Actions {
  const say = (what: string, more = {}) => void session.command({ do: what, ...more });
  const linked = () =>
    session.over ? "the window has closed" : session.link.connected ? "" : "there is no connection to the window";
  const state = () => session.update?.state;
  const ended = () => linked() || (state() === "ended" ? "the simulation has ended" : "");
  const able = () =>
    ended() || (state() === "failed" ? "the physics has failed; see the line below the panes" : "");
  const can = (what: "rewind" | "checkpoint" | "quit") => () => linked() || (session.hello?.can[what] ?? "");
  // A key that is held repeats faster than a window may answer: pending repeats are sent with the next message.
  let owed = 0;
  let stepping = false;
  const frames = async (n: number) => {
    owed += n;
    if (stepping) return;
    stepping = true;
    while (owed !== 0) {
      const steps = owed;
      owed = 0;
      await session.command({ do: "step", steps });
    }
    stepping = false;
  };
  const by = (what: "colour" | "size") => () =>
    changeable(session, panes.active?.drawing).some(({ key }) => key === what)
      ? ""
      : `${panes.active?.diagnosis} has none to choose`;
  const fields = () => ["", ...(session.hello?.quantities.map(({ name }) => name) ?? [])];

  const cycle = (what: "colour" | "size") => () => {
    const next = after(fields(), panes.active.has(what) ?? "");
    panes.active.change({ [what]: next });
    const label = session.hello?.quantities.find(({ name }) => name === next)?.label || next;
    session.notices.set(
      "reply",
      what === "colour" ? `Colour: ${label || "by ensemble"}` : `Size: ${label || "the ensemble's"}`,
    );
  };

  const list: Action[] = [
    {
      id: "toggle",
      words: "Play or stop",
      help: "continue or pause",
      keys: [" "],
      why: ended,
      run: () => say(state() === "playing" || state() === "rewinding" ? "stop" : "play"),
    },
    { id: "play", words: "Play", help: "continue from here", keys: [], icon: "play", why: able, run: () => say("play") },
    {
      id: "step",
      words: "Step",
      help: "one step (in a replay: one frame)",
      keys: ["s", "."],
      icon: "step",
      why: able,
      run: () => void frames(1),
    },
    {
      id: "rewind",
      words: "Rewd",
      help: "run backwards",
      keys: ["r"],
      icon: "rewind",
      why: () => able() || can("rewind")(),
      run: () => say("rewind"),
    },
    { id: "stop", words: "Stop", help: "pause", keys: [], icon: "stop", why: ended, run: () => say("stop") },
    {
      id: "quit",
      words: "Quit",
      help: "end the simulation, after a confirmation",
      keys: ["q"],
      icon: "quit",
      why: can("quit"),
      run: () => parts.quit.ask(),
    },
    {
      id: "popup",
      words: "Popup",
      help: "the panel: diagnoses, steps, colours, saving",
      keys: ["p"],
      icon: "popup",
      run: () => parts.panel.toggle(),
    },

    {
      id: "step-back",
      words: "Step back",
      help: "one step (or frame) backwards",
      keys: [","],
      why: can("rewind"),
      run: () => void frames(-1),
    },
    {
      id: "escape",
      words: "Close or stop",
      help: "close the card, then the panel; then stop",
      keys: ["Escape"],
      run: () => {
        if (!parts.card.close() && !parts.panel.close() && !ended()) say("stop");
      },
    },
    {
      id: "faster",
      words: "More steps",
      help: "twice the steps per frame (replay: frames per second)",
      keys: ["]"],
      why: linked,
      run: () => say("set", { steps_per_frame: Math.max(1, (session.hello?.steps_per_frame ?? 1) * 2) }),
    },
    {
      id: "slower",
      words: "Fewer steps",
      help: "half as many",
      keys: ["["],
      why: linked,
      run: () => say("set", { steps_per_frame: Math.max(1, Math.floor((session.hello?.steps_per_frame ?? 1) / 2)) }),
    },
    {
      id: "diagnosis",
      words: "Next diagnosis",
      help: "next diagnosis in this pane (shift: previous)",
      keys: ["d", "D"],
      run: (key) => {
        const names = session.hello?.diagnoses.map(({ name }) => name) ?? [];
        panes.active.show(after(names, panes.active.diagnosis, key === "D" ? -1 : 1));
      },
    },
    {
      id: "add",
      words: "Add a pane",
      help: "show one more diagnosis, six at most",
      keys: ["a"],
      why: () => (panes.list.length < most_panes ? "" : `at most ${most_panes} panes`),
      run: () => panes.add(),
    },
    {
      id: "remove",
      words: "Close the pane",
      help: "the active one",
      keys: ["x"],
      why: () => (panes.list.length > 1 ? "" : "the last pane can't be closed"),
      run: () => panes.remove(),
    },
    {
      id: "pane",
      words: "Go to a pane",
      help: "by its number",
      keys: ["1", "2", "3", "4", "5", "6", "7", "8", "9"],
      run: (key) => {
        const pane: Pane | undefined = panes.list.find(({ id }) => String(id) === key);
        panes.activate(pane);
        pane?.focus();
      },
    },
    { id: "colour", words: "Colour", help: "by the next field", keys: ["c"], why: by("colour"), run: cycle("colour") },
    { id: "size", words: "Size", help: "by the next field", keys: ["z"], why: by("size"), run: cycle("size") },
    {
      id: "whole",
      words: "Whole view",
      help: "reset zoom and camera",
      keys: ["Home"],
      run: () => panes.active.reset(),
    },
    {
      id: "track",
      words: "Track",
      help: "draw tracks: keep earlier frames",
      keys: ["t"],
      run: () => session.choose({ tracking: !session.tracking }),
    },
    {
      id: "follow",
      words: "Follow",
      help: "keep the selected particle in the middle",
      keys: ["f"],
      why: () => (session.following || session.update?.selected ? "" : "no particle is selected: click one"),
      run: () => session.choose({ following: !session.following }),
    },
    {
      id: "picture",
      words: "Save a picture",
      help: "in the format of the panel: PNG, SVG or PDF",
      keys: ["g"],
      run: () => void savePicture(session, panes.active),
    },
    {
      id: "movie",
      words: "Record a movie",
      help: "record the active pane; again: stop and save",
      keys: ["m"],
      run: () => panes.active.record(),
    },
    {
      id: "checkpoint",
      words: "Save a checkpoint",
      help: "the whole state, in the folder of the run",
      keys: ["k"],
      why: can("checkpoint"),
      run: async () => {
        const reply = await session.command({ do: "checkpoint" });
        if (!reply.error) session.notices.set("reply", `Checkpoint saved: ${String(reply.path)}`);
      },
    },
    {
      id: "theme",
      words: "Theme",
      help: "light, dark, or that of the system",
      keys: ["l"],
      run: () => {
        session.choose({ theme: after<Theme>(["light", "dark", "system"], session.theme) });
        session.notices.set(
          "reply",
          session.theme === "system" ? "Colours of the system" : `Colours: ${session.theme}`,
        );
      },
    },
    { id: "help", words: "Keys", help: "this list", keys: ["?"], run: () => parts.help.toggle() },
  ];

  const of = (id: string) => list.find((action) => action.id === id) as Action;
  const run = (action: Action, key?: string) => {
    const why = action.why?.() ?? "";
    if (why) session.notices.set("reply", `${action.words}: ${why}`, "warning");
    else action.run(key);
  };

  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented || session.hello?.kind === "gallery")
      return;
    const target = event.target as HTMLElement;
    const typing =
      target.closest("input:not([type=checkbox], [type=radio], [type=range]), select, textarea") &&
      event.key !== "Escape";
    const pressing = target.closest("button, summary, a, input:not([type=range])") && event.key === " ";
    const sliding = target.closest("input[type=range]") && event.key === "Home";
    if (typing || pressing || sliding || document.querySelector("dialog[open]") || panes.list.length === 0) return;
    const key = event.key.length === 1 && !event.shiftKey ? event.key.toLowerCase() : event.key;
    const action =
      list.find(({ keys }) => keys.includes(key)) ?? list.find(({ keys }) => keys.includes(key.toLowerCase()));
    if (!action) return;
    event.preventDefault();
    run(action, key);
  });

  return { list, of, run: (id) => run(of(id)) };
}
