// A stored run on a page: its slider, its speed, and the same diagnoses; a run that goes on is joined and left.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { answer, browser, bzm, choose, cloud, data, keep, ownFolder, painted, pictureOf, test, until, watch } from "./window.mjs";

let chromium;
before(async () => (chromium = await browser()));
after(() => chromium.close());

const steps = 200;
const every = 20; // steps between stored frames
const frames = steps / every + 1;

async function stored(t, { between = every, ...options } = {}) {
  const cwd = ownFolder(t);
  const words = ["run", "copper", "--out", "run", "--steps", String(steps), "--set", `output.trajectory=${between}`, "--quiet"];
  execFileSync(process.env.BZM, words, { cwd });
  const run = await bzm(t, ["window", "run"], { cwd });
  const page = await watch(t, chromium, run, options);
  return { run, page, folder: join(cwd, "run") };
}

// On its way: a browser that is slow may not see every frame.
const pastFrame = (page, frame) => until(() => page.wire.update?.frame >= frame, () => `frame ${frame}; it is ${page.wire.update?.frame}`);
const atFrame = (page, frame) =>
  until(
    async () => page.wire.update?.frame === frame && (await data(page, "body")).frame === String(frame),
    () => `frame ${frame}; it is ${page.wire.update?.frame}`,
  );

test("the slider goes to any frame, by mouse and by keyboard", async (t) => {
  const { page } = await stored(t);
  assert.equal(page.wire.hello.kind, "replay");
  assert.equal(page.wire.update.frames, frames);
  await painted(page, 1);
  await page.locator("#frame").focus();
  await page.keyboard.press("Home");
  await atFrame(page, 0);
  await pictureOf(page, 0);
  const start = cloud(page).at(60);
  await page.keyboard.press("ArrowRight");
  await atFrame(page, 1);
  await pictureOf(page, every);
  // The knock-on has gone on at (0.4, -0.45), but for what the lattice has slowed it.
  const [x, y] = cloud(page).at(60);
  assert.ok(x - start[0] > 0.06 && x - start[0] < 0.081 && y - start[1] < -0.06, `${x - start[0]} ${y - start[1]}`);
  await page.keyboard.press("End");
  await atFrame(page, frames - 1);
  assert.equal(page.wire.update.step, steps);
  assert.match(await page.textContent("#frame-place"), new RegExp(`frame ${frames} of ${frames}`));
  await keep(page, "replay");
  const box = await page.locator("#frame").boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await atFrame(page, (frames - 1) / 2);
});

test("STEP, PLAY, REWD, STOP and the speed", async (t) => {
  const { page } = await stored(t, { between: 2 }); // STOP comes long before the end, however late
  await page.locator("#frame").focus();
  await page.keyboard.press("Home");
  await atFrame(page, 0);
  await page.click("#step");
  await atFrame(page, 1);
  await page.keyboard.press("s");
  await atFrame(page, 2);
  await page.keyboard.press(",");
  await atFrame(page, 1);
  await page.selectOption("#replay-speed", "5");
  const { reply } = await answer(page, "set");
  assert.equal(reply.error, undefined);
  const pressed = Date.now();
  await page.click("#play");
  await pastFrame(page, 2);
  const begun = Date.now();
  await pastFrame(page, 6);
  const [least, most] = [pressed, begun].map((from) => (Date.now() - from) / 1000).reverse();
  const went = page.wire.update.frame - 2; // more than 4 if a slow machine looks late
  assert.ok((went + 1) / most < 7 && went / least > 1, `${least} to ${most} s for ${went} to ${went + 1} frames at 5 a second`);
  await page.click("#stop");
  await until(() => page.wire.update.state === "paused", "it stands");
  await page.selectOption("#replay-speed", "60");
  await page.click("#play");
  await atFrame(page, steps / 2);
  await page.click("#rewind");
  await atFrame(page, 0);
});

test("a replay shows every diagnosis, and saves pictures", async (t) => {
  const { page } = await stored(t);
  for (const { name } of page.wire.hello.diagnoses) {
    await choose(page, name);
    await painted(page, 1, 2e-4);
    assert.equal(await page.locator(".fault:visible").count(), 0, name);
  }
  await choose(page, page.wire.hello.diagnoses[0].name);
  await painted(page, 1);
  await page.locator("[data-view='1'] canvas").first().focus();
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("g")]);
  assert.equal(readFileSync(await download.path()).subarray(1, 4).toString(), "PNG");
  // What can't be done says why.
  assert.notEqual(page.wire.hello.can.checkpoint, "");
  assert.equal(await page.locator("#step-size").count(), 0);
});

test("quitting a replay leaves the stored run as it was", async (t) => {
  const { run, page, folder } = await stored(t);
  const before = readFileSync(join(folder, "trajectory.h5"));
  await page.click("#quit");
  await page.click("#quit-yes");
  assert.equal(await run.ended, 0, run.output());
  assert.deepEqual(readFileSync(join(folder, "trajectory.h5")), before);
});

test("a run that goes on without a browser is joined by its folder, and left", async (t) => {
  const cwd = ownFolder(t);
  const run = await bzm(t, ["run", "copper", "--window", "--play", "--out", "run", "--steps", "1000000000"], { cwd });
  const told = execFileSync(process.env.BZM, ["window", "run"], { cwd, encoding: "utf8" });
  assert.match(told, /the address of its window is in run\/window\.txt/);
  assert.equal(readFileSync(join(cwd, "run", "window.txt"), "utf8").trim(), run.address);
  const page = await watch(t, chromium, run);
  const { step } = await until(() => page.wire.update?.step > 0 && page.wire.update, "it goes on");
  await until(() => page.wire.update.step > step, "more steps");
  await page.close();
  const again = await watch(t, chromium, run);
  await until(() => again.wire.update?.step > step, "it has gone on meanwhile");
  assert.equal(again.wire.update.viewers, 1);
  await again.click("#stop");
  await until(() => again.wire.update.state === "paused", "it stands");
});

test("a replay at the width of a phone", async (t) => {
  const { page } = await stored(t, { width: 360, height: 740 });
  assert.ok((await page.evaluate(() => document.scrollingElement.scrollWidth)) <= 360, "too wide");
  assert.ok(await page.isVisible("#frame"));
  await painted(page, 1);
  await keep(page, "replay-phone");
});
