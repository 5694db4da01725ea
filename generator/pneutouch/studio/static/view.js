// The bodies in three dimensions: turned by pointer or keys, cut open, moved apart. Drawn when something changes alone.
import * as three from "/vendor/three.module.min.js";
import { element } from "./dom.js";

const CUT = new three.Plane(new three.Vector3(0, 1, 0), 1e-3);
const BASE = new three.Plane(new three.Vector3(0, 0, -1), 0.01);
const MARKS = { error: 0xd93025, warning: 0xe09b00, note: 0x2a7ab8 };

function bytes(text) {
  const raw = atob(text);
  const made = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k += 1) made[k] = raw.charCodeAt(k);
  return made.buffer;
}

/** A renderer, or null where the browser has no WebGL. */
function renderer() {
  try {
    const made = new three.WebGLRenderer({ antialias: true, alpha: true });
    made.localClippingEnabled = true;
    return made;
  } catch {
    return null;
  }
}

export class View {
  constructor(host) {
    this.host = host;
    this.renderer = renderer();
    if (!this.renderer) {
      host.replaceChildren(element("p", { class: "muted" }, "This browser offers no WebGL: the section stands alone."));
      host.classList.add("none");
      return;
    }
    this.scene = new three.Scene();
    this.camera = new three.PerspectiveCamera(30, 1, 1, 5000);
    this.camera.up.set(0, 0, 1);
    this.sun = new three.DirectionalLight(0xffffff, 2.1);
    this.scene.add(new three.HemisphereLight(0xffffff, 0x8899aa, 1.5), this.sun);
    Object.assign(this, { groups: new Map(), azimuth: -1.1, height: 0.42, zoom: 1, open: true, apart: 0, findings: [] });
    // Without a graphics card a frame takes the processor longer than an answer of the atlas.
    const info = this.renderer.getContext().getExtension("WEBGL_debug_renderer_info");
    const name = info ? this.renderer.getContext().getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
    this.drawnBySoftware = /swiftshader|llvmpipe|software/i.test(name);
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "The sensor in three dimensions. Arrow keys turn it, plus and minus zoom.");
    host.replaceChildren(this.canvas);
    this.listen();
  }

  listen() {
    const { canvas } = this;
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons) this.turn(-0.01 * event.movementX, 0.01 * event.movementY);
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.scale(Math.exp(0.001 * event.deltaY));
    }, { passive: false });
    const steps = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, 0.15], ArrowDown: [0, -0.15] };
    canvas.addEventListener("keydown", (event) => {
      if (steps[event.key]) this.turn(...steps[event.key]);
      else if (event.key === "+" || event.key === "=") this.scale(0.9);
      else if (event.key === "-") this.scale(1.1);
      else return;
      event.preventDefault();
    });
    new ResizeObserver(() => this.draw()).observe(this.host);
  }

  turn(sideways, upwards) {
    this.azimuth += sideways;
    this.height = Math.max(-1.5, Math.min(1.5, this.height + upwards));
    this.draw();
  }

  scale(factor) {
    this.zoom = Math.max(0.3, Math.min(4, this.zoom * factor));
    this.draw();
  }

  /** Bodies in place of those before; a body of a name that is there already keeps its materials. */
  show(bodies) {
    if (!this.renderer) return;
    const before = this.groups;
    this.groups = new Map(bodies.map((body) => [body.name, this.group(body, before.get(body.name))]));
    for (const [name, group] of before) if (!this.groups.has(name)) this.drop(group);
    this.bounds = new three.Box3();
    for (const group of this.groups.values()) this.bounds.expandByObject(group);
    this.mark(this.findings);
    this.draw();
  }

  group(body, known) {
    const shape = new three.BufferGeometry();
    shape.setAttribute("position", new three.BufferAttribute(new Float32Array(bytes(body.corners)), 3));
    shape.setAttribute("normal", new three.BufferAttribute(new Int8Array(bytes(body.normals)), 3, true));
    const group = this.made(shape, body.colour, known);
    this.scene.add(group);
    return group;
  }

  /** A shape seen from outside and from within; in the group that is known, whose shaders are compiled already. */
  made(shape, colour, known) {
    if (known) {
      known.children[0].geometry.dispose();
      for (const part of known.children.slice(0, 2)) part.geometry = shape;
    }
    const materials = known?.userData.materials ?? [
      new three.MeshStandardMaterial({ roughness: 0.55, metalness: 0 }),
      // Where a body is cut open its far side is seen from within: in one flat colour that reads as the cut face.
      new three.MeshBasicMaterial({ side: three.BackSide }),
    ];
    materials[0].color.set(colour);
    materials[1].color.set(colour).multiplyScalar(0.62);
    if (known) return known;
    const group = new three.Group();
    group.add(...materials.map((material) => new three.Mesh(shape, material)));
    group.userData = { materials };
    return group;
  }

  drop(group) {
    this.scene.remove(group);
    for (const part of group.children) {
      part.geometry.dispose();
      part.material.dispose();
    }
  }

  /** Spheres where findings of the print rules lie; they move with their bodies. */
  mark(findings) {
    if (!this.renderer || (!findings.length && !this.findings.length)) return;
    this.findings = findings;
    if (!this.bounds) return;
    const radius = 0.012 * this.bounds.getSize(new three.Vector3()).length();
    for (const group of this.groups.values()) group.remove(...group.children.slice(2));
    for (const finding of findings) {
      const group = this.groups.get(finding.body);
      if (!group || !finding.where_mm) continue;
      const look = new three.MeshBasicMaterial({ color: MARKS[finding.severity], depthTest: false });
      const sphere = new three.Mesh(new three.SphereGeometry(radius, 16, 12), look);
      sphere.position.set(...finding.where_mm);
      sphere.renderOrder = 1;
      group.add(sphere);
    }
    this.draw();
  }

  /** The wall as pressed, turned about the axis, in place of the membrane above the base; null for the sensor as printed. */
  press(pressed) {
    if (!this.renderer || (!pressed && !this.pressed)) return;
    this.pressed = Boolean(pressed);
    if (pressed) this.wall = this.turned(pressed);
    if (pressed) this.scene.add(this.wall);
    else this.scene.remove(this.wall);
    this.draw();
  }

  turned({ walls, at }) {
    const points = walls[at];
    const loop = [];
    for (let k = 0; k < points.length; k += 2) loop.push(new three.Vector2(Math.max(0, points[k]), points[k + 1]));
    const shape = new three.LatheGeometry([...loop, loop[0]].reverse(), 96);
    shape.rotateX(Math.PI / 2);
    const [membrane] = this.groups.values();
    return this.made(shape, membrane ? membrane.userData.materials[0].color : 0xd98a4b, this.wall);
  }

  set({ open = this.open, apart = this.apart }) {
    Object.assign(this, { open, apart });
    this.draw();
  }

  /** Draw once before the next frame, whatever changed until then. */
  draw() {
    this.due ??= requestAnimationFrame(() => this.render());
  }

  render() {
    this.due = null;
    if (!this.renderer || !this.bounds) return;
    const width = this.host.clientWidth;
    const height = this.host.clientHeight;
    if (!width || !height) return;
    const size = this.bounds.getSize(new three.Vector3());
    const middle = this.bounds.getCenter(new three.Vector3());
    [...this.groups.values()].forEach((group, k) => {
      // The membrane comes first: it goes up, and each other body further down.
      group.position.z = this.apart * size.z * (k ? 0.25 - 0.75 * k : 0.55);
      // A pressed wall takes the place of the printed one above the base.
      const planes = [...(this.open ? [CUT] : []), ...(this.pressed && !k ? [BASE] : [])];
      for (const material of group.userData.materials) material.clippingPlanes = planes;
      if (!k && this.pressed) {
        this.wall.position.z = group.position.z;
        for (const material of this.wall.userData.materials) material.clippingPlanes = this.open ? [CUT] : [];
      }
    });
    const far = (1.42 + 1.1 * this.apart) * size.length() * this.zoom * Math.max(1, height / width);
    const flat = far * Math.cos(this.height);
    this.camera.position.set(
      middle.x + flat * Math.cos(this.azimuth),
      middle.y + flat * Math.sin(this.azimuth),
      middle.z + far * Math.sin(this.height),
    );
    this.camera.aspect = width / height;
    this.camera.near = 0.05 * far;
    this.camera.far = 5 * far;
    this.camera.updateProjectionMatrix();
    this.camera.lookAt(middle);
    this.sun.position.copy(this.camera.position).add(new three.Vector3(0, 0, 0.6 * far));
    this.fit(width, height, Math.min(2, window.devicePixelRatio || 1));
    this.renderer.render(this.scene, this.camera);
  }

  /** Pixels for the place of the view: to set them makes a new buffer, whatever they were. */
  fit(width, height, ratio) {
    const now = [width, height, ratio].join();
    if (now === this.fitted) return;
    this.fitted = now;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
  }
}
