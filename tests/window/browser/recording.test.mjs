// A stored run as one HTML file: it plays from a file and in a frame that may do nothing but run its script, and asks nobody.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { pathToFileURL } from "node:url";
import { browser, data, keep, open, ownFolder, painted, share, test, until } from "./window.mjs";

let chromium;
before(async () => (chromium = await browser()));
after(() => chromium.close());

const steps = 200;
const every = 20; // steps between stored frames
const frames = steps / every + 1;

/** The file that bzm makes of a run of copper. */
function recorded(t, ...more) {
  const cwd = ownFolder(t);
  const bzm = (...words) => execFileSync(process.env.BZM, words, { cwd, encoding: "utf8" });
  bzm("run", "copper", "--out", "run", "--steps", String(steps), "--set", `output.trajectory=${every}`, "--quiet");
  bzm("window", "run", "-o", "run.html", ...more);
  return join(cwd, "run.html");
}

/** A page, or a frame in it, that has its first picture. */
async function ready(place) {
  await until(async () => (await place.locator("[data-view='1'][data-frames]").count()) > 0, "a painted picture");
  return place;
}

async function opened(t, options = {}, ...more) {
  const page = await open(t, chromium, String(pathToFileURL(recorded(t, ...more))), options);
  page.on("websocket", (socket) => assert.fail(`a socket to ${socket.url()}`));
  return ready(page);
}

/** The same in a frame without an origin, as a notebook shows it. */
async function framed(t) {
  const file = recorded(t);
  const quoted = readFileSync(file, "utf8").replaceAll("&", "&amp;").replaceAll('"', "&quot;");
  const notebook = file.replace("run.html", "notebook.html");
  writeFileSync(notebook, `<!doctype html><iframe sandbox="allow-scripts" width="900" height="600" srcdoc="${quoted}"></iframe>`);
  const page = await open(t, chromium, String(pathToFileURL(notebook)));
  page.on("websocket", (socket) => assert.fail(`a socket to ${socket.url()}`));
  const frame = await until(() => page.frames().find((each) => each !== page.mainFrame()), "the frame");
  return { page, frame: await ready(frame) };
}

const atFrame = (place, frame) =>
  until(
    async () => (await data(place, "body")).frame === String(frame) && (await data(place, "[data-view='1']")).step === String(frame * every),
    async () => `the picture of frame ${frame}; it is ${JSON.stringify(await data(place, "body"))}`,
  );
const picture = (place) => place.locator("[data-view='1'] canvas").first().evaluate((canvas) => canvas.toDataURL());

/** Steps and plays, and the picture is another each time. */
async function goesOn(place) {
  await painted(place, 1);
  assert.equal((await data(place, "body")).frame, "0");
  const start = await picture(place);
  await place.click("#step");
  await atFrame(place, 1);
  await painted(place, 1);
  const second = await picture(place);
  assert.notEqual(second, start);
  await place.click("#play");
  await atFrame(place, frames - 1);
  assert.equal((await data(place, "body")).state, "done");
  await painted(place, 1);
  assert.ok(![start, second].includes(await picture(place)));
  await place.click("#rewind");
  await atFrame(place, 0);
  assert.equal(await picture(place), start);
}

test("a file plays, steps and goes back, and fetches nothing", async (t) => {
  const page = await opened(t);
  await goesOn(page);
  await keep(page, "recording");
  await page.locator("#frame").focus();
  await page.keyboard.press("End");
  await atFrame(page, frames - 1);
  assert.match(await page.textContent("#frame-place"), new RegExp(`frame ${frames} of ${frames}`));
  await page.selectOption("#replay-speed", "5");
  await page.keyboard.press("Home");
  await atFrame(page, 0);
  const pressed = Date.now();
  await page.click("#play");
  await atFrame(page, frames - 1);
  assert.ok(Date.now() - pressed > 180 * (frames - 1), `${frames - 1} frames at 5 a second`);
  await page.selectOption("#replay-speed", "1"); // slow, so that a busy machine presses before the end
  await page.click("#play");
  await until(async () => (await data(page, "body")).state === "playing", "it plays");
  await page.keyboard.press(" ");
  await until(async () => (await data(page, "body")).state === "paused", "it stands");
});

test("it plays in a frame that may only run scripts, without storage", async (t) => {
  const { page, frame } = await framed(t);
  assert.equal(await frame.evaluate(() => { try { return localStorage.length; } catch { return "none"; } }), "none"); // prettier-ignore
  await goesOn(frame);
  await frame.locator("#panes canvas").first().focus();
  await page.keyboard.press("l"); // a choice that is kept elsewhere
  await page.keyboard.press("l");
  await until(() => frame.evaluate(() => document.documentElement.dataset.theme === "dark"), "a dark page");
  await painted(frame, 1);
  await keep(page, "recording-frame");
});

test("it shows the views that it was given, and the table", async (t) => {
  const page = await opened(t, {}, "--view", "Phase space", "--view", "Histogram");
  assert.deepEqual(await page.locator("#pane-1-chooser option").allTextContents(), ["Phase space", "Histogram", "Energies", "Measured"]);
  for (const name of ["Histogram", "Measured", "Phase space"]) {
    await page.selectOption("#pane-1-chooser", name);
    await until(async () => (await data(page, "[data-view='1']")).diagnosis === name && (await share(page, 1)) > 5e-4, `a picture of ${name}`);
    assert.equal(await page.locator(".fault:visible").count(), 0, name);
  }
  // Two beside each other go together.
  await page.locator("[data-view='1'] canvas").first().focus();
  await page.keyboard.press("a");
  await until(async () => (await data(page, "[data-view='2']")).frames !== undefined, "a second pane");
  await page.click("#step");
  for (const view of [1, 2]) await until(async () => (await data(page, `[data-view='${view}']`)).step === String(every), `pane ${view} goes on`);
  assert.equal((await data(page, "[data-view='2']")).diagnosis, "Histogram");
});

test("what can't be done of a recording is not offered, or says so", async (t) => {
  const page = await opened(t);
  await painted(page, 1);
  for (const hidden of ["#quit", "#viewers"]) assert.equal(await page.isVisible(hidden), false, hidden);
  await page.click("#popup");
  for (const absent of ["#view-colour", "#step-size", "#checkpoint", "#most", "#save-format"])
    assert.equal(await page.locator(absent).count(), 0, absent);
  await page.click("#done");
  await page.locator("[data-view='1'] canvas").first().focus();
  for (const [key, words] of [["k", /this is a recording/], ["q", /this is a recording/], ["c", /has none to choose/]]) {
    await page.keyboard.press(key);
    assert.match(await page.textContent("[data-matter='reply']"), words);
  }
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("g")]);
  assert.equal(readFileSync(await download.path()).subarray(1, 4).toString(), "PNG");
});

test("a click tells where a particle is, and FOLLOW keeps it in the middle", async (t) => {
  const page = await opened(t);
  await painted(page, 1);
  // The knock-on, atom 60, is yellow; what is beside the last axis is its colour bar.
  const place = await page.evaluate(() => {
    const picture = document.querySelector("[data-view='1'] canvas");
    const copy = document.createElement("canvas");
    Object.assign(copy, { width: picture.width, height: picture.height });
    const context = copy.getContext("2d");
    context.drawImage(picture, 0, 0);
    const width = Math.floor(picture.width * 0.68);
    const { data } = context.getImageData(0, 0, width, picture.height);
    const found = [];
    for (let k = 0; k < data.length; k += 4)
      if (data[k] > 230 && data[k + 1] > 200 && data[k + 2] < 90) found.push([(k / 4) % width, Math.floor(k / 4 / width)]);
    const box = picture.getBoundingClientRect();
    const middle = (axis) => found.reduce((sum, each) => sum + each[axis], 0) / found.length;
    return { x: box.left + (middle(0) * box.width) / picture.width, y: box.top + (middle(1) * box.height) / picture.height };
  });
  await page.mouse.click(place.x, place.y);
  await page.waitForSelector("#card:not([hidden])");
  assert.equal(await page.textContent("#card h2"), "atoms 60");
  const told = () =>
    page.locator("#card tr").evaluateAll((rows) => Object.fromEntries(rows.map(({ cells }) => [cells[0].textContent, cells[1].textContent])));
  const start = await told();
  assert.equal(start.speed, "≥ 100.00 angstrom/ps"); // 332, but the scenario ends its colours there
  await page.click("#step");
  await atFrame(page, 1);
  // 20 steps of 0.01 t0 at 0.4 l0/t0, l0 = 1.804 angstrom, less what the lattice has slowed it.
  const moved = parseFloat((await told()).x) - parseFloat(start.x);
  assert.ok(moved > 0.06 * 1.804 && moved < 0.081 * 1.804, `${moved} angstrom`);
  await page.click("#card-follow");
  await page.click("#step");
  await atFrame(page, 2);
  await page.keyboard.press("Escape");
  await page.waitForSelector("#card", { state: "hidden" });
});

test("a file that was cut off says so", async (t) => {
  const file = recorded(t);
  const text = readFileSync(file, "utf8");
  writeFileSync(file, text.slice(0, text.length - 5000));
  const page = await open(t, chromium, String(pathToFileURL(file)));
  await page.waitForSelector("[data-matter='reply'].error");
  assert.match(await page.textContent("[data-matter='reply']"), /damaged/);
});

test("a recording in the dark, and at the width of a phone", async (t) => {
  const dark = await opened(t, { dark: true });
  await painted(dark, 1);
  await keep(dark, "recording-dark");
  const page = await opened(t, { width: 360, height: 740 }, "--frames", "6");
  assert.ok((await page.evaluate(() => document.scrollingElement.scrollWidth)) <= 360, "too wide");
  assert.ok(await page.isVisible("#frame"));
  assert.match(await page.textContent("[data-matter='run']"), new RegExp(`A recording with 6 of ${frames} frames`));
  await painted(page, 1);
  await keep(page, "recording-phone");
});
