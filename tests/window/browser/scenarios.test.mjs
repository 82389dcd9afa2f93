// Every shipped scenario in the window: it opens, paints, and goes a step; a picture of each is kept for people.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { after, before } from "node:test";
import { browser, bzm, choose, keep, painted, pictureOf, test, until, watch } from "./window.mjs";

let chromium;
before(async () => (chromium = await browser()));
after(() => chromium.close());

const scenarios = new URL("../../../scenarios/", import.meta.url);
const names = readdirSync(scenarios)
  .filter((file) => file.endsWith(".toml"))
  .map((file) => file.slice(0, -5));

for (const name of names)
  test(`${name} is shown and goes on`, async (t) => {
    // What comes before the first step is the same without a window: it is made short. A few steps are all that is looked at:
    // a run that goes on until a busy browser has stopped it costs a minute where it does many.
    const text = readFileSync(new URL(`${name}.toml`, scenarios), "utf8");
    const words = ["--steps", "3"];
    if (/^\[equilibrate\]/m.test(text)) words.push("--set", "equilibrate.time=0.1");
    if (/^\[sweep\]/m.test(text)) words.push("--no-sweep"); // of a time, maybe, which says the same as steps
    const run = await bzm(t, ["run", name, "--window", "--out", "run", ...words]);
    const page = await watch(t, chromium, run, { width: 640, height: 480 });
    // Something that shows the particles, or their fields, at any step.
    const state = ["cartesian", "bands", "contours", "map", "mesh", "phase-space", "profile"];
    const shown = state.map((drawing) => page.wire.hello.diagnoses.find((each) => each.drawing === drawing)).find(Boolean);
    await choose(page, shown.name);
    await painted(page, 1, 2e-5);
    await page.keyboard.press("s");
    await pictureOf(page, 1);
    assert.equal(page.wire.update.message, "");
    await page.keyboard.press("Space");
    await until(() => page.wire.update.state === "done", () => `the steps of ${name}: ${JSON.stringify(page.wire.update.message)}`);
    assert.equal(page.wire.update.step, 3);
    await pictureOf(page);
    await painted(page, 1, 2e-5);
    if (page.wire.hello.dimension === 3 && shown.drawing === "cartesian") {
      // The camera turns without new data.
      const picture = page.locator("[data-view='1'] canvas").first();
      const pixels = () => picture.evaluate((canvas) => canvas.toDataURL());
      const before = await pixels();
      await picture.focus();
      for (let k = 0; k < 3; ++k) await page.keyboard.press("ArrowRight");
      await until(async () => (await pixels()) !== before, "another view");
    }
    await keep(page, `scenario-${name}`);
    assert.equal(await page.locator(".fault:visible").count(), 0);
  });
