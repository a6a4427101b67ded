// Colour scales. Stops are sRGB, spaced evenly; colours between two stops are mixed linearly.

const hex = (text) => text.split(" ").map((c) => [0, 2, 4].map((i) => parseInt(c.slice(i, i + 2), 16)));

/** Least to greatest: viridis. */
const SEQUENTIAL = hex("440154 482878 3e4a89 31688e 26828e 1f9e89 35b779 6ece58 b5de2b fde725");
/** White through red to dark, for errors; the same as kfmaps.viz.ERROR_MAP. */
const ERROR = hex("ffffff fde0c5 f7a17a e0503f a5142f 560723");
/** Blue through near-white to red, for signed numbers. */
const DIVERGING = hex("053061 2166ac 4393c3 92c5de d1e5f0 f7f7f7 fddbc7 f4a582 d6604d b2182b 67001f");

export const SCALES = { sequential: SEQUENTIAL, error: ERROR, diverging: DIVERGING };
/** For "not known". */
export const UNKNOWN = [190, 192, 196];
/** The plain surface. */
export const PLAIN = [208, 211, 216];

/** The colour, [r, g, b] up to 255, at `t` in [0, 1]. */
export function at(scale, t) {
  if (!(t === t)) return UNKNOWN;
  const stops = SCALES[scale];
  const x = Math.min(Math.max(t, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(x), stops.length - 2);
  const f = x - i;
  return [0, 1, 2].map((c) => stops[i][c] * (1 - f) + stops[i + 1][c] * f);
}

/** Colours of `values` on [low, high], three bytes each. */
export function painted(values, scale, low, high) {
  const table = Array.from({ length: 256 }, (_, i) => at(scale, i / 255));
  const out = new Uint8Array(3 * values.length);
  const span = high - low || 1;
  for (let i = 0; i < values.length; i++) {
    const t = (values[i] - low) / span;
    const colour = t === t ? table[Math.round(255 * Math.min(Math.max(t, 0), 1))] : UNKNOWN;
    out.set(colour, 3 * i);
  }
  return out;
}

export function plain(count) {
  const out = new Uint8Array(3 * count);
  for (let i = 0; i < count; i++) out.set(PLAIN, 3 * i);
  return out;
}

/** The value below which a part `q` of the known values lies. */
export function quantile(values, q) {
  const known = Float32Array.from(values.filter((v) => v === v)).sort();
  return known.length ? known[Math.min(known.length - 1, Math.floor(q * known.length))] : NaN;
}

/** The smallest of 1, 2, 2.5, 5 times a power of ten that is not below `value`. */
export function roundedUp(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 2.5, 5, 10].map((m) => m * power).find((v) => v >= value * (1 - 1e-9));
}

/** Draws the scale from left to right over a canvas. */
export function drawBar(canvas, scale) {
  const pen = canvas.getContext("2d");
  for (let x = 0; x < canvas.width; x++) {
    const [r, g, b] = at(scale, x / (canvas.width - 1));
    pen.fillStyle = `rgb(${Math.round(r)},${Math.round(g)},${Math.round(b)})`;
    pen.fillRect(x, 0, 1, canvas.height);
  }
}

/** A colour for pair number `i`: ten that differ well in hue and lightness, then over again. */
const PAIRS = ["#1f5fbf", "#c2410c", "#15803d", "#a21caf", "#b45309", "#0e7490", "#b91c1c", "#4d7c0f", "#6d28d9", "#9d174d"];
export const pairColour = (i) => PAIRS[i % PAIRS.length];
