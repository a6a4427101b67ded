// Reads the page's data: JSON with arrays as base64 of little-endian integers (kfmaps.viz.pack).

const TYPES = { uint8: Uint8Array, uint16: Uint16Array, uint32: Uint32Array };

function bytes(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const text = atob(base64);
  const out = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) out[i] = text.charCodeAt(i);
  return out;
}

/** The whole numbers of a record. */
export function numbers(record) {
  return new TYPES[record.type](bytes(record.base64).buffer);
}

/** The real numbers of a quantised record; the code 65535 is "not known" and becomes NaN. */
export function reals(record) {
  const codes = numbers(record);
  const out = new Float32Array(codes.length);
  for (let i = 0; i < codes.length; i++) out[i] = codes[i] === 65535 ? NaN : record.low + record.step * codes[i];
  return out;
}

export function pageData() {
  return JSON.parse(document.getElementById("data").textContent);
}

/** At most `digits` significant digits, in the plainest form. */
export function short(value, digits = 4) {
  if (typeof value !== "number") return String(value);
  if (Number.isInteger(value) && Math.abs(value) < 1e7) return String(value);
  if (!Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  if (size < 1e-3 || size >= 1e6) return value.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e");
  return String(Number(value.toPrecision(digits)));
}

/** An element with text, never markup. */
export function element(tag, text, attributes = {}) {
  const made = document.createElement(tag);
  if (text !== undefined && text !== null) made.textContent = text;
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}
