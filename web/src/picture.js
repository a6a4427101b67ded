// Saving what is seen as a PNG: both views, their names and the colour bar.
import { at } from "./colours.js";

export function composed(stage, names, legend, scale = 2) {
  const views = stage.picture(scale);
  const canvas = document.createElement("canvas");
  canvas.width = views.width;
  canvas.height = views.height + 50 * scale;
  const pen = canvas.getContext("2d");
  pen.fillStyle = "#ffffff";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(views, 0, 0);
  pen.fillStyle = "#1c2430";
  pen.textAlign = "center";
  pen.font = `600 ${15 * scale}px system-ui, sans-serif`;
  const all = stage.element.getBoundingClientRect();
  stage.views.forEach((view, i) => {
    // Above each view the page has its title, so there is room for the name.
    const box = view.box.getBoundingClientRect();
    pen.fillText(names[i], (box.left - all.left + box.width / 2) * scale, (box.top - all.top - 12) * scale);
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
  pen.strokeStyle = "#8b94a1";
  pen.lineWidth = scale;
  pen.strokeRect(middle - wide / 2, y - tall - 6 * scale, wide, tall);
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
