// A parameter of a scenario: what its field shows, what a user has typed as TOML, and what is wrong with it.
import { elements, isNumber, quoted, scalar, unquoted } from "./toml";

export interface Parameter {
  /** As `bzm run --set` takes it: "ensembles.atoms.mass". */
  path: string;
  group: string;
  name: string;
  kind: "quantity" | "integer" | "number" | "word" | "boolean" | "text" | "vector" | "any";
  /** As TOML; of a key that is absent its default, "" where `otherwise` says it. */
  value: string;
  /** What the simulation shows such a quantity in, and its limits here; "" for pure numbers. */
  unit: string;
  /** Some units that it may be given in. */
  units: string[];
  /** Limits in `unit`. */
  low: number | null;
  high: number | null;
  low_excluded: boolean;
  /** Allowed words; empty: any text. */
  words: string[];
  comment: string;
  /** What it means. */
  doc: string;
  /** Of a key that is absent: what holds without it. */
  otherwise: string;
}

/** The TOML value as a field shows it. */
export function shown({ kind, value }: Parameter): string {
  if (kind === "vector") return elements(value)?.join(", ") ?? value;
  return unquoted(value) ?? value;
}

/** What a user has typed, as TOML. */
export function typed({ kind, value }: Parameter, text: string): string {
  switch (kind) {
    case "boolean":
    case "any": // TOML, and what is none is a text
      return text.trim();
    case "word":
    case "text":
      return quoted(text);
    case "vector": {
      // An array of arrays is shown and typed as TOML.
      if ((value !== "" && elements(value) === null) || /^\s*\[\s*\[/.test(text)) return text;
      const inside = text.trim().replace(/^\[([^]*)\]$/, "$1").trim();
      const parts = inside === "" ? [] : inside.split(",").map((part) => part.trim().replace(/^(["'])([^]*)\1$/, "$2"));
      return `[${parts.map(scalar).join(", ")}]`;
    }
    default:
      return scalar(text);
  }
}

/** "0.5" with the parameter's unit behind it. */
function measured(value: number, { unit }: Parameter): string {
  return unit ? `${readable(value)} ${unit}` : readable(value);
}

/** 1000000000 as "1,000,000,000", 1e-30 as it is. */
function readable(value: number): string {
  return Number.isInteger(value) && Math.abs(value) < 1e15 ? value.toLocaleString("en-US") : String(value);
}

/** The limits in words: "above 0", "from 0 to 1 nm"; empty if there are none. */
export function limits(parameter: Parameter): string {
  const { low, high, low_excluded } = parameter;
  if (low === null && high === null) return "";
  if (high === null) return `${low_excluded ? "above" : "at least"} ${low === 0 ? "0" : measured(low!, parameter)}`;
  if (low === null) return `at most ${measured(high, parameter)}`;
  return `${low_excluded ? "above" : "from"} ${readable(low)} ${low_excluded ? "and at most" : "to"} ${measured(high, parameter)}`;
}

/** A number and the unit behind it; nothing if the text is something else. */
function measure(text: string): { number: number; unit: string } | null {
  const parts = /^([+-]?(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(\S.*)?$/.exec(text.trim());
  return parts && { number: Number(parts[1].replace(/_/g, "")), unit: parts[2] ?? "" };
}

/** What the page itself sees to be wrong with a text, at once; the window knows the rest: units, words that depend. */
export function wrong(parameter: Parameter, text: string): string {
  const { kind, low, high, low_excluded, unit } = parameter;
  if (!["quantity", "integer", "number"].includes(kind)) return "";
  if (text.trim() === "") return ""; // left out: the window knows whether it is needed
  const found = measure(text);
  if (!found) return kind === "quantity" ? "" : "a number is needed"; // a quantity may be a formula
  if (kind !== "quantity" && (found.unit || !isNumber(scalar(text)))) return "a number without a unit is needed";
  if (kind === "integer" && !Number.isInteger(found.number)) return "a whole number is needed";
  // A limit of 0 holds in any unit; another one only in the unit that it is in, not in numbers of the simulation's base.
  const same = kind !== "quantity" || unit === "" || found.unit === unit;
  const below = low !== null && (same || low === 0) && (low_excluded ? found.number <= low : found.number < low);
  const above = high !== null && (same || high === 0) && found.number > high;
  return below || above ? `allowed: ${limits(parameter)}` : "";
}
