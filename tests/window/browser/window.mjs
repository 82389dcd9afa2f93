// What the browser tests share: bzm with a window, a browser, a page whose every complaint is a failure.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { test as nodeTest } from "node:test";

/** Where run.sh has installed the modules, and where screenshots go. */
export const folder = process.env.WINDOW_FOLDER ?? ".";
const { chromium } = createRequire(join(folder, "package.json"))("playwright-core");

/** Seconds that anything may take, on a machine that does much else. */
const patience = 120;

/** Waits until `condition` gives something true, and returns it. */
export async function until(condition, what) {
  const end = Date.now() + patience * 1000;
  for (;;) {
    const found = await condition();
    if (found) return found;
    if (Date.now() > end) assert.fail(`after ${patience} s still not: ${typeof what === "function" ? await what() : what}`);
    await new Promise((resolve) => setTimeout(resolve, 30));
  }
}

const rests = new WeakMap();

/** A test, and after it what its parts have left to do, the last thing first: a page is left before what it shows is ended. */
export function test(name, body) {
  return nodeTest(name, async (t) => {
    rests.set(t, []);
    const failures = [];
    const attempt = async (what, ...words) => {
      try {
        await what(...words);
      } catch (failure) {
        failures.push(failure);
      }
    };
    await attempt(body, t);
    for (const rest of rests.get(t).reverse()) await attempt(rest, failures.length > 0);
    if (failures.length > 0) throw failures[0];
  });
}

/** What is to be done when a test is over; it is told whether the test has failed. */
export function atEnd(t, rest) {
  rests.get(t).push(rest);
}

/** A folder of a test's own, taken away after it: `t` is the context that node:test gives it. */
export function ownFolder(t) {
  const made = mkdtempSync(join(tmpdir(), "boltzmann-window-"));
  atEnd(t, () => rmSync(made, { recursive: true, force: true, maxRetries: 3 }));
  return made;
}

/** Starts bzm and waits for the address of its window. It is ended with the test, if it still runs then. */
export async function bzm(t, words, { cwd = ownFolder(t) } = {}) {
  assert.ok(process.env.BZM, "BZM is the path of the command");
  const child = spawn(process.env.BZM, words, { cwd, stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, NO_COLOR: "1" } });
  let output = "";
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (text) => (output += text));
  const run = {
    child,
    cwd,
    address: "",
    output: () => output,
    /** The exit status, or the signal, once it has ended. */
    ended: new Promise((resolve) => child.on("close", (status, signal) => resolve(status ?? signal))),
    running: () => child.exitCode === null && child.signalCode === null,
  };
  atEnd(t, async () => {
    if (run.running()) child.kill("SIGKILL"); // nothing that it would still write is read
    await run.ended;
  });
  run.address = await until(
    () => {
      const place = /its address is in (\S+)\n/.exec(output);
      const address = place && /^http:\/\/127\.0\.0\.1:\d+\/\?token=[\w-]+/.exec(readFileSync(place[1], "utf8"));
      if (!address && !run.running()) assert.fail(`bzm ${words.join(" ")} ended with ${child.exitCode}:\n${output}`);
      return address?.[0];
    },
    () => `an address in what bzm ${words.join(" ")} prints:\n${output}`,
  );
  return run;
}

// SwiftShader draws WebGL2 where there is no graphics card; the rest of a page is drawn without it, which takes a fifth of
// the time. The others: nothing of Chromium speaks to anybody.
const flags = [
  "--enable-unsafe-swiftshader",
  "--use-gl=angle",
  "--use-angle=swiftshader",
  "--disable-gpu-compositing",
  "--disable-gpu-sandbox",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];

/** A browser for all tests of a file: close() it after them. `more`: flags of Chromium's. */
export function browser(...more) {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    chromiumSandbox: false, // root and containers have none; it shows nothing but our own pages
    args: [...flags, ...more],
  });
}

// Pages that tests have left: another test goes on with them, as a new one takes as long as most tests.
const left = new WeakMap();

async function blankPage(chromium) {
  if (!left.has(chromium)) left.set(chromium, []);
  const page = left.get(chromium).pop();
  if (page) return page;
  const context = await chromium.newContext({ reducedMotion: "reduce", acceptDownloads: true });
  return context.newPage();
}

/** Nothing of what a test has done with a page is left: the storage of its window is cleared, and its port is another's next time. */
async function leave(page, chromium) {
  for (const event of ["console", "pageerror", "request", "websocket"]) page.removeAllListeners(event);
  await page.evaluate(() => [localStorage, sessionStorage].forEach((storage) => storage.clear()));
  await page.goto("about:blank");
  await page.mouse.move(0, 0);
  left.get(chromium).push(page);
}

/** Opens an address. What the page complains of is kept, and fails the test at its end. */
export async function open(t, chromium, address, { width = 960, height = 640, dark = false } = {}) {
  const page = await blankPage(chromium);
  await page.setViewportSize({ width, height });
  await page.emulateMedia({ colorScheme: dark ? "dark" : "light" });
  page.setDefaultTimeout(patience * 1000);
  const complaints = [];
  page.on("console", (message) => {
    if (message.type() === "error") complaints.push(`console: ${message.text()} (${message.location().url})`);
  });
  page.on("pageerror", (error) => complaints.push(`exception: ${error.stack ?? error}`));
  const { origin, protocol } = new URL(address);
  const own = protocol === "file:" ? address : origin;
  page.on("request", (request) => {
    const url = request.url();
    if (![own, "blob:", "data:"].some((start) => url.startsWith(start))) complaints.push(`fetched ${url}`);
  });
  page.wire = listen(page);
  atEnd(t, async (failed) => {
    for (const complaint of complaints) t.diagnostic(complaint);
    failed ||= complaints.length > 0;
    if (failed && !page.isClosed()) await keep(page, `failed/${t.name.replace(/\W+/g, "-").slice(0, 60)}`);
    if (failed || page.isClosed()) await page.context().close();
    else await leave(page, chromium);
    assert.deepEqual(complaints, []);
  });
  await page.goto(address);
  return page;
}

/**
 * What a page and its window say to each other, as it goes over the wire: the page's own reading of it is left out.
 * said: the page's messages; hello, update: the last ones; views: the last canvas of each view, with `numbers(stored)`
 * for its arrays; replies: by id.
 */
function listen(page) {
  const wire = { said: [], hello: null, update: null, replies: new Map(), views: new Map(), steps: [], closed: false };
  const hear = (message, payload) => {
    if (message.type === "hello") wire.hello = message;
    if (message.type === "reply") wire.replies.set(message.id, message);
    if (message.type !== "update") return;
    wire.update = message;
    if (wire.steps.at(-1) !== message.step) wire.steps.push(message.step);
    for (const view of message.views) wire.views.set(view.id, { ...view, step: message.step, numbers: (stored) => numbers(payload, stored) });
  };
  page.on("websocket", (socket) => {
    Object.assign(wire, { hello: null, update: null, closed: false });
    wire.views.clear();
    wire.replies.clear();
    socket.on("close", () => (wire.closed = true));
    socket.on("framesent", ({ payload }) => wire.said.push(JSON.parse(payload)));
    socket.on("framereceived", ({ payload }) => {
      if (typeof payload === "string") return hear(JSON.parse(payload), null);
      const length = 4 + payload.readUInt32LE(0);
      hear(JSON.parse(payload.subarray(4, length).toString()), payload.subarray(length));
    });
  });
  return wire;
}

const kinds = { f32: Float32Array, f64: Float64Array, u32: Uint32Array, u8: Uint8Array };
function numbers(payload, { at, count, as }) {
  const bytes = new Uint8Array(payload).slice(at, at + count * kinds[as].BYTES_PER_ELEMENT);
  return new kinds[as](bytes.buffer);
}

/** The last message of the page that does this, and its answer. */
export async function answer(page, what) {
  const said = await until(() => page.wire.said.findLast((words) => words.do === what), `a message "${what}"`);
  return { said, reply: await until(() => page.wire.replies.get(said.id), `an answer to ${JSON.stringify(said)}`) };
}

/** The cloud of particles that a view was sent last: { count, at: (particle) => coordinates, ... }. */
export function cloud(page, view = 1) {
  const { canvas, numbers: read } = page.wire.views.get(view);
  const mark = canvas.marks.find(({ kind }) => kind === "cloud");
  const positions = read(mark.positions);
  const at = (k) => Array.from({ length: mark.dimension }, (_, a) => mark.origin[a] + mark.scale[a] * positions[k * mark.dimension + a]);
  return { ...mark, at, value: mark.values ? (k) => read(mark.values)[k] : undefined };
}

/** A page of a simulation that has its first picture. */
export async function watch(test, chromium, run, options) {
  const page = await open(test, chromium, run.address, options);
  await until(() => page.wire.update && (page.wire.views.has(1) || page.wire.hello.diagnoses[0].drawing === "table"), "a first picture");
  await until(async () => Number((await data(page, "[data-view='1']")).frames) > 0, "a painted picture");
  return page;
}

/** Waits until the window has said, and the page shows, this step. */
export async function atStep(page, step) {
  await until(
    async () => page.wire.update?.step === step && (await data(page, "body")).step === String(step),
    () => `step ${step}; it is ${page.wire.update?.step} and ${page.wire.update?.state}`,
  );
}

/** Waits until a pane shows the picture of this step, or of the last one that the window has told of. */
export async function pictureOf(page, step, view = 1) {
  const wanted = () => String(step ?? page.wire.update.step);
  const shown = async () => (await data(page, `[data-view='${view}']`)).step;
  await until(async () => (await shown()) === wanted(), async () => `the picture of step ${wanted()}; it is that of ${await shown()}`);
}

/** Chooses a diagnosis for a pane, and waits until it is painted. */
export async function choose(page, diagnosis, view = 1) {
  const pane = `[data-view='${view}']`;
  const before = await data(page, pane);
  if (before.diagnosis === diagnosis) return;
  await page.selectOption(`#pane-${view}-chooser`, diagnosis);
  assert.equal((await data(page, pane)).diagnosis, diagnosis);
  await until(async () => (await data(page, pane)).frames !== before.frames, `a picture of ${diagnosis}`);
}

/** The data- attributes of the first element that is found. */
export function data(page, selector) {
  return page.locator(selector).first().evaluate((element) => ({ ...element.dataset }));
}

/**
 * How much of a pane's canvas shows something: the coloured share of it (particles, curves and images are; axes, texts
 * and the paper are grey; the right, where colour bars are, is left out), or what stands out in its middle, if that is
 * more (an image in greys).
 */
export function share(page, view) {
  return page.evaluate((number) => {
    const canvas = document.querySelector(`[data-view="${number}"] canvas`);
    if (!canvas || canvas.width === 0 || canvas.height === 0) return 0;
    const copy = document.createElement("canvas");
    const width = (copy.width = Math.ceil(canvas.width * 0.7));
    const height = (copy.height = canvas.height);
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    const spread = (data, k) => Math.max(data[k], data[k + 1], data[k + 2]) - Math.min(data[k], data[k + 1], data[k + 2]);
    const { data } = context.getImageData(0, 0, width, height);
    let coloured = 0;
    for (let k = 0; k < data.length; k += 4) if (spread(data, k) > 40) ++coloured;
    const middle = context.getImageData(canvas.width * 0.3, canvas.height * 0.3, canvas.width * 0.4, canvas.height * 0.4).data;
    let other = 0;
    for (let k = 0; k < middle.length; k += 4) // lines of the grid are fainter than this
      if ([0, 1, 2].some((c) => Math.abs(middle[k + c] - data[c]) > 60)) ++other;
    return Math.max(coloured, other > middle.length / 40 ? other : 0) / (width * height);
  }, view);
}

/** Fails unless the pane shows a picture: particles, curves or an image on its background. */
export async function painted(page, view, least = 0.0005) {
  await until(async () => (await share(page, view)) > least, `a picture in pane ${view}`);
}

/** Keeps a screenshot for people to look at. */
export async function keep(page, name) {
  const file = join(folder, "screenshots", `${name}.png`);
  mkdirSync(dirname(file), { recursive: true });
  writeFileSync(file, await page.screenshot());
}
