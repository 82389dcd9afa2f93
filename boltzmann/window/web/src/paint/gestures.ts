// Mouse, touch and keyboard input of a pane: rotation, translation and zoom.

export interface Steered {
  /** x, y: CSS pixels in the pane; factors above 1 magnify. */
  zoomAt(x: number, y: number, factorX: number, factorY: number): void;
  pan(dx: number, dy: number): void;
  orbit(azimuth: number, elevation: number): void;
  reset(): void;
  click(x: number, y: number): void;
  readonly turns: boolean;
  readonly element: HTMLElement;
}

/** Returns a function that removes the listeners. */
export function steer(pane: Steered): () => void {
  const { element } = pane;
  const ended = new AbortController();
  const on = <K extends keyof HTMLElementEventMap>(type: K, call: (event: HTMLElementEventMap[K]) => void) =>
    element.addEventListener(type, call, { signal: ended.signal, passive: false });
  const place = (event: MouseEvent) => {
    const box = element.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const fingers = new Map<number, { x: number; y: number }>();
  let moved = 0;
  let grab = { x: 0, y: 0 };

  on("wheel", (event) => {
    event.preventDefault();
    const { x, y } = place(event);
    const lines = event.deltaMode === 1 ? 30 : event.deltaMode === 2 ? 400 : 1;
    const way = Math.max(-300, Math.min(300, (event.deltaY || event.deltaX) * lines));
    const factor = Math.exp(-way * (event.ctrlKey ? 0.008 : 0.0016)); // ctrl: two fingers on a touch pad
    pane.zoomAt(x, y, event.altKey ? 1 : factor, event.shiftKey ? 1 : factor);
  });
  on("pointerdown", (event) => {
    if (event.pointerType === "mouse" && event.button === 1) return;
    element.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, (grab = place(event)));
    moved = fingers.size > 1 ? Infinity : 0;
  });
  on("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const now = place(event);
    const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
    // Tolerate small movements during a click.
    if (moved < 4) moved = Math.max(moved, Math.hypot(now.x - grab.x, now.y - grab.y));
    if (moved < 4) return;
    fingers.set(event.pointerId, now);
    const [dx, dy] = [now.x - before.x, now.y - before.y];
    if (other) {
      const length = (p: { x: number; y: number }) => Math.max(Math.hypot(p.x - other.x, p.y - other.y), 10);
      const factor = length(now) / length(before);
      pane.pan(dx / 2, dy / 2);
      pane.zoomAt((now.x + other.x) / 2, (now.y + other.y) / 2, factor, factor);
    } else if (pane.turns && !event.shiftKey && !(event.buttons & 2)) {
      pane.orbit(-dx * 0.4, dy * 0.4);
    } else {
      pane.pan(dx, dy);
    }
  });
  const release = (event: PointerEvent, clicks: boolean) => {
    if (fingers.delete(event.pointerId) && clicks && moved < 4 && event.button === 0) {
      const { x, y } = place(event);
      pane.click(x, y);
    }
    if (!fingers.size) moved = 0;
  };
  on("pointerup", (event) => release(event, true));
  on("pointercancel", (event) => release(event, false));
  on("contextmenu", (event) => event.preventDefault());
  on("dblclick", (event) => {
    event.preventDefault();
    pane.reset();
  });
  on("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    const { clientWidth: width, clientHeight: height } = element;
    if (arrow) {
      const [x = 0, y = 0] = arrow;
      if (pane.turns && !event.shiftKey) pane.orbit(5 * x, 5 * y);
      else pane.pan(-0.08 * x * width, 0.08 * y * height);
    } else if (event.key === "+" || event.key === "=" || event.key === "-") {
      const factor = event.key === "-" ? 1 / 1.25 : 1.25;
      pane.zoomAt(NaN, NaN, factor, factor);
    } else if (event.key === "0" || event.key === "Home") {
      pane.reset();
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  });
  return () => ended.abort();
}
