// Water tables and free surfaces over the body: lines in the plane; in space surfaces on a raster, where they meet the cut, and
// where soil slips.

const WATER = "#0072b2";

// The triangles of a raster { x, y, z }, by their corners; none where a corner has no level.
function trianglesOf({ x, y, z }) {
  const corner = (i, j) => (z[j][i] === null ? null : [x[i], y[j], z[j][i]]);
  const triangles = [];
  for (let j = 0; j + 1 < y.length; j += 1) {
    for (let i = 0; i + 1 < x.length; i += 1) {
      const [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
      for (const own of [[a, b, c], [a, c, d]]) if (own.every(Boolean)) triangles.push(own);
    }
  }
  return triangles;
}

// What a triangle is cut into by a plane: the part that the cut leaves, and where it meets the plane.
function parted(triangle, { normal, offset }) {
  const beyond = triangle.map((corner) => dot(normal, corner) - offset);
  const [kept, met] = [[], []];
  triangle.forEach((corner, k) => {
    const next = (k + 1) % 3;
    if (beyond[k] <= 0) kept.push(corner);
    if (beyond[k] > 0 === beyond[next] > 0) return;
    const share = beyond[k] / (beyond[k] - beyond[next]);
    const point = corner.map((own, axis) => own + share * (triangle[next][axis] - own));
    kept.push(point);
    met.push(point);
  });
  return { kept, met };
}

// Upright lines of a raster as far as the plan of the soil goes, thinned to at most so many each way.
function thinned({ x, y, z }, { low, high }, most) {
  const pick = (places, axis) => {
    const inside = places.map((_, k) => k).filter((k) => places[k] >= low[axis] - 1e-9 && places[k] <= high[axis] + 1e-9);
    const every = Math.ceil(inside.length / most);
    return inside.filter((_, k) => k % every === 0 || k === inside.length - 1);
  };
  const [across, along] = [pick(x, 0), pick(y, 1)];
  return { x: across.map((i) => x[i]), y: along.map((j) => y[j]), z: along.map((j) => across.map((i) => z[j][i])) };
}

// The triangles of a surface by their corners, as far as the plan of the soil goes.
function sheetOf(raster, extent) {
  return trianglesOf(thinned(raster, extent, 24));
}

class Water {
  constructor(scene) {
    this.scene = scene;
  }

  paint(pen, place) {
    const { bodies, dimension } = this.scene;
    for (const own of bodies.water) {
      if (dimension === 2) this.line(pen, place, own.map(([x, y]) => projected(place, this.scene.camera, [x, y, 0])));
      else Water.sign(pen, ...this.surface(pen, place, own, WATER));
    }
  }

  // A line, with the sign of a free surface at its highest end.
  line(pen, place, points) {
    Water.heavy(pen, [points], WATER);
    const { left, right } = place.room;
    const inside = points.filter(([x]) => x > left + 8 && x < place.width - right - 8);
    const [x, y] = inside.length > 0 ? inside.reduce((best, own) => (own[1] < best[1] ? own : best)) : [left + 14, points[0][1]];
    Water.sign(pen, x, y);
  }

  static heavy(pen, lines, own) {
    for (const [width, colour] of [[4, "rgba(255,255,255,0.7)"], [1.8, own]]) {
      pen.lineWidth = width;
      pen.strokeStyle = colour;
      pen.beginPath();
      for (const points of lines) points.forEach(([x, y], k) => (k === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y)));
      pen.stroke();
    }
  }

  static sign(pen, x, y) {
    if (!Number.isFinite(y)) return;
    pen.fillStyle = WATER;
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(x - 5, y - 8);
    pen.lineTo(x + 5, y - 8);
    pen.fill();
  }

  // A heavy line where the cut meets a surface, and its highest place. Without WebGL2 the surface is drawn here too, over the soil.
  surface(pen, place, raster, colour) {
    const { scene } = this;
    const seen = (points) => points.map((own) => projected(place, scene.camera, own));
    const triangles = sheetOf(raster, scene.extent);
    const parts = scene.cut ? triangles.map((own) => parted(own, scene.cut)) : triangles.map((kept) => ({ kept, met: [] }));
    if (!scene.surface) Water.sheet(pen, parts.map(({ kept }) => seen(kept)), colour);
    const lines = parts.map(({ met }) => seen(met)).filter((own) => own.length > 1);
    Water.heavy(pen, lines, colour);
    scene.canvas.dataset[colour === WATER ? "waterCut" : "slipCut"] = lines.length;
    return lines.flat().reduce((best, own) => (own[1] < best[1] ? own : best), [0, Infinity]);
  }

  static sheet(pen, parts, colour) {
    pen.beginPath();
    for (const points of parts) {
      points.forEach(([x, y], k) => (k === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y)));
      if (points.length > 0) pen.closePath();
    }
    pen.fillStyle = `${colour}38`;
    pen.fill();
    pen.strokeStyle = `${colour}73`;
    pen.lineWidth = 0.6;
    pen.stroke();
  }
}
