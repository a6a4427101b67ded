import { say } from "./base.js";
import { pageData } from "./data.js";
import { startPicker } from "./picker.js";
import { startReview } from "./review.js";
import { startResult } from "./result.js";

try {
  const data = pageData();
  const page = { result: startResult, picker: startPicker, review: startReview }[data.kind](data);
  const side = (name) => ["source", "target"].indexOf(name);
  // For scripts: where a vertex is in the window, which vertex is at a place
  // there, which vertices are marked, and when first drawn (ms).
  window.kfmaps = {
    project: (name, vertex) => page.stage.project(side(name), vertex),
    pick: (name, x, y) => page.stage.pick(side(name), x, y),
    marks: (name) => page.stage.views[side(name)].markers.map((marker) => marker.vertex),
    firstPicture: null,
  };
  const drawn = page.stage.onDraw;
  page.stage.onDraw = () => {
    window.kfmaps.firstPicture ??= performance.now();
    drawn();
  };
} catch (error) {
  const webgl = /webgl/i.test(error.message);
  say(webgl
    ? "This browser gives no WebGL, which the 3D views need. Switch on hardware or software rendering in its settings."
    : `The page could not be shown: ${error.message}`);
  throw error;
}
