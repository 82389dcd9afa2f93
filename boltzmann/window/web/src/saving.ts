// Pictures of a pane as files. The window draws them as bzm render does; without it, the canvas of the screen is saved.
import { download } from "./elements";
import type { Pane } from "./pane";
import type { Session } from "./session";

export interface PictureChoice {
  format: "png" | "svg" | "pdf";
  scale: number;
  /** undefined: as the page. */
  dark?: boolean;
}

export const choice: PictureChoice = { format: "png", scale: 2 };

const width = 1200;

export async function savePicture(session: Session, pane: Pane): Promise<void> {
  const name = `${pane.fileName()}.${choice.format}`;
  if (pane.plot || !session.link.connected || session.hello?.recording) {
    const why = pane.plot
      ? "Curves of the table are saved as PNG here"
      : "Without the window only the screen can be saved, as PNG";
    if (choice.format !== "png") session.notices.set("reply", `${why}.`, "warning");
    else pane.picture?.toBlob((png) => png && download(name, png), "image/png");
    return;
  }
  const { clientWidth, clientHeight } = pane.picture?.parentElement ?? pane.element;
  const shape = Math.min(1.6, Math.max(0.5, clientHeight / clientWidth || 0.75));
  const reply = await session.command({
    do: "picture",
    view: pane.viewAsSeen(),
    format: choice.format,
    width,
    height: Math.round(width * shape),
    scale: choice.scale,
    dark: choice.dark ?? session.dark,
  });
  if (reply.error) return;
  const content = reply.file as Uint8Array<ArrayBuffer>;
  download(name, new Blob([content], { type: String(reply.mime) }));
  session.notices.set("reply", `Saved by the browser: ${name}`);
}
