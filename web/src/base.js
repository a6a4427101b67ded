// What the page of a result and the landmark picker share: two shapes on a stage and the tools around them.
import { drawBar } from "./colours.js";
import { element } from "./data.js";
import { savePicture } from "./picture.js";
import { Stage } from "./stage.js";
import { Surface } from "./surface.js";

/** What the legend says of confidence. */
export const CONFIDENCE = "confidence: how well distances to the surroundings are kept";
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
  byId("linked").addEventListener("change", () => { stage.linked = byId("linked").checked; });
  return { shapes, names, stage };
}

/** The buttons that turn the views back; `rotations()` are those of the two shapes, or null. */
export function viewTools(stage, rotations) {
  const reset = () => stage.reset(byId("up").value, rotations());
  byId("up").addEventListener("change", reset);
  byId("reset").addEventListener("click", reset);
  reset();
  return reset;
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

export function say(text) {
  byId("message").textContent = text;
  byId("message").hidden = !text;
}
