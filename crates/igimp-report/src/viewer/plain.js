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
    const [axis, side] = [Math.floor(face / 2), 2 * (face % 2) - 1];
    if (side * place.eye[axis] <= 1e-6 || scene.isLeftOut(box)) continue;
    const [low, high] = [scene.corner("low", box), scene.corner("high", box)];
    if (cut && !clipped(low, high, cut)) continue;
    const about = [0, 1, 2].map((j) => (lie[4 * box + j] - 128) / 127 + (j === axis ? 0.3 * side : 0));
    const length = Math.hypot(...about) || 1;
    const light = dimension === 2 ? 1 : lightOf(place, about.map((x) => x / length), lie[4 * box + 3] / 255);
    add(box, face, light, cornersOf(low, high, face));
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

// Takes from a box what the cut takes away; false where that is all of it, or the face that is cut off.
function clipped(low, high, { axis, normal, offset }) {
  const at = offset * normal[axis];
  if (normal[axis] > 0) high[axis] = Math.min(high[axis], at);
  else low[axis] = Math.max(low[axis], at);
  return low[axis] < high[axis];
}
