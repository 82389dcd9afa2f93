// The bar of buttons, as in 1990: PLAY STEP REWD STOP QUIT POPUP, and at the right the current step.
import type { Action, Actions } from "./actions";
import { h, icon, iconButton, roughly } from "./elements";
import type { Session } from "./session";

const states = {
  paused: "paused",
  playing: "playing",
  rewinding: "rewinding",
  done: "done",
  failed: "failed",
  ended: "ended",
} as const;

export function makeBar(session: Session, actions: Actions): HTMLElement {
  const buttons = actions.list
    .filter((action) => action.icon)
    .map((action) => [action, button(action, actions)] as const);
  const name = h("span", { id: "name" });
  const state = h("span", { id: "state", class: "state" }, "connecting");
  const status = h("span", { id: "status" });
  const viewers = h("span", { id: "viewers", title: "browsers that watch" });
  const spoken = h("p", { class: "unseen", "aria-live": "polite" });
  const progress = h("div", { id: "progress", role: "presentation" });

  const refresh = () => {
    const now = session.update?.state;
    for (const [action, element] of buttons) {
      const why = action.why?.() ?? "";
      const key = action.keys[0] ? ` (${action.keys[0].toUpperCase()})` : "";
      element.setAttribute("aria-disabled", String(why !== ""));
      element.title = why ? `${action.words}: ${why}` : `${action.words}: ${action.help}${key}`;
      if (action.id === "play") element.setAttribute("aria-pressed", String(now === "playing"));
      if (action.id === "rewind") element.setAttribute("aria-pressed", String(now === "rewinding"));
    }
    const word = !session.link.connected ? "away" : now ? states[now] : "connecting";
    if (state.textContent !== word) {
      state.textContent = word;
      state.dataset.state = word;
      spoken.textContent = session.update ? `${word}, step ${session.update.step}` : word;
      document.body.dataset.state = now ?? "";
    }
    document.body.dataset.state = now ?? "";
    document.body.dataset.connected = session.over ? "gone" : session.link.connected ? "yes" : "no";
  };
  session.on("link", refresh);
  session.on("hello", (hello) => {
    document.body.dataset.kind = hello.kind;
    document.body.toggleAttribute("data-recording", hello.recording === true);
    name.textContent = name.title = hello.title || hello.name;
    refresh();
  });
  session.on("update", (update) => {
    const { step, planned, time, frame, frames, steps_per_second: speed } = update;
    const count =
      planned > 0
        ? `step ${step.toLocaleString("en-US")} of ${planned.toLocaleString("en-US")}`
        : `step ${step.toLocaleString("en-US")}`;
    const clock = session.hello?.time_unit || !time ? time : `time ${time}`;
    const parts = [count, clock, speed > 0 ? `${roughly(speed)} steps/s` : ""].filter(Boolean);
    status.replaceChildren(...parts.map((part) => h("span", {}, part)));
    viewers.replaceChildren(
      icon("viewers"),
      String(update.viewers),
      h("span", { class: "unseen" }, update.viewers === 1 ? "viewer" : "viewers"),
    );
    document.body.dataset.step = String(step);
    document.body.dataset.frame = String(frame ?? "");
    const part = frames ? (frame ?? 0) / Math.max(1, frames - 1) : planned > 0 ? step / planned : 0;
    progress.style.transform = `scaleX(${Math.min(1, Math.max(0, part))})`;
    refresh();
  });

  return h(
    "header",
    { id: "bar" },
    h(
      "div",
      { class: "buttons", role: "toolbar", "aria-label": "simulation" },
      ...buttons.map(([, element]) => element),
    ),
    h(
      "div",
      { class: "facts" },
      name,
      state,
      status,
      viewers,
      iconButton("help", "keys (?)", () => actions.run("help"), { id: "help" }),
    ),
    spoken,
    progress,
  );
}

function button(action: Action, actions: Actions): HTMLButtonElement {
  const element = h(
    "button",
    {
      type: "button",
      id: action.id,
      click: (event: MouseEvent) => {
        // So that the space bar plays and stops, instead of pressing this button again.
        if (event.detail > 0) element.blur();
        actions.run(action.id);
      },
    },
    icon(action.icon ?? "play"),
    h("span", {}, action.words),
  );
  return element;
}
