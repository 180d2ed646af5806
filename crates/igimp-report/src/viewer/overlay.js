// What lies over the particles: contours, edges of the bodies, water, the slip line, reinforcement, arrows of a vector,
// principal stresses, a section.

// Most arrows or crosses, and their length where the value is largest [CSS pixel].
const MOST_ARROWS = 450;
const LONGEST_ARROW = 34;

const SLIP = "#c00020";

class Overlay {
  constructor(scene) {
    this.scene = scene;
    this.water = new Water(scene);
    this.contours = new Contours(scene);
    this.arrows = null;
    this.section = null;
  }

  see(place, x, y, z = 0) {
    return projected(place, this.scene.camera, [x, y, z]);
  }

  // Follows lines of the plane: corners one after another, and where each line ends among them.
  each({ corners, ends }, place, call) {
    let start = 0;
    ends.forEach((end, k) => {
      const points = [];
      for (let at = start; at < end; at += 1) points.push(this.see(place, corners[2 * at], corners[2 * at + 1]));
      start = end;
      if (points.length > 1) call(points, k);
    });
  }

  // Pieces without WebGL2.
  pieces(pen, place, colours) {
    const { pieces } = this.scene.boxes;
    pen.lineWidth = 0.7;
    this.each(pieces, place, (points, k) => {
      const box = pieces.whose[k];
      pen.fillStyle = `rgb(${colours.subarray(4 * box, 4 * box + 3)})`;
      pen.strokeStyle = pen.fillStyle;
      this.scene.trace(pen, points);
      pen.fill();
      pen.stroke();
    });
  }

  // Whose the piece is that is drawn last over a point, and -1 where there is none.
  pieceAt(x, y) {
    const piece = this.pieceOver(x, y);
    return piece < 0 ? -1 : this.scene.boxes.pieces.whose[piece];
  }

  // The piece that is drawn last over a point, and -1 where there is none.
  pieceOver(x, y) {
    const { corners, ends } = this.scene.boxes.pieces;
    for (let k = ends.length - 1; k >= 0; k -= 1) {
      const [start, end] = [k > 0 ? ends[k - 1] : 0, ends[k]];
      let isInside = false;
      for (let at = start, before = end - 1; at < end; before = at, at += 1) {
        const [xa, ya, xb, yb] = [corners[2 * at], corners[2 * at + 1], corners[2 * before], corners[2 * before + 1]];
        if (ya > y !== yb > y && x < xa + ((xb - xa) * (y - ya)) / (yb - ya)) isInside = !isInside;
      }
      if (isInside) return k;
    }
    return -1;
  }

  markPiece(pen, place, box) {
    const { pieces } = this.scene.boxes;
    this.each(pieces, place, (points, k) => {
      if (pieces.whose[k] !== box) return;
      this.scene.trace(pen, points);
      pen.stroke();
    });
  }

  paint(pen, place) {
    const { scene } = this;
    this.contours.paint(pen, place);
    if (scene.outlined && scene.dimension === 2) this.edges(pen, place);
    if (scene.outlined && scene.dimension === 3 && !scene.surface) sketched(pen, place, scene, [...scene.segments, ...scene.seams]);
    this.water.paint(pen, place);
    this.slip(pen, place);
    this.members(pen, place);
    this.contours.write(pen, place);
    if (this.arrows) this.paintArrows(pen, place);
    if (this.section) this.paintSection(pen, place);
  }

  // The edges of the bodies of the plane.
  edges(pen, place) {
    const { edges } = this.scene.boxes;
    if (!edges) return;
    pen.strokeStyle = cssColour("--ink") || cssColour("--soft");
    pen.lineWidth = 1.1;
    this.each(edges, place, (points) => {
      this.scene.trace(pen, points);
      pen.stroke();
    });
  }

  // The line along which soil shears most as it begins to fail, or the surface.
  slip(pen, place) {
    const { slip } = this.scene.bodies;
    if (!slip) return;
    if (this.scene.dimension === 3) {
      this.water.surface(pen, place, slip, SLIP);
      return;
    }
    const points = slip.map(([x, y]) => this.see(place, x, y));
    pen.lineJoin = "round";
    for (const [width, colour] of [[5, "rgba(255,255,255,0.8)"], [2.4, SLIP]]) {
      pen.lineWidth = width;
      pen.strokeStyle = colour;
      pen.beginPath();
      Contours.curve(pen, points);
      pen.stroke();
    }
    pen.lineJoin = "miter";
  }

  // Reinforcement: a heavy line with a light core, as in the pictures of a report.
  members(pen, place) {
    const { members } = this.scene.bodies;
    for (const [width, colour] of [[4, "#202020"], [1.6, "#ffffff"]]) {
      pen.lineWidth = width;
      pen.strokeStyle = colour;
      pen.lineCap = "round";
      pen.beginPath();
      for (let at = 0; at < members.length; at += 6) {
        const [from, to] = [0, 3].map((k) => this.see(place, members[at + k], members[at + k + 1], members[at + k + 2]));
        pen.moveTo(from[0], from[1]);
        pen.lineTo(to[0], to[1]);
      }
      pen.stroke();
    }
    pen.lineCap = "butt";
  }

  // The boxes with a face towards the eye, that no cut takes away.
  facing(place) {
    const { boxes, cut } = this.scene;
    const seen = new Set();
    for (let k = 0; k < boxes.faces.box.length; k += 1) {
      const [box, face] = [boxes.faces.box[k], boxes.faces.face[k]];
      const isFront = (2 * (face % 2) - 1) * place.eye[Math.floor(face / 2)] > 1e-6;
      if (isFront && !this.scene.isLeftOut(box) && (!cut || dot(cut.normal, this.scene.centre(box)) <= cut.offset)) seen.add(box);
    }
    return seen;
  }

  // The particles that have an arrow: those nearest to the middles of a raster of the canvas, on the skin in space.
  rastered(place) {
    const { boxes } = this.scene;
    const spacing = Math.max(12, Math.sqrt((place.width * place.height) / MOST_ARROWS));
    const found = new Map();
    const seen = this.scene.dimension === 2 ? null : this.facing(place);
    for (let box = 0; box < boxes.count; box += 1) {
      if (seen && !seen.has(box)) continue;
      const [x, y] = this.see(place, ...this.scene.centre(box));
      const [i, j] = [Math.floor(x / spacing), Math.floor(y / spacing)];
      const off = Math.hypot(x - (i + 0.5) * spacing, y - (j + 0.5) * spacing);
      const known = found.get(`${i} ${j}`);
      if (!known || off < known.off) found.set(`${i} ${j}`, { box, x, y, off });
    }
    return [...found.values()];
  }

  // Arrows of vectors, or crosses of principal stresses: long as the value is over the largest of all particles.
  paintArrows(pen, place) {
    const { numbers, components, largest, kind } = this.arrows;
    if (!(largest > 0)) return;
    const size = LONGEST_ARROW / largest;
    const spots = this.rastered(place);
    this.scene.canvas.dataset.arrows = spots.length;
    for (const { box, x, y } of spots) {
      const own = numbers.subarray(components * box, components * (box + 1));
      // Light on dark soil.
      const inks = isDark(this.scene.colours.subarray(4 * box, 4 * box + 3)) ? ["rgba(0,0,0,0.5)", "#ffffff"] : ["rgba(255,255,255,0.6)", "#101010"];
      if (kind === "stress") this.cross(pen, x, y, own, size, inks);
      else {
        const across = [place.right, place.up].map((way) => size * dot(way, own));
        Overlay.arrow(pen, x, y, across[0], -across[1], inks);
      }
    }
  }

  static arrow(pen, x, y, dx, dy, inks) {
    const length = Math.hypot(dx, dy);
    if (!(length > 0.8)) return;
    const head = Math.min(5, 0.5 * length);
    const [ux, uy] = [dx / length, dy / length];
    const trace = () => {
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(x + dx, y + dy);
      for (const side of [-1, 1]) {
        pen.moveTo(x + dx, y + dy);
        pen.lineTo(x + dx - head * (ux + side * 0.5 * uy), y + dy - head * (uy - side * 0.5 * ux));
      }
      pen.stroke();
    };
    pen.strokeStyle = inks[0];
    pen.lineWidth = 2.4;
    trace();
    pen.strokeStyle = inks[1];
    pen.lineWidth = 1.2;
    trace();
  }

  // The two principal stresses in the plane, by σxx, σyy and σxy with tension positive: dark or light in compression, red in tension.
  cross(pen, x, y, own, size, inks) {
    for (const { value, angle } of principal(own[0], own[1], own[3])) {
      const half = 0.5 * size * Math.abs(value);
      if (half < 0.4) continue;
      const [dx, dy] = [half * Math.cos(angle), -half * Math.sin(angle)];
      const trace = () => {
        pen.beginPath();
        pen.moveTo(x - dx, y - dy);
        pen.lineTo(x + dx, y + dy);
        pen.stroke();
      };
      pen.strokeStyle = value > 0 ? "rgba(255,255,255,0.8)" : inks[0];
      pen.lineWidth = 2.4;
      trace();
      pen.strokeStyle = value > 0 ? "#c00020" : inks[1];
      pen.lineWidth = 1.2;
      trace();
    }
  }

  paintSection(pen, place) {
    const [from, to] = this.section.map((point) => this.see(place, ...point));
    pen.setLineDash([6, 4]);
    pen.strokeStyle = cssColour("--cursor");
    pen.lineWidth = 2;
    pen.beginPath();
    pen.moveTo(from[0], from[1]);
    pen.lineTo(to[0], to[1]);
    pen.stroke();
    pen.setLineDash([]);
    pen.fillStyle = cssColour("--cursor");
    pen.font = "600 12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.fillText("A", from[0], from[1] - 6);
    pen.fillText("B", to[0], to[1] - 6);
  }
}

// Principal values of a symmetric tensor of the plane with the angles of their directions to x, largest first.
function principal(xx, yy, xy) {
  const [mean, half] = [0.5 * (xx + yy), 0.5 * (xx - yy)];
  const radius = Math.hypot(half, xy);
  const angle = 0.5 * Math.atan2(xy, half);
  return [{ value: mean + radius, angle }, { value: mean - radius, angle: angle + Math.PI / 2 }];
}
