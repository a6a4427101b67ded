// What is said of a run: energies, times, settings, residuals. All of it is text, whatever it holds.
import { logCurve } from "./chart.js";
import { element, short } from "./data.js";

const isRecord = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

/** Rows [name, value] of nested mappings, names joined by dots. */
function rowsOf(value, name = "") {
  if (!isRecord(value)) return [[name, value]];
  return Object.entries(value).flatMap(([key, inner]) => rowsOf(inner, name ? `${name}.${key}` : key));
}

function said(value) {
  if (value === null || value === undefined) return "–";
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (Array.isArray(value)) {
    const shown = value.slice(0, 12).map(said).join(", ");
    return value.length > 12 ? `${shown}, … (${value.length})` : shown;
  }
  return isRecord(value) ? JSON.stringify(value) : short(value);
}

function table(caption, rows, { heads = null, bars = false } = {}) {
  const made = element("table");
  made.append(element("caption", caption, { class: "unseen" }));
  if (heads) {
    const head = made.createTHead().insertRow();
    heads.forEach((text) => head.append(element("th", text, { scope: "col" })));
  }
  const body = made.createTBody();
  const most = Math.max(...rows.map(([, v]) => (typeof v === "number" ? v : 0)), 1e-300);
  for (const [name, value] of rows) {
    const row = body.insertRow();
    row.append(element("th", name.replaceAll("_", " "), { scope: "row" }));
    const cell = element("td", said(value), typeof value === "number" ? { class: "number" } : {});
    row.append(cell);
    if (!bars) continue;
    const bar = element("div", null, { class: "bar-of-row", "aria-hidden": "true" });
    bar.style.width = `${Math.max(0, Math.min(1, value / most)) * 100}%`;
    const place = element("td", null, { class: "bar-cell" });
    place.append(bar);
    row.append(place);
  }
  return made;
}

function put(id, ...content) {
  const place = document.getElementById(id);
  place.append(...content);
  document.getElementById(`${id}-card`).hidden = false;
}

export function showSummary(summary) {
  const { settings, energies, residuals, times, ...other } = summary;
  if (Array.isArray(residuals)) {
    const curve = logCurve(residuals, { x: "step", y: "relative residual" });
    if (curve) put("residuals", curve);
  }
  if (isRecord(energies) && Object.keys(energies).length) put("energies", table("Energies", rowsOf(energies), { bars: true }));
  if (isRecord(times) && Object.keys(times).length) {
    const rows = rowsOf(times);
    const total = rows.reduce((sum, [, v]) => sum + (typeof v === "number" ? v : 0), 0);
    put("times", table("Times in seconds", rows, { heads: ["Stage", "Seconds", ""], bars: true }),
      element("p", `${short(total, 3)} s in all`, { class: "hint" }));
  }
  if (Object.keys(other).length) put("other", table("Run", rowsOf(other)));
  if (isRecord(settings) && Object.keys(settings).length) put("settings", table("Settings", rowsOf(settings)));
}
