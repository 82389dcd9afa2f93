// The page of the window: assembles its parts and shows a simulation, a stored run, or the gallery.
import { makeActions, type Actions } from "./actions";
import { makeBar } from "./bar";
import { Card } from "./card";
import { makeHelp, makeQuit } from "./dialogs";
import { h } from "./elements";
import { showGallery } from "./gallery/index";
import { Notices } from "./notices";
import { Panel } from "./panel";
import { Panes } from "./panes";
import { makeReplay } from "./replay";
import { savePicture } from "./saving";
import { Session } from "./session";
import "./style.css";

const session = new Session(new Notices());
const panes = new Panes(session, (pane) => void savePicture(session, pane));
let actions: Actions;
const panel = new Panel(session, panes, () => actions);
const card = new Card(session);
const help = makeHelp(() => actions.list);
const quit = makeQuit(session);
actions = makeActions(session, panes, { panel, card, help, quit });

const heading = h("h1", { class: "unseen" }, "Boltzmann");
const gallery = h("div", { id: "gallery", hidden: true });
const simulation = h(
  "div",
  { id: "simulation" },
  makeBar(session, actions),
  h("div", { id: "middle" }, h("div", { id: "stage" }, panes.element, card.element), panel.element),
  makeReplay(session),
);
document.body.append(heading, simulation, gallery, session.notices.element, help.dialog, quit.dialog);

let leaveGallery: (() => void) | null = null;
session.on("hello", (hello) => {
  const name = hello.title || hello.name;
  document.title = hello.kind === "gallery" ? (hello.runs ? "Boltzmann: runs" : "Boltzmann: gallery") : `${name} · Boltzmann`;
  heading.textContent = hello.kind === "gallery" ? "Gallery" : name;
  if (hello.kind !== "gallery") {
    leaveGallery?.();
    leaveGallery = null;
  }
  simulation.hidden = hello.kind === "gallery";
  gallery.hidden = hello.kind !== "gallery";
  if (hello.kind !== "gallery" || leaveGallery) return;
  panel.close();
  leaveGallery = showGallery(gallery, (words) => session.link.say(words), hello, () => session.notices.putAway("run")); // how the last run ended
});
