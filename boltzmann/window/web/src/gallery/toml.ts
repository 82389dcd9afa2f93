// Conversion of values between TOML and a form, which omits quotes and brackets.

const escapes: Record<string, string> = { b: "\b", t: "\t", n: "\n", f: "\f", r: "\r", '"': '"', "\\": "\\" };

/** "7.6 angstrom" for the TOML text '"7.6 angstrom"' or "'7.6 angstrom'"; null if it is not a single text. */
export function unquoted(toml: string): string | null {
  const literal = /^'([^']*)'$/.exec(toml) ?? /^'''\n?([^]*)'''$/.exec(toml);
  if (literal) return literal[1];
  const basic = /^"""\n?([^]*)"""$/.exec(toml) ?? /^"((?:[^"\\\n]|\\.)*)"$/.exec(toml);
  if (!basic) return null;
  return basic[1].replace(/\\(?:u([0-9a-fA-F]{4})|U([0-9a-fA-F]{8})|\n\s*|(.))/g, (_all, short, long, one) => {
    const code = (short ?? long) as string | undefined;
    if (code) return String.fromCodePoint(parseInt(code, 16));
    return one ? (escapes[one as string] ?? (one as string)) : "";
  });
}

/** A text as TOML. */
export function quoted(text: string): string {
  return JSON.stringify(text).replace(/\u007f/g, "\\u007F");
}

const number = /^[+-]?(?:\d[\d_]*(?:\.\d[\d_]*)?(?:[eE][+-]?\d+)?|inf|nan)$/;
/** True if it is a TOML number. */
export function isNumber(text: string): boolean {
  return number.test(text);
}

/** A number unchanged, with ".5" and "5." completed; anything else becomes a text: "2 fs". */
export function scalar(text: string): string {
  const trimmed = text.trim();
  const whole = trimmed.replace(/^([+-]?)\./, "$10.").replace(/^([+-]?\d+)\.(?=$|[eE])/, "$1.0");
  if (isNumber(whole)) return whole.replace(/^([+-]?)0+(?=\d)/, "$1");
  return quoted(trimmed);
}

/** The elements of a flat array, without quotes; null if it is not such an array. */
export function elements(toml: string): string[] | null {
  const inside = /^\[([^]*)\]$/.exec(toml.trim());
  if (!inside) return null;
  const found: string[] = [];
  let rest = inside[1].trim();
  while (rest !== "") {
    const one = /^("(?:[^"\\\n]|\\.)*"|'[^'\n]*'|[^,"'[\]{}#]+)\s*(?:,\s*|$)/.exec(rest);
    if (!one) return null;
    const text = one[1].trim();
    found.push(unquoted(text) ?? text);
    rest = rest.slice(one[0].length);
  }
  return found;
}
