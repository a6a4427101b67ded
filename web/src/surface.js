// One shape on the stage: its geometry, what it shows, and finding the vertex under the pointer.
import {
  BufferAttribute, BufferGeometry, DoubleSide, Group, LinearFilter, Matrix4, Mesh, Points, Ray, RepeatWrapping,
  ShaderMaterial, Sphere, Texture, Triangle, Vector3,
} from "three";
import { MeshBVH } from "three-mesh-bvh";
import { numbers, reals } from "./data.js";
import { plain } from "./colours.js";

const VERTEX = `
attribute vec3 colour;
attribute vec2 plane;
uniform float size;
varying vec3 vColour;
varying vec2 vPlane;
varying vec3 vNormal;
varying vec3 vEye;
void main() {
  vColour = colour;
  vPlane = plane;
  vNormal = normalMatrix * normal;
  vec4 eye = modelViewMatrix * vec4(position, 1.0);
  vEye = eye.xyz;
  gl_Position = projectionMatrix * eye;
  gl_PointSize = size / max(-eye.z, 1e-3);
}`;

// Two-sided light from beside the viewer. The texture is a grid over a checkerboard, drawn from coordinates
// that lie on the source; where neighbours' coordinates are far apart its lines would only flicker, so they fade.
const FRAGMENT = `
uniform bool textured;
uniform bool pictured;
uniform sampler2D picture;
uniform bool round;
uniform float cells;
varying vec3 vColour;
varying vec2 vPlane;
varying vec3 vNormal;
varying vec3 vEye;
vec3 pattern(vec3 base) {
  vec2 at = vPlane * cells;
  vec2 wide = fwidth(at);
  float fade = 1.0 - smoothstep(0.25, 0.7, max(wide.x, wide.y));
  vec2 cell = floor(at);
  float odd = mod(cell.x + cell.y, 2.0);
  vec2 off = abs(fract(at - 0.5) - 0.5) / max(wide, vec2(1e-5));
  float line = 1.0 - smoothstep(0.8, 1.8, min(off.x, off.y));
  vec3 tile = mix(base, vec3(1.0), 0.62 * odd * fade);
  return mix(tile, vec3(0.12, 0.14, 0.18), 0.75 * line * fade);
}
void main() {
  vec2 off = 2.0 * gl_PointCoord - 1.0;
  if (round && dot(off, off) > 1.0) discard;
  vec3 base = pictured ? texture2D(picture, vPlane).rgb : textured ? pattern(vColour) : vColour;
  float light = 1.04 - 0.45 * dot(off, off); // a point is a little ball
  if (!round) {
    vec3 n = normalize(vNormal);
    vec3 v = normalize(-vEye);
    if (dot(n, v) < 0.0) n = -n;
    float key = max(dot(n, normalize(vec3(-0.35, 0.55, 0.8))), 0.0);
    float fill = max(dot(n, normalize(vec3(0.7, -0.1, 0.6))), 0.0);
    light = 0.52 + 0.46 * key + 0.14 * fill;
  }
  gl_FragColor = vec4(base * min(light, 1.05), 1.0);
}`;

const AROUND = 0.06; // √area around a point that its normal is the mean of

export class Surface {
  constructor(record) {
    this.name = record.name;
    this.positions = reals(record.positions);
    this.faces = numbers(record.faces);
    this.count = this.positions.length / 3;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(this.positions, 3));
    geometry.setAttribute("colour", new BufferAttribute(plain(this.count), 3, true));
    geometry.setAttribute("plane", new BufferAttribute(new Float32Array(2 * this.count), 2));
    if (this.faces.length) {
      geometry.setIndex(new BufferAttribute(this.faces.length && this.count > 65535 ? Uint32Array.from(this.faces) : Uint16Array.from(this.faces), 1));
      geometry.computeVertexNormals();
    }
    this.radius = 0;
    for (let i = 0; i < this.count; i++) this.radius = Math.max(this.radius, this.place(i).length());
    geometry.boundingSphere = new Sphere(new Vector3(), this.radius);
    this.geometry = geometry;
    this.material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: DoubleSide,
      uniforms: {
        textured: { value: false },
        pictured: { value: false },
        picture: { value: null },
        round: { value: !this.faces.length },
        cells: { value: 16 },
        size: { value: 1 },
      },
    });
    this.body = this.faces.length ? new Mesh(geometry, this.material) : new Points(geometry, this.material);
    this.body.frustumCulled = false;
    this.group = new Group();
    this.group.add(this.body);
    this.tree = null;
    this.dressed = null;
  }

  /** Position of a vertex, or of a point inside a triangle ({face, weights}), in the shape's own frame. */
  place(at, into = new Vector3()) {
    if (typeof at === "number") return into.fromArray(this.positions, 3 * at);
    into.set(0, 0, 0);
    this.corners(at.face).forEach((corner, i) => into.addScaledVector(corner, at.weights[i]));
    return into;
  }

  /** Positions of the corners of a face. */
  corners(face) {
    return [0, 1, 2].map((i) => this.place(this.faces[3 * face + i]));
  }

  /** Mean normal of the surface around a point of a triangle, of what faces the same way. */
  normal(at) {
    const [a, b, c] = this.corners(at.face);
    const own = b.sub(a).cross(c.sub(a)).normalize();
    const middle = this.place(at), sum = own.clone(), p = new Vector3(), n = new Vector3();
    for (let i = 0; i < this.count; i++) {
      if (this.place(i, p).distanceToSquared(middle) > AROUND ** 2) continue;
      n.fromBufferAttribute(this.geometry.attributes.normal, i);
      if (n.dot(own) > 0) sum.add(n);
    }
    return sum.normalize();
  }

  /** Straight distance between two vertices, in √area: the page's shapes have unit area. */
  apart(a, b) {
    return this.place(a).distanceTo(this.place(b));
  }

  /** Position of a vertex on the stage. */
  world(vertex, into = new Vector3()) {
    return this.place(vertex, into).applyMatrix4(this.group.matrixWorld);
  }

  /** Takes the picture of a texture (a record with coordinates for each corner of the faces), then calls `ready`. */
  dress(record, ready) {
    const image = new Image();
    image.onload = () => {
      const picture = new Texture(image);
      picture.wrapS = picture.wrapT = RepeatWrapping;
      picture.minFilter = LinearFilter; // smaller copies would mix neighbours in the picture
      picture.generateMipmaps = false;
      picture.needsUpdate = true;
      this.material.uniforms.picture.value = picture;
      const own = this.geometry.toNonIndexed();
      const uv = reals(record.uv);
      const corners = numbers(record.corners);
      const plane = new Float32Array(2 * corners.length);
      corners.forEach((at, i) => plane.set([uv[2 * at], uv[2 * at + 1]], 2 * i));
      own.setAttribute("plane", new BufferAttribute(plane, 2));
      this.dressed = own;
      ready();
    };
    image.src = record.picture;
  }

  /** Shows the picture that `dress` took. */
  showPicture() {
    this.body.geometry = this.dressed;
    this.material.uniforms.pictured.value = true;
  }

  /** Three bytes a vertex, shown as they are or, with `plane` (two numbers a vertex), under the texture. */
  show(colours, plane = null) {
    this.body.geometry = this.geometry;
    this.material.uniforms.pictured.value = false;
    this.geometry.attributes.colour.array.set(colours);
    this.geometry.attributes.colour.needsUpdate = true;
    if (plane) {
      this.geometry.attributes.plane.array.set(plane);
      this.geometry.attributes.plane.needsUpdate = true;
    }
    this.material.uniforms.textured.value = plane !== null;
  }

  /** The vertex that a ray of the stage meets first, or -1; with `inside` the point in its triangle, or null. */
  pick(ray, inside = false) {
    const inverse = new Matrix4().copy(this.group.matrixWorld).invert();
    const own = new Ray().copy(ray).applyMatrix4(inverse);
    if (!this.faces.length) return this.#nearestPoint(own);
    // The tree takes a moment on a large shape, so it is built when first needed; indirect keeps the faces' order.
    this.tree ??= new MeshBVH(this.geometry, { indirect: true });
    const hit = this.tree.raycastFirst(own, DoubleSide);
    if (inside) return hit && this.#inside(hit.faceIndex, hit.point);
    if (!hit) return -1;
    const corners = [hit.face.a, hit.face.b, hit.face.c];
    const distance = corners.map((v) => this.place(v).distanceToSquared(hit.point));
    return corners[distance.indexOf(Math.min(...distance))];
  }

  #inside(face, point) {
    const weights = Triangle.getBarycoord(point, ...this.corners(face), new Vector3());
    const all = weights ? weights.toArray().map((w) => Math.max(w, 0)) : [1, 0, 0];
    const sum = all[0] + all[1] + all[2];
    return { face, weights: all.map((w) => w / sum) };
  }

  /** Of the points close to the ray, the one nearest to the eye. */
  #nearestPoint(ray) {
    const reach = (0.02 * this.radius) ** 2;
    const p = new Vector3();
    let best = -1, depth = Infinity;
    for (let i = 0; i < this.count; i++) {
      this.place(i, p);
      if (ray.distanceSqToPoint(p) > reach) continue;
      const along = p.sub(ray.origin).dot(ray.direction);
      if (along < depth) [best, depth] = [i, along];
    }
    return best;
  }

  /** Whether nothing of the shape hides the vertex from `eye` (a point of the stage). */
  sees(vertex, eye) {
    if (!this.faces.length) return true;
    const inverse = new Matrix4().copy(this.group.matrixWorld).invert();
    const from = eye.clone().applyMatrix4(inverse);
    const to = this.place(vertex);
    const way = to.clone().sub(from);
    const length = way.length();
    this.tree ??= new MeshBVH(this.geometry, { indirect: true });
    const hit = this.tree.raycastFirst(new Ray(from, way.divideScalar(length)), DoubleSide);
    return !hit || hit.distance > length - 1e-3 * this.radius;
  }
}
