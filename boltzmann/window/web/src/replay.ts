// A stored run: the slider for its frames.
import { h } from "./elements";
import type { Session } from "./session";

export function makeReplay(session: Session): HTMLElement {
  const place = h("output", { id: "frame-place", for: "frame" });
  let going = false;
  let wanted: number | null = null;
  let held = 0;

  // One request at a time: of the intermediate positions only the last is requested.
  const seek = async (): Promise<void> => {
    if (going) return;
    going = true;
    while (wanted !== null) {
      const frame = wanted;
      wanted = null;
      await session.command({ do: "seek", frame });
    }
    going = false;
  };
  const slider = h("input", {
    type: "range",
    id: "frame",
    min: 0,
    max: 0,
    step: 1,
    value: 0,
    "aria-label": "frame",
    input: () => {
      wanted = Number(slider.value);
      held = performance.now();
      void seek();
    },
  });
  const speed = h(
    "select",
    {
      id: "replay-speed",
      "aria-label": "play speed",
      change: () => void session.command({ do: "set", steps_per_frame: Number(speed.value) }),
    },
    ...[1, 2, 5, 10, 15, 20, 30, 60].map((value) => h("option", { value }, `${value} frames/s`)),
  );
  const bar = h("div", { id: "replay", role: "group", "aria-label": "replay", hidden: true }, slider, place, speed);

  const paced = () => {
    const pace = String(session.hello?.steps_per_frame);
    if (speed.value === pace) return;
    if (![...speed.options].some(({ value }) => value === pace))
      speed.append(h("option", { value: pace }, `${pace} frames/s`));
    speed.value = pace;
  };
  session.on("hello", (hello) => {
    bar.hidden = hello.kind !== "replay" || hello.can.seek !== "";
    paced();
  });
  session.on("choice", paced);
  session.on("update", ({ frame, frames, time }) => {
    if (frame === undefined || frames === undefined) return;
    slider.max = String(Math.max(0, frames - 1));
    if (performance.now() - held > 400) slider.value = String(frame);
    slider.setAttribute("aria-valuetext", `frame ${frame + 1} of ${frames}, ${time}`);
    place.textContent = `frame ${frame + 1} of ${frames}`;
  });
  return bar;
}
