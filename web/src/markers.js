// Marks on a surface, the same size on the screen however near; one behind the surface shows through faintly.
import { CanvasTexture, SRGBColorSpace, Sprite, SpriteMaterial, Vector3 } from "three";

const kept = new Map();

/** A disc with a white rim and, where given, a short text; made once for each look. */
function texture(colour, text) {
  const key = `${colour} ${text}`;
  if (kept.has(key)) return kept.get(key);
  const size = 96;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  const pen = canvas.getContext("2d");
  const disc = (radius, fill) => {
    pen.beginPath();
    pen.arc(size / 2, size / 2, radius, 0, 2 * Math.PI);
    pen.fillStyle = fill;
    pen.fill();
  };
  disc(47, "rgba(20,24,32,0.55)");
  disc(45, "#ffffff");
  disc(37, colour);
  if (text) {
    pen.fillStyle = "#ffffff";
    pen.font = `bold ${text.length > 2 ? 34 : text.length > 1 ? 44 : 52}px system-ui, sans-serif`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText(text, size / 2, size / 2 + 3);
  }
  const made = new CanvasTexture(canvas);
  made.colorSpace = SRGBColorSpace;
  kept.set(key, made);
  return made;
}

export class Marker {
  /** `pixels`: diameter on the screen. */
  constructor({ vertex, colour, text = "", pixels = text ? 24 : 16 }, scene) {
    this.vertex = vertex;
    this.pixels = pixels;
    const map = texture(colour, text);
    const common = { map, transparent: true, depthWrite: false, sizeAttenuation: false, toneMapped: false };
    this.front = new Sprite(new SpriteMaterial(common));
    this.ghost = new Sprite(new SpriteMaterial({ ...common, depthTest: false, opacity: 0.3 }));
    this.ghost.renderOrder = 1;
    this.front.renderOrder = 2;
    scene.add(this.ghost, this.front);
  }

  settle(view, height) {
    const at = view.surface.world(this.vertex);
    const eye = new Vector3().subVectors(view.camera.position, at);
    const size = (this.pixels / height) * 2 * Math.tan((view.camera.fov * Math.PI) / 360);
    // Towards the eye by more than the disc's radius, or a sloping surface around the vertex would cut it.
    at.addScaledVector(eye, (0.015 * view.surface.radius) / eye.length() + 0.6 * size);
    for (const sprite of [this.front, this.ghost]) {
      sprite.position.copy(at);
      sprite.scale.set(size, size, 1);
      sprite.updateMatrixWorld();
    }
  }

  remove(scene) {
    scene.remove(this.front, this.ghost);
    this.front.material.dispose();
    this.ghost.material.dispose();
  }
}
