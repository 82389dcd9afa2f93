// The gallery in a browser: cards, search, the form of a scenario and its checks, SAVE AS, RUN and the way back.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { browser, bzm, data, keep, open, ownFolder, test, until } from "./window.mjs";

const shipped = readdirSync(new URL("../../../scenarios/", import.meta.url))
  .filter((file) => file.endsWith(".toml"))
  .map((file) => file.slice(0, -5));

let chromium;
before(async () => (chromium = await browser()));
after(() => chromium.close());

/** The gallery in a page of its own. */
async function gallery(t, options) {
  const run = await bzm(t, ["window"]);
  const page = await open(t, chromium, run.address, options);
  await page.waitForSelector('.gallery[data-page="list"]');
  return { run, page };
}

/** Chooses a scenario by its card. */
async function choose(page, name) {
  await page.click(`[data-scenario="${name}"] a`);
  await page.waitForSelector(`.gallery-scenario[data-name="${name}"]`);
}

const field = (page, path) => page.locator(`[data-path="${path}"]`);
const input = (page, path) => field(page, path).locator("input, select, textarea");
const trouble = (page, path) => field(page, path).locator(".gallery-trouble").textContent();
const checked = (page, state) =>
  until(async () => (await data(page, ".gallery-scenario")).checked === state, `the form is ${state}`);
const noWiderThan = async (page, width) =>
  assert.ok((await page.evaluate(() => document.scrollingElement.scrollWidth)) <= width, `wider than ${width} pixels`);

test("every shipped scenario has a card with its picture, and can be searched for", async (t) => {
  const { page } = await gallery(t);
  const cards = page.locator("[data-scenario]");
  assert.deepEqual(await cards.evaluateAll((all) => all.map((card) => card.dataset.scenario).sort()), [...shipped].sort());
  const shown = await cards.evaluateAll((all) =>
    Promise.all(
      all.map(async (card) => {
        const image = card.querySelector("img");
        image.loading = "eager";
        await image.decode();
        const [title, beginning, facts] = ["h2", ".gallery-beginning", ".gallery-facts"].map((part) => card.querySelector(part).textContent);
        return { name: card.dataset.scenario, width: image.naturalWidth, title, beginning, facts };
      }),
    ),
  );
  for (const { name, width, title, beginning, facts } of shown) {
    assert.ok(width >= 200, `the picture of ${name}`);
    assert.ok(title.length > 3 && beginning.length > 20, name);
    assert.match(facts, /[123]D/, name);
  }
  assert.match(await page.locator('[data-scenario="copper"] .gallery-facts').textContent(), /2D · 250 particles · 2,000 steps/);
  await page.evaluate(() => scrollTo(0, 0));
  await keep(page, "gallery");

  const visible = () => cards.evaluateAll((all) => all.filter((card) => card.offsetParent).map((card) => card.dataset.scenario));
  await page.fill("#gallery-search", "Copper RADIATION");
  assert.deepEqual((await visible()).sort(), ["copper", "copper-10000", "copper-cascade"]);
  await page.fill("#gallery-search", "zzz");
  assert.deepEqual(await visible(), []);
  assert.match(await page.textContent(".gallery-none"), /zzz/);
  await page.fill("#gallery-search", "");
  assert.equal((await visible()).length, shipped.length);
});

test("the form shows every value of the file, checks while one types, and goes back", async (t) => {
  const { page } = await gallery(t);
  await choose(page, "copper");
  assert.match(await page.textContent(".gallery-text"), /one atom is knocked out of its site/);
  assert.match(await page.locator(".gallery-toml pre").textContent(), /^title = "Radiation/);
  assert.equal(await input(page, "run.step").inputValue(), "0.01");
  assert.equal(await input(page, "run.cutoff").inputValue(), "7.653 angstrom");
  assert.match(await field(page, "run.cutoff").locator(".gallery-hint").textContent(), /3 r0.*angstrom/);
  assert.equal(await input(page, "box.high").inputValue(), "100 angstrom, 100 angstrom");
  assert.equal(await input(page, "ensembles.atoms.integrator").evaluate((element) => element.tagName), "SELECT");
  // Every input has a label and is described.
  const unnamed = await page.locator(".gallery-form .gallery-field :is(input, select, textarea)").evaluateAll((all) =>
    all
      .filter((one) => {
        const described = (one.getAttribute("aria-describedby") ?? "").split(" ").every((id) => document.getElementById(id));
        return !one.labels[0]?.textContent || !described;
      })
      .map((one) => one.outerHTML),
  );
  assert.deepEqual(unnamed, []);

  // Wrong at once: outside the limits, no number.
  await input(page, "run.step").fill("-1");
  assert.match(await trouble(page, "run.step"), /above 0/);
  assert.equal(await input(page, "run.step").getAttribute("aria-invalid"), "true");
  await input(page, "run.steps").fill("ten");
  assert.match(await trouble(page, "run.steps"), /number/);
  await page.click("#gallery-run"); // does not start: the keyboard is put where the mistake is
  assert.equal(await page.evaluate(() => document.activeElement.closest("[data-path]")?.dataset.path), "run.step");
  await input(page, "run.steps").fill("10");

  // Wrong for the window: another dimension. It says so at the field, after a pause.
  await input(page, "run.step").fill("2 kg");
  await until(async () => /mass|time/.test(await trouble(page, "run.step")), "an error at the step");
  assert.equal((await data(page, ".gallery-scenario")).checked, "errors");
  await keep(page, "gallery-form-error");
  await page.click("#gallery-run");
  await until(async () => !(await page.locator("#gallery-run").isDisabled()), "an answer");
  assert.equal((await data(page, ".gallery")).page, "scenario");

  // Right, in another unit.
  await input(page, "run.step").fill("0.03 fs");
  await checked(page, "ok");
  assert.equal(await trouble(page, "run.step"), "");
  assert.equal((await field(page, "run.step").getAttribute("data-changed")), "true");
  assert.match(await page.textContent("#gallery-state"), /2 changed/);

  // Back to what the file has.
  await field(page, "run.step").getByRole("button", { name: "back to 0.01" }).click();
  assert.equal(await input(page, "run.step").inputValue(), "0.01");
  await page.click("#gallery-all-back");
  assert.equal(await input(page, "run.steps").inputValue(), "2000");
  await checked(page, "ok");
});

test("keys that a table could have, too, are folded away; one is set, checked, saved and left out", async (t) => {
  const { run, page } = await gallery(t);
  await choose(page, "copper");
  const more = (table) => page.locator(`.gallery-more[data-table="${table}"]`);
  const line = (table) => more(table).locator("summary").textContent();
  assert.equal(await page.locator(".gallery-more[open]").count(), 0);
  assert.equal(await line("ensembles.atoms.load"), "2 more keys of load");
  const [, count] = /^(\d+) more keys$/.exec(await line("run"));
  assert.equal(await more("run").locator("[data-path]").count(), Number(count));
  assert.ok(!(await input(page, "run.skin").isVisible()));

  // What it means, what it may be, and what holds without it.
  await more("run").locator("summary").click();
  assert.equal(await input(page, "run.skin").inputValue(), "");
  assert.equal(await input(page, "run.skin").getAttribute("placeholder"), "automatic");
  assert.match(await field(page, "run.skin").locator(".gallery-hint").textContent(), /neighbour lists.* · at least 0 · in angstrom/);
  assert.match(await field(page, "run.cutoff").locator(".gallery-hint").textContent(), /^3 r0 · distance beyond which/); // the comment first
  assert.match(await page.textContent("#gallery-state"), /as in the file/);

  // Long help is whole where the keyboard is, and moves nothing: a click would miss what it was meant for.
  const help = field(page, "run.cutoff").locator(".gallery-hint > span");
  const lines = () => help.evaluate((one) => ({ shown: one.clientHeight, needed: one.scrollHeight }));
  const place = () => more("run").locator("summary").evaluate((one) => one.offsetTop);
  const [before, cut] = [await place(), await lines()];
  assert.ok(cut.shown < cut.needed, JSON.stringify(cut));
  await input(page, "run.cutoff").focus();
  const whole = await lines();
  assert.equal(whole.shown, whole.needed);
  assert.equal(await place(), before);

  await input(page, "run.skin").fill("-1");
  assert.match(await trouble(page, "run.skin"), /at least 0/);
  await input(page, "run.skin").fill("2 kg");
  await until(async () => /mass|length/.test(await trouble(page, "run.skin")), "an error at the skin");
  await input(page, "run.skin").fill("2 angstrom");
  await checked(page, "ok");
  assert.equal(await line("run"), `${count} more keys1 set`);
  for (const table of ["ensembles.atoms.load", "ensembles.atoms"]) await more(table).locator("summary").click();
  await input(page, "ensembles.atoms.load.jitter").fill("0.01");
  await input(page, "ensembles.atoms.velocity").fill("1 m/s, 2 m/s");
  await checked(page, "ok");
  assert.match(await page.textContent("#gallery-state"), /3 changed/);
  await keep(page, "gallery-more");

  await page.click("#gallery-save");
  await page.fill("#gallery-as", "more");
  await page.press("#gallery-as", "Enter");
  const file = join(run.cwd, "more.toml");
  await until(async () => (await page.textContent("#gallery-answer")).includes(file), "the path of the file");
  assert.match(readFileSync(file, "utf8"), /^skin = "2 angstrom"$/m);
  assert.match(readFileSync(file, "utf8"), /^load = \{.*, jitter = 0\.01 \}/m);
  assert.match(readFileSync(file, "utf8"), /^velocity = \["1 m\/s", "2 m\/s"\]$/m);
  execFileSync(process.env.BZM, ["check", file]);

  // Left out again.
  await field(page, "run.skin").getByRole("button", { name: "leave out" }).click();
  await input(page, "ensembles.atoms.velocity").fill("");
  await checked(page, "ok");
  assert.equal(await line("run"), `${count} more keys`);
  assert.match(await page.textContent("#gallery-state"), /1 changed/);
  await page.click("#gallery-all-back");
  await checked(page, "ok");
  assert.equal(await input(page, "ensembles.atoms.load.jitter").inputValue(), "");
});

test("a key whose field is emptied is left out, and put back; one that is needed says so", async (t) => {
  const { run, page } = await gallery(t);
  await choose(page, "copper");
  await input(page, "run.step").fill("");
  await until(async () => /'step'/.test(await trouble(page, "run.step")), "an error at the step");
  await field(page, "run.step").getByRole("button", { name: "back to 0.01" }).click();
  await input(page, "ensembles.atoms.diameter").fill("");
  await input(page, "output.pictures.0.high").fill("");
  await input(page, "ensembles.atoms.integrator").selectOption("");
  await checked(page, "ok");
  assert.match(await page.textContent("#gallery-state"), /3 changed/);
  assert.equal(await field(page, "ensembles.atoms.diameter").count(), 1); // not offered a second time
  await page.click("#gallery-save");
  await page.fill("#gallery-as", "less");
  await page.press("#gallery-as", "Enter");
  const file = join(run.cwd, "less.toml");
  await until(async () => (await page.textContent("#gallery-answer")).includes(file), "the path of the file");
  const text = readFileSync(file, "utf8");
  assert.doesNotMatch(text, /^(diameter|integrator) =|high = "100 angstrom/m);
  assert.match(text, /# 3 r0/);
  execFileSync(process.env.BZM, ["check", file]);
  await page.click("#gallery-all-back");
  await checked(page, "ok");
  assert.equal(await input(page, "ensembles.atoms.diameter").inputValue(), "2.2 angstrom");
});

test("a typed law is drawn beside its text, again when it changes, and not while it is wrong", async (t) => {
  const { page } = await gallery(t);
  await choose(page, "nematic-discs");
  const path = "influences.0.energy";
  const curve = field(page, path).locator(".gallery-curve");
  assert.ok((await curve.locator("path.energy").getAttribute("d")).length > 200);
  assert.match(await curve.textContent(), /energy.*force.*up to/);
  const before = await curve.locator("path.force").getAttribute("d");
  await curve.scrollIntoViewIfNeeded();
  await keep(page, "typed-law");
  await input(page, path).fill("push*(1 - r/1.2)^3*step(1.2 - r)");
  await checked(page, "ok");
  assert.notEqual(await curve.locator("path.force").getAttribute("d"), before);
  await input(page, path).fill("push*(");
  await checked(page, "errors");
  assert.equal(await curve.count(), 0);
});

test("another word brings its own keys; what is set among them is there again after a run", async (t) => {
  const { page } = await gallery(t);
  await choose(page, "copper");
  const of = "output.pictures.1";
  assert.equal(await field(page, `${of}.bins`).count(), 0);
  assert.equal(await field(page, `${of}.logarithmic`).count(), 1);
  await input(page, `${of}.drawing`).selectOption("profile");
  await input(page, `${of}.y`).fill("density");
  await until(async () => (await field(page, `${of}.bins`).count()) === 1, "the bins of a profile");
  await page.locator(`.gallery-more[data-table="${of}"] summary`).click();
  await input(page, `${of}.bins`).fill("20");
  await input(page, "run.steps").fill("5");
  await checked(page, "ok");
  assert.match(await page.textContent("#gallery-state"), /4 changed/);
  await page.click("#gallery-run");
  await page.waitForSelector("#play:visible");
  await page.click("#quit");
  await page.getByRole("dialog").getByRole("button", { name: /quit/i }).click();
  await page.waitForSelector('.gallery-scenario[data-name="copper"]');
  await checked(page, "ok");
  await until(async () => (await field(page, `${of}.bins`).count()) === 1, "the bins again");
  assert.equal(await input(page, `${of}.bins`).inputValue(), "20");
  assert.equal(await page.locator(`.gallery-more[data-table="${of}"][open]`).count(), 1);
  await input(page, `${of}.bins`).fill("");
  await input(page, `${of}.drawing`).selectOption("time-series");
  await until(async () => (await field(page, `${of}.bins`).count()) === 0, "no bins of a time series");
});

test("a changed scenario is saved as a file that the command takes; another file is not overwritten unasked", async (t) => {
  const { run, page } = await gallery(t);
  await choose(page, "copper");
  await input(page, "run.steps").fill("123");
  await checked(page, "ok");
  await page.click("#gallery-save");
  await page.fill("#gallery-as", "my-copper");
  await page.press("#gallery-as", "Enter");
  const file = join(run.cwd, "my-copper.toml");
  await until(async () => (await page.textContent("#gallery-answer")).includes(file), "the path of the file");
  assert.match(readFileSync(file, "utf8"), /^steps = 123$/m);
  assert.match(readFileSync(file, "utf8"), /# 3 r0/); // comments are still there
  execFileSync(process.env.BZM, ["check", file]);

  await input(page, "run.steps").fill("456");
  await checked(page, "ok");
  await page.click("#gallery-save-now");
  await page.waitForSelector("#gallery-replace:not([hidden])");
  assert.match(readFileSync(file, "utf8"), /^steps = 123$/m);
  await page.click("#gallery-replace");
  await until(() => /^steps = 456$/m.test(readFileSync(file, "utf8")), "the other number in the file");

  for (const name of ["../elsewhere", "/tmp/elsewhere", ""]) {
    await page.fill("#gallery-as", name);
    await page.click("#gallery-save-now");
    await until(async () => /name/.test(await page.textContent("#gallery-answer")), `a refusal of '${name}'`);
  }
  assert.ok(!existsSync(join(run.cwd, "..", "elsewhere.toml")));

  // It stands in the list now, and its form has the new value.
  await page.click(".gallery-back");
  await page.waitForSelector('[data-scenario="my-copper"] .gallery-own');
  await choose(page, "my-copper");
  assert.equal(await input(page, "run.steps").inputValue(), "456");
});

test("RUN starts what was typed; QUIT comes back to the form as it was", async (t) => {
  const { run, page } = await gallery(t);
  await choose(page, "copper");
  await input(page, "run.steps").fill("77");
  await page.fill("#gallery-out", "results");
  await page.click("#gallery-run");
  await page.waitForSelector("#play:visible");
  await until(async () => (await page.textContent("#simulation")).includes("of 77"), "step ... of 77");
  await page.click("#play");
  await until(async () => (await data(page, "body")).step === "77", "the last step");
  await page.click("#quit");
  await page.getByRole("dialog").getByRole("button", { name: /quit/i }).click();
  await page.waitForSelector('.gallery-scenario[data-name="copper"]');
  assert.equal(await input(page, "run.steps").inputValue(), "77");
  assert.ok(run.running());
  assert.match(readFileSync(join(run.cwd, "results", "scenario.toml"), "utf8"), /steps = 77/);
});

test("the runs below a folder are cards with their pictures; one is shown, and QUIT comes back", async (t) => {
  const cwd = ownFolder(t);
  for (const out of ["results/first", "results/second"])
    execFileSync(process.env.BZM, ["run", "copper", "--steps", "20", "--set", "output.trajectory=10", "--out", out, "--quiet"], { cwd });
  const run = await bzm(t, ["window", "results"], { cwd });
  const page = await open(t, chromium, run.address);
  await page.waitForSelector('.gallery[data-page="list"]');
  const cards = page.locator("[data-scenario]");
  assert.deepEqual(await cards.evaluateAll((all) => all.map((card) => card.dataset.scenario)), ["first", "second"]);
  assert.equal(await page.textContent(".gallery-count"), "2 runs");
  await until(() => cards.first().locator("img").evaluate((image) => image.naturalWidth > 100), "a picture of the run");
  await keep(page, "runs");
  await page.click('[data-scenario="second"] a');
  await page.waitForSelector("#play:visible");
  await until(async () => page.wire.hello?.kind === "replay" && page.wire.update?.frames === 3, "the three frames");
  await page.click("#quit");
  await page.getByRole("dialog").getByRole("button", { name: /quit/i }).click();
  await page.waitForSelector('.gallery[data-page="list"]');
  assert.ok(run.running());
});

test("how a run has ended is said until somebody goes on", async (t) => {
  const { page } = await gallery(t);
  const start = async (steps) => {
    await choose(page, "three-body");
    await input(page, "run.steps").fill(steps);
    await page.click("#gallery-run");
    await page.waitForSelector("#play:visible");
    assert.equal(await page.locator('[data-matter="run"]').count(), 0);
    await page.click("#quit");
    await page.getByRole("dialog").getByRole("button", { name: /quit/i }).click();
    await page.waitForSelector(".gallery-scenario");
  };
  await start("50");
  await until(async () => /has ended/.test((await page.locator('[data-matter="run"]').allTextContents()).join()), "how it ended");
  await page.click(".gallery-back");
  await page.waitForSelector('.gallery[data-page="list"]');
  await choose(page, "copper");
  await until(async () => (await page.locator('[data-matter="run"]').count()) === 0, "nothing of the last run");
});

test("the keyboard alone finds a scenario, changes it, and goes back", async (t) => {
  const { page } = await gallery(t);
  const press = async (key, wanted) => {
    for (let times = 0; times < 60; ++times) {
      if (await page.evaluate(wanted)) return;
      await page.keyboard.press(key);
    }
    assert.fail(`no ${key} leads to ${wanted}`);
  };
  await press("Tab", "document.activeElement.id === 'gallery-search'");
  await page.keyboard.type("pythagorean");
  await press("Tab", "document.activeElement.closest('[data-scenario=pythagorean]') !== null");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".gallery-scenario[data-name=pythagorean]");
  await press("Tab", "document.activeElement.closest('[data-path^=\"run.\"]') !== null");
  await press("Tab", "document.activeElement.id === 'gallery-run'");
  await press("Shift+Tab", "document.activeElement.classList.contains('gallery-back')");
  await page.keyboard.press("Enter");
  await page.waitForSelector('.gallery[data-page="list"]');
  // The search is as it was, and the keyboard where it was.
  assert.equal(await page.inputValue("#gallery-search"), "pythagorean");
  await until(() => page.evaluate(() => document.activeElement.closest("[data-scenario=pythagorean]") !== null), "the card has the keyboard");
  await page.goBack();
  await page.waitForSelector(".gallery-scenario[data-name=pythagorean]");
});

test("a name that there is not is one line with a way back", async (t) => {
  const { page } = await gallery(t);
  await page.evaluate(() => (location.hash = "#coper"));
  await until(async () => /coper/.test(await page.textContent(".gallery")), "the name in the message");
  await page.click(".gallery-back");
  await page.waitForSelector('.gallery[data-page="list"]');
});

for (const dark of [false, true])
  test(`readable at the width of a phone, ${dark ? "dark" : "light"}`, async (t) => {
    const { page } = await gallery(t, { width: 360, height: 740, dark });
    await noWiderThan(page, 360);
    await keep(page, `gallery-phone-${dark ? "dark" : "light"}`);
    await choose(page, "copper");
    await noWiderThan(page, 360);
    for (const summary of await page.locator(".gallery-more summary").all()) await summary.click();
    await noWiderThan(page, 360);
    await page.locator('[data-path="run.step"]').scrollIntoViewIfNeeded();
    await keep(page, `gallery-form-phone-${dark ? "dark" : "light"}`);
    // Paper and ink differ enough to be read (WCAG: 7 to 1 is the best class).
    const contrast = await page.evaluate(() => {
      const luminance = (colour) => {
        const [r, g, b] = colour.match(/[\d.]+/g).map((part) => {
          const x = Number(part) / 255;
          return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
        });
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const label = document.querySelector(".gallery-label label");
      let behind = label;
      const see = (element) => getComputedStyle(element).backgroundColor;
      while (behind && /, 0\)$|transparent/.test(see(behind))) behind = behind.parentElement;
      const [a, b] = [luminance(getComputedStyle(label).color), luminance(behind ? see(behind) : "rgb(255, 255, 255)")];
      return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    });
    assert.ok(contrast > 7, `contrast ${contrast}`);
  });
