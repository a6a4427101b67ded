// The landmark picker.
import {
  LOCAL_FIT, Legend, SIDES, UNIT, byId, modeButtons, percent, say, setUp, showVerdict, typedVertex, viewTools,
} from "./base.js";
import { painted, pairColour, plain } from "./colours.js";
import { attach } from "./controls.js";
import { element, numbers, reals, short } from "./data.js";
import { Link } from "./link.js";
import { Pairs } from "./pairs.js";
import { ask, tell } from "./speak.js";

const HOVER = "#4a5464";
const REACH = 14; // pixels within which a mark is grabbed

export function startPicker(data) {
  const { shapes, names, stage } = setUp(data);
  viewTools(stage, data.views);
  const legend = new Legend(stage, names);
  const colours = numbers(data.source.colours);
  const plane = reals(data.source.plane);
  const pairs = new Pairs(data.pairs, data.names);
  const links = []; // one for each run done
  const confidences = [];
  const verdicts = [];
  const state = { mode: "plain", map: -1, selected: -1, hovered: null, running: false };
  const link = () => links[state.map];

  const shows = {
    plain: () => {
      shapes.forEach((s) => s.show(plain(s.count)));
      return {};
    },
    colours: () => {
      shapes[0].show(colours);
      shapes[1].show(link().carried(colours, 3));
      return { text: `Each point of ${names[1]} has the colour of its match on ${names[0]}.` };
    },
    texture: () => {
      shapes[0].show(colours, plane);
      shapes[1].show(link().carried(colours, 3), link().carried(plane, 2));
      return { text: `The pattern lies on ${names[0]} and is carried to ${names[1]} by the map.` };
    },
    change: () => {
      const before = links[state.map - 1];
      if (!before) {
        shows.plain();
        return { text: "There is no run before this one." };
      }
      const moved = Float32Array.from(link().points, (s, t) => shapes[0].apart(s, before.points[t]));
      shapes[1].show(painted(moved, "error", 0, 0.5));
      shapes[0].show(painted(link().pushed(moved), "error", 0, 0.5));
      return { scale: "error", low: "0", high: "50", text: `how far matches moved since the run before, in ${UNIT}` };
    },
    confidence: () => {
      const sure = confidences[state.map];
      shapes[1].show(painted(sure, "sequential", 0, 1));
      shapes[0].show(painted(link().pushed(sure), "sequential", 0, 1));
      return { scale: "sequential", low: "0 %", high: "100 %", text: LOCAL_FIT };
    },
  };
  const show = () => {
    showVerdict(verdicts[state.map]);
    legend.show(shows[link() ? state.mode : "plain"]());
    stage.draw();
  };

  const instruction = () => {
    const next = pairs.list.length + 1;
    if (!pairs.half) return `Pair ${next}: click a point on ${names[0]}, or on ${names[1]}.`;
    const other = names[1 - pairs.half.i];
    return proposal() ? `Pair ${next}: the map proposes the mark "?" on ${other}. Take it, or click a better place.`
      : `Pair ${next}: now click its match on ${other}.`;
  };

  /** Where the map of the run that is shown would put the other half of a pair: {i, vertex}, or null. */
  const proposal = () => {
    if (!pairs.half || !link()) return null;
    const { i, vertex } = pairs.half;
    const other = i === 1 ? link().toSource(vertex) : link().toTarget(vertex).targets[0];
    return other >= 0 && pairs.holder(1 - i, other) < 0 ? { i: 1 - i, vertex: other } : null;
  };

  /** Whether no other pair has the vertex on side `i`; says so where one has. */
  const free = (i, vertex, except = -1) => {
    const holder = pairs.holder(i, vertex, except);
    say(holder < 0 ? "" : `Vertex ${vertex} of the ${SIDES[i]} belongs to pair ${holder + 1}. A vertex can be in one pair only.`);
    return holder < 0;
  };

  const pick = (i, vertex) => {
    if (free(i, vertex)) pairs.pick(i, vertex);
  };

  const matched = () => {
    const at = state.hovered;
    if (!at || !link()) return [[], []];
    const to = at.i === 1 ? link().toSource(at.vertex) : -1;
    return at.i === 1 ? [to < 0 ? [] : [to], []] : [[], link().toTarget(at.vertex).targets.slice(0, 60)];
  };

  const mark = () => {
    const hovered = matched();
    SIDES.forEach((_, i) => stage.mark(i, [
      ...hovered[i].map((vertex) => ({ vertex, colour: HOVER })),
      ...pairs.points(i).map(({ number, vertex }) => ({
        vertex, colour: pairColour(number), text: String(number + 1), pixels: number === state.selected ? 32 : 24,
      })),
      ...(proposal()?.i === i ? [{ vertex: proposal().vertex, colour: pairColour(pairs.list.length), text: "?" }] : []),
    ]));
  };

  const row = (pair, number) => {
    const made = element("tr");
    made.classList.toggle("selected", number === state.selected);
    const head = element("th", null, { scope: "row" });
    const badge = element("span", String(number + 1), { class: "badge" });
    badge.style.background = pairColour(number);
    head.append(badge);
    const remove = element("button", "Delete", { type: "button", "aria-label": `Delete pair ${number + 1}` });
    remove.addEventListener("click", () => {
      state.selected = -1;
      pairs.delete(number);
      update();
      byId("pairs").querySelectorAll("button")[Math.min(number, pairs.list.length - 1)]?.focus();
    });
    const name = element("input", null, {
      type: "text", maxlength: 60, placeholder: "left hand, …", "aria-label": `Name of pair ${number + 1}`,
    });
    name.value = pair[2];
    name.addEventListener("change", () => {
      pairs.name(number, name.value.trim());
      update();
    });
    const named = element("td");
    named.append(name);
    made.append(head, ...pair.slice(0, 2).map((vertex) => element("td", vertex, { class: "number" })), named);
    if (link()) {
      const to = link().toSource(pair[1]);
      made.append(element("td", to < 0 ? "\u2013" : percent(shapes[0].apart(pair[0], to), 2), { class: "number" }));
    }
    const last = element("td");
    last.append(remove);
    made.append(last);
    made.addEventListener("click", (event) => {
      if (event.target === remove || event.target === name) return;
      state.selected = state.selected === number ? -1 : number;
      update();
    });
    return made;
  };

  const update = () => {
    byId("pairs").tBodies[0].replaceChildren(...pairs.list.map(row));
    byId("pairs").hidden = !pairs.list.length;
    byId("no-pairs").hidden = pairs.list.length > 0;
    byId("head-off").hidden = !link();
    byId("undo").disabled = !pairs.past.length;
    byId("match").disabled = state.running;
    byId("match").hidden = !data.canMatch;
    byId("take").hidden = !proposal();
    byId("propose").hidden = !link();
    byId("save-map").hidden = !link() || !data.canSave;
    byId("save").disabled = !pairs.list.length;
    byId("readout").textContent = instruction();
    byId("facts").textContent = `to be saved in ${data.output}${pairs.changed ? " · not saved yet" : ""}`;
    mark();
  };

  /** Whether a vertex of side `i` is seen close to a point of the window. */
  const close = (i, vertex, x, y) => {
    const at = stage.project(i, vertex);
    return at.visible && Math.hypot(at.x - x, at.y - y) < REACH;
  };

  /** The mark of side `i` under a point of the window: its number, or null. */
  const grab = (i, x, y) => {
    const near = pairs.points(i).map((point) => ({ ...point, ...stage.project(i, point.vertex) }))
      .filter((p) => p.visible && Math.hypot(p.x - x, p.y - y) < REACH)
      .sort((a, b) => Math.hypot(a.x - x, a.y - y) - Math.hypot(b.x - x, b.y - y));
    return near.length ? { number: near[0].number, moved: false } : null;
  };

  SIDES.forEach((side, i) => {
    attach(stage, i, {
      grab,
      drag: (j, vertex, held) => {
        if (pairs.holder(j, vertex, held.number) >= 0) return; // a vertex is in one pair only
        if (!held.moved) pairs.beginMove();
        held.moved = true;
        pairs.move(held.number, j, vertex);
        mark();
      },
      drop: () => update(),
      hover: (j, vertex) => {
        if (!link() || (state.hovered?.i === j && state.hovered?.vertex === vertex)) return;
        state.hovered = vertex < 0 ? null : { i: j, vertex };
        mark();
      },
      click: (j, vertex, event) => {
        const held = event && grab(j, event.clientX, event.clientY);
        const proposed = proposal();
        if (held) state.selected = state.selected === held.number ? -1 : held.number;
        else if (event && proposed?.i === j && close(j, proposed.vertex, event.clientX, event.clientY)) take();
        else if (vertex >= 0) pick(j, vertex);
        else if (!event) pairs.letGo();
        update();
      },
    });
    byId(`head-${side}`).textContent = `${names[i]} (${side})`;
    byId(`add-${side}`).max = shapes[i].count - 1;
  });

  const take = () => {
    const proposed = proposal();
    if (proposed) pick(proposed.i, proposed.vertex);
    update();
  };
  byId("take").addEventListener("click", take);
  // Where landmarks are farthest away one more helps most; the map proposes its match.
  byId("propose").addEventListener("click", () => {
    const target = shapes[1];
    let best = 0, far = -1;
    for (let v = 0; v < target.count; v++) {
      const apart = pairs.list.length ? Math.min(...pairs.list.map((pair) => target.apart(v, pair[1]))) : target.place(v).length();
      if (apart > far && pairs.holder(1, v) < 0) [best, far] = [v, apart];
    }
    if (pairs.half) pairs.letGo();
    pairs.pick(1, best);
    update();
  });

  const undo = () => {
    state.selected = -1;
    pairs.undo();
    update();
  };
  byId("undo").addEventListener("click", undo);
  document.addEventListener("keydown", (event) => {
    if (event.key.toLowerCase() !== "z" || !(event.ctrlKey || event.metaKey) || event.target.matches("input")) return;
    event.preventDefault();
    if (pairs.past.length) undo();
  });
  byId("add").addEventListener("submit", (event) => {
    event.preventDefault();
    const typed = [];
    for (const [i, side] of SIDES.entries()) {
      const vertex = typedVertex(byId(`add-${side}`), shapes[i].count, side);
      if (vertex === null || !free(i, vertex)) return;
      typed.push(vertex);
    }
    pairs.add(...typed);
    event.target.reset();
    byId("add-source").focus();
    update();
  });

  const attempt = async (work) => {
    say("");
    try {
      await work();
    } catch (error) {
      say(error.message);
    }
  };

  const save = (overwrite) => attempt(async () => {
    const { status, body } = await tell("save", { ...pairs.record(), overwrite });
    if (status === 409) {
      asked(`${body.exists} exists already. Replace it with these ${pairs.list.length} pairs?`, () => save(true));
      return;
    }
    pairs.changed = false;
    update();
    byId("readout").textContent = `Saved ${body.count} pairs in ${body.saved}.`;
  });
  const saveMap = (overwrite) => attempt(async () => {
    const { status, body } = await tell("save-map", { run: state.map, overwrite });
    if (status === 409) {
      asked(`${body.exists} exists already. Replace it with this map?`, () => saveMap(true));
      return;
    }
    byId("readout").textContent = `Saved the map in ${body.saved}.`;
  });
  let agreed = () => {};
  const asked = (text, then) => {
    agreed = then;
    byId("overwrite-text").textContent = text;
    byId("overwrite").showModal();
  };
  byId("save").addEventListener("click", () => save(false));
  byId("save-map").addEventListener("click", () => saveMap(false));
  byId("overwrite-no").addEventListener("click", () => byId("overwrite").close());
  byId("overwrite-yes").addEventListener("click", () => {
    byId("overwrite").close();
    agreed();
  });
  window.addEventListener("beforeunload", (event) => pairs.changed && event.preventDefault());

  const watch = async () => {
    for (;;) {
      const { body } = await ask("progress");
      byId("progress").value = body.fraction;
      byId("stage-name").textContent = `${body.stage} (${short(body.seconds, 2)} s)`;
      if (body.state !== "running") return body;
      await new Promise((later) => setTimeout(later, 300));
    }
  };
  const during = (running) => {
    state.running = running;
    byId("running").hidden = byId("cancel").hidden = !running;
    byId("cancel").disabled = false;
    update();
  };

  byId("match").addEventListener("click", () => attempt(async () => {
    during(true);
    try {
      await tell("match", { pairs: pairs.record().pairs });
      const end = await watch();
      if (end.state === "failed") throw new Error(`The match failed: ${end.error}`);
      if (end.state === "done") {
        const { body } = await ask("map");
        addRun({ ...body, label: `${links.length + 1}: ${body.label}, ${short(end.seconds, 2)} s` });
      }
    } finally {
      during(false);
    }
  }));
  byId("cancel").addEventListener("click", () => attempt(async () => {
    byId("cancel").disabled = true;
    await tell("cancel", {});
  }));

  const addRun = (record) => {
    links.push(new Link(record, shapes[0].count));
    confidences.push(reals(record.confidence));
    verdicts.push(record.verdict);
    state.map = links.length - 1;
    byId("map").append(element("option", record.label, { value: state.map }));
    byId("map").value = state.map;
    byId("map-choice").hidden = byId("modes").hidden = false;
    if (links.length === 1) byId("modes").querySelector("[value=colours]").click();
    show();
  };
  byId("map").addEventListener("change", () => {
    state.map = Number(byId("map").value);
    show();
    update();
  });
  const modes = {
    plain: "Plain", colours: "Map colours", texture: "Texture", change: "Change", confidence: "Local fit",
  };
  modeButtons(modes, state.mode, (mode) => {
    state.mode = mode;
    show();
  });

  show();
  update();
  return { stage };
}
