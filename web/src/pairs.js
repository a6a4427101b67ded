// The landmark pairs being picked, with what undo needs. A pair is [source vertex, target vertex].

export class Pairs {
  constructor(pairs) {
    this.list = pairs.map((pair) => [...pair]);
    this.half = null; // {i, vertex}: the first point of the pair to come
    this.past = [];
    this.changed = false;
  }

  #remember() {
    this.past.push({ list: this.list.map((pair) => [...pair]), half: this.half && { ...this.half } });
    this.changed = true;
  }

  /** A point picked on side `i`: it begins a pair, moves the point begun with, or completes the pair. */
  pick(i, vertex) {
    this.#remember();
    if (!this.half || this.half.i === i) {
      this.half = { i, vertex };
      return;
    }
    this.list.push(i === 1 ? [this.half.vertex, vertex] : [vertex, this.half.vertex]);
    this.half = null;
  }

  add(source, target) {
    this.#remember();
    this.list.push([source, target]);
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
}
