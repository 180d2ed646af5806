// The shaders of the surface: how boxes, pieces, rigid bodies and outlines become pixels.

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

// A value within a box by those at its corners, x first, then y.
const BETWEEN = `
float between(vec4 lower, vec4 upper, vec3 share) {
  vec4 own = mix(lower, upper, clamp(share.z, 0.0, 1.0));
  vec2 along = mix(own.xz, own.yw, clamp(share.x, 0.0, 1.0));
  return mix(along.x, along.y, clamp(share.y, 0.0, 1.0));
}
`;

// How much of the colour is left beside contours, which stand at whole numbers from 0 on; there is none where nothing changes, and none
// where they would be closer than some pixels. Those whose bit is set are light.
const CONTOURED = `
uniform vec2 contours;
uniform int light;
float contoured(float level) {
  float across = fwidth(level);
  float own = floor(level + 0.5);
  float off = abs(level - own) / max(across, 1e-7) / contours.y;
  float line = (1.0 - smoothstep(0.35, 1.15, off)) * (1.0 - smoothstep(0.3, 0.6, across));
  bool isOne = contours.x > 0.5 && own > -0.5 && own < contours.x - 0.5 && across > 1e-6;
  return isOne ? 1.0 - 0.85 * line : 1.0;
}
vec3 inked(vec3 colour, float left, float level) {
  bool isLight = ((light >> int(clamp(level + 0.5, 0.0, 30.0))) & 1) == 1;
  return mix(isLight ? vec3(1.0) : vec3(0.06), colour, left);
}
`;

const BOXES = `#version 300 es
precision highp float;
layout(location = 0) in vec3 low;
layout(location = 1) in vec3 high;
layout(location = 2) in vec4 lie;
layout(location = 3) in vec4 colour;
layout(location = 4) in float face;
layout(location = 5) in vec4 lower;
layout(location = 6) in vec4 upper;
// How the corners of the face have moved onto the surface without stairs, in bytes, by axis.
layout(location = 7) in vec4 movedX;
layout(location = 8) in vec4 movedY;
layout(location = 9) in vec4 movedZ;
uniform float flatly;
out vec2 at;
out vec3 place;
out float level;
flat out vec3 tint;
${LIGHT}
${BETWEEN}
vec3 moves(int corner) {
  return (vec3(movedX[corner], movedY[corner], movedZ[corner]) * 255.0 - 128.0) / 127.0;
}
void main() {
  vec2 corner = vec2(gl_VertexID == 1 || gl_VertexID == 3, gl_VertexID >= 2);
  int axis = int(face) / 2;
  float side = 2.0 * float(int(face) % 2) - 1.0;
  vec3 size = high - low;
  int one = (axis + 1) % 3, two = (axis + 2) % 3;
  place = low;
  // A little larger than it is, over the seams between neighbours.
  place[one] += size[one] * corner.x + (corner.x - 0.5) * 0.7 * scale.w;
  place[two] += size[two] * corner.y + (corner.y - 0.5) * 0.7 * scale.w;
  if (side > 0.0) place[axis] = high[axis];
  level = between(lower, upper, (place - low) / size);
  place += moves(gl_VertexID) * size;
  // Across the diagonals of the face.
  vec3 on = vec3(0.0), off = vec3(0.0);
  on[one] = on[two] = off[two] = 1.0;
  off[one] = -1.0;
  vec3 across = side * cross((on + moves(3) - moves(0)) * size, (off + moves(2) - moves(1)) * size);
  vec3 about = (lie.xyz * 255.0 - 128.0) / 127.0;
  vec3 smoothed = normalize(normalize(across) + about);
  bool isBack = dot(across, eye) <= 0.0;
  if (flatly > 0.5) tint = colour.rgb;
  else tint = lifted(colour.rgb) * (isBack ? 0.35 : lightOf(smoothed, lie.w));
  at = corner;
  // The insides of the far walls are seen through cracks.
  bool shown = colour.a > 0.5 && !(isBack && flatly > 0.5);
  gl_Position = shown ? seen(place) : vec4(2.0, 2.0, 2.0, 1.0);
}`;

const INK = `#version 300 es
precision highp float;
in vec2 at;
in vec3 place;
in float level;
flat in vec3 tint;
uniform vec4 cut;
uniform float lines;
out vec4 ink;
${CONTOURED}
void main() {
  float drawn = contoured(level);
  if (dot(cut.xyz, place) > cut.w) discard;
  // Lines along the edges of boxes that are large enough for them.
  vec2 step = max(fwidth(at), vec2(1e-6));
  vec2 from = min(at, 1.0 - at) / step;
  float line = 1.0 - smoothstep(0.3, 1.3, min(from.x, from.y));
  float room = smoothstep(5.0, 16.0, min(1.0 / step.x, 1.0 / step.y));
  // Darker than the face, on dark faces lighter.
  float dark = 1.0 - smoothstep(0.1, 0.3, dot(tint, vec3(0.2126, 0.7152, 0.0722)));
  vec3 own = mix(tint * (1.0 - lines), tint + 0.3 * lines * tint + 0.25 * lines * 0.3, dark);
  ink = vec4(inked(min(mix(tint, own, line * room), 1.0), drawn, level), 1.0);
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
layout(location = 2) in float worth;
out vec4 tint;
out float level;
${LIGHT}
void main() {
  tint = colour;
  level = worth;
  gl_Position = seen(low);
}`;

const PLAIN = `#version 300 es
precision highp float;
in vec4 tint;
in float level;
out vec4 ink;
${CONTOURED}
void main() {
  float drawn = contoured(level);
  if (tint.a < 0.5) discard;
  ink = vec4(inked(tint.rgb, drawn, level), 1.0);
}`;

const GREY = `#version 300 es
precision highp float;
in vec3 place;
uniform vec4 cut;
uniform vec4 grey;
${LIGHT}
out vec4 ink;
void main() {
  if (dot(cut.xyz, place) > cut.w) discard;
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  if (dot(normal, eye) < 0.0) normal = -normal;
  ink = vec4(grey.rgb * lightOf(normal, 0.5), 1.0) * grey.a;
}`;

// A segment as a strip of even width that faces the eye.
const STRIPS = `#version 300 es
precision highp float;
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
uniform vec2 pixel;
uniform float half_width, nearer;
out vec3 place;
${LIGHT}
void main() {
  vec4 a = seen(from), b = seen(to);
  vec2 way = (b.xy - a.xy) / pixel;
  way = length(way) > 1e-6 ? normalize(way) : vec2(1.0, 0.0);
  bool isEnd = gl_VertexID >= 2;
  float side = gl_VertexID == 1 || gl_VertexID == 3 ? 1.0 : -1.0;
  vec2 off = half_width * (side * vec2(-way.y, way.x) + (isEnd ? 0.5 : -0.5) * way);
  place = isEnd ? to : from;
  gl_Position = (isEnd ? b : a) + vec4(off * pixel, -nearer * scale.z, 0.0);
}`;

const STRIP = `#version 300 es
precision highp float;
in vec3 place;
uniform vec4 cut, colour;
out vec4 ink;
void main() {
  if (dot(cut.xyz, place) > cut.w + 1e-6) discard;
  ink = vec4(colour.rgb * colour.a, colour.a);
}`;
