// Whether the page puts the ticks of an axis where pictures have them, with the same labels: tests/pictures/ticks.json.
// Usage: node ticks.mjs TICKS_MODULE CASES
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [, , module, path] = process.argv;
const { ticksBetween } = await import(pathToFileURL(module));
const cases = JSON.parse(readFileSync(path, "utf8"));
if (cases.length < 200) throw new Error(`${path} has only ${cases.length} cases`);

const near = (a, b, scale) => Math.abs(a - b) <= 1e-12 * scale;
let wrong = 0;
for (const { axis, ...wanted } of cases) {
  const now = ticksBetween(...axis);
  const scale = Math.max(...axis.slice(0, 2).map(Math.abs));
  const differs = Object.keys(wanted).filter((key) => {
    if (!Array.isArray(wanted[key])) return now[key] !== wanted[key];
    const same = typeof wanted[key][0] === "number" ? (a, b) => near(a, b, scale) : (a, b) => a === b;
    return now[key].length !== wanted[key].length || !now[key].every((one, i) => same(one, wanted[key][i]));
  });
  for (const key of differs) {
    ++wrong;
    console.log(`axis ${axis}: ${key} ${JSON.stringify(now[key])}, pictures have ${JSON.stringify(wanted[key])}`);
  }
}
if (wrong > 0) process.exit(1);
console.log(`ticks of ${cases.length} axes are those of pictures`);
