// A point map read both ways. Of a part, target vertices may have no counterpart: theirs is the number after the last.
import { numbers, reals } from "./data.js";

const GREY = 160;

export class Link {
  /** `record` as kfmaps.viz.page.map_record makes it. */
  constructor(record, sourceCount) {
    this.label = record.label;
    this.sourceCount = sourceCount;
    this.points = numbers(record.points); // source vertex of each target vertex
    this.nearest = numbers(record.nearest); // nearest source vertex that some target vertex lands on
    this.distortion = reals(record.distortion);
    this.first = new Uint32Array(sourceCount + 2);
    for (const s of this.points) this.first[s + 1]++;
    for (let s = 0; s <= sourceCount; s++) this.first[s + 1] += this.first[s];
    const next = this.first.slice(0, -1);
    this.sorted = new Uint32Array(this.points.length);
    this.points.forEach((s, t) => (this.sorted[next[s]++] = t));
  }

  /** Source vertex of a target vertex; -1 where there is none. */
  toSource(target) {
    return this.points[target] < this.sourceCount ? this.points[target] : -1;
  }

  /** Target vertices of a source vertex, or of the nearest that has any: {from, targets}. */
  toTarget(source) {
    const from = this.nearest[source];
    return { from, targets: [...this.sorted.subarray(this.first[from], this.first[from + 1])] };
  }

  /** Colours (or any numbers, `width` of them a vertex) of the source, at the target's vertices; else grey, or 0. */
  carried(values, width) {
    const out = new values.constructor(width * this.points.length).fill(width === 3 ? GREY : 0);
    for (let t = 0; t < this.points.length; t++) {
      if (this.points[t] >= this.sourceCount) continue;
      for (let c = 0; c < width; c++) out[width * t + c] = values[width * this.points[t] + c];
    }
    return out;
  }

  /** A number for each target vertex, averaged at the source's. */
  pushed(values) {
    return Float32Array.from(this.nearest, (from) => {
      let sum = 0, count = 0;
      for (let k = this.first[from]; k < this.first[from + 1]; k++) {
        const v = values[this.sorted[k]];
        if (v === v) [sum, count] = [sum + v, count + 1];
      }
      return count ? sum / count : NaN;
    });
  }
}
