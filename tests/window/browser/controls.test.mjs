// Every control of a run's page is pressed, and what it does is read from what the window says then, from its files, or
// from the pixels of the picture.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { answer, atStep, browser, bzm, choose, cloud, data, keep, ownFolder, painted, pictureOf, share, test, until, watch } from "./window.mjs";

let chromium;
before(async () => (chromium = await browser()));
after(() => chromium.close());

/** The knock-on of scenario copper is particle 60; its step is 0.01. */
async function copper(t, { words = [], ...options } = {}) {
  const cwd = ownFolder(t);
  const run = await bzm(t, ["run", "copper", "--window", "--out", "run", ...words], { cwd });
  const page = await watch(t, chromium, run, options);
  return { run, page, folder: join(cwd, "run") };
}

const near = (found, wanted, by) => assert.ok(Math.abs(found - wanted) <= by, `${found} instead of ${wanted} +- ${by}`);
const state = (page, word) =>
  until(async () => page.wire.update?.state === word && (await data(page, "body")).state === word, `the state is ${word}`);
const panel = async (page) => {
  await page.click("#popup");
  await page.waitForSelector("#panel:not([hidden])");
};
/** What a view shows, once a canvas has come for which `condition` holds. */
const canvas = (page, condition, what, view = 1) =>
  until(() => {
    const found = page.wire.views.get(view)?.canvas;
    return found && condition(found) && found;
  }, what);
const commit = async (page, selector, text) => {
  await page.fill(selector, text);
  await page.press(selector, "Enter");
};

/** So many steps between two pictures. */
async function pace(page, steps) {
  await panel(page);
  await commit(page, "#steps-per-frame", String(steps));
  await until(() => page.wire.update.steps_per_frame === steps, `${steps} steps a frame`);
  await page.click("#done");
}

async function toTheEnd(page, steps) {
  await pace(page, 1000);
  await page.click("#play");
  await atStep(page, steps);
}

/** A run that does not end before a test does, however slow the browser. */
async function endless(t, options) {
  const { run, page } = await copper(t, { words: ["--steps", "100000000"], ...options });
  await pace(page, 1);
  return { run, page };
}

test("STEP goes one step, forwards and backwards", async (t) => {
  const { page } = await copper(t);
  await painted(page, 1);
  assert.match(await page.textContent("#status"), /step 0 of 2,000/);
  const before = cloud(page);
  assert.equal(before.count, 250);
  const start = before.at(60);
  await page.click("#step");
  await atStep(page, 1);
  assert.match(await page.textContent("#status"), /step 1 of 2,000/);
  near(page.wire.update.time_number, 0.01, 1e-12);
  await pictureOf(page, 1);
  // The knock-on has gone velocity times step, (0.4, -0.45) * 0.01.
  near(cloud(page).at(60)[0] - start[0], 0.004, 2e-4);
  near(cloud(page).at(60)[1] - start[1], -0.0045, 2e-4);
  await page.keyboard.press("s");
  await atStep(page, 2);
  await page.keyboard.press(",");
  await atStep(page, 1);
  for (let k = 0; k < 3; ++k) await page.keyboard.press("."); // faster than pictures come
  await atStep(page, 4);
});

test("PLAY goes on, STOP stands still; Space does both, and a played run arrives at its end", async (t) => {
  const { page } = await copper(t, { words: ["--steps", "6000"] });
  await pace(page, 1); // the end is a hundred seconds away
  await page.click("#play");
  await state(page, "playing");
  assert.equal(await page.getAttribute("#play", "aria-pressed"), "true");
  await until(() => page.wire.update.step > 5, "some steps");
  await page.click("#stop");
  await state(page, "paused");
  const { step } = page.wire.update;
  assert.ok(step > 5 && step < 6000, `stopped at ${step}`);
  await new Promise((resolve) => setTimeout(resolve, 300));
  assert.equal(page.wire.update.step, step);
  await page.keyboard.press("Space");
  await until(() => page.wire.update.step > step, "more steps");
  await page.keyboard.press("Space");
  await state(page, "paused");
  await toTheEnd(page, 6000);
  await state(page, "done");
});

test("REWD runs back to the start and says by how much it is missed", async (t) => {
  const { page } = await copper(t, { words: ["--steps", "60"] });
  const start = cloud(page);
  await toTheEnd(page, 60);
  assert.notDeepEqual(cloud(page).at(60), start.at(60));
  await page.click("#rewind");
  await atStep(page, 0);
  const missed = await until(() => page.wire.update.missed, "what is missed");
  assert.ok(missed.position < 1e-9 && missed.velocity < 1e-9, JSON.stringify(missed));
  await until(async () => (await page.textContent("#notices")).includes("missed by up to"), "a line about it");
  await pictureOf(page, 0);
  for (const k of [0, 60, 249]) cloud(page).at(k).forEach((x, a) => near(x, start.at(k)[a], 1e-5));
});

test("the reversible leap-frog comes back exactly, by key R", async (t) => {
  const { page } = await copper(t, { words: ["--steps", "60", "--set", "ensembles.atoms.integrator=reversible-leap-frog"] });
  await toTheEnd(page, 60);
  await page.keyboard.press("r");
  await atStep(page, 0);
  const missed = await until(() => page.wire.update.missed, "what is missed");
  assert.deepEqual([missed.position, missed.velocity], [0, 0]);
  await until(async () => (await page.textContent("#notices")).includes("exactly"), "a line about it");
});

test("the step size is set, with a unit, and the next step has it; a mass is refused", async (t) => {
  const { page } = await copper(t);
  await panel(page);
  await commit(page, "#step-size", "0.06546 fs"); // 0.02 t0 of 3.273 fs
  await until(() => Math.abs(page.wire.update.step_size_number - 0.02) < 1e-9, () => `0.02, not ${page.wire.update.step_size_number}`);
  await page.click("#step");
  await atStep(page, 1);
  near(page.wire.update.time_number, 0.02, 1e-9);
  await commit(page, "#step-size", "2 kg");
  await page.waitForSelector("#panel .fault");
  assert.match(await page.textContent("#panel .fault"), /kg|time/);
  near(page.wire.update.step_size_number, 0.02, 1e-9);
});

test("steps per frame: number, slider, keys, full speed", async (t) => {
  const { page } = await endless(t);
  const paced = (steps) => until(() => page.wire.update.steps_per_frame === steps, () => `${steps} steps per frame, not ${page.wire.update.steps_per_frame}`);
  await panel(page);
  await commit(page, "#steps-per-frame", "25");
  await paced(25);
  page.wire.steps.length = 0;
  await page.click("#play");
  await until(() => page.wire.steps.length > 4, "some frames");
  await page.click("#stop");
  await state(page, "paused");
  for (const step of page.wire.steps.slice(1, 5)) assert.equal(step % 25, 0, page.wire.steps.join(" "));
  await page.focus("#steps-slider");
  await page.keyboard.press("Home");
  await paced(1);
  await page.keyboard.press("ArrowRight");
  await paced(2);
  await page.locator("#panel").focus();
  await page.keyboard.press("]");
  await paced(4);
  await page.keyboard.press("[");
  await paced(2);
  await page.check("#full-speed");
  await paced(0);
  const from = page.wire.update.step;
  await page.click("#play");
  await until(() => page.wire.update.step > from + 200, "200 steps");
  await page.click("#stop");
  await page.uncheck("#full-speed");
  await paced(1);
});

test("every diagnosis can be chosen and paints something; D and shift-D go through them", async (t) => {
  const { page } = await copper(t, { words: ["--steps", "200"] });
  await toTheEnd(page, 200);
  const names = page.wire.hello.diagnoses.map(({ name }) => name);
  assert.ok(names.includes("Particles") && names.length >= 5, names.join());
  for (const name of names) {
    await choose(page, name);
    await painted(page, 1, 2e-4);
    assert.equal(await page.locator(".fault:visible").count(), 0, name);
    await keep(page, `diagnosis-${name.replace(/\W+/g, "-")}`);
  }
  await choose(page, names[0]);
  await page.locator("[data-view='1'] canvas").first().focus();
  await page.keyboard.press("d");
  assert.equal((await data(page, "[data-view='1']")).diagnosis, names[1]);
  await page.keyboard.press("Shift+D");
  assert.equal((await data(page, "[data-view='1']")).diagnosis, names[0]);
});

test("several diagnoses stand side by side, six at most, and each is sent", async (t) => {
  const { page } = await copper(t, { words: ["--steps", "200"] });
  await toTheEnd(page, 200);
  await panel(page);
  await page.click("#add-pane");
  await page.locator("#panel").focus();
  for (let count = 3; count <= 6; ++count) {
    await page.keyboard.press("a");
    await until(async () => (await page.locator(".pane").count()) === count, `${count} panes`);
  }
  assert.equal(await page.locator("#add-pane").count(), 0);
  for (let view = 1; view <= 6; ++view) await painted(page, view, 2e-4);
  await keep(page, "six-panes");
  assert.deepEqual(page.wire.said.findLast((words) => words.do === "views").views.map(({ id }) => id), [1, 2, 3, 4, 5, 6]);
  // What is below in the panel is about the pane that is chosen there, or by its number.
  await page.click("#pane-3-active");
  assert.equal(await page.getAttribute("#pane-3-active", "aria-pressed"), "true");
  await page.selectOption("#pane-3-diagnosis", "Particles");
  assert.equal((await data(page, "[data-view='3']")).diagnosis, "Particles");
  await page.click("#pane-6-remove");
  await until(async () => (await page.locator(".pane").count()) === 5, "5 panes");
  await page.locator("[data-view='5'] button.close").click();
  await until(async () => (await page.locator(".pane").count()) === 4, "4 panes");
  await page.keyboard.press("2");
  await page.keyboard.press("x");
  await until(async () => (await page.locator("[data-view='2']").count()) === 0, "pane 2 is gone");
  await until(() => page.wire.said.findLast((words) => words.do === "views").views.map(({ id }) => id).join() === "1,3,4", "three views");
});

test("colour, size, ends of the colours, arrows: the window draws them", async (t) => {
  const { page } = await copper(t);
  await panel(page);
  await page.selectOption("#view-colour", "velocity.x");
  const coloured = await canvas(page, ({ bars }) => /velocity/.test(bars[0]?.label), "a colour bar of the velocity");
  assert.equal(coloured.bars.length, 1);
  await commit(page, "#view-low", "-20");
  await commit(page, "#view-high", "80");
  const ends = await canvas(page, ({ bars }) => Math.abs(bars[0].high * bars[0].factor - 80) < 1e-6, "an end of 80");
  near(ends.bars[0].low * ends.bars[0].factor, -20, 1e-6);
  // 0.4 l0/t0 = 220.5 angstrom/ps is above the upper end; rest is a fifth up.
  near(cloud(page).value(60), 1, 1e-3);
  near(cloud(page).value(0), 0.2, 1e-3);
  await commit(page, "#view-high", "much");
  await page.waitForSelector("#panel .fault");
  await commit(page, "#view-low", "");
  await commit(page, "#view-high", "");
  await canvas(page, ({ bars }) => Math.abs(bars[0].high * bars[0].factor - 80) > 1, "ends as found");
  await page.selectOption("#view-vectors", "velocity");
  await canvas(page, ({ marks }) => marks.some(({ kind, data }) => kind === "arrow" && data.count > 0), "arrows");
  await keep(page, "arrows");
  await page.selectOption("#view-vectors", "");
  await canvas(page, ({ marks }) => !marks.some(({ kind }) => kind === "arrow"), "no arrows");
  await page.selectOption("#view-size", "velocity.x");
  await canvas(page, ({ marks }) => marks.some(({ kind, diameters }) => kind === "cloud" && diameters?.count === 250), "a size for each");
  await page.selectOption("#view-colour", "");
  await canvas(page, ({ bars }) => bars.length === 0, "no colour bar");
  // By keys, too.
  await page.locator("#panel").focus();
  await page.keyboard.press("c");
  await canvas(page, ({ bars }) => bars.length === 1, "a colour bar again");
  await page.keyboard.press("z");
  await until(() => page.wire.said.findLast((words) => words.do === "views").views[0].size !== "velocity.x", "another size");
});

test("DYE AS STREAKLINES joins what was released at each place, and GAPS ABOVE says up to where", async (t) => {
  const run = await bzm(t, ["run", "foppl", "--window", "--out", "run", "--steps", "200"]);
  const page = await watch(t, chromium, run);
  await toTheEnd(page, 200);
  const curves = (wanted) => canvas(page, ({ marks }) => marks.filter(({ kind }) => kind === "curve").length === wanted, `${wanted} curves`);
  await curves(12); // as the scenario's picture has it
  await panel(page);
  await page.uncheck("#view-streaklines");
  await curves(0);
  assert.equal(await page.locator("#view-gap").count(), 0);
  await page.check("#view-streaklines");
  await curves(12);
  await commit(page, "#view-gap", "0.001");
  await curves(0);
  await commit(page, "#view-gap", "");
  await curves(12);
});

test("axes of phase space, bins and logarithm of a histogram", async (t) => {
  const { page } = await copper(t);
  await page.click("#step");
  await atStep(page, 1);
  await panel(page);
  const drawings = Object.fromEntries(page.wire.hello.diagnoses.map(({ name, drawing }) => [drawing, name]));
  await page.selectOption("#pane-1-diagnosis", drawings["phase-space"]);
  await page.selectOption("#view-x", "position.y");
  await page.selectOption("#view-y", "velocity.y");
  const phase = await canvas(page, ({ x, y }) => /y/.test(x.label) && /velocity y/.test(y.label), "the axes");
  // The knock-on's -0.45 l0/t0 is far below the others.
  near(phase.y.low * phase.y.factor, -248, 30);
  const histogram = drawings.histogram ?? drawings.spectrum;
  await page.selectOption("#pane-1-diagnosis", histogram);
  await page.selectOption("#view-x", drawings.histogram ? "velocity.y" : "position.y");
  if (!drawings.histogram) return;
  await commit(page, "#view-bins", "12");
  await until(() => page.wire.said.findLast((words) => words.do === "views").views[0].bins === 12, "12 bins");
  await page.check("#view-logarithmic");
  await canvas(page, ({ y }) => y.logarithmic, "a logarithmic axis");
  await painted(page, 1, 2e-4);
});

test("levels, weight and range of a field of the particles", async (t) => {
  const cwd = ownFolder(t);
  const copper = readFileSync(new URL("../../../scenarios/copper.toml", import.meta.url), "utf8");
  writeFileSync(join(cwd, "lines.toml"), `${copper}\n[[views]]\nname = "Lines"\ndrawing = "contours"\nlevels = 3\n`);
  const page = await watch(t, chromium, await bzm(t, ["run", "lines.toml", "--window", "--out", "run"], { cwd }));
  await panel(page);
  await page.selectOption("#pane-1-diagnosis", "Lines");
  const view = (key, value) =>
    until(() => JSON.stringify(page.wire.said.findLast((words) => words.do === "views").views[0][key]) === JSON.stringify(value), `${key} ${value}`);
  assert.equal(await page.inputValue("#view-levels"), "3");
  await canvas(page, ({ marks }) => marks.some(({ kind }) => kind === "curve"), "contours");
  await commit(page, "#view-levels", "5");
  await view("levels", 5);
  await commit(page, "#view-levels", "five");
  await page.waitForSelector("#panel .fault");
  await commit(page, "#view-levels", "");
  await view("levels", null);
  await page.selectOption("#view-weight", "wendland");
  await view("weight", "wendland");
  await commit(page, "#view-range", "8");
  await until(() => page.wire.said.findLast((words) => words.do === "views").views[0].range > 0, "a range");
  await canvas(page, ({ marks }) => marks.some(({ kind }) => kind === "curve"), "contours of wider particles");
  await keep(page, "contours");
});

test("TRACK keeps what was drawn, until it is turned off", async (t) => {
  const { page } = await endless(t);
  await panel(page);
  await commit(page, "#steps-per-frame", "100");
  await page.check("#track");
  await page.click("#play");
  await until(() => page.wire.update.step > 500, "some way");
  await page.click("#stop");
  await state(page, "paused");
  await pictureOf(page);
  assert.ok(Number((await data(page, "[data-view='1']")).frames) > 3);
  await keep(page, "track");
  const tracked = await share(page, 1);
  await page.locator("#panel").focus();
  await page.keyboard.press("t");
  assert.equal(await page.isChecked("#track"), false);
  await until(async () => (await share(page, 1)) < tracked, "fewer marks");
});

test("a click reads a particle; FOLLOW keeps it in the middle; Escape lets it go", async (t) => {
  const { page } = await copper(t);
  await painted(page, 1);
  // The brightest disc is the knock-on: find it by its colour in the pixels.
  const place = await page.evaluate(() => {
    const picture = document.querySelector("[data-view='1'] canvas");
    const copy = document.createElement("canvas");
    copy.width = picture.width;
    copy.height = picture.height;
    const context = copy.getContext("2d");
    context.drawImage(picture, 0, 0);
    const { data } = context.getImageData(0, 0, Math.floor(picture.width * 0.68), picture.height);
    const found = [];
    const width = Math.floor(picture.width * 0.68);
    for (let k = 0; k < data.length; k += 4)
      if (data[k] > 230 && data[k + 1] > 200 && data[k + 2] < 90) found.push([(k / 4) % width, Math.floor(k / 4 / width)]);
    const box = picture.getBoundingClientRect();
    const middle = (axis) => found.reduce((sum, each) => sum + each[axis], 0) / found.length;
    return { x: box.left + (middle(0) * box.width) / picture.width, y: box.top + (middle(1) * box.height) / picture.height, count: found.length };
  });
  assert.ok(place.count > 20, "a yellow disc");
  await page.mouse.click(place.x, place.y);
  const selected = await until(() => page.wire.update.selected, "a selected particle");
  assert.deepEqual([selected.ensemble, selected.particle], ["atoms", 60]);
  await page.waitForSelector("#card:not([hidden])");
  for (const { name, value } of selected.fields) assert.equal(await page.textContent(`#card [data-field="${name}"] td`), value);
  const velocity = selected.fields.find(({ name }) => name === "velocity.x").value;
  near(parseFloat(velocity), 220.5, 0.5); // angstrom/ps: 0.4 l0/t0
  await keep(page, "selected");

  // Followed and zoomed, a picture of what is seen has the particle in its middle.
  await page.click("#card-follow");
  await page.locator("[data-view='1'] canvas").first().focus();
  for (let k = 0; k < 4; ++k) await page.keyboard.press("+");
  for (let k = 0; k < 3; ++k) await page.keyboard.press("s");
  await atStep(page, 3);
  await pictureOf(page, 3);
  await page.keyboard.press("g");
  const { said } = await answer(page, "picture");
  const [x, y] = cloud(page).at(60);
  near((said.view.x_range[0] + said.view.x_range[1]) / 2, x, 0.2);
  near((said.view.y_range[0] + said.view.y_range[1]) / 2, y, 0.2);
  await page.keyboard.press("f");
  assert.equal(await page.getAttribute("#card-follow", "aria-pressed"), "false");
  await page.click("#card-copy");
  await page.keyboard.press("Escape");
  await page.waitForSelector("#card", { state: "hidden" });
  await until(() => page.wire.update.selected === null, "nothing selected");
  await page.keyboard.press("Home");
});

test("zoom by wheel, keys and the button for the whole view", async (t) => {
  const { page } = await copper(t);
  const seen = async () => {
    const before = page.wire.said.length;
    await page.keyboard.press("g");
    return (await until(() => page.wire.said.slice(before).find((words) => words.do === "picture"), "a picture")).view.x_range;
  };
  const picture = page.locator("[data-view='1'] canvas").first();
  await picture.hover();
  await page.mouse.wheel(0, -400);
  const zoomed = await until(seen, "a zoomed view");
  assert.ok(zoomed && zoomed[1] - zoomed[0] < 60, `zoomed to ${zoomed}`);
  await page.locator("[data-view='1'] button.whole").click();
  assert.equal(await seen(), undefined);
  await picture.focus();
  await page.keyboard.press("+");
  const closer = await seen();
  assert.ok(closer, "zoomed by key");
  await page.keyboard.press("ArrowRight");
  const moved = await seen();
  assert.notEqual(moved[0], closer[0]);
  await page.keyboard.press("Home");
  assert.equal(await seen(), undefined);
  await page.keyboard.press("+");
  await panel(page);
  await page.click("#panel #whole");
  assert.equal(await seen(), undefined);
});

test("a space is turned by mouse and keys, without new data, and comes back", async (t) => {
  const run = await bzm(t, ["run", "three-body", "--window", "--out", "run"]);
  const page = await watch(t, chromium, run);
  const camera = async () => {
    const before = page.wire.said.length;
    await page.keyboard.press("g");
    const { view } = await until(() => page.wire.said.slice(before).find((words) => words.do === "picture"), "a picture");
    return [view.azimuth, view.elevation];
  };
  const { canvas: shown } = page.wire.views.get(1);
  assert.ok(shown.z, "three axes");
  const picture = page.locator("[data-view='1'] canvas").first();
  await picture.focus();
  const first = await camera();
  near(first[0], shown.azimuth, 1e-6);
  near(first[1], shown.elevation, 1e-6);
  const box = await picture.boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 80, y + 40, { steps: 4 });
  await page.mouse.up();
  const dragged = await camera();
  assert.ok(Math.abs(dragged[0] - first[0]) > 5 && Math.abs(dragged[1] - first[1]) > 2, `${first} -> ${dragged}`);
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("ArrowUp");
  const turned = await camera();
  assert.ok(turned[0] !== dragged[0] && turned[1] !== dragged[1], `${dragged} -> ${turned}`);
  await page.keyboard.press("Home");
  const back = await camera();
  near(back[0], first[0], 1e-6);
  near(back[1], first[1], 1e-6);
  await painted(page, 1, 1e-4);
});

test("pictures are saved as PNG, SVG and PDF, as the window draws them", async (t) => {
  const { page } = await copper(t);
  await panel(page);
  const save = async () => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("#save-picture")]);
    return { name: download.suggestedFilename(), content: readFileSync(await download.path()) };
  };
  await page.selectOption("#save-scale", "2");
  await page.selectOption("#save-dark", "dark");
  const png = await save();
  assert.match(png.name, /^copper-particles-step-0\.png$/);
  assert.equal(png.content.subarray(1, 4).toString(), "PNG");
  assert.equal(png.content.readUInt32BE(16), 2400); // the width
  assert.equal((await answer(page, "picture")).said.dark, true);
  await page.selectOption("#save-dark", "light");
  await page.selectOption("#save-format", "svg");
  const svg = await save();
  assert.match(svg.name, /\.svg$/);
  assert.match(svg.content.toString(), /<svg[^]*<\/svg>\s*$/);
  await page.selectOption("#save-format", "pdf");
  assert.equal((await save()).content.subarray(0, 5).toString(), "%PDF-");
  await page.selectOption("#save-format", "png");
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("[data-view='1'] button.save").click()]);
  assert.match(download.suggestedFilename(), /\.png$/);
});

test("a movie is recorded", async (t) => {
  const { page } = await endless(t, { width: 480, height: 480 });
  await page.evaluate(() => {
    const { start } = MediaRecorder.prototype;
    MediaRecorder.prototype.start = function (...words) {
      window.recorded = 0;
      this.addEventListener("dataavailable", ({ data }) => (window.recorded += data.size));
      start.apply(this, words);
    };
  });
  const recording = () => until(async () => (await page.getAttribute("#record", "aria-pressed")) === "true", "recording");
  await page.click("#play");
  await panel(page);
  await page.click("#record");
  await recording();
  await until(() => page.evaluate(() => window.recorded > 5000), "a movie");
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#record")]);
  assert.match(download.suggestedFilename(), /\.webm$/);
  const content = readFileSync(await download.path());
  assert.equal(content.subarray(0, 4).toString("hex"), "1a45dfa3"); // EBML
  assert.ok(content.length > 5000, `${content.length} bytes`);
  // The same by key, and by the button of the pane.
  await page.locator("#panel").focus();
  await page.keyboard.press("m");
  await recording();
  const [again] = await Promise.all([page.waitForEvent("download"), page.locator("[data-view='1'] button.record").click()]);
  assert.match(again.suggestedFilename(), /\.webm$/);
});

test("a checkpoint is saved, and the run goes on from it", async (t) => {
  const { run, page, folder } = await copper(t, { words: ["--steps", "50"] });
  for (let k = 1; k <= 3; ++k) {
    await page.click("#step");
    await atStep(page, k);
  }
  await panel(page);
  await page.click("#panel #checkpoint");
  const { reply } = await answer(page, "checkpoint");
  assert.equal(reply.error, undefined);
  const file = join(folder, "checkpoint.h5");
  assert.ok(String(reply.path).endsWith("run/checkpoint.h5"), reply.path);
  assert.equal(readFileSync(file).subarray(0, 4).toString(), "Bolt");
  const saved = statSync(file).mtimeMs;
  await page.locator("#panel").focus();
  await page.keyboard.press("k");
  await until(() => statSync(file).mtimeMs > saved, "a newer checkpoint");
  await page.close();
  run.child.kill("SIGKILL"); // nothing is written any more
  await run.ended;
  const output = execFileSync(process.env.BZM, ["resume", "run", "--steps", "2"], { cwd: run.cwd, encoding: "utf8" });
  assert.match(output, /step 5/);
});

test("the table is plotted and exported; its values are those of diagnoses.csv", async (t) => {
  const { page, folder } = await copper(t, { words: ["--steps", "100"] });
  const table = page.wire.hello.diagnoses.find(({ drawing }) => drawing === "table").name;
  await choose(page, table);
  await toTheEnd(page, 100);
  await painted(page, 1, 2e-4);
  await until(async () => Number((await data(page, "[data-view='1']")).points) >= 6, "six rows");
  const chips = page.locator("[data-view='1'] [data-column]");
  const shown = await chips.evaluateAll((all) => all.map((one) => one.checked));
  await chips.first().click();
  assert.equal(await chips.first().isChecked(), !shown[0]);
  await panel(page);
  await page.check("#view-logarithmic");
  await painted(page, 1, 2e-4);
  await keep(page, "table");
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#csv")]);
  const lines = (text) => text.trim().split(/\r?\n/);
  const exported = lines(readFileSync(await download.path(), "utf8"));
  const stored = lines(readFileSync(join(folder, "diagnoses.csv"), "utf8"));
  assert.equal(exported.length, stored.length);
  const row = (line) => line.split(",").map(Number);
  row(exported.at(-1)).forEach((value, k) => near(value, row(stored.at(-1))[k], 1e-5 * Math.abs(value) + 1e-12));
});

test("points at most", async (t) => {
  const { page } = await copper(t);
  await panel(page);
  await commit(page, "#most", "60");
  await until(() => cloud(page).count <= 60, "fewer points");
  await until(async () => Number((await data(page, "[data-view='1']")).points) === cloud(page).count, "as many painted");
  await commit(page, "#most", "");
  await until(() => cloud(page).count === 250, "all points");
});

test("themes: by the panel and by key L, kept by the browser", async (t) => {
  const { page } = await copper(t);
  const theme = async (word) => until(async () => (await data(page, "html")).theme === word, `theme ${word}`);
  await panel(page);
  await page.check("#theme-dark", { force: true });
  await theme("dark");
  await painted(page, 1);
  await keep(page, "dark");
  await page.reload();
  await until(() => page.wire.views.has(1), "a picture");
  await theme("dark");
  await page.keyboard.press("l"); // the system's, which is light
  await theme("light");
});

test("the panel opens and closes by POPUP, P, DONE and Escape; ? shows every key", async (t) => {
  const { page } = await copper(t);
  const open = (wanted) => until(async () => (await page.isVisible("#panel")) === wanted, `the panel is ${wanted ? "open" : "closed"}`);
  await page.click("#popup");
  await open(true);
  await page.click("#done");
  await open(false);
  await page.keyboard.press("p");
  await open(true);
  await page.keyboard.press("Escape");
  await open(false);
  await page.keyboard.press("?");
  await page.waitForSelector("#help-dialog[open]");
  const keys = await page.locator("#help-dialog kbd").allTextContents();
  for (const key of ["Space", "S", "R", "Q", "P", "D", "A", "X", "C", "Z", "T", "F", "G", "M", "K", "L", "Home", "Esc", "?"])
    assert.ok(keys.includes(key), `${key} is not in ${keys.join(" ")}`);
  await keep(page, "keys");
  await page.click("#help-close");
  await page.click("#help");
  await page.waitForSelector("#help-dialog[open]");
  await page.keyboard.press("Escape");
  await page.waitForSelector("#help-dialog", { state: "hidden" });
});

test("QUIT asks, then ends the run; the last picture stays", async (t) => {
  const { run, page, folder } = await copper(t);
  await page.click("#step");
  await atStep(page, 1);
  await page.click("#quit");
  await page.click("#quit-no");
  await new Promise((resolve) => setTimeout(resolve, 200));
  assert.ok(run.running());
  await page.keyboard.press("q");
  await page.click("#quit-yes");
  assert.equal(await run.ended, 0, run.output());
  await until(async () => /closed/.test(await page.textContent("#notices")), "a line that says so");
  assert.equal((await data(page, "body")).connected, "gone");
  await painted(page, 1);
  assert.ok(existsSync(join(folder, "diagnoses.csv")));
  assert.match(await page.getAttribute("#play", "title"), /closed/);
  assert.equal(await page.getAttribute("#play", "aria-disabled"), "true");
});

test("several browsers at once: what one does, all see; they come and go", async (t) => {
  const { run, page } = await endless(t);
  const other = await watch(t, chromium, run);
  await until(() => page.wire.update.viewers === 2 && other.wire.update.viewers === 2, "two viewers");
  assert.match(await page.textContent("#viewers"), /2/);
  await page.click("#step");
  await atStep(page, 1);
  await atStep(other, 1);
  await choose(other, page.wire.hello.diagnoses[2].name); // only there
  await painted(other, 1, 2e-4);
  assert.equal((await data(page, "[data-view='1']")).diagnosis, page.wire.hello.diagnoses[0].name);
  await other.click("#play");
  await until(() => page.wire.update.step > 10, "steps");
  await other.close();
  await until(() => page.wire.update.viewers === 1, "one viewer");
  const { step } = page.wire.update;
  await until(() => page.wire.update.step > step + 5, "steps without the other one");
});

test("by keyboard alone: every button can be reached, sees the focus, and works", async (t) => {
  const { page } = await copper(t);
  const seen = [];
  for (let k = 0; k < 30; ++k) {
    await page.keyboard.press("Tab");
    const at = await page.evaluate(() => {
      const { activeElement: now } = document;
      const { outlineStyle, outlineWidth } = getComputedStyle(now);
      return { id: now.id || now.className || now.tagName, ring: outlineStyle !== "none" && parseFloat(outlineWidth) > 0, name: now.getAttribute("aria-label") || now.textContent.trim() };
    });
    if (at.id === "BODY") break;
    assert.ok(at.ring, `${at.id} shows no focus`);
    assert.ok(at.name, `${at.id} has no name`);
    seen.push(at.id);
    if (at.id === "step") {
      await page.keyboard.press("Enter");
      await atStep(page, 1);
    }
  }
  for (const id of ["play", "step", "rewind", "stop", "quit", "popup", "help", "pane-1-chooser"])
    assert.ok(seen.includes(id), `${id} is not among ${seen.join(" ")}`);
});

test("nothing can be pressed that the tests above don't press", async (t) => {
  const { page } = await copper(t);
  await panel(page);
  await page.click("#add-pane");
  const pressed = new Set(
    `play step rewind stop quit popup help help-close quit-no quit-yes done add-pane whole csv track follow most step-size
     steps-per-frame steps-slider full-speed save-format save-scale save-dark save-picture record checkpoint theme-light theme-dark theme-system
     card-follow card-copy card-close view-x view-y view-colour view-size view-vectors view-low view-high view-cells view-bins view-logarithmic
     view-trace view-slice view-at view-levels view-weight view-range frame replay-speed`.split(/\s+/),
  );
  const unknown = new Set();
  for (const { name } of page.wire.hello.diagnoses) {
    await page.selectOption("#pane-2-diagnosis", name);
    const found = await page.locator("button, input, select, textarea").evaluateAll((all) => all.map((one) => one.id || one.className || one.outerHTML));
    for (const one of found) if (!pressed.has(one) && !/^pane-\d-(chooser|diagnosis|active|remove)$|^small |^small$|data-column/.test(one)) unknown.add(one);
  }
  assert.deepEqual([...unknown], []);
});

for (const dark of [false, true])
  test(`usable at the width of a phone, ${dark ? "dark" : "light"}`, async (t) => {
    const { page } = await copper(t, { width: 360, height: 740, dark });
    await painted(page, 1);
    const fits = async () => assert.ok((await page.evaluate(() => document.scrollingElement.scrollWidth)) <= 360, "too wide");
    await fits();
    await keep(page, `phone-${dark ? "dark" : "light"}`);
    await page.click("#step");
    await atStep(page, 1);
    await panel(page);
    await fits();
    await keep(page, `phone-panel-${dark ? "dark" : "light"}`);
    await page.click("#done");
  });
