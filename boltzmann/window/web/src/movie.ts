// A movie of a pane's canvas, recorded by the browser and saved as .webm.
import { download } from "./elements";

const kinds = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];

export class Movie {
  private recorder: MediaRecorder | null = null;

  constructor(private readonly changed: () => void) {}

  get running(): boolean {
    return this.recorder !== null;
  }

  /** Starts recording; reports why it can't. */
  start(canvas: HTMLCanvasElement | null, name: string): string | null {
    if (!canvas) return "There is nothing to record in this pane yet.";
    const kind = "MediaRecorder" in window ? kinds.find((each) => MediaRecorder.isTypeSupported(each)) : undefined;
    if (!kind || !("captureStream" in canvas))
      return "This browser can't record movies (no MediaRecorder for webm); bzm render makes them from the stored run.";
    const parts: Blob[] = [];
    const recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: kind, videoBitsPerSecond: 8e6 });
    recorder.ondataavailable = ({ data }) => parts.push(data);
    recorder.onstop = () => download(name, new Blob(parts, { type: "video/webm" }));
    recorder.start(1000);
    this.recorder = recorder;
    this.changed();
    return null;
  }

  stop(): void {
    if (!this.recorder) return;
    this.recorder.stop();
    this.recorder = null;
    this.changed();
  }
}
