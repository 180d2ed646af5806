// Boxes drawn by WebGL2: a quad for every face that is seen, the face of a cut, pieces of the
// plane in their place where there are some, and rigid bodies as translucent triangles.

// A colour of a style as three shares.
function sharesOf(colour) {
  const digits = /^#(..)(..)(..)$/.exec(colour);
  return digits ? digits.slice(1).map((part) => parseInt(part, 16) / 255) : [0.7, 0.7, 0.7];
}

function program(gl, sources) {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, sources[0]], [gl.FRAGMENT_SHADER, sources[1]]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made) || "no program");
  const names = Array.from({ length: gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS) }, (_, k) => gl.getActiveUniform(made, k).name);
  return { made, at: Object.fromEntries(names.map((name) => [name, gl.getUniformLocation(made, name)])) };
}

class Surface {
  // Throws where there is no WebGL2.
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: true, preserveDrawingBuffer: true });
    if (!this.gl) throw new Error("no WebGL2");
    const { gl } = this;
    this.programs = { boxes: program(gl, [BOXES, INK]), bodies: program(gl, [BODIES, GREY]), pieces: program(gl, [PIECES, PLAIN]), strips: program(gl, [STRIPS, STRIP]) };
    this.arrays = { faces: gl.createVertexArray(), bodies: gl.createVertexArray(), pieces: gl.createVertexArray(), slices: gl.createVertexArray(), strips: gl.createVertexArray(), seams: gl.createVertexArray(), water: gl.createVertexArray(), slip: gl.createVertexArray() };
    this.buffers = new Map();
    this.count = { faces: 0, bodies: 0, pieces: 0, slices: 0, strips: 0, seams: 0, water: 0, slip: 0 };
    [this.levels, this.light] = [0, 0];
  }

  // Hands numbers over: `per` components of a type at a place of the program, for every instance.
  hand(of, place, per, kind, data, isForEach = 1) {
    const { gl } = this;
    const name = `${of} ${place}`;
    if (!this.buffers.has(name)) this.buffers.set(name, gl.createBuffer());
    gl.bindVertexArray(this.arrays[of]);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.get(name));
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, per, kind, kind === gl.UNSIGNED_BYTE && per === 4, 0, 0);
    gl.vertexAttribDivisor(place, isForEach);
  }

  // Boxes relative to `origin`, and which of them the faces that are seen belong to.
  shape(boxes, triangles) {
    const { gl } = this;
    const { low, high, lie, moves, faces, origin, pieces } = boxes;
    this.boxes = boxes;
    const near = (numbers) => Float32Array.from(numbers, (x, k) => x - origin[k % 3]);
    const [own, ends] = [near(low), near(high)];
    const pick = (numbers, per) => {
      const picked = new numbers.constructor(per * faces.box.length);
      for (let k = 0; k < faces.box.length; k += 1) {
        for (let c = 0; c < per; c += 1) picked[per * k + c] = numbers[per * faces.box[k] + c];
      }
      return picked;
    };
    this.pick = pick;
    this.hand("faces", 0, 3, gl.FLOAT, pick(own, 3));
    this.hand("faces", 1, 3, gl.FLOAT, pick(ends, 3));
    this.hand("faces", 2, 4, gl.UNSIGNED_BYTE, pick(lie, 4));
    this.hand("faces", 4, 1, gl.UNSIGNED_BYTE, faces.face);
    for (let axis = 0; axis < 3; axis += 1) {
      // The corners of a face in the order of a strip.
      const own = new Uint8Array(4 * faces.box.length);
      faces.box.forEach((box, k) => {
        const around = aroundFace(faces.face[k]);
        [0, 1, 3, 2].forEach((turn, j) => (own[4 * k + j] = moves[24 * box + 3 * around[turn] + axis]));
      });
      this.hand("faces", 7 + axis, 4, gl.UNSIGNED_BYTE, own);
    }
    this.hand("bodies", 0, 3, gl.FLOAT, near(triangles), 0);
    const corners = pieces ? this.fans(pieces, origin) : 0;
    this.count = { ...this.count, faces: faces.box.length, bodies: triangles.length / 3, pieces: corners, slices: 0 };
    this.levels = 0;
  }

  // Outlines or the lines of a cut: segments of six numbers. They are drawn nearer to the eye by the width of a box, whose corners
  // would hide them.
  lines(of, segments, { low, high, origin, count }) {
    const { gl } = this;
    const end = (from) => Float32Array.from({ length: segments.length / 2 }, (_, k) => segments[6 * Math.floor(k / 3) + from + (k % 3)] - origin[k % 3]);
    [0, 3].forEach((from, place) => this.hand(of, place, 3, gl.FLOAT, end(from)));
    this.count[of] = segments.length / 6;
    const some = Array.from({ length: Math.min(count, 999) }, (_, k) => Math.floor((k * count) / 999)).filter((box) => box < count);
    const widths = some.map((box) => Math.max(...[0, 1, 2].map((axis) => high[3 * box + axis] - low[3 * box + axis])));
    this.nearer = widths.sort((a, b) => a - b)[Math.floor(widths.length / 2)] || 0;
  }

  // Contours: levels at the eight corners of every box, the first contour at 0, the next at 1, with the colours of
  // the scale there; none without them.
  contour(corners, colours) {
    const { gl, pick } = this;
    this.levels = corners ? colours.length : 0;
    this.light = colours.reduce((bits, colour, k) => (isDark(colour) ? bits | (1 << k) : bits), 0);
    this.corners = corners;
    if (!corners) return;
    [0, 4].forEach((first, k) => {
      const own = Float32Array.from({ length: corners.length / 2 }, (_, at) => corners[8 * (at >> 2) + first + (at & 3)]);
      this.hand("faces", 5 + k, 4, gl.FLOAT, pick(own, 4));
    });
    this.levelSlices();
  }

  // Levels at the corners of the cut.
  levelSlices() {
    const { gl, corners, slicePlaces, boxes } = this;
    if (this.levels === 0 || this.count.slices === 0) return;
    this.sliceLevels = Float32Array.from(this.sliced, (box, k) => {
      const share = [0, 1, 2].map((axis) => (slicePlaces[3 * k + axis] - boxes.low[3 * box + axis]) / (boxes.high[3 * box + axis] - boxes.low[3 * box + axis]));
      return [0, 1, 2, 3, 4, 5, 6, 7].reduce((sum, j) => sum + corners[8 * box + j] * share.reduce((product, x, axis) => product * ((j >> axis) & 1 ? x : 1 - x), 1), 0);
    });
    this.hand("slices", 2, 1, gl.FLOAT, this.sliceLevels, 0);
  }

  // Pieces as triangles around their first corners, and whose each corner is; the number of corners.
  fans({ corners, ends, whose }, origin) {
    const { gl } = this;
    const places = [];
    this.owners = [];
    let start = 0;
    ends.forEach((end, k) => {
      for (let at = start + 1; at + 1 < end; at += 1) {
        for (const corner of [start, at, at + 1]) {
          places.push(corners[2 * corner] - origin[0], corners[2 * corner + 1] - origin[1]);
          this.owners.push(whose[k]);
        }
      }
      start = end;
    });
    this.hand("pieces", 0, 2, gl.FLOAT, Float32Array.from(places), 0);
    return this.owners.length;
  }

  // The faces of a cut: triangles by their corners, and whose each corner is.
  slice({ places, owners }, origin) {
    const { gl } = this;
    this.hand("slices", 0, 3, gl.FLOAT, Float32Array.from(places, (x, k) => x - origin[k % 3]), 0);
    Object.assign(this, { sliced: owners, slicePlaces: places });
    this.count.slices = owners.length;
    this.colourSlices();
    this.levelSlices();
  }

  colourSlices() {
    const { gl, colours } = this;
    if (this.count.slices === 0 || !colours) return;
    const own = new Uint8Array(4 * this.sliced.length);
    this.sliced.forEach((box, k) => own.set(colours.subarray(4 * box, 4 * box + 4), 4 * k));
    this.hand("slices", 1, 4, gl.UNSIGNED_BYTE, own, 0);
  }

  colour(colours) {
    const { gl } = this;
    this.colours = colours;
    this.colourSlices();
    if (this.count.pieces > 0) {
      const own = new Uint8Array(4 * this.owners.length);
      this.owners.forEach((box, k) => own.set(colours.subarray(4 * box, 4 * box + 4), 4 * k));
      this.hand("pieces", 1, 4, gl.UNSIGNED_BYTE, own, 0);
    }
    this.hand("faces", 3, 4, gl.UNSIGNED_BYTE, this.pick(colours, 4));
  }

  // A scene as its camera sees it; the cut has the direction of what is taken away, and how far it stands.
  paint(place, camera, { cut, dimension, outlined, boxes: { origin } }, sharp) {
    const { gl, canvas } = this;
    canvas.width = Math.round(place.width * sharp);
    canvas.height = Math.round(place.height * sharp);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.SCISSOR_TEST);
    const { room } = place;
    const box = dimension === 2 ? [room.left, room.bottom, place.width - room.left - room.right, place.height - room.top - room.bottom] : [0, 0, place.width, place.height];
    gl.scissor(...box.map((x) => Math.round(x * sharp)));
    const use = ({ made, at }) => {
      gl.useProgram(made);
      gl.uniform3fv(at.right, place.right);
      gl.uniform3fv(at.up, place.up);
      gl.uniform3fv(at.eye, place.eye);
      const [x, y] = projected(place, camera, origin);
      gl.uniform3f(at.moved, (2 * x) / place.width - 1, 1 - (2 * y) / place.height, 0);
      gl.uniform4f(at.scale, (2 * place.scale) / place.width, (2 * place.scale) / place.height, 0.45 / place.deep, 1 / place.scale);
      const normal = cut ? cut.normal : [0, 0, 0];
      gl.uniform2f(at.contours, dimension === 3 ? this.levels : 0, sharp);
      gl.uniform1i(at.light, this.light);
      gl.uniform4f(at.cut, ...normal, cut ? cut.offset - dot(normal, origin) : 0);
      return at;
    };
    if (this.count.pieces > 0) {
      use(this.programs.pieces);
      gl.bindVertexArray(this.arrays.pieces);
      gl.drawArrays(gl.TRIANGLES, 0, this.count.pieces);
    } else this.paintBoxes(use, cut, dimension);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    this.paintSheets(use(this.programs.bodies));
    if (outlined && dimension === 3) this.paintStrips(use(this.programs.strips), place, cut);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    gl.disable(gl.SCISSOR_TEST);
  }

  // Rigid bodies, water and where soil slips: faint in the soil, clear before it.
  paintSheets(at) {
    const { gl, count } = this;
    const draw = (of, test, colour, share) => {
      if (count[of] === 0) return;
      gl.bindVertexArray(this.arrays[of]);
      gl.depthFunc(test);
      gl.uniform4f(at.grey, ...sharesOf(colour), share);
      gl.drawArrays(gl.TRIANGLES, 0, count[of]);
    };
    draw("slip", gl.GREATER, SLIP, 0.3);
    draw("slip", gl.LEQUAL, SLIP, 0.6);
    draw("water", gl.GREATER, WATER, 0.14);
    draw("water", gl.LEQUAL, WATER, 0.5);
    draw("bodies", gl.LEQUAL, cssColour("--soft"), 0.62);
    gl.depthFunc(gl.LEQUAL);
  }

  // Surfaces of a kind: triangles by their corners.
  sheets(of, triangles, { origin }) {
    const { gl } = this;
    const corners = triangles.flat();
    this.hand(of, 0, 3, gl.FLOAT, Float32Array.from(corners.flat(), (x, k) => x - origin[k % 3]), 0);
    this.count[of] = corners.length;
  }

  // Outlines, faint behind the soil and dark before it, and the lines of a cut that faces the eye.
  paintStrips(at, place, cut) {
    const { gl, count } = this;
    gl.uniform2f(at.pixel, 2 / place.width, 2 / place.height);
    gl.uniform1f(at.nearer, this.nearer);
    const ink = sharesOf(cssColour("--ink"));
    const draw = (of, test, half, share) => {
      gl.bindVertexArray(this.arrays[of]);
      gl.depthFunc(test);
      gl.uniform1f(at.half_width, half);
      gl.uniform4f(at.colour, ...ink, share);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count[of]);
    };
    if (count.strips > 0) {
      draw("strips", gl.GREATER, 0.5, 0.22);
      draw("strips", gl.LEQUAL, 0.75, 0.95);
    }
    if (count.seams > 0 && cut && dot(cut.normal, place.eye) > 1e-6) {
      // They lie in the plane of the cut, which takes nothing of them away.
      gl.uniform4f(at.cut, 0, 0, 0, 0);
      draw("seams", gl.LEQUAL, 0.75, 0.95);
    }
    gl.depthFunc(gl.LEQUAL);
  }

  paintBoxes(use, cut, dimension) {
    const { gl } = this;
    const at = use(this.programs.boxes);
    gl.uniform1f(at.lines, dimension === 2 ? 0.16 : 0.3);
    gl.uniform1f(at.flatly, dimension === 2 ? 1 : 0);
    gl.bindVertexArray(this.arrays.faces);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count.faces);
    if (!cut || this.count.slices === 0) return;
    use(this.programs.pieces);
    gl.bindVertexArray(this.arrays.slices);
    gl.drawArrays(gl.TRIANGLES, 0, this.count.slices);
  }
}
