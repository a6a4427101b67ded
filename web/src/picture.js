// Saving what is seen as a PNG: both views, their names and the colour bar.
import { at } from "./colours.js";

export function composed(stage, names, legend, scale = 2) {
  const views = stage.picture(scale);
  const top = 34 * scale, bottom = 44 * scale;
  const canvas = document.createElement("canvas");
  canvas.width = views.width;
  canvas.height = views.height + top + bottom;
  const pen = canvas.getContext("2d");
  pen.fillStyle = "#ffffff";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(views, 0, top);
  pen.fillStyle = "#1c2430";
  pen.textAlign = "center";
  pen.font = `600 ${15 * scale}px system-ui, sans-serif`;
  const all = stage.element.getBoundingClientRect();
  stage.views.forEach((view, i) => {
    const box = view.box.getBoundingClientRect();
    const y = Math.max(top - 10 * scale, top + (box.top - all.top) * scale + (i && box.top - all.top > 40 ? 20 * scale : -10 * scale));
    pen.fillText(names[i], (box.left - all.left + box.width / 2) * scale, y);
  });
  pen.font = `${13 * scale}px system-ui, sans-serif`;
  const y = canvas.height - 18 * scale;
  if (!legend.scale) {
    pen.fillText(legend.text ?? "", canvas.width / 2, y);
    return canvas;
  }
  const [wide, tall, middle] = [240 * scale, 12 * scale, canvas.width / 2];
  for (let x = 0; x < wide; x++) {
    pen.fillStyle = `rgb(${at(legend.scale, x / (wide - 1)).map(Math.round).join(",")})`;
    pen.fillRect(middle - wide / 2 + x, y - tall - 6 * scale, 1, tall);
  }
  pen.fillStyle = "#1c2430";
  pen.textAlign = "right";
  pen.fillText(legend.low, middle - wide / 2 - 8 * scale, y - 7 * scale);
  pen.textAlign = "left";
  pen.fillText(legend.high, middle + wide / 2 + 8 * scale, y - 7 * scale);
  pen.textAlign = "center";
  pen.fillText(legend.text, middle, y + 10 * scale);
  return canvas;
}

export function savePicture(stage, names, legend) {
  composed(stage, names, legend).toBlob((blob) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = `${names.join("-to-").replace(/[^\p{L}\p{N}._-]+/gu, "_").slice(0, 120)}.png`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }, "image/png");
}
