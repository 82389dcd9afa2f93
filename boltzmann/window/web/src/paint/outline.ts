// The outline of a box in space: edges behind the particles first, the three at the nearest corner last; names and
// ticks along three edges of the silhouette. It is the same as BoxOutline in boltzmann/pictures/projection.cpp;
// tests/pictures/outlines.json tests both.
import { toPane, type Look, type Place3, type Space } from "./look";
import { Pen } from "./text";
import { css, type Theme } from "./theme";
import { ticksBetween } from "./ticks";

interface Corner {
  place: Place3;
  right: number;
  up: number;
  near: number;
}

export class Outline {
  private readonly corners: Corner[] = [];
  private nearest = 0;
  private farthest = 0;

  constructor(
    private readonly space: Space,
    private readonly look: Look,
    private readonly pen: Pen,
    private readonly theme: Theme,
    private readonly unit: number,
    private readonly width: number,
    private readonly height: number,
  ) {
    for (let corner = 0; corner < 8; ++corner) {
      const place = space.sides.map((side, axis) => ((corner >> axis) & 1 ? side : -side)) as Place3;
      this.corners.push({ place, ...space.project(place) });
      if (this.at(corner).near > this.at(this.nearest).near) this.nearest = corner;
      if (this.at(corner).near < this.at(this.farthest).near) this.farthest = corner;
    }
  }

  private at(corner: number): Corner {
    return this.corners[corner] as Corner;
  }
  private eachEdge(visit: (a: number, b: number, axis: number) => void) {
    for (let axis = 0; axis < 3; ++axis)
      for (let corner = 0; corner < 8; ++corner) if (!((corner >> axis) & 1)) visit(corner, corner | (1 << axis), axis);
  }
  private line(from: readonly number[], to: readonly number[], alpha: number, width: number) {
    const { context } = this.pen;
    context.strokeStyle = css(this.theme.ink, alpha);
    context.lineWidth = width * this.unit;
    context.beginPath();
    context.moveTo(from[0] ?? 0, from[1] ?? 0);
    context.lineTo(to[0] ?? 0, to[1] ?? 0);
    context.stroke();
  }
  /** Keeps names inside the pane if possible. */
  private write(text: string, x: number, y: number, font: number, align: number) {
    const { pen, unit } = this;
    const wide = pen.width(text, font * unit);
    const left = Math.max(Math.min(x - align * wide, this.width - wide - 3 * unit), Math.min(3 * unit, x));
    pen.context.fillStyle = css(this.theme.ink);
    pen.draw(text, x > -wide && x < this.width + wide ? left : x - align * wide, y + 0.36 * font * unit, font * unit);
  }
  private edge(a: number, b: number, alpha: number) {
    const pane = (corner: number) => toPane(this.look.unit, this.height, this.at(corner).place);
    this.line(pane(a), pane(b), alpha, 1.4);
  }

  drawBehind() {
    this.pen.context.lineCap = "round";
    this.eachEdge((a, b) => {
      const hidden = a === this.farthest || b === this.farthest;
      if (a !== this.nearest && b !== this.nearest) this.edge(a, b, hidden ? 0.22 : 0.5);
    });
  }

  drawBefore() {
    this.eachEdge((a, b) => {
      if (a === this.nearest || b === this.nearest) this.edge(a, b, 0.22);
    });
  }

  nameAxes() {
    const { space, unit } = this;
    const { size } = space.ranges();
    const origin = toPane(this.look.unit, this.height, [0, 0, 0]);
    const per = this.look.perUnit;
    // Right and up of the camera, in unit coordinates, as pixels of the pane.
    const pane = (right: number, up: number) => [origin[0] + right * per, origin[1] - up * per] as const;
    space.axes.forEach((axis, along) => {
      // The silhouette's edges along an axis are those without the nearest and farthest corner. The names of x and y
      // are at the lower of them, that of z at the left one.
      let best: [Corner, Corner] | undefined;
      let lowest = Infinity;
      this.eachEdge((i, j, direction) => {
        if (direction !== along || [i, j].some((c) => c === this.nearest || c === this.farthest)) return;
        const [a, b] = [this.at(i), this.at(j)];
        const rank = along === 2 ? a.right + b.right : a.up + b.up;
        if (rank < lowest - 1e-12 * size) {
          lowest = rank;
          best = [a, b];
        }
      });
      if (!best) return;
      const [a, b] = best;
      const length = Math.hypot(b.right - a.right, b.up - a.up);
      const pixels = length * per;
      if (pixels < 80 * unit) return; // parallel to the direction of view, or thin
      let outRight = (b.up - a.up) / length;
      let outUp = -(b.right - a.right) / length;
      if (outRight * (a.right + b.right) + outUp * (a.up + b.up) < 0) {
        outRight = -outRight;
        outUp = -outUp;
      }
      // away: distance from the edge, in pixels of a picture's texts.
      const edgeAt = (fraction: number, away: number) =>
        pane(
          a.right + fraction * (b.right - a.right) + ((away * unit) / per) * outRight,
          a.up + fraction * (b.up - a.up) + ((away * unit) / per) * outUp,
        );
      const align = 0.5 - 0.5 * Math.min(Math.max(4 * outRight, -1), 1);
      const write = (fraction: number, away: number, text: string, font: number) => {
        const [x, y] = edgeAt(fraction, away);
        this.write(text, x, y, font, align);
      };
      const most = Math.max(
        2,
        Math.min(Math.max(5, Math.floor(pixels / (170 * unit))), Math.floor(pixels / (45 * unit))),
      );
      const ticks = ticksBetween(axis.low * axis.factor, axis.high * axis.factor, false, most);
      ticks.major.forEach((tick, i) => {
        const fraction = (tick / axis.factor - axis.low) / (axis.high - axis.low);
        this.line(edgeAt(fraction, 0), edgeAt(fraction, 8), 0.6, 1.3);
        write(fraction, 24, ticks.labels[i] ?? "", 18);
      });
      const units = [ticks.multiplier, axis.unit].filter(Boolean).join(" ");
      const name = axis.label + (units ? ` (${units})` : "");
      if (along === 2) {
        // Above the upper end, where it needs no extra margin.
        const top = a.up > b.up ? a : b;
        const [x, y] = pane(top.right, top.up + (34 * unit) / per);
        this.write(name, x, y, 21, 0.85);
      } else {
        // Beyond the numbers at the ticks.
        const widest = Math.max(0, ...ticks.labels.map((label) => this.pen.width(label, 18)));
        write(0.5, 34 + Math.abs(outRight) * widest + Math.abs(outUp) * 18, name, 21);
      }
    });
  }
}
