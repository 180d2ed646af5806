// Where the body is looked at from: a parallel projection, so that lengths in a direction stay comparable.

const ROOM = { plane: { left: 46, right: 8, top: 8, bottom: 26 }, space: { left: 64, right: 40, top: 26, bottom: 38 } };

// Turned about the upright axis and raised above the level plane [°].
const VIEWS = {
  isometric: [45, 35.264], front: [0, 0], back: [180, 0], left: [-90, 0], right: [90, 0], top: [0, 90], bottom: [0, -90],
};

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

class Camera {
  constructor(dimension) {
    this.dimension = dimension;
    this.reset();
  }

  reset() {
    this.look(this.dimension === 2 ? "top" : "isometric");
  }

  look(name) {
    [this.turn, this.raise] = VIEWS[name];
    this.fitted = VIEWS[name];
    this.zoom = 1;
    this.pan = [0, 0];
  }

  rotate(turn, raise) {
    if (this.dimension === 2) return;
    this.turn = ((this.turn + turn + 540) % 360) - 180;
    this.raise = Math.min(Math.max(this.raise + raise, -90), 90);
  }

  // Unit vectors to the right, upwards and towards the eye, in the axes of the body.
  directions([turn, raise] = [this.turn, this.raise]) {
    const [t, r] = [(turn * Math.PI) / 180, (raise * Math.PI) / 180];
    const right = [Math.cos(t), Math.sin(t), 0];
    const eye = [Math.cos(r) * Math.sin(t), -Math.cos(r) * Math.cos(t), Math.sin(r)];
    return { right, up: cross(eye, right), eye };
  }

  // Size in CSS pixels, and the projection that brings what is in sight into it.
  layout(width, extent) {
    const { low, high } = extent;
    const room = this.dimension === 2 ? ROOM.plane : ROOM.space;
    const inner = Math.max(width - room.left - room.right, 50);
    const { right, up } = this.directions(this.fitted);
    const across = (v) => [0, 1, 2].reduce((sum, k) => sum + Math.abs(v[k]) * (high[k] - low[k]), 0) || 1;
    const wanted = this.dimension === 2 ? (inner * across(up)) / across(right) : 0.62 * inner;
    const tall = Math.min(Math.max(wanted, this.dimension === 2 ? 120 : 260), 0.68 * window.innerHeight);
    const height = Math.round(tall) + room.top + room.bottom;
    const inside = height - room.top - room.bottom;
    const scale = this.zoom * Math.min(inner / across(right), inside / across(up));
    return {
      width, height, room, scale, centre: low.map((x, k) => 0.5 * (x + high[k])), ...this.directions(),
      middle: [room.left + inner / 2, room.top + inside / 2],
      deep: 0.5 * Math.hypot(...low.map((x, k) => high[k] - x)) || 1,
    };
  }
}

// A point of space on the canvas [CSS pixel], and how near it is [m].
function projected(place, camera, point) {
  const from = [0, 1, 2].map((k) => point[k] - place.centre[k]);
  return [
    place.middle[0] + (dot(place.right, from) - camera.pan[0]) * place.scale,
    place.middle[1] - (dot(place.up, from) - camera.pan[1]) * place.scale,
    dot(place.eye, from),
  ];
}

// A point of the canvas in space, in the plane through the centre that faces the eye.
function lifted(place, camera, x, y) {
  const a = (x - place.middle[0]) / place.scale + camera.pan[0];
  const b = (place.middle[1] - y) / place.scale + camera.pan[1];
  return [0, 1, 2].map((k) => place.centre[k] + a * place.right[k] + b * place.up[k]);
}

// How light a surface is, by its normal and by how free it lies; the same in pictures for print.
function lightOf(place, normal, open) {
  const towards = [0, 1, 2].map((k) => -0.35 * place.right[k] + 0.6 * place.up[k] + 0.72 * place.eye[k]);
  const share = Math.max(dot(normal, towards) / Math.hypot(...towards), 0);
  const hollow = Math.min(Math.max((open - 0.12) / 0.3, 0), 1);
  return (0.5 + 0.52 * share) * (0.72 + 0.28 * hollow);
}
