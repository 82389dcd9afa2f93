// Ticks: steps of 1, 2, 5 times a power of ten, and labels as short as possible. The same as in
// boltzmann/pictures/canvas_ticks.cpp; tests/pictures/ticks.json tests both.

export interface Ticks {
  major: number[];
  minor: number[];
  /** One per major tick. */
  labels: string[];
  /** The factor (and offset) common to all labels, "×10^{−8}"; may be empty. */
  multiplier: string;
  exponent: number;
}

const minus = "\u2212";
const signed = (text: string) => text.replace("-", minus);
const power = (exponent: number) => `\u00d710^{${signed(String(exponent))}}`;
const scaled = (units: number, exponent: number) => (exponent < 0 ? units / 10 ** -exponent : units * 10 ** exponent);

/** units * 10^exponent as exact text: "1.25", "−3400", "1.25×10^{−12}". */
function exactText(units: number, exponent: number): string {
  if (units === 0) return "0";
  while (units % 10 === 0) {
    units /= 10;
    ++exponent;
  }
  const digits = String(Math.abs(units));
  const sign = units < 0 ? minus : "";
  const before = digits.length + exponent;
  const split = (at: number) => (at === digits.length ? digits : digits.slice(0, at) + "." + digits.slice(at));
  if (exponent >= 0 && before <= 7) return sign + digits + "0".repeat(exponent);
  if (exponent < 0 && before > 0) return sign + split(before);
  if (exponent < 0 && before > -3) return sign + "0." + "0".repeat(-before) + digits;
  return sign + split(1) + power(before - 1);
}

/** The step is mantissa * 10^exponent; ticks are its multiples first..last. */
function stepFor(low: number, high: number, most: number) {
  for (let exponent = Math.floor(Math.log10((high - low) / most)); ; ++exponent)
    for (const mantissa of [1, 2, 5]) {
      const step = scaled(mantissa, exponent);
      const slack = (1e-9 * (high - low)) / step;
      const first = Math.ceil(low / step - slack);
      const last = Math.floor(high / step + slack);
      if (last - first + 1 <= most) return { mantissa, first, last, exponent };
    }
}

function linearTicks(low: number, high: number, most: number, atMostExponent: number): Ticks {
  const { mantissa, first, last, exponent } = stepFor(low, high, most);
  const ticks: Ticks = { major: [], minor: [], labels: [], multiplier: "", exponent: 0 };
  const units: number[] = [];
  for (let i = first; i <= last; ++i) units.push(i * mantissa);
  ticks.major = units.map((u) => scaled(u, exponent));

  const parts = mantissa === 2 ? 4 : 5;
  const slack = 1e-9 * (high - low);
  for (let i = (first - 1) * parts; i <= (last + 1) * parts; ++i) {
    const at = scaled((i * mantissa) / parts, exponent);
    if (i % parts !== 0 && at >= low - slack && at <= high + slack) ticks.minor.push(at);
  }

  const largest = Math.max(Math.abs(first), Math.abs(last)) * mantissa;
  if (largest >= 100000) {
    // Too many digits: the common part of all ticks is written once.
    const middle = Math.trunc((first + last) / 2) * mantissa;
    const shared = Math.trunc((middle + (middle < 0 ? -50 : 50)) / 100) * 100;
    ticks.labels = units.map((u) => signed(String(u - shared)));
    ticks.exponent = exponent;
    ticks.multiplier =
      (exponent !== 0 ? power(exponent) + " " : "") +
      (shared < 0 ? minus : "+") +
      " " +
      exactText(Math.abs(shared), exponent);
    return ticks;
  }
  const largestValue = scaled(largest, exponent);
  const plain = largest === 0 || (largestValue < 1e4 && largestValue >= 0.0099);
  if (!plain) {
    ticks.exponent = Math.min(Math.max(atMostExponent, exponent - 3), exponent);
    ticks.multiplier = power(ticks.exponent);
  }
  const zeros = Math.round(10 ** (exponent - ticks.exponent));
  ticks.labels = units.map((u) =>
    signed(
      !plain
        ? String(u * zeros + 0)
        : exponent < 0
          ? (scaled(u, exponent) + 0).toFixed(-exponent)
          : String(scaled(u, exponent) + 0),
    ),
  );
  return ticks;
}

function logarithmicTicks(low: number, high: number, most: number): Ticks {
  const bottom = Math.log10(low);
  const top = Math.log10(high);
  const first = Math.ceil(bottom - 1e-9);
  const last = Math.floor(top + 1e-9);
  const below = Math.floor(bottom);
  const inside = (v: number) => v >= low * (1 - 1e-9) && v <= high * (1 + 1e-9);
  const ticks: Ticks = { major: [], minor: [], labels: [], multiplier: "", exponent: 0 };
  if (last - first >= 2 || (last - first === 1 && top - bottom > 1.6)) {
    const stride =
      [1, 2, 3, 5, 10, 20, 30, 50, 100, 200].find((s) => Math.floor((last - first) / s) + 1 <= most) ?? 200;
    for (let n = first; n <= last; ++n) {
      const major = n % stride === 0;
      (major ? ticks.major : ticks.minor).push(scaled(1, n));
      if (major) ticks.labels.push(`10^{${signed(String(n))}}`);
    }
    if (stride === 1)
      for (let n = below; n <= last; ++n)
        for (let m = 2; m <= 9; ++m) if (inside(scaled(m, n))) ticks.minor.push(scaled(m, n));
    return ticks;
  }
  for (let n = below; n <= last; ++n)
    for (let m = 1; m <= 9; ++m) {
      const at = scaled(m, n);
      if (!inside(at)) continue;
      const major = m === 1 || m === 2 || m === 5;
      (major ? ticks.major : ticks.minor).push(at);
      if (major) ticks.labels.push(exactText(m, n));
    }
  if (ticks.major.length < 3 || ticks.major.length > most) return linearTicks(low, high, most, 400);
  return ticks;
}

/** At most `most` (>= 2) major ticks inside low..high; none if the range is invalid. */
export function ticksBetween(low: number, high: number, logarithmic = false, most = 8, atMostExponent = 400): Ticks {
  if (!(low < high) || !isFinite(high - low) || (logarithmic && low <= 0))
    return { major: [], minor: [], labels: [], multiplier: "", exponent: 0 };
  most = Math.max(most, 2);
  return logarithmic ? logarithmicTicks(low, high, most) : linearTicks(low, high, most, atMostExponent);
}

/** A number in a few characters of markup: "0.25", "3200", "−1.6×10^{−19}". */
export function numberText(value: number, digits = 3): string {
  if (!isFinite(value)) return isNaN(value) ? "not a number" : value < 0 ? minus + "∞" : "∞";
  const [mantissa = "0", exponent = "0"] = value.toExponential(digits - 1).split("e");
  return exactText(Number(mantissa.replace(".", "")), Number(exponent) - digits + 1);
}
