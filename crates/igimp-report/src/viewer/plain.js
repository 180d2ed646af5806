// Boxes on an ordinary canvas, where there is no WebGL2.

// Boxes without WebGL2: faces from the farthest to the nearest, and those of the cut.
function paintBoxes(pen, place, scene) {
  const { boxes: { faces, lie, count }, camera, dimension, colours } = scene;
  // A slanted cut asks for WebGL2.
  const cut = scene.cut && scene.cut.axis >= 0 ? scene.cut : null;
  const quads = [];
  const add = (box, face, light, corners) => {
    const points = corners.map((corner) => projected(place, camera, corner));
    quads.push({ box, light, points, depth: points.reduce((sum, point) => sum + point[2], 0) });
  };
  for (let k = 0; k < faces.box.length; k += 1) {
    const [box, face] = [faces.box[k], faces.face[k]];
    const side = 2 * (face % 2) - 1;
    if (scene.isLeftOut(box)) continue;
    const corners = cornersOf(scene.boxes, box);
    const [a, b, c, d] = aroundFace(face).map((corner) => corners[corner]);
    const diagonals = [[a, c], [b, d]].map(([from, to]) => to.map((x, j) => x - from[j]));
    const across = cross(...diagonals).map((x) => side * x);
    if (dot(across, place.eye) <= 0) continue;
    if (cut && !clipped(corners, cut)) continue;
    const about = across.map((x, j) => x / Math.hypot(...across) + (lie[4 * box + j] - 128) / 127);
    const length = Math.hypot(...about) || 1;
    const light = dimension === 2 ? 1 : lightOf(place, about.map((x) => x / length), lie[4 * box + 3] / 255);
    add(box, face, light, aroundFace(face).map((corner) => corners[corner]));
  }
  if (cut && dot(cut.normal, place.eye) > 0) {
    for (let box = 0; box < count; box += 1) {
      const corners = scene.isLeftOut(box) ? [] : faceIn(scene.boxes, box, cut);
      if (corners.length > 0) add(box, 2 * cut.axis, 0.97, corners);
    }
  }
  if (dimension === 3) quads.sort((a, b) => a.depth - b.depth);
  pen.lineWidth = 0.7;
  for (const { box, light, points } of quads) {
    const colour = [0, 1, 2].map((k) => Math.min(Math.round(light * colours[4 * box + k]), 255));
    pen.fillStyle = `rgb(${colour})`;
    pen.strokeStyle = pen.fillStyle;
    scene.trace(pen, points);
    pen.fill();
    pen.stroke();
  }
}

// Takes from the corners of a box what the cut takes away; false where that is all of it.
function clipped(corners, { axis, normal, offset }) {
  const beyond = (corner) => normal[axis] * corner[axis] - offset;
  if (corners.every((corner) => beyond(corner) >= 0)) return false;
  for (const corner of corners) if (beyond(corner) > 0) corner[axis] = offset * normal[axis];
  return true;
}
