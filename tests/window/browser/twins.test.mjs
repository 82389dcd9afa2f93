// Two ways to one picture: what the page paints with WebGL, what the window saves and what `bzm render` writes, of the
// same frame of the same run. The files are the same byte for byte; the page differs from them by the edges of discs
// and letters, and from another frame by much more.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { browser, bzm, data, keep, ownFolder, pictureOf, test, until, watch } from "./window.mjs";

let chromium;
before(async () => (chromium = await browser()));
after(() => chromium.close());

const width = 1200;
const height = 900;

/** A stored run, and a page of its window whose picture has the size of a saved one. */
async function stored(t, scenario, ...words) {
  const cwd = ownFolder(t);
  const command = (...all) => execFileSync(process.env.BZM, all, { cwd, stdio: "pipe" });
  command("run", scenario, "--out", "run", "--quiet", ...words);
  const window = await bzm(t, ["window", "run"], { cwd });
  const page = await watch(t, chromium, window, { width: 1400, height: 1000 });
  const now = await page.evaluate(() => {
    const { width, height } = document.querySelector("[data-view='1'] canvas").getBoundingClientRect();
    return { width, height };
  });
  await page.setViewportSize({ width: Math.round(1400 + width - now.width), height: Math.round(1000 + height - now.height) });
  await until(async () => {
    const box = await page.evaluate(() => document.querySelector("[data-view='1'] canvas").getBoundingClientRect().width);
    return Math.abs(box - width) < 1;
  }, "a pane as wide as a picture");
  const render = (frame, ...more) => {
    command("render", "run", "-o", `${frame}.png`, "--frame", String(frame), ...more);
    return readFileSync(join(cwd, `${frame}.png`));
  };
  return { page, render };
}

async function show(page, frame) {
  await page.evaluate((value) => {
    const slider = document.querySelector("#frame");
    slider.value = String(value);
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    slider.dispatchEvent(new Event("change", { bubbles: true }));
  }, frame);
  await until(() => page.wire.update.frame === frame, `frame ${frame}`);
  await pictureOf(page);
}

/** The picture as the window saves it: its bytes, and where its frame stands. */
const saved = (page, diagnosis) =>
  page.evaluate(
    ({ diagnosis, width, height }) =>
      new Promise((found, failed) => {
        const socket = new WebSocket(`ws://${location.host}/socket${location.search}`);
        socket.binaryType = "arraybuffer";
        socket.onerror = () => failed(new Error("no socket"));
        socket.onopen = () =>
          socket.send(JSON.stringify({ do: "picture", id: 1, view: { diagnosis }, format: "png", width, height, scale: 1, dark: false }));
        socket.onmessage = ({ data }) => {
          if (typeof data === "string") {
            const message = JSON.parse(data);
            if (message.type === "reply") failed(new Error(message.error));
            return;
          }
          const length = new DataView(data).getUint32(0, true);
          const head = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
          const bytes = new Uint8Array(data, 4 + length + head.file.at, head.file.count);
          socket.close();
          const file = new FileReader();
          file.onload = () => found({ box: head.box, bytes: file.result.replace(/^.*,/, "") });
          file.readAsDataURL(new Blob([bytes]));
        };
      }),
    { diagnosis, width, height },
  );

/**
 * How much what the page shows differs from a picture: the mean over 100 x 100 places, of 255. Letters have other sizes on
 * the page, so what is compared is the part of each frame that the coloured marks fill.
 */
const difference = (page, png, box) =>
  page.evaluate(
    async ({ png, box }) => {
      const pane = document.querySelector("[data-view='1']");
      const painted = pane.querySelector("canvas");
      const scale = painted.width / painted.getBoundingClientRect().width;
      const picture = await createImageBitmap(new Blob([Uint8Array.from(atob(png), (c) => c.charCodeAt(0))], { type: "image/png" }));
      const pixels = (source, [left, top, wide, high], across, down) => {
        const drawn = new OffscreenCanvas(across, down).getContext("2d", { willReadFrequently: true });
        drawn.fillStyle = "white";
        drawn.fillRect(0, 0, across, down);
        drawn.imageSmoothingQuality = "high";
        drawn.drawImage(source, left, top, wide, high, 0, 0, across, down);
        return drawn.getImageData(0, 0, across, down).data;
      };
      const coloured = (source, box) => {
        const [left, top, wide, high] = box.map(Math.round);
        const all = pixels(source, [left, top, wide, high], wide, high);
        const ends = [wide, high, 0, 0];
        for (let y = 0; y < high; ++y)
          for (let x = 0; x < wide; ++x) {
            const k = 4 * (y * wide + x);
            if (Math.max(all[k], all[k + 1], all[k + 2]) - Math.min(all[k], all[k + 1], all[k + 2]) < 60) continue;
            ends[0] = Math.min(ends[0], x);
            ends[1] = Math.min(ends[1], y);
            ends[2] = Math.max(ends[2], x);
            ends[3] = Math.max(ends[3], y);
          }
        return [left + ends[0], top + ends[1], ends[2] - ends[0] + 1, ends[3] - ends[1] + 1];
      };
      const own = pane.dataset.box.split(" ").map((v) => Number(v) * scale);
      const a = pixels(painted, coloured(painted, own), 100, 100);
      const b = pixels(picture, coloured(picture, box), 100, 100);
      let sum = 0;
      for (let k = 0; k < a.length; k += 4) sum += Math.max(...[0, 1, 2].map((c) => Math.abs(a[k + c] - b[k + c])));
      return sum / 10_000;
    },
    { png: png.toString("base64"), box },
  );

for (const [scenario, words, frame, other, most] of [
  ["copper", ["--steps", "1200"], 5, 11, 20],
  ["two-stream", [], 40, 60, 4],
  ["molten-salt", ["--steps", "40", "--set", "output.trajectory=10"], 1, 4, 6],
])
  test(`${scenario}: the page, the saved picture and bzm render agree`, async (t) => {
    const { page, render } = await stored(t, scenario, ...words);
    await show(page, frame);
    const { diagnosis } = await data(page, "[data-view='1']");
    const picture = await saved(page, diagnosis);
    const rendered = render(frame);
    assert.ok(rendered.equals(Buffer.from(picture.bytes, "base64")), "the window saves what bzm render writes, byte for byte");
    // The page's letters are smaller, so its frame is larger.
    const mean = await difference(page, rendered, picture.box);
    const wrong = await difference(page, render(other), picture.box);
    t.diagnostic(`differs by ${mean.toFixed(2)} of 255, from another frame by ${wrong.toFixed(2)}`);
    await keep(page, `twins-${scenario}`);
    assert.ok(mean < most, `the page differs by ${mean} of 255`);
    assert.ok(wrong > 5 * mean, `another frame differs by ${wrong}, this one by ${mean}`);
  });
