// Outlines in space: edges of bodies of soil, as the program hands them over, and those of rigid bodies, where their triangles
// turn. In the plane the overlay draws the edges.

// Triangles that turn by less than this from one to the next have no edge between them, by the cosine.
const BLUNT = Math.cos(Math.PI / 6);

// Lines of corners, one after another, as segments of six numbers.
function segmentsOf({ corners, ends }) {
  const found = [];
  let start = 0;
  ends.forEach((end) => {
    for (let at = start; at + 1 < end; at += 1) for (let k = 0; k < 6; k += 1) found.push(corners[3 * at + k]);
    start = end;
  });
  return found;
}

// The edges at which triangles turn, or end, as segments of six numbers.
function creasesOf(triangles) {
  const edges = new Map();
  for (let at = 0; at + 8 < triangles.length; at += 9) {
    const corners = [0, 3, 6].map((k) => Array.from(triangles.slice(at + k, at + k + 3)));
    const [u, v] = [1, 2].map((k) => corners[k].map((x, axis) => x - corners[0][axis]));
    const across = cross(u, v);
    const length = Math.hypot(...across) || 1;
    const normal = across.map((x) => x / length);
    corners.forEach((from, k) => {
      const ends = [from, corners[(k + 1) % 3]];
      const key = ends.map((end) => end.join(" ")).sort().join(" / ");
      const own = edges.get(key);
      if (own) own.normals.push(normal);
      else edges.set(key, { ends, normals: [normal] });
    });
  }
  const isCrease = ({ normals: [a, b] }) => !b || dot(a, b) < BLUNT;
  return [...edges.values()].filter(isCrease).flatMap(({ ends }) => ends.flat());
}

// The length of segments of six numbers [m].
function lengthOf(segments) {
  let sum = 0;
  for (let at = 0; at < segments.length; at += 6) sum += Math.hypot(...[0, 1, 2].map((k) => segments[at + 3 + k] - segments[at + k]));
  return sum;
}

// Draws segments without WebGL2, those behind the soil too; what a cut takes away is left out.
function sketched(pen, place, scene, segments) {
  const { camera, cut } = scene;
  pen.strokeStyle = cssColour("--ink") || cssColour("--soft");
  pen.lineWidth = 1.1;
  pen.beginPath();
  for (let at = 0; at < segments.length; at += 6) {
    const ends = [0, 3].map((k) => Array.from(segments.slice(at + k, at + k + 3)));
    if (cut && ends.some((end) => dot(cut.normal, end) > cut.offset + 1e-9 * Math.abs(cut.offset))) continue;
    const [from, to] = ends.map((end) => projected(place, camera, end));
    pen.moveTo(from[0], from[1]);
    pen.lineTo(to[0], to[1]);
  }
  pen.stroke();
}
