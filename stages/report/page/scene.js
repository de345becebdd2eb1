// The body in WebGL: buffers of what is drawn, a picture of it, and what lies under a
// point of it.

const QUAD = [-1, -1, 1, -1, -1, 1, 1, 1];
const ARROW = [0, -1, 0, 1, -1, 0, 0, 1, 0, 0, 1, 0, 1, -1, 0, 1, 1, 0, 0, -1, 1, 1, 0, 1, 0, 1, 1];
const KINDS = { grain: 1, throat: 2, crack: 3 };

function newScene(canvas, body, cracks) {
  const gl = canvas.getContext("webgl2", { antialias: body.grain.n < 5000, alpha: false, preserveDrawingBuffer: true });
  if (!gl) return null;
  const scene = { gl, canvas, body, cracks, programs: {}, sets: {}, seen: null };
  for (const name in SHADERS) scene.programs[name] = buildProgram(gl, name);
  scene.quad = fill(gl, gl.createBuffer(), new Float32Array(QUAD));
  scene.arrowShape = fill(gl, gl.createBuffer(), new Float32Array(ARROW));
  scene.sets.line = vertexSet(scene, "line", [["from", 3]], null, 0);
  fill(gl, scene.sets.line.buffers.from, boxLines(body));
  scene.sets.grain = vertexSet(scene, "sphere", [["sphere", 4], ["tint", 3], ["id", 1]], scene.quad, 2);
  scene.sets.throat = vertexSet(scene, "throat", [["from", 3], ["to", 3], ["life", 3], ["tint", 3], ["id", 1]], scene.quad, 2);
  scene.sets.crack = vertexSet(scene, "crack", [["disc", 4], ["normal", 3], ["life", 2], ["id", 1]], scene.quad, 2);
  scene.sets.arrow = vertexSet(scene, "arrow", [["sphere", 4], ["force", 3]], scene.arrowShape, 3);
  fillCracks(scene);
  return scene;
}

function fill(gl, buffer, data) {
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
  return buffer;
}

// The arrays of one kind of thing, each entry for a whole instance; SHAPE has its corners.
function vertexSet({ gl, programs }, name, columns, shape, size) {
  const { program } = programs[name], set = { array: gl.createVertexArray(), buffers: {}, count: 0 };
  gl.bindVertexArray(set.array);
  const use = (key, buffer, width, each) => {
    const at = gl.getAttribLocation(program, key);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    if (at < 0) return;
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, width, gl.FLOAT, false, 0, 0);
    gl.vertexAttribDivisor(at, each);
  };
  if (shape) use("corner", shape, size, 0);
  for (const [key, width] of columns) use(key, set.buffers[key] = gl.createBuffer(), width, shape ? 1 : 0);
  gl.bindVertexArray(null);
  return set;
}

function boxLines({ size }) {
  const points = [];
  for (let axis = 0; axis < 3; axis++)
    for (const u of [-1, 1]) for (const v of [-1, 1]) for (const w of [-1, 1]) {
      const corner = [0, 0, 0];
      corner[axis] = w; corner[(axis + 1) % 3] = u; corner[(axis + 2) % 3] = v;
      points.push(...corner.map((side, k) => side * size[k] / 2));
    }
  return new Float32Array(points);
}

function fillCracks({ gl, sets, cracks }) {
  const column = (width, of) => {
    const data = new Float32Array(width * cracks.length);
    cracks.forEach((crack, k) => data.set(of(crack, k), width * k));
    return data;
  };
  fill(gl, sets.crack.buffers.disc, column(4, (crack) => [...crack.at, crack.radius]));
  fill(gl, sets.crack.buffers.normal, column(3, (crack) => crack.normal));
  fill(gl, sets.crack.buffers.life, column(2, (crack) => [crack.key, crack.mode]));
  fill(gl, sets.crack.buffers.id, column(1, (crack, k) => [k]));
  sets.crack.count = cracks.length;
}

const upTo = (n) => Int32Array.from({ length: n }, (_, k) => k);

// Takes what visibleOf found, or all where SEEN is null.
function fillBody(scene, seen) {
  const { gl, sets, body: { grain, throat, node } } = scene;
  const grains = seen ? seen.grains : upTo(grain.n), throats = seen ? seen.throats : upTo(throat.n);
  const sphere = new Float32Array(4 * grains.length);
  for (let k = 0; k < grains.length; k++) {
    sphere.set(grain.at.subarray(3 * grains[k], 3 * grains[k] + 3), 4 * k);
    sphere[4 * k + 3] = grain.radius[grains[k]];
  }
  const from = new Float32Array(3 * throats.length), to = from.slice(), life = from.slice();
  for (let k = 0; k < throats.length; k++) {
    const t = throats[k];
    for (let axis = 0; axis < 3; axis++) {
      from[3 * k + axis] = node.at[3 * throat.first[t] + axis];
      to[3 * k + axis] = node.at[3 * throat.second[t] + axis];
    }
    life[3 * k] = throat.radius[t]; life[3 * k + 1] = throat.leaves[t]; life[3 * k + 2] = throat.ends[t];
  }
  fill(gl, sets.grain.buffers.sphere, sphere);
  fill(gl, sets.arrow.buffers.sphere, sphere);
  fill(gl, sets.grain.buffers.id, Float32Array.from(grains));
  fill(gl, sets.throat.buffers.from, from);
  fill(gl, sets.throat.buffers.to, to);
  fill(gl, sets.throat.buffers.life, life);
  fill(gl, sets.throat.buffers.id, Float32Array.from(throats));
  scene.shown = { grains, throats };
  sets.grain.count = sets.arrow.count = grains.length;
  sets.throat.count = throats.length;
}

// Colours from COLOUR (index to 0..255) of what is shown.
function fillTint(scene, kind, colour) {
  const shown = scene.shown[`${kind}s`], tint = new Float32Array(3 * shown.length);
  for (let k = 0; k < shown.length; k++) {
    const rgb = colour(shown[k]);
    for (let c = 0; c < 3; c++) tint[3 * k + c] = rgb[c] / 255;
  }
  fill(scene.gl, scene.sets[kind].buffers.tint, tint);
}

// FORCES (3 a grain, shares of the largest).
function fillForces(scene, forces) {
  const { grains } = scene.shown, shown = new Float32Array(3 * grains.length);
  for (let k = 0; k < grains.length; k++)
    for (let axis = 0; axis < 3; axis++) shown[3 * k + axis] = forces[3 * grains[k] + axis];
  fill(scene.gl, scene.sets.arrow.buffers.force, shown);
}

function begin({ gl, programs }, name, view, picking, opacity) {
  const { program, uniform } = programs[name];
  gl.useProgram(program);
  const kind = { sphere: KINDS.grain, throat: KINDS.throat, crack: KINDS.crack }[name] || 0;
  gl.uniformMatrix3fv(uniform.turn, true, view.turn);
  gl.uniform4fv(uniform.frame, view.frame);
  const set = (key, how, ...values) => uniform[key] && gl[how](uniform[key], ...values);
  set("clip", "uniform4fv", view.clip);
  set("now", "uniform1f", view.key);
  set("picking", "uniform1f", picking ? 1 : 0);
  set("kind", "uniform2f", kind / 255, opacity);
  set("grow", "uniform1f", view.grow);
  set("least", "uniform1f", view.pixel * 0.6);
  set("drawEmpty", "uniform1f", view.show.empty ? 1 : 0);
  set("emptyColour", "uniform3fv", view.colours.empty);
  set("modeColour", "uniform3fv", [...view.colours.tension, ...view.colours.shear]);
  set("rimColour", "uniform3fv", view.colours.rim);
  set("arrowColour", "uniform3fv", view.colours.force);
  set("lineColour", "uniform3fv", view.colours.line);
  set("longest", "uniform1f", view.longest);
}

function drawSet({ gl, sets }, name, mode, corners) {
  if (!sets[name].count) return;
  gl.bindVertexArray(sets[name].array);
  gl.drawArraysInstanced(mode, 0, corners, sets[name].count);
}

function drawThings(scene, view, picking) {
  const { gl } = scene, { show } = view;
  if (show.grains) { begin(scene, "sphere", view, picking, 1); drawSet(scene, "grain", gl.TRIANGLE_STRIP, 4); }
  if (show.liquid || show.empty) { begin(scene, "throat", view, picking, 1); drawSet(scene, "throat", gl.TRIANGLE_STRIP, 4); }
  if (show.cracks) { begin(scene, "crack", view, picking, 1); drawSet(scene, "crack", gl.TRIANGLE_STRIP, 4); }
}

// Broken bonds that something hides shine through it, pale.
function drawHiddenCracks(scene, view) {
  const { gl } = scene;
  gl.depthFunc(gl.GREATER);
  gl.depthMask(false);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  begin(scene, "crack", view, false, 0.3);
  drawSet(scene, "crack", gl.TRIANGLE_STRIP, 4);
  gl.disable(gl.BLEND);
  gl.depthMask(true);
  gl.depthFunc(gl.LEQUAL);
}

function drawScene(scene, view) {
  const { gl, canvas, sets } = scene;
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.clearColor(...view.colours.panel, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  begin(scene, "line", view, false, 1);
  gl.bindVertexArray(sets.line.array);
  gl.drawArrays(gl.LINES, 0, 24);
  drawThings(scene, view, false);
  if (view.show.cracks) drawHiddenCracks(scene, view);
  if (view.show.forces) { begin(scene, "arrow", view, false, 1); drawSet(scene, "arrow", gl.TRIANGLES, 9); }
}

// {kind, index} of what is at X, Y (pixels from the lower left corner), or null.
function pickAt(scene, view, x, y) {
  const { gl, canvas } = scene, target = gl.createFramebuffer(), pixel = new Uint8Array(4);
  const buffers = [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]].map(([format, place]) => {
    const buffer = gl.createRenderbuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, format, canvas.width, canvas.height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
    return buffer;
  });
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.enable(gl.SCISSOR_TEST);
  gl.scissor(x, y, 1, 1);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  drawThings(scene, view, true);
  gl.readPixels(x, y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  gl.disable(gl.SCISSOR_TEST);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.deleteFramebuffer(target);
  buffers.forEach((buffer) => gl.deleteRenderbuffer(buffer));
  const kind = Object.keys(KINDS).find((name) => KINDS[name] === pixel[3]);
  return kind ? { kind, index: pixel[0] + 256 * pixel[1] + 65536 * pixel[2] } : null;
}
