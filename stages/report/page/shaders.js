// What WebGL draws: flat quads that look like spheres, cylinders and discs. A picture of
// numbers (`picking`) tells what lies under the pointer.

const SHADER_HEAD = `#version 300 es
precision highp float;
uniform mat3 turn;      // world to eye: right, up, near
uniform vec4 frame;     // middle and half extent of what is seen
uniform vec4 clip;      // direction and place of the cut
uniform float now;      // key
uniform float picking;  // 1: draw numbers
uniform vec2 kind;      // kind of thing / 255, opacity
vec4 onScreen(vec3 eye) { return vec4((eye.xy - frame.xy) / frame.zw, -eye.z * 0.4, 1.0); }
bool isCut(vec3 at) { return dot(clip.xyz, at) > clip.w; }
const vec4 nowhere = vec4(2.0, 2.0, 2.0, 1.0);
vec4 numbered(float id, float kind) {
  return vec4(mod(id, 256.0), mod(floor(id / 256.0), 256.0), floor(id / 65536.0), 255.0 * kind) / 255.0;
}
`;

// In a fragment shader uniforms of the head that are not used do no harm.
const SHADERS = {
  sphere: [`
in vec2 corner; in vec4 sphere; in vec3 tint; in float id;
uniform float grow;
out vec2 at; flat out vec3 colour; flat out float number;
void main() {
  vec3 eye = turn * sphere.xyz;
  at = corner; colour = tint; number = id;
  gl_Position = isCut(sphere.xyz) ? nowhere : onScreen(eye + vec3(corner, 0.0) * sphere.w * grow);
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

  // A throat: full until it leaves, empty when it ends, and thinner in between.
  throat: [`
in vec2 corner; in vec3 from; in vec3 to; in vec3 life; in vec3 tint; in float id;
uniform float least; uniform float drawEmpty; uniform vec3 emptyColour;
out float across; flat out vec3 colour; flat out float number;
void main() {
  float wet = life.z > now ? clamp((life.z - now) / max(life.z - life.y, 1.0), 0.0, 1.0) : 0.0;
  if (life.y > now) wet = 1.0;
  vec3 a = turn * from, b = turn * to;
  vec2 along = b.xy - a.xy;
  float far = length(along);
  along = far > 1e-7 ? along / far : vec2(1.0, 0.0);
  float half_ = max(wet > 0.0 ? life.x * (0.35 + 0.65 * wet) : 0.0, least);
  float t = corner.x * 0.5 + 0.5;
  vec3 eye = mix(a, b, t);
  eye.xy += along * corner.x * (wet > 0.0 ? half_ : 0.0) + vec2(-along.y, along.x) * corner.y * half_;
  across = corner.y; number = id;
  colour = wet > 0.0 ? tint : emptyColour;
  bool gone = isCut(0.5 * (from + to)) || (wet <= 0.0 && drawEmpty < 0.5);
  gl_Position = gone ? nowhere : onScreen(eye);
}`, `
in float across; flat in vec3 colour; flat in float number; out vec4 result;
void main() {
  float light = 0.55 + 0.45 * sqrt(max(0.0, 1.0 - across * across));
  result = picking > 0.5 ? numbered(number, kind.x) : vec4(colour * light, 1.0);
}`],

  // A broken bond: a disc across it, never thinner than a stroke.
  crack: [`
in vec2 corner; in vec4 disc; in vec3 normal; in vec2 life; in float id;
uniform vec3 modeColour[2];
out vec2 at; flat out vec3 colour; flat out float number;
void main() {
  vec3 n = turn * normal;
  float flat_ = length(n.xy);
  vec2 minor = flat_ > 1e-5 ? n.xy / flat_ : vec2(0.0, 1.0);
  vec3 u = vec3(-minor.y, minor.x, 0.0), w = cross(n, u);
  float thin = length(w.xy);
  w.xy = thin > 0.16 ? w.xy : 0.16 * minor;
  vec3 eye = turn * disc.xyz + disc.w * (corner.x * u + corner.y * w);
  at = corner; colour = modeColour[int(life.y)]; number = id;
  gl_Position = life.x > now || isCut(disc.xyz) ? nowhere : onScreen(eye);
}`, `
in vec2 at; flat in vec3 colour; flat in float number; out vec4 result;
uniform vec3 rimColour;
void main() {
  float far = dot(at, at);
  if (far > 1.0) discard;
  result = picking > 0.5 ? numbered(number, kind.x) : vec4(far > 0.74 ? rimColour : colour, kind.y);
}`],

  // A force: an arrow from the middle of its grain, in front of it.
  arrow: [`
in vec3 corner; in vec4 sphere; in vec3 force;
uniform float grow; uniform float longest;
void main() {
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

  line: [`
in vec3 from;
void main() { gl_Position = onScreen(turn * from); }`, `
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
