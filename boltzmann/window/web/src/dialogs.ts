// Dialogs in front of the page: the confirmation of QUIT and the list of keys.
import type { Action } from "./actions";
import { h, icon } from "./elements";
import type { Session } from "./session";

/** The confirmation before a simulation is ended. */
export function makeQuit(session: Session) {
  const watching = h("p", {});
  const dialog = h(
    "dialog",
    { id: "quit-dialog", "aria-labelledby": "quit-title" },
    h("h2", { id: "quit-title" }, "Quit the simulation?"),
    watching,
    h(
      "div",
      { class: "row end" },
      h("button", { type: "button", id: "quit-no", click: () => dialog.close() }, "Stay"),
      h(
        "button",
        {
          type: "button",
          id: "quit-yes",
          class: "primary",
          click: () => {
            dialog.close();
            void session.command({ do: "quit" });
          },
        },
        "Quit",
      ),
    ),
  );
  return {
    dialog,
    ask() {
      const others = (session.update?.viewers ?? 1) - 1;
      watching.textContent =
        session.hello?.kind === "replay"
          ? "The replay ends; the stored run stays as it is."
          : `It ends after this step${others > 0 ? `, also for ${others === 1 ? "one other viewer" : `${others} other viewers`}` : ""}; what it has stored stays.`;
      dialog.showModal();
    },
  };
}

const names: Record<string, string> = { " ": "Space", Escape: "Esc" };

/** The list of all keys. */
export function makeHelp(actions: () => Action[]) {
  const list = h("dl", { class: "keys" });
  const dialog = h(
    "dialog",
    { id: "help-dialog", "aria-labelledby": "help-title" },
    h(
      "header",
      {},
      h("h2", { id: "help-title" }, "Keys"),
      h(
        "button",
        {
          type: "button",
          id: "help-close",
          class: "small",
          title: "close (Esc)",
          "aria-label": "close",
          click: () => dialog.close(),
        },
        icon("close"),
      ),
    ),
    list,
    h(
      "p",
      { class: "quiet" },
      "With a pane in focus: arrows move or turn, + and − zoom, 0 shows all. With the mouse: drag, wheel, click a particle; in a curve, drag over a part to zoom and click twice to see all.",
    ),
  );
  dialog.addEventListener("keydown", (event) => {
    if (event.key !== "?") return;
    event.preventDefault();
    event.stopPropagation();
    dialog.close();
  });
  return {
    dialog,
    toggle() {
      const shown = (keys: string[]) =>
        keys[0] === "1" ? ["1 … 9"] : keys.filter((key) => key === key.toLowerCase() || key.length > 1);
      list.replaceChildren(
        ...actions()
          .filter(({ keys }) => keys.length > 0)
          .map(({ keys, words, help }) =>
            h(
              "div",
              {},
              h(
                "dt",
                {},
                ...shown(keys).map((key) => h("kbd", {}, names[key] ?? (key.length === 1 ? key.toUpperCase() : key))),
              ),
              h("dd", {}, h("strong", {}, words), " ", h("span", { class: "quiet" }, help)),
            ),
          ),
      );
      dialog.showModal();
    },
  };
}
