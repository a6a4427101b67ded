// What the page of a result and the landmark picker share: two shapes on a stage and the tools around them.
import { Matrix4, Quaternion } from "three";
import { drawBar } from "./colours.js";
import { element, short } from "./data.js";
import { savePicture } from "./picture.js";
import { Stage } from "./stage.js";
import { Surface } from "./surface.js";

/** The one unit of distances and errors; what the page computes is in √area. */
export const UNIT = "% of √area";
export const percent = (value, digits = 3) => short(100 * value, digits);

export const share = (value) => `${Math.round(100 * value)} %`;

/** A probability in words: neither 0 nor 100 %, which nothing is. */
const probability = (p) => (p > 0.99 ? ">99 %" : p < 0.01 ? "<1 %" : share(p));

/** What the legend says of the local fit. */
export const LOCAL_FIT = "local fit: how well distances to the surroundings are kept";
export const SIDES = ["source", "target"];
export const byId = (id) => document.getElementById(id);

/** Puts both shapes on the stage and their names on the page. */
export function setUp(data) {
  const shapes = SIDES.map((side) => new Surface(data[side]));
  const names = shapes.map((s) => s.name);
  SIDES.forEach((side, i) => {
    byId(`name-${side}`).textContent = names[i];
    byId(`title-${side}`).textContent = `${names[i]} (${side}, ${shapes[i].count} vertices)`;
    byId(`view-${side}`).setAttribute("aria-label", `3D view of the ${side}, ${names[i]}`);
  });
  const stage = new Stage(byId("stage"), shapes, SIDES.map((side) => byId(`view-${side}`)));
  byId("up").value = data.up;
  byId("spin").setAttribute("aria-pressed", "false");
  byId("linked").addEventListener("change", () => { stage.linked = byId("linked").checked; });
  return { shapes, names, stage };
}

/** The rotation of nine numbers, row by row. */
export function rotationOf(r) {
  const turn = new Matrix4().set(r[0], r[1], r[2], 0, r[3], r[4], r[5], 0, r[6], r[7], r[8], 0, 0, 0, 0, 1);
  return new Quaternion().setFromRotationMatrix(turn);
}

/**
 * Where the views begin: a good side of the source, and the same side of the body on the target, as the shapes
 * themselves say (`views` as kfmaps.viz.page.views_record makes it); `aligned()` is a rotation of the target onto the
 * source to be taken instead, or null. Returns what turns the views back.
 */
export function viewTools(stage, views, aligned = () => null) {
  const frame = rotationOf(views.frame);
  const back = rotationOf(views.turn).invert();
  const reset = () => stage.reset(byId("up").value, frame, [null, aligned() ?? back]);
  byId("up").addEventListener("change", reset);
  byId("reset").addEventListener("click", reset);
  byId("spin").addEventListener("click", () => {
    const on = byId("spin").getAttribute("aria-pressed") !== "true";
    byId("spin").setAttribute("aria-pressed", on);
    stage.spin(on);
  });
  reset();
  return reset;
}

/** A vertex number that was typed: the vertex, or null where the shape has no such vertex, which is then said. */
export function typedVertex(box, count, side) {
  const vertex = Number(box.value);
  const fits = box.value !== "" && Number.isInteger(vertex) && vertex >= 0 && vertex < count;
  const wrong = fits || box.value === "" ? "" : `The ${side} has no vertex ${box.value}: they go from 0 to ${count - 1}.`;
  box.setAttribute("aria-invalid", wrong !== "");
  say(wrong);
  return fits ? vertex : null;
}

/** One radio button for each of `modes` (value: text). */
export function modeButtons(modes, first, choose) {
  for (const [mode, text] of Object.entries(modes)) {
    const label = element("label");
    const radio = element("input", null, { type: "radio", name: "mode", value: mode });
    radio.checked = mode === first;
    radio.addEventListener("change", () => choose(mode));
    label.append(radio, element("span", text));
    byId("modes").append(label);
  }
}

/** The line under the stage that says what the colours mean; also what a saved picture says. */
export class Legend {
  constructor(stage, names) {
    this.now = {};
    byId("picture").addEventListener("click", () => savePicture(stage, names, this.now));
  }

  /** `legend`: text and, for a scale, its name, low and high. */
  show(legend) {
    this.now = legend;
    byId("legend").hidden = !legend.text;
    byId("legend").classList.toggle("wordy", !legend.scale);
    if (legend.scale) drawBar(byId("legend-bar"), legend.scale);
    byId("legend-low").textContent = legend.low ?? "";
    byId("legend-high").textContent = legend.high ?? "";
    byId("legend-text").textContent = legend.text ?? "";
  }
}

/** Puts the verdict of a map above the stage: `kind`, `text` and, where it is known, `confidence`. */
export function showVerdict(verdict) {
  byId("verdict").hidden = !verdict;
  if (!verdict) return;
  const { kind, text, confidence } = verdict;
  byId("verdict").dataset.kind = kind;
  byId("verdict-name").textContent = kind[0].toUpperCase() + kind.slice(1)
    + (typeof confidence === "number" ? `, ${probability(confidence)}.` : ".");
  byId("verdict-text").textContent = text;
}

export function say(text) {
  byId("message").textContent = text;
  byId("message").hidden = !text;
}
