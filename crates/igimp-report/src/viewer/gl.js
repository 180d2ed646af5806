// Boxes drawn by WebGL2: a quad for every face that is seen, one for every box that the cut goes through, pieces of the
// plane in their place where there are some, and rigid bodies as translucent triangles.

const LIGHT = `
uniform vec3 right, up, eye;
float lightOf(vec3 normal, float open) {
  vec3 towards = normalize(-0.35 * right + 0.6 * up + 0.72 * eye);
  float hollow = clamp((open - 0.12) / 0.3, 0.0, 1.0);
  return (0.5 + 0.52 * max(dot(normal, towards), 0.0)) * (0.72 + 0.28 * hollow);
}
// Dark colours would hide the shape.
vec3 lifted(vec3 colour) {
  return mix(colour, vec3(1.0), 0.07);
}
uniform vec3 moved;
uniform vec4 scale;
vec4 seen(vec3 at) {
  return vec4(dot(right, at) * scale.x + moved.x, dot(up, at) * scale.y + moved.y, -dot(eye, at) * scale.z, 1.0);
}
`;

const BOXES = `#version 300 es
precision highp float;
layout(location = 0) in vec3 low;
layout(location = 1) in vec3 high;
layout(location = 2) in vec4 lie;
layout(location = 3) in vec4 colour;
layout(location = 4) in float face;
uniform vec4 cut;
uniform float caps, flatly;
out vec2 at;
out vec3 place;
flat out vec3 tint;
${LIGHT}
void main() {
  vec2 corner = vec2(gl_VertexID == 1 || gl_VertexID == 3, gl_VertexID >= 2);
  // The axis across a cap is that of the cut.
  int axis = caps > 0.5 ? (cut.x != 0.0 ? 0 : cut.y != 0.0 ? 1 : 2) : int(face) / 2;
  float side = caps > 0.5 ? cut[axis] : 2.0 * float(int(face) % 2) - 1.0;
  vec3 normal = vec3(0.0);
  normal[axis] = side;
  vec3 size = high - low;
  int one = (axis + 1) % 3, two = (axis + 2) % 3;
  place = low;
  // A little larger than it is, over the seams between neighbours.
  place[one] += size[one] * corner.x + (corner.x - 0.5) * 0.7 * scale.w;
  place[two] += size[two] * corner.y + (corner.y - 0.5) * 0.7 * scale.w;
  if (caps > 0.5) place[axis] = cut.w * side;
  else if (side > 0.0) place[axis] = high[axis];
  // Where the cut runs between boxes, or through a narrow crack, those that stay are seen.
  vec2 ends = vec2(low[axis], high[axis]) + size[axis] * (side > 0.0 ? vec2(1e-4, 0.1) : vec2(-0.1, -1e-4));
  bool crosses = caps < 0.5 || (ends.x <= place[axis] && place[axis] <= ends.y);
  vec3 about = (lie.xyz * 255.0 - 128.0) / 127.0;
  vec3 smoothed = normalize(normal * 0.3 + about);
  bool isBack = dot(normal, eye) <= 1e-6;
  if (flatly > 0.5) tint = colour.rgb;
  else if (caps > 0.5) tint = lifted(colour.rgb) * 0.97;
  else tint = lifted(colour.rgb) * (isBack ? 0.35 : lightOf(smoothed, lie.w));
  at = corner;
  // The insides of the far walls are seen through cracks.
  bool shown = colour.a > 0.5 && crosses && !(isBack && (caps > 0.5 || flatly > 0.5));
  gl_Position = shown ? seen(place) : vec4(2.0, 2.0, 2.0, 1.0);
}`;

const INK = `#version 300 es
precision highp float;
in vec2 at;
in vec3 place;
flat in vec3 tint;
uniform vec4 cut;
uniform float caps, lines;
out vec4 ink;
void main() {
  if (caps < 0.5 && dot(cut.xyz, place) > cut.w) discard;
  // Lines along the edges of boxes that are large enough for them.
  vec2 step = max(fwidth(at), vec2(1e-6));
  vec2 from = min(at, 1.0 - at) / step;
  float line = 1.0 - smoothstep(0.3, 1.3, min(from.x, from.y));
  float room = smoothstep(5.0, 16.0, min(1.0 / step.x, 1.0 / step.y));
  // Darker than the face, on dark faces lighter.
  float dark = 1.0 - smoothstep(0.1, 0.3, dot(tint, vec3(0.2126, 0.7152, 0.0722)));
  vec3 own = mix(tint * (1.0 - lines), tint + 0.3 * lines * tint + 0.25 * lines * 0.3, dark);
  ink = vec4(min(mix(tint, own, line * room), 1.0), 1.0);
}`;

const BODIES = `#version 300 es
precision highp float;
layout(location = 0) in vec3 low;
out vec3 place;
${LIGHT}
void main() {
  place = low;
  gl_Position = seen(low);
}`;

const PIECES = `#version 300 es
precision highp float;
layout(location = 0) in vec3 low;
layout(location = 1) in vec4 colour;
out vec4 tint;
${LIGHT}
void main() {
  tint = colour;
  gl_Position = seen(low);
}`;

const PLAIN = `#version 300 es
precision highp float;
in vec4 tint;
out vec4 ink;
void main() {
  if (tint.a < 0.5) discard;
  ink = vec4(tint.rgb, 1.0);
}`;

const GREY = `#version 300 es
precision highp float;
in vec3 place;
uniform vec4 cut;
uniform vec3 grey;
${LIGHT}
out vec4 ink;
void main() {
  if (dot(cut.xyz, place) > cut.w) discard;
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  if (dot(normal, eye) < 0.0) normal = -normal;
  ink = vec4(grey * lightOf(normal, 0.5), 1.0) * 0.62;
}`;

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
    this.programs = { boxes: program(gl, [BOXES, INK]), bodies: program(gl, [BODIES, GREY]), pieces: program(gl, [PIECES, PLAIN]) };
    this.arrays = { faces: gl.createVertexArray(), caps: gl.createVertexArray(), bodies: gl.createVertexArray(), pieces: gl.createVertexArray(), slices: gl.createVertexArray() };
    this.buffers = new Map();
    this.count = { faces: 0, caps: 0, bodies: 0, pieces: 0, slices: 0 };
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
  shape({ low, high, lie, faces, origin, pieces }, triangles) {
    const { gl } = this;
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
    this.hand("caps", 0, 3, gl.FLOAT, own);
    this.hand("caps", 1, 3, gl.FLOAT, ends);
    this.hand("bodies", 0, 3, gl.FLOAT, near(triangles), 0);
    const corners = pieces ? this.fans(pieces, origin) : 0;
    this.count = { faces: faces.box.length, caps: own.length / 3, bodies: triangles.length / 3, pieces: corners, slices: 0 };
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

  // The faces of a slanted cut: triangles by their corners, and whose each corner is.
  slice({ places, owners }, origin) {
    const { gl } = this;
    this.hand("slices", 0, 3, gl.FLOAT, Float32Array.from(places, (x, k) => x - origin[k % 3]), 0);
    this.sliced = owners;
    this.count.slices = owners.length;
    this.colourSlices();
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
    this.hand("caps", 3, 4, gl.UNSIGNED_BYTE, colours);
  }

  // The view of a camera; `cut` has the direction of what is taken away, and how far it stands.
  paint(place, camera, cut, dimension, sharp, grey, origin) {
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
      gl.uniform4f(at.cut, ...normal, cut ? cut.offset - dot(normal, origin) : 0);
      return at;
    };
    if (this.count.pieces > 0) {
      use(this.programs.pieces);
      gl.bindVertexArray(this.arrays.pieces);
      gl.drawArrays(gl.TRIANGLES, 0, this.count.pieces);
    } else this.paintBoxes(use, cut, dimension);
    if (this.count.bodies > 0) {
      const own = use(this.programs.bodies);
      gl.uniform3fv(own.grey, grey);
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
      gl.depthMask(false);
      gl.bindVertexArray(this.arrays.bodies);
      gl.drawArrays(gl.TRIANGLES, 0, this.count.bodies);
      gl.depthMask(true);
      gl.disable(gl.BLEND);
    }
    gl.disable(gl.SCISSOR_TEST);
  }

  paintBoxes(use, cut, dimension) {
    const { gl } = this;
    const at = use(this.programs.boxes);
    gl.uniform1f(at.lines, dimension === 2 ? 0.16 : 0.3);
    gl.uniform1f(at.flatly, dimension === 2 ? 1 : 0);
    gl.uniform1f(at.caps, 0);
    gl.bindVertexArray(this.arrays.faces);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count.faces);
    if (cut && cut.axis < 0) {
      if (this.count.slices === 0) return;
      use(this.programs.pieces);
      gl.bindVertexArray(this.arrays.slices);
      gl.drawArrays(gl.TRIANGLES, 0, this.count.slices);
    } else if (cut) {
      gl.uniform1f(at.caps, 1);
      gl.bindVertexArray(this.arrays.caps);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count.caps);
    }
  }
}
