// Every shipped scenario in the window: it opens, paints, and goes a step; a picture of each is kept for people.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { after, before } from "node:test";
import { browser, bzm, data, keep, painted, test, until, watch } from "./window.mjs";

let chromium;
before(async () => (chromium = await browser()));
after(() => chromium.close());

const names = readdirSync(new URL("../../../scenarios/", import.meta.url))
  .filter((file) => file.endsWith(".toml"))
  .map((file) => file.slice(0, -5));

for (const name of names)
  test(`${name} is shown and goes on`, async (t) => {
    const run = await bzm(t, ["run", name, "--window", "--out", "run"], { seconds: 120 });
    const page = await watch(t, chromium, run);
    // Something that shows the particles, or their fields, at any step.
    const state = ["cartesian", "bands", "contours", "map", "mesh", "phase-space", "profile"];
    const shown = state.map((drawing) => page.wire.hello.diagnoses.find((each) => each.drawing === drawing)).find(Boolean);
    await page.selectOption("#pane-1-chooser", shown.name);
    await until(() => page.wire.views.has(1), "a picture");
    await painted(page, 1, 2e-5);
    await page.click("#step");
    await until(() => page.wire.update.step === 1 && page.wire.views.get(1).step === 1, () => `step 1 of ${name}: ${JSON.stringify(page.wire.update.message)}`, 120);
    assert.equal(page.wire.update.message, "");
    await page.click("#play");
    await until(() => page.wire.update.step > 3 || page.wire.update.state === "done", () => `some steps of ${name}: ${JSON.stringify(page.wire.update.message)}`, 120);
    await new Promise((resolve) => setTimeout(resolve, 1500));
    await page.click("#stop");
    await until(() => ["paused", "done"].includes(page.wire.update.state), "it stands", 60);
    await painted(page, 1, 2e-5);
    const { drawing } = await data(page, "[data-view='1']");
    const space = page.wire.hello.dimension === 3 && drawing === "cartesian";
    if (space) {
      // The camera turns without new data.
      const before = await page.locator("[data-view='1'] canvas").first().screenshot();
      await page.locator("[data-view='1'] canvas").first().focus();
      for (let k = 0; k < 3; ++k) await page.keyboard.press("ArrowRight");
      await until(async () => !before.equals(await page.locator("[data-view='1'] canvas").first().screenshot()), "another view");
    }
    await keep(page, `scenario-${name}`);
    assert.equal(await page.locator(".fault:visible").count(), 0);
  });
