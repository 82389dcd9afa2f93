// Curves, texts and images of a canvas, drawn with the 2D context.
import type { Curve, Image, Texts } from "../protocol";
import { toPane, type Look } from "./look";
import { Pen } from "./text";
import { css, parse, shown, unpacked, type Theme } from "./theme";

interface Node {
  x: number;
  y: number;
}

/** Reduces many nodes within half a pixel in x to the first, lowest, highest and last. */
function reduced(nodes: Node[]): Node[] {
  const kept: Node[] = [];
  for (let begin = 0, end = 0; begin < nodes.length; begin = end) {
    const column = Math.floor(2 * (nodes[begin] as Node).x);
    let low = begin;
    let high = begin;
    for (; end < nodes.length && Math.floor(2 * (nodes[end] as Node).x) === column; ++end) {
      if ((nodes[end] as Node).y < (nodes[low] as Node).y) low = end;
      if ((nodes[end] as Node).y > (nodes[high] as Node).y) high = end;
    }
    if (end - begin <= 4) kept.push(...nodes.slice(begin, end));
    else for (const i of [begin, Math.min(low, high), Math.max(low, high), end - 1]) kept.push(nodes[i] as Node);
  }
  return kept;
}

export function drawCurve(curve: Curve, look: Look, pen: Pen, theme: Theme, unit: number, height: number) {
  const { context } = pen;
  const width = curve.width * unit;
  context.strokeStyle = context.fillStyle = css(shown(parse(curve.colour), theme));
  context.lineWidth = width;
  context.lineJoin = "round";
  context.lineCap = curve.dashed ? "butt" : "round";
  const dash = (5 + 2.5 * curve.width) * unit;
  context.setLineDash(curve.dashed ? [dash, 0.75 * dash] : []);
  let stretch: Node[] = [];
  const finish = () => {
    const [first] = stretch;
    context.beginPath();
    if (first && stretch.length === 1) {
      context.arc(first.x, first.y, 1.2 * width, 0, 7);
      context.fill();
    } else {
      for (const node of reduced(stretch)) context.lineTo(node.x, node.y);
      context.stroke();
    }
    stretch = [];
  };
  for (let i = 0; i < curve.x.length; ++i) {
    const [x, y] = toPane(look.unit, height, [curve.x[i] as number, curve.y[i] as number, curve.z?.[i] ?? 0]);
    if (isFinite(x) && isFinite(y)) stretch.push({ x, y });
    else finish();
  }
  finish();
  context.setLineDash([]);
}

export function drawTexts(texts: Texts, look: Look, pen: Pen, theme: Theme, unit: number, height: number) {
  texts.texts.forEach((text, k) => {
    const [x = 0, y = 0, z = 0, size = 20, align = 0.5] = texts.data.subarray(5 * k, 5 * k + 5);
    const at = toPane(look.unit, height, [x, y, z]);
    pen.context.fillStyle = css(shown(unpacked(texts.colours[k] ?? 0), theme));
    pen.draw(text, at[0], at[1] + 0.36 * size * unit, size * unit, align);
  });
}

const pictures = new WeakMap<Image, HTMLCanvasElement>();

export function drawImage(image: Image, look: Look, context: CanvasRenderingContext2D, height: number) {
  if (!image.columns || !image.rows) return;
  let picture = pictures.get(image);
  if (!picture) {
    picture = document.createElement("canvas");
    picture.width = image.columns;
    picture.height = image.rows;
    const bytes = new Uint8ClampedArray(image.pixels);
    picture.getContext("2d")?.putImageData(new ImageData(bytes, image.columns, image.rows), 0, 0);
    pictures.set(image, picture);
  }
  const corner = (x: number, y: number) => toPane(look.unit, height, [x, y, 0]);
  const first = corner(image.x0, image.y0);
  const across = corner(image.x1, image.y0);
  const along = corner(image.x0, image.y1);
  context.save();
  context.transform(
    (across[0] - first[0]) / image.columns,
    (across[1] - first[1]) / image.columns,
    (along[0] - first[0]) / image.rows,
    (along[1] - first[1]) / image.rows,
    first[0],
    first[1],
  );
  context.imageSmoothingEnabled = false;
  context.drawImage(picture, 0, 0);
  context.restore();
}
