// The page of a result.
import {
  LOCAL_FIT, Legend, SIDES, UNIT, byId, modeButtons, percent, rotationOf, setUp, share, showVerdict, typedVertex,
  viewTools,
} from "./base.js";
import { painted, plain, quantile, roundedUp } from "./colours.js";
import { attach } from "./controls.js";
import { element, numbers, reals, short } from "./data.js";
import { Link } from "./link.js";
import { drawMatrix } from "./matrix.js";
import { showSummary } from "./tables.js";

const HOVER = "#d97706";
const PINNED = "#1d4ed8";
const MOST_MARKS = 60;
const NOTHING = "Point at a surface to see its match on the other.";

export function startResult(data) {
  const { shapes, names, stage } = setUp(data);
  const colours = numbers(data.source.colours);
  const plane = reals(data.source.plane);
  const errors = (data.errors ?? []).map(reals);
  const confidence = (data.confidence ?? []).map(reals);
  const links = data.maps.map(() => null);
  const state = { mode: "colours", map: 0, descriptor: 0, hovered: null, pinned: null };
  const linkOf = (map) => (links[map] ??= new Link(data.maps[map], shapes[0].count));
  const link = () => linkOf(state.map);

  /** Colours, or places in the pattern, on the target: mixed inside triangles where the map has points there. */
  const carried = (kind) => {
    const [own, read, width] = kind === "plane" ? [plane, reals, 2] : [colours, numbers, 3];
    const exact = data.maps[state.map][kind];
    return exact ? read(exact) : link().carried(own, width);
  };

  const rotation = rotationOf(data.rotation);
  const reset = viewTools(stage, data.views, () => (byId("aligned").checked ? rotation : null));
  byId("aligned").addEventListener("change", reset);
  const legend = new Legend(stage, names);

  /** A number for each target vertex on both shapes, and the legend that reads it. */
  const field = (values, scale, low, high, said) => {
    shapes[1].show(painted(values, scale, low, high));
    shapes[0].show(painted(link().pushed(values), scale, low, high));
    return { scale, ...said };
  };
  const unknown = (text) => {
    shapes.forEach((s) => s.show(plain(s.count)));
    return { text };
  };

  const shows = {
    colours: () => {
      shapes[0].show(colours);
      shapes[1].show(carried("colours"));
      const grey = link().points.some((s) => s >= shapes[0].count) ? " Grey points have no match." : "";
      return { text: `Each point of ${names[1]} has the colour of its match on ${names[0]}.${grey}` };
    },
    texture: () => {
      if (state.map === 0 && shapes.every((s) => s.dressed)) {
        shapes.forEach((s) => s.showPicture());
        return { text: `The texture of ${names[0]}, carried to ${names[1]} by the map.` };
      }
      shapes[0].show(colours, plane);
      shapes[1].show(carried("colours"), carried("plane"));
      return { text: `The pattern lies on ${names[0]} and is carried to ${names[1]} by the map.` };
    },
    descriptor: () => {
      const column = data.descriptors[state.descriptor];
      const values = SIDES.map((side) => reals(column[side]));
      const both = Float32Array.from([...values[0], ...values[1]]);
      const [low, high] = [quantile(both, 0.01), quantile(both, 0.99)];
      values.forEach((v, i) => shapes[i].show(painted(v, "sequential", low, high)));
      return { scale: "sequential", low: short(low, 3), high: short(high, 3), text: `descriptor ${column.number}` };
    },
    error: () => {
      const values = errors[state.map];
      if (!values) return unknown("The error of this map is not known.");
      const top = roundedUp(quantile(values, 0.99));
      return field(values, "error", 0, top, { low: "0", high: percent(top), text: `distance to the truth, in ${UNIT}` });
    },
    distortion: () => field(link().distortion, "diverging", -2, 2,
      { low: "¼", high: "4", text: "area on the source / area on the target, both of unit area" }),
    difference: () => {
      // Of the alternative chosen, or of the first while the best map is shown.
      const other = linkOf(Math.max(state.map, 1));
      const apart = Float32Array.from(linkOf(0).points, (s, t) => shapes[0].apart(s, other.points[t]));
      const text = `between the matches of the best map and of ${other.label.toLowerCase()}, in ${UNIT}`;
      return field(apart, "error", 0, 0.5, { low: "0", high: "50", text });
    },
    confidence: () => {
      const values = confidence[state.map];
      if (!values) return unknown("The local fit of this map is not known.");
      return field(values, "sequential", 0, 1, { low: "0 %", high: "100 %", text: LOCAL_FIT });
    },
  };
  const show = () => {
    legend.show(shows[state.mode]());
    byId("descriptor-choice").hidden = state.mode !== "descriptor";
    mark();
  };

  (data.textures ?? []).forEach((record, i) => shapes[i].dress(record, () => {
    if (state.mode === "texture") show();
  }));

  const measured = (target) => {
    const error = errors[state.map]?.[target] ?? NaN;
    const sure = confidence[state.map]?.[target] ?? NaN;
    return (Number.isNaN(error) ? "" : `, error ${percent(error)} ${UNIT}`)
      + (Number.isNaN(sure) ? "" : `, local fit ${share(sure)}`);
  };

  /** The match of a vertex of side `i`: what to mark on either side and how to say it. */
  const match = ({ i, vertex }) => {
    if (i === 1) {
      const to = link().toSource(vertex);
      if (to < 0) return { marks: [[], [vertex]], text: `target ${vertex}: no counterpart` };
      return { marks: [[to], [vertex]], text: `target ${vertex} → source ${to}${measured(vertex)}` };
    }
    const { from, targets } = link().toTarget(vertex);
    const list = targets.slice(0, 8).join(", ") + (targets.length > 8 ? `, … (${targets.length})` : "");
    const via = from === vertex ? "" : ` (no target vertex lands here; the nearest that has one is ${from})`;
    return { marks: [[vertex], targets.slice(0, MOST_MARKS)], text: `source ${vertex} ← target ${list}${via}` };
  };

  const mark = () => {
    const both = [[state.pinned, PINNED], [state.hovered, HOVER]].filter(([at]) => at);
    const all = both.map(([at, colour]) => [match(at), colour]);
    SIDES.forEach((_, i) => stage.mark(i, all.flatMap(([m, colour]) => m.marks[i].map((vertex) => ({ vertex, colour })))));
    const said = state.hovered ?? state.pinned;
    byId("readout").textContent = said ? match(said).text : NOTHING;
  };

  const pin = (i, vertex) => {
    state.pinned = vertex < 0 ? null : { i, vertex };
    SIDES.forEach((side, j) => (byId(`goto-${side}`).value = state.pinned && j === i ? vertex : ""));
    byId("pinned").textContent = state.pinned ? match(state.pinned).text : "";
    mark();
  };

  SIDES.forEach((side, i) => {
    attach(stage, i, {
      hover: (j, vertex) => {
        const same = state.hovered?.i === j && state.hovered?.vertex === vertex;
        if (same || (vertex < 0 && !state.hovered)) return;
        state.hovered = vertex < 0 ? null : { i: j, vertex };
        mark();
      },
      click: pin,
    });
    const box = byId(`goto-${side}`);
    box.max = shapes[i].count - 1;
    box.addEventListener("change", () => {
      const vertex = typedVertex(box, shapes[i].count, side);
      if (vertex !== null) pin(i, vertex);
      else if (box.value === "") pin(i, -1);
    });
  });

  modeButtons({
    colours: "Map colours",
    texture: "Texture",
    ...(data.descriptors.length && { descriptor: "Descriptor" }),
    ...(errors.length && { error: "Error" }),
    ...(shapes.every((s) => s.faces.length) && { distortion: "Area distortion" }),
    ...(data.maps.length > 1 && { difference: "Difference" }),
    ...(confidence.length && { confidence: "Local fit" }),
  }, state.mode, (mode) => { state.mode = mode; show(); });
  const choices = (id, texts, set) => {
    texts.forEach((text, value) => byId(id).append(element("option", text, { value })));
    byId(id).addEventListener("change", () => { set(Number(byId(id).value)); show(); });
  };
  choices("map", data.maps.map((m) => m.label), (v) => {
    state.map = v;
    tellMap();
  });
  choices("descriptor", data.descriptors.map((d) => String(d.number)), (v) => { state.descriptor = v; });
  byId("map-choice").hidden = data.maps.length < 2;

  /** What is said of the map that is shown: figures of its own, and that it is an alternative where it is one. */
  const tellMap = () => {
    byId("facts").textContent = facts(errors[state.map], confidence[state.map]);
    byId("alternative").hidden = state.map === 0;
    byId("alternative-name").textContent = `${link().label}, not the answer.`;
    const which = state.map ? ` (${link().label.toLowerCase()})` : "";
    byId("title-target").textContent = `${names[1]} (target, ${shapes[1].count} vertices)${which}`;
  };
  showVerdict(data.verdict);
  document.querySelectorAll(".best").forEach((place) => (place.textContent = data.maps.length > 1 ? " of the best map" : ""));
  tellMap();
  show();
  // The tables can wait for the first picture.
  requestAnimationFrame(() => setTimeout(() => {
    if (data.matrix) {
      drawMatrix(byId("matrix"), byId("matrix-readout"), reals(data.matrix), ...data.matrix.shape);
      byId("matrix-card").hidden = false;
    }
    showSummary(data.summary);
  }));
  return { stage };
}

function facts(errors, confidence) {
  const mean = (values) => {
    const known = (values ?? []).filter((v) => !Number.isNaN(v));
    return known.length ? known.reduce((a, b) => a + b, 0) / known.length : NaN;
  };
  const [error, fit] = [mean(errors), mean(confidence)];
  return [
    ...(Number.isNaN(error) ? [] : [`mean error ${percent(error)} ${UNIT}`]),
    ...(Number.isNaN(fit) ? [] : [`mean local fit ${share(fit)}`]),
  ].join(" · ");
}
