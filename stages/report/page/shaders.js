// What WebGL draws: flat triangles that look like spheres, cylinders and discs. A picture of
// numbers (`picking`) tells what lies under the pointer.

const SHADER_HEAD = `#version 300 es
precision highp float;
precision highp sampler2D;
uniform mat3 turn;      // world to eye: right, up, near
uniform vec4 frame;     // middle and half extent of what is seen
uniform vec4 clip;      // direction and place of the cut
uniform float now;      // key
uniform float picking;  // 1: draw numbers
uniform vec2 kind;      // kind of thing / 255, opacity
uniform sampler2D things; // numbers of each thing, some texels a thing
uniform sampler2D tints;  // its colour, 0xbbggrr
vec4 onScreen(vec3 eye) { return vec4((eye.xy - frame.xy) / frame.zw, -eye.z * 0.4, 1.0); }
bool isCut(vec3 at) { return dot(clip.xyz, at) > clip.w; }
vec4 texel(sampler2D from, int k) { return texelFetch(from, ivec2(k & 1023, k >> 10), 0); }
vec3 colourOf(int k) { int c = int(texel(tints, k).x); return vec3(c & 255, c >> 8 & 255, c >> 16) / 255.0; }
const vec4 nowhere = vec4(2.0, 2.0, 2.0, 1.0);
vec4 numbered(float id, float kind) {
  return vec4(mod(id, 256.0), mod(floor(id / 256.0), 256.0), floor(id / 65536.0), 255.0 * kind) / 255.0;
}
`;

// Which thing, and which corner of it, a vertex is. Things are not drawn as instances:
// small ones are slow everywhere, and a thousand times too slow where a processor draws.
const TRIANGLE = `
const vec2 corners[3] = vec2[](vec2(-1.7321, -1.0), vec2(1.7321, -1.0), vec2(0.0, 2.0));
#define THING (gl_VertexID / 3)
#define CORNER corners[gl_VertexID % 3]
`;
const SQUARE = `
const vec2 corners[4] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(1, 1));
#define THING (gl_VertexID / 4)
#define CORNER corners[gl_VertexID & 3]
`;
const ARROW = `
const vec3 corners[9] = vec3[](vec3(0, -1, 0), vec3(1, -1, 0), vec3(0, 1, 0), vec3(0, 1, 0), vec3(1, -1, 0), vec3(1, 1, 0), vec3(0, -1, 1), vec3(1, 0, 1), vec3(0, 1, 1));
#define THING (gl_VertexID / 9)
#define CORNER corners[gl_VertexID % 9]
`;

// In a fragment shader uniforms of the head that are not used do no harm.
const SHADERS = {
  // Texels: place and radius.
  grain: [`${TRIANGLE}
uniform float grow; uniform sampler2D numbers;
out vec2 at; flat out vec3 colour; flat out float number;
void main() {
  vec4 sphere = texel(things, THING);
  at = CORNER; colour = colourOf(THING); number = texel(numbers, THING).x;
  gl_Position = isCut(sphere.xyz) ? nowhere : onScreen(turn * sphere.xyz + vec3(at, 0.0) * sphere.w * grow);
}`, `
in vec2 at; flat in vec3 colour; flat in float number; out vec4 result;
void main() {
  float far = dot(at, at);
  if (far > 1.0) discard;
  float near = sqrt(1.0 - far);
  float light = 0.45 + 0.55 * max(0.0, dot(vec3(at, near), vec3(-0.37, 0.46, 0.8)));
  if (near < 0.28) light *= 0.72;
  result = picking > 0.5 ? numbered(number, kind.x) : vec4(colour * light, 1.0);
}`],

  // Texels: one end and radius; the other end and number; keys. A throat is full until it
  // leaves, empty when it ends, and thinner in between.
  throat: [`${SQUARE}
uniform float grow; uniform float least; uniform float drawEmpty; uniform float drawLiquid; uniform vec3 emptyColour;
out float across; flat out vec3 colour; flat out float number;
void main() {
  vec4 life = texel(things, 3 * THING + 2);
  float wet = life.x > now ? 1.0 : life.y > now ? clamp((life.y - now) / max(life.y - life.x, 1.0), 0.0, 1.0) : 0.0;
  gl_Position = nowhere;
  if (wet > 0.0 ? drawLiquid < 0.5 : drawEmpty < 0.5) return;
  vec4 from = texel(things, 3 * THING), to = texel(things, 3 * THING + 1);
  if (isCut(0.5 * (from.xyz + to.xyz))) return;
  vec3 a = turn * from.xyz, b = turn * to.xyz;
  vec2 along = b.xy - a.xy, corner = CORNER;
  float far = length(along);
  along = far > 1e-7 ? along / far : vec2(1.0, 0.0);
  float wide = max(wet > 0.0 ? grow * from.w * (0.35 + 0.65 * wet) : 0.0, least);
  vec3 eye = mix(a, b, corner.x * 0.5 + 0.5);
  eye.xy += along * corner.x * (wet > 0.0 ? min(wide, 0.4 * far) : 0.0) + vec2(-along.y, along.x) * corner.y * wide;
  across = corner.y; number = to.w;
  colour = wet > 0.0 ? colourOf(THING) : emptyColour;
  gl_Position = onScreen(eye);
}`, `
in float across; flat in vec3 colour; flat in float number; out vec4 result;
void main() {
  float light = 0.55 + 0.45 * sqrt(max(0.0, 1.0 - across * across));
  result = picking > 0.5 ? numbered(number, kind.x) : vec4(colour * light, 1.0);
}`],

  // Texels: place and radius; normal and key; mode and number. A broken bond is a disc
  // across it, never thinner than a stroke.
  crack: [`${TRIANGLE}
uniform vec3 modeColour[2];
out vec2 at; flat out vec3 colour; flat out float number;
void main() {
  vec4 disc = texel(things, 3 * THING), normal = texel(things, 3 * THING + 1), rest = texel(things, 3 * THING + 2);
  vec3 n = turn * normal.xyz;
  float flat_ = length(n.xy);
  vec2 minor = flat_ > 1e-5 ? n.xy / flat_ : vec2(0.0, 1.0);
  vec3 u = vec3(-minor.y, minor.x, 0.0), w = cross(n, u);
  w.xy = length(w.xy) > 0.16 ? w.xy : 0.16 * minor;
  at = CORNER; colour = modeColour[int(rest.x)]; number = rest.y;
  gl_Position = normal.w > now || isCut(disc.xyz) ? nowhere : onScreen(turn * disc.xyz + disc.w * (at.x * u + at.y * w));
}`, `
in vec2 at; flat in vec3 colour; flat in float number; out vec4 result;
uniform vec3 rimColour;
void main() {
  float far = dot(at, at);
  if (far > 1.0) discard;
  result = picking > 0.5 ? numbered(number, kind.x) : vec4(far > 0.74 ? rimColour : colour, kind.y);
}`],

  // Texels: those of the grains, and forces. An arrow from the middle of its grain, in
  // front of it.
  arrow: [`${ARROW}
uniform float grow; uniform float longest; uniform sampler2D forces;
void main() {
  vec4 sphere = texel(things, THING);
  vec3 force = texel(forces, THING).xyz, corner = CORNER;
  vec3 a = turn * sphere.xyz, f = turn * force * longest;
  float far = length(f.xy), width = longest * 0.045;
  vec2 along = far > 1e-7 ? f.xy / far : vec2(1.0, 0.0);
  float head = min(far, 4.0 * width);
  float t = corner.z > 0.5 ? far - head + corner.x * head : corner.x * (far - head);
  vec3 eye = vec3(a.xy + along * t + vec2(-along.y, along.x) * corner.y * width * (corner.z > 0.5 ? 2.2 : 0.8), a.z + sphere.w * grow);
  gl_Position = isCut(sphere.xyz) || length(force) < 0.02 ? nowhere : onScreen(eye);
}`, `
out vec4 result;
uniform vec3 arrowColour;
void main() { result = vec4(arrowColour, 1.0); }`],

  // Texels: ends of the edges of the box.
  line: [`
void main() { gl_Position = onScreen(turn * texel(things, gl_VertexID).xyz); }`, `
out vec4 result;
uniform vec3 lineColour;
void main() { result = vec4(lineColour, 1.0); }`],
};

function buildProgram(gl, name) {
  const program = gl.createProgram();
  SHADERS[name].forEach((text, k) => {
    const shader = gl.createShader(k ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
    gl.shaderSource(shader, SHADER_HEAD + text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  });
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const uniform = {};
  for (let k = 0; k < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); k++) {
    const { name: key } = gl.getActiveUniform(program, k);
    uniform[key.replace("[0]", "")] = gl.getUniformLocation(program, key);
  }
  return { program, uniform };
}
