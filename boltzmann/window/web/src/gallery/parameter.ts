// A parameter of a scenario: conversion between its field and TOML, and validation.
import { elements, isNumber, quoted, scalar, unquoted } from "./toml";

export interface Parameter {
  /** As in `bzm run --set`: "ensembles.atoms.mass". */
  path: string;
  group: string;
  name: string;
  kind: "quantity" | "integer" | "number" | "word" | "boolean" | "text" | "vector" | "any";
  /** As TOML; for an absent key its default, or "" if `otherwise` describes it. */
  value: string;
  /** The display unit of the simulation, also of the limits here; "" for pure numbers. */
  unit: string;
  /** Possible units. */
  units: string[];
  /** Limits in `unit`. */
  low: number | null;
  high: number | null;
  low_excluded: boolean;
  /** Allowed words; empty: any text. */
  words: string[];
  comment: string;
  /** The description. */
  doc: string;
  /** For an absent key: the behaviour without it. */
  otherwise: string;
}

/** The display form of the TOML value. */
export function shown({ kind, value }: Parameter): string {
  if (kind === "vector") return elements(value)?.join(", ") ?? value;
  return unquoted(value) ?? value;
}

/** The user's input as TOML. */
export function typed({ kind, value }: Parameter, text: string): string {
  switch (kind) {
    case "boolean":
    case "any": // TOML, and what is none is a text
      return text.trim();
    case "word":
    case "text":
      return quoted(text);
    case "vector": {
      // An array of arrays is displayed and typed as TOML.
      if ((value !== "" && elements(value) === null) || /^\s*\[\s*\[/.test(text)) return text;
      const inside = text.trim().replace(/^\[([^]*)\]$/, "$1").trim();
      const parts = inside === "" ? [] : inside.split(",").map((part) => part.trim().replace(/^(["'])([^]*)\1$/, "$2"));
      return `[${parts.map(scalar).join(", ")}]`;
    }
    default:
      return scalar(text);
  }
}

/** "0.5" followed by the parameter's unit. */
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

/** A number and its unit; nothing if the text is something else. */
function measure(text: string): { number: number; unit: string } | null {
  const parts = /^([+-]?(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(\S.*)?$/.exec(text.trim());
  return parts && { number: Number(parts[1].replace(/_/g, "")), unit: parts[2] ?? "" };
}

/**
 * Errors that the page can detect immediately. The window checks the rest: units, and words that depend on other
 * values.
 */
export function wrong(parameter: Parameter, text: string): string {
  const { kind, low, high, low_excluded, unit } = parameter;
  if (!["quantity", "integer", "number"].includes(kind)) return "";
  if (text.trim() === "") return ""; // left out: the window knows whether it is needed
  const found = measure(text);
  if (!found) return kind === "quantity" ? "" : "a number is needed"; // a quantity may be a formula
  if (kind !== "quantity" && (found.unit || !isNumber(scalar(text)))) return "a number without a unit is needed";
  if (kind === "integer" && !Number.isInteger(found.number)) return "a whole number is needed";
  // A limit of 0 applies in any unit; other limits only in their own unit, not for numbers in the simulation's base.
  const same = kind !== "quantity" || unit === "" || found.unit === unit;
  const below = low !== null && (same || low === 0) && (low_excluded ? found.number <= low : found.number < low);
  const above = high !== null && (same || high === 0) && found.number > high;
  return below || above ? `allowed: ${limits(parameter)}` : "";
}
