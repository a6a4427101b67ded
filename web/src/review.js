// The review of a study: one specimen beside a template, flagged landmarks red, to be moved and accepted.
import { SIDES, byId, say, setUp, share, viewTools } from "./base.js";
import { attach } from "./controls.js";
import { element } from "./data.js";
import { tell } from "./speak.js";

const [RIGHT, FLAGGED, DONE, CHOSEN] = ["#3d5a80", "#c1121f", "#1b7f4d", "#b45309"];
const REVIEWED = ["corrected", "checked"];
const REACH = 12; // pixels within which a mark is grabbed
const NEAR = 3; // how much larger a chosen landmark's surroundings are shown

export function startReview(data) {
  const { names, shapes, stage } = setUp(data);
  byId("title-source").textContent = `${names[0]} (template)`;
  byId("title-target").textContent = names[1];
  const reset = viewTools(stage, data.views);
  const state = { list: data.landmarks, chosen: -1, past: [], changes: new Map(), saving: false };
  const flagged = (one) => one.flag !== "" && !REVIEWED.includes(one.flag);
  const colour = (one) => (flagged(one) ? FLAGGED : one.flag ? DONE : RIGHT);
  const chosen = () => state.list[state.chosen];

  const mark = () => SIDES.forEach((_, i) => stage.mark(i, state.list.flatMap((one, number) => {
    const at = i === 0 ? data.template[number] : one.place;
    const pick = number === state.chosen;
    return at ? [{ vertex: at, colour: pick && !flagged(one) ? CHOSEN : colour(one), text: pick ? String(number + 1) : "", pixels: pick ? 26 : 13 }] : [];
  })));

  const row = (one, number) => {
    const made = element("tr", null, { tabindex: 0, "aria-selected": number === state.chosen });
    made.classList.toggle("selected", number === state.chosen);
    const head = element("th", null, { scope: "row" });
    const badge = element("span", String(number + 1), { class: "badge" });
    badge.style.background = colour(one);
    head.append(badge);
    const sure = one.place ? (one.confidence === null ? "" : share(one.confidence)) : "missing";
    made.append(head, element("td", one.name), element("td", one.flag), element("td", sure, { class: "number" }));
    made.addEventListener("click", () => choose(number));
    made.addEventListener("keydown", (event) => event.key === "Enter" && choose(number));
    return made;
  };

  const update = () => {
    byId("pairs").tBodies[0].replaceChildren(...state.list.map(row));
    const left = state.list.filter(flagged).length;
    byId("facts").textContent = (left ? `${left} of ${state.list.length} flagged` : `${state.list.length} landmarks, none flagged`)
      + (state.changes.size ? ` · ${state.changes.size} not saved yet` : "");
    byId("save").disabled = !state.changes.size || state.saving;
    byId("undo").disabled = !state.past.length;
    byId("next").disabled = !left;
    byId("accept").disabled = byId("missing").disabled = !chosen()?.place;
    byId("readout").textContent = !chosen() ? "Click a landmark, or Next flagged."
      : `${chosen().name}${chosen().flag ? `: ${chosen().flag}` : ""}. `
        + (chosen().place ? `Drag it on ${names[1]}, or click a better place.` : `Click its place on ${names[1]}.`);
    mark();
  };

  /** Chooses a landmark and shows it from the front, on both shapes. */
  const choose = (number, turn = true) => {
    state.chosen = number;
    if (turn && number >= 0) {
      const places = [data.template[number], chosen().place];
      const first = places.findIndex(Boolean);
      if (first >= 0) stage.face(first, places[first]);
      places.forEach((at, i) => at && stage.centre(i, at, NEAR));
    }
    update();
  };

  const remember = () => state.past.push({ list: state.list.map((one) => ({ ...one })), changes: new Map(state.changes) });
  const change = (number, values, sent) => {
    Object.assign(state.list[number], values);
    state.changes.set(state.list[number].name, { name: state.list[number].name, ...sent });
  };
  const move = (number, place) => change(number, { place, flag: "corrected", confidence: 1 }, place);

  const next = () => {
    const count = state.list.length;
    const order = state.list.map((_, k) => (state.chosen + 1 + k) % count);
    choose(order.find((k) => flagged(state.list[k])) ?? -1);
  };

  SIDES.forEach((_, i) => attach(stage, i, {
    grab: (j, x, y) => {
      const near = state.list.flatMap((one, number) => {
        const at = j === 0 ? data.template[number] : one.place;
        const p = at && stage.project(j, at);
        const far = p && p.visible ? Math.hypot(p.x - x, p.y - y) : REACH;
        return far < REACH ? [{ number, far, moved: false }] : [];
      });
      return near.sort((a, b) => a.far - b.far)[0] ?? null;
    },
    drag: (j, _vertex, held, event) => {
      const place = j === 1 && stage.pick(1, event.clientX, event.clientY, true);
      if (!place) return;
      if (!held.moved) remember();
      held.moved = true;
      state.chosen = held.number;
      move(held.number, place);
      mark();
    },
    drop: () => update(),
    hover: () => {},
    click: (j, vertex, event, held) => {
      if (held) return choose(held.number, false);
      if (j === 0 || vertex < 0 || !chosen()) return choose(-1);
      const { left, top, width, height } = byId("view-target").getBoundingClientRect();
      const place = stage.pick(1, event?.clientX ?? left + width / 2, event?.clientY ?? top + height / 2, true);
      remember();
      move(state.chosen, place);
      return update();
    },
  }));

  byId("next").addEventListener("click", next);
  byId("accept").addEventListener("click", () => {
    if (chosen().flag !== "corrected") { // of one that was moved nothing more need be said
      remember();
      change(state.chosen, { flag: "checked", confidence: 1 }, { checked: true });
    }
    state.list.some(flagged) ? next() : update();
  });
  byId("missing").addEventListener("click", () => {
    remember();
    change(state.chosen, { place: null, flag: "corrected", confidence: null }, {});
    update();
  });
  const undo = () => {
    Object.assign(state, state.past.pop());
    update();
  };
  byId("undo").addEventListener("click", undo);
  document.addEventListener("keydown", (event) => {
    if (event.key.toLowerCase() !== "z" || !(event.ctrlKey || event.metaKey) || !state.past.length) return;
    event.preventDefault();
    undo();
  });
  byId("save").addEventListener("click", async () => {
    say("");
    state.saving = true;
    update();
    try {
      const { body } = await tell("save", { specimen: names[1], changes: [...state.changes.values()] });
      Object.assign(state, { list: body.landmarks, past: [], changes: new Map() });
      byId(`specimen-${names[1]}`).textContent = described({ name: names[1], flags: body.flags });
      update();
      byId("readout").textContent = `Saved. Tables and statistics are written anew.`;
    } catch (error) {
      say(error.message);
    } finally {
      state.saving = false;
      byId("save").disabled = !state.changes.size;
    }
  });
  window.addEventListener("beforeunload", (event) => state.changes.size && event.preventDefault());

  const described = ({ name, flags }) => (flags ? `${name} (${flags} flagged)` : name);
  const here = data.specimens.findIndex((one) => one.name === names[1]);
  data.specimens.forEach((one) => {
    byId("specimen").append(element("option", described(one), { value: one.page, id: `specimen-${one.name}` }));
  });
  byId("specimen").selectedIndex = here;
  byId("specimen").addEventListener("change", (event) => {
    const to = event.target.value;
    event.target.selectedIndex = here; // what the browser keeps when the page is not left after all
    location.assign(to);
  });
  [["before", -1], ["after", 1]].forEach(([id, step]) => {
    const other = data.specimens[here + step];
    byId(id).disabled = !other;
    byId(id).addEventListener("click", () => location.assign(String(other.page)));
  });
  byId("reset").addEventListener("click", reset);
  update();
  return { stage, shapes };
}
