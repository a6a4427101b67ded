// The functional map as a picture: one square an entry, blue below zero, red above.
import { at } from "./colours.js";
import { short } from "./data.js";

/** The colour that the page's style has for `name` now, light or dark. */
const styled = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Shows (rows, columns) `values` on `canvas` with axes; tells `readout` the entry under the pointer. */
export function drawMatrix(canvas, readout, values, rows, columns) {
  const point = paint(canvas, values, rows, columns);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => paint(canvas, values, rows, columns));
  canvas.addEventListener("pointermove", (event) => {
    const [i, j] = point(event);
    const inside = i >= 0 && j >= 0 && i < rows && j < columns;
    readout.textContent = inside ? `C[${i}, ${j}] = ${short(values[i * columns + j])}` : "";
  });
  canvas.addEventListener("pointerleave", () => (readout.textContent = ""));
}

/** Draws it; returns what finds the row and column under the pointer. */
function paint(canvas, values, rows, columns) {
  let most = 0;
  for (const v of values) if (v === v) most = Math.max(most, Math.abs(v));
  const left = 52, top = 40, right = 74, bottom = 10;
  const ratio = Math.max(window.devicePixelRatio || 1, 2);
  const room = 360 / Math.max(rows, columns);
  // Whole pixels of the screen for each entry, where there is room for one.
  const fine = Math.floor(room * ratio) / ratio || room;
  const [wide, tall] = [Math.round(fine * columns), Math.round(fine * rows)];
  const [width, height] = [left + wide + right, top + tall + bottom];
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  canvas.style.width = `${width}px`;
  canvas.setAttribute("aria-label",
    `Functional map, ${rows} target by ${columns} source eigenfunctions, entries up to ${short(most, 3)} in size`);
  const image = new ImageData(columns, rows);
  for (let i = 0; i < values.length; i++) {
    const colour = at("diverging", most ? 0.5 + values[i] / most / 2 : 0.5);
    image.data.set([...colour, 255], 4 * i);
  }
  const small = document.createElement("canvas");
  small.width = columns;
  small.height = rows;
  small.getContext("2d").putImageData(image, 0, 0);
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  pen.imageSmoothingEnabled = fine * ratio < 1;
  pen.drawImage(small, left, top, wide, tall);
  pen.strokeStyle = styled("--axis");
  pen.lineWidth = 1;
  pen.strokeRect(left - 0.5, top - 0.5, wide + 1, tall + 1);
  pen.fillStyle = styled("--ink");
  pen.font = "12px system-ui, sans-serif";
  ticks(columns, fine).forEach((j) => {
    pen.textAlign = "center";
    pen.fillText(String(j), left + (j + 0.5) * fine, top - 6);
  });
  ticks(rows, fine).forEach((i) => {
    pen.textAlign = "right";
    pen.fillText(String(i), left - 6, top + (i + 0.5) * fine + 4);
  });
  pen.textAlign = "center";
  pen.fillText("source eigenfunction", left + wide / 2, 14);
  pen.save();
  pen.translate(14, top + tall / 2);
  pen.rotate(-Math.PI / 2);
  pen.fillText("target eigenfunction", 0, 0);
  pen.restore();
  scale(pen, left + wide + 16, top, Math.min(tall, 160), most);
  return (event) => {
    const box = canvas.getBoundingClientRect();
    const grow = width / box.width;
    return [
      Math.floor(((event.clientY - box.top) * grow - top) / fine),
      Math.floor(((event.clientX - box.left) * grow - left) / fine),
    ];
  };
}

function ticks(count, cell) {
  const raw = Math.max(1, 44 / cell);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= raw);
  const out = [];
  for (let i = 0; i < count; i += step) out.push(i);
  return out;
}

function scale(pen, x, y, height, most) {
  for (let k = 0; k < height; k++) {
    pen.fillStyle = `rgb(${at("diverging", 1 - k / (height - 1)).map(Math.round).join(",")})`;
    pen.fillRect(x, y + k, 10, 1);
  }
  pen.fillStyle = styled("--ink");
  pen.textAlign = "left";
  pen.fillText(short(most, 2), x + 14, y + 10);
  pen.fillText("0", x + 14, y + height / 2 + 4);
  pen.fillText(`−${short(most, 2)}`, x + 14, y + height);
}
