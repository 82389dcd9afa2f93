// The curves of a typed law: its energy and its force over the distance, each on its own scale about zero.
import { h } from "../elements";
import { written } from "../plot";

export interface Curve {
  path: string;
  length_unit: string;
  energy_unit: string;
  distance: number[];
  force: (number | null)[];
  energy: (number | null)[];
}

const width = 300;
const height = 96;
const space = "http://www.w3.org/2000/svg";

function svg(tag: string, attributes: Record<string, string | number>): SVGElement {
  const element = document.createElementNS(space, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  return element;
}

/**
 * The upper end of the displayed range: diverging cores are cut off above the attractive part, or the values far out.
 */
function extent(values: (number | null)[]): number {
  const finite = values.map((value) => (value === null ? 0 : value));
  const lowest = Math.min(0, ...finite);
  const highest = Math.max(0, ...finite);
  const outside = Math.max(0, ...finite.slice(Math.floor(finite.length / 5)));
  const shown = highest < 4 * outside ? highest : outside;
  return Math.max(-lowest, lowest < 0 ? Math.min(shown, -1.5 * lowest) : shown) || 1;
}

/** A line with gaps for missing numbers; values beyond the range leave at the edge. */
function line(curve: Curve, values: (number | null)[], kind: string): SVGElement {
  const end = curve.distance[curve.distance.length - 1];
  const scale = extent(values);
  let path = "";
  let pen = false;
  values.forEach((value, k) => {
    if (value === null || Math.abs(value) > 4 * scale) {
      pen = false;
      return;
    }
    const x = (curve.distance[k] / end) * width;
    const y = (height / 2) * (1 - (0.92 * value) / scale);
    path += `${pen ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`;
    pen = true;
  });
  return svg("path", { d: path, class: kind });
}

/** The position and the depth of the energy's minimum, or the force between neighbours. */
function bottom(curve: Curve): string {
  let deepest = 0;
  let at = -1;
  curve.energy.forEach((value, k) => {
    if (value !== null && value < deepest) [deepest, at] = [value, k];
  });
  if (at <= 0 || at === curve.energy.length - 1) return "";
  const unit = (name: string) => (name ? ` ${name}` : "");
  return `least energy ${written(deepest, 3)}${unit(curve.energy_unit)} at ${written(curve.distance[at], 2)}${unit(curve.length_unit)}`;
}

export function drawn(curve: Curve): HTMLElement {
  const end = curve.distance[curve.distance.length - 1];
  const picture = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img" });
  const least = bottom(curve);
  picture.setAttribute("aria-label", `energy and force over the distance${least ? `: ${least}` : ""}`);
  picture.append(svg("path", { d: `M0 ${height / 2}H${width}`, class: "zero" }));
  if (curve.energy.length > 0) picture.append(line(curve, curve.energy, "energy"));
  picture.append(line(curve, curve.force, "force"));
  return h(
    "figure",
    { class: "gallery-curve" },
    picture,
    h(
      "figcaption",
      {},
      curve.energy.length > 0 ? h("span", { class: "energy" }, "energy") : null,
      h("span", { class: "force" }, "force"),
      h("span", {}, `up to ${written(end, 2)}${curve.length_unit ? ` ${curve.length_unit}` : ""}${least ? `; ${least}` : ""}`),
    ),
  );
}
