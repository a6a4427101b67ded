// The residual curve: a small SVG with a logarithmic axis.
import { short } from "./data.js";

const NS = "http://www.w3.org/2000/svg";

function add(parent, tag, attributes, text) {
  const made = document.createElementNS(NS, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  if (text !== undefined) made.textContent = text;
  parent.append(made);
  return made;
}

/** About `count` whole numbers from 0 to `last`, at equal round steps. */
function steps(last, count) {
  const raw = Math.max(last / count, 1);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= raw);
  const out = [];
  for (let x = 0; x <= last; x += step) out.push(x);
  return out;
}

/** A drawing of positive `values` over their number; values that are not positive are left out. */
export function logCurve(values, { x, y }) {
  const points = values.map((v, i) => [i, Number(v)]).filter(([, v]) => v > 0 && Number.isFinite(v));
  if (points.length < 2) return null;
  const [width, height, left, right, top, bottom] = [420, 240, 62, 14, 12, 44];
  const logs = points.map(([, v]) => Math.log10(v));
  let low = Math.floor(Math.min(...logs)), high = Math.ceil(Math.max(...logs));
  if (low === high) high += 1;
  const last = values.length - 1;
  const px = (i) => left + (i / last) * (width - left - right);
  const py = (log) => top + ((high - log) / (high - low)) * (height - top - bottom);
  const svg = document.createElementNS(NS, "svg");
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.setAttribute("class", "chart");
  svg.setAttribute("role", "img");
  const [first, end] = [points[0][1], points[points.length - 1][1]];
  svg.setAttribute("aria-label", `${y} against ${x}: from ${short(first)} to ${short(end)} in ${last} steps`);
  const every = Math.ceil((high - low) / 6);
  for (let d = high; d >= low; d -= every) {
    add(svg, "line", { x1: left, x2: width - right, y1: py(d), y2: py(d), class: "grid" });
    const label = add(svg, "text", { x: left - 8, y: py(d) + 4, "text-anchor": "end" }, "10");
    add(label, "tspan", { dy: -5, "font-size": 9 }, String(d).replace("-", "−"));
  }
  for (const i of steps(last, 6)) {
    add(svg, "line", { x1: px(i), x2: px(i), y1: height - bottom, y2: height - bottom + 4, class: "axis" });
    add(svg, "text", { x: px(i), y: height - bottom + 17, "text-anchor": "middle" }, String(i));
  }
  add(svg, "polyline", { points: `${left},${top} ${left},${height - bottom} ${width - right},${height - bottom}`, class: "axis" });
  add(svg, "polyline", { points: points.map(([i, v]) => `${px(i).toFixed(1)},${py(Math.log10(v)).toFixed(1)}`).join(" "), class: "curve" });
  add(svg, "text", { x: (left + width - right) / 2, y: height - 8, "text-anchor": "middle" }, x);
  const middle = (top + height - bottom) / 2;
  add(svg, "text", { x: 16, y: middle, "text-anchor": "middle", transform: `rotate(-90 16 ${middle})` }, y);
  return svg;
}
