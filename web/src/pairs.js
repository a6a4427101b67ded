// The landmark pairs being picked, with what undo needs. A pair is [source vertex, target vertex, name].

export class Pairs {
  constructor(pairs, names = []) {
    this.list = pairs.map(([s, t], i) => [s, t, names[i] ?? ""]);
    this.half = null; // {i, vertex}: the first point of the pair to come
    this.past = [];
    this.changed = false;
  }

  #remember() {
    this.past.push({ list: this.list.map((pair) => [...pair]), half: this.half && { ...this.half } });
    this.changed = true;
  }

  /** The number of another pair that has the vertex on side `i`, or -1. */
  holder(i, vertex, except = -1) {
    return this.list.findIndex((pair, number) => number !== except && pair[i] === vertex);
  }

  /** A point picked on side `i`: it begins a pair, moves the point begun with, or completes the pair. */
  pick(i, vertex) {
    this.#remember();
    if (!this.half || this.half.i === i) {
      this.half = { i, vertex };
      return;
    }
    this.list.push(i === 1 ? [this.half.vertex, vertex, ""] : [vertex, this.half.vertex, ""]);
    this.half = null;
  }

  add(source, target) {
    this.#remember();
    this.list.push([source, target, ""]);
  }

  name(number, text) {
    if (this.list[number][2] === text) return;
    this.#remember();
    this.list[number][2] = text;
  }

  delete(number) {
    this.#remember();
    this.list.splice(number, 1);
  }

  /** Call once before moving a point about, so that one undo takes it back to where it was. */
  beginMove() {
    this.#remember();
  }

  /** Moves the point of side `i` of a pair, or of the half pair (`number` = list.length). */
  move(number, i, vertex) {
    if (number < this.list.length) this.list[number][i] = vertex;
    else this.half.vertex = vertex;
  }

  letGo() {
    if (this.half) this.#remember();
    this.half = null;
  }

  undo() {
    const before = this.past.pop();
    if (before) Object.assign(this, before);
    this.changed = true;
  }

  /** Marks to draw on side `i`: {number, vertex}. */
  points(i) {
    const out = this.list.map((pair, number) => ({ number, vertex: pair[i] }));
    if (this.half?.i === i) out.push({ number: this.list.length, vertex: this.half.vertex });
    return out;
  }

  /** What is sent to the program: the pairs, and their names. */
  record() {
    return { pairs: this.list.map(([s, t]) => [s, t]), names: this.list.map(([, , name]) => name) };
  }
}
