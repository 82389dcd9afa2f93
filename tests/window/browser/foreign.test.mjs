// What a browser lets other pages do to a window: a notebook on this machine may show it in a frame; no page can speak to
// its socket, and none that has made its own name lead here gets anything. The run goes on.
import assert from "node:assert/strict";
import { createServer } from "node:http";
import { after, before } from "node:test";
import { atEnd, atStep, browser, bzm, painted, test, until, watch } from "./window.mjs";

let chromium;
before(async () => (chromium = await browser("--host-resolver-rules=MAP rebound.example 127.0.0.1, MAP foreign.example 127.0.0.1")));
after(() => chromium.close());

async function otherPage(t) {
  const context = await chromium.newContext();
  atEnd(t, () => context.close());
  return context.newPage();
}

/** A page of somebody else's on another port of this machine, and what it was refused. */
async function elsewhere(t, html, name = "localhost") {
  const server = createServer((_request, response) => response.writeHead(200, { "content-type": "text/html" }).end(html));
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  atEnd(t, () => {
    server.closeAllConnections();
    server.close();
  });
  const page = await otherPage(t);
  const refused = [];
  page.on("requestfailed", (request) => refused.push(request.url()));
  const visit = (name) => page.goto(`http://${name}:${server.address().port}/`);
  await visit(name);
  return { page, refused, visit };
}

/** Whether the run still answers a browser that may ask. */
async function goesOn(t, run) {
  const page = await watch(t, chromium, run);
  const { step } = page.wire.update;
  await page.click("#step");
  await atStep(page, step + 1);
}

test("a notebook's frame shows the window", async (t) => {
  const run = await bzm(t, ["run", "copper", "--window", "--out", "run"]);
  const { page } = await elsewhere(t, `<!doctype html><iframe width="900" height="600" src="${run.address}"></iframe>`);
  const frame = await until(() => page.frames().find((each) => each.url() === run.address), "the frame");
  await frame.waitForSelector("[data-view='1'][data-frames]");
  await painted(frame, 1);
  await frame.click("#step");
  await until(() => frame.evaluate(() => document.body.dataset.step === "1"), "step 1");
});

test("a page of the internet can't put it into a frame", async (t) => {
  const run = await bzm(t, ["run", "copper", "--window", "--out", "run"]);
  const { page, refused } = await elsewhere(t, `<!doctype html><iframe width="900" height="600" src="${run.address}"></iframe>`, "foreign.example");
  await until(() => refused.includes(run.address), "a refusal");
  for (const frame of page.frames()) assert.equal(await frame.locator("#bar").count(), 0, frame.url());
  await goesOn(t, run);
});

test("no other page can open the socket or read the page, even with the token", async (t) => {
  const run = await bzm(t, ["run", "copper", "--window", "--out", "run"]);
  const { page, visit } = await elsewhere(t, "<!doctype html>");
  for (const name of ["localhost", "127.0.0.1", "foreign.example"]) {
    await visit(name);
    const socket = run.address.replace("http", "ws").replace("/?", "/socket?");
    const opened = await page.evaluate(
      (address) =>
        new Promise((resolve) => {
          const made = new WebSocket(address);
          made.onopen = () => resolve(true);
          made.onerror = made.onclose = () => resolve(false);
        }),
      socket,
    );
    assert.equal(opened, false, name);
    const read = await page.evaluate((address) => fetch(address).then((response) => response.text(), () => "refused"), run.address);
    assert.equal(read, "refused", name);
    const posted = await page.evaluate((address) => fetch(address, { method: "POST", mode: "no-cors", body: '{"do":"quit"}' }).then(() => "sent", () => "refused"), run.address);
    assert.ok(["sent", "refused"].includes(posted)); // whatever the browser says: nothing was done
  }
  assert.ok(run.running());
  await goesOn(t, run);
});

test("a name that leads to this machine gets nothing, nor does who has no token", async (t) => {
  const run = await bzm(t, ["run", "copper", "--window", "--out", "run"]);
  const page = await otherPage(t);
  const status = async (address) => (await page.goto(address)).status();
  assert.equal(await status(run.address), 200);
  assert.equal(await status(run.address.replace("127.0.0.1", "localhost")), 200); // ssh -L
  assert.equal(await status(run.address.replace("127.0.0.1", "rebound.example")), 403);
  assert.equal(await status(run.address.replace(/token=.*/, "token=0")), 403);
  assert.equal(await status(run.address.replace(/\?.*/, "")), 403);
  await goesOn(t, run);
});
