// The body in WebGL: textures of what is drawn, a picture of it, and what lies under a
// point of it.

const KINDS = { grain: 1, throat: 2, crack: 3 };
const CORNERS = { grain: 3, crack: 3, arrow: 9, line: 1 };
const TEXTURES = ["things", "tints", "numbers", "forces"]; // by unit

function newScene(canvas, body, cracks) {
  const gl = canvas.getContext("webgl2", { antialias: false, alpha: false });
  if (!gl) return null;
  const scene = { gl, canvas, body, cracks, programs: {}, sets: {}, squares: 0 };
  for (const name in SHADERS) {
    scene.programs[name] = buildProgram(gl, name);
    scene.sets[name] = { count: 0, textures: {} };
  }
  put(scene, "line", "things", boxLines(body), 3);
  scene.sets.line.count = 24;
  putCracks(scene);
  return scene;
}

const TEXELS = 1024; // a row of a texture

// VALUES, WIDTH of them a texel, as the texture NAME of the set; a texel has room for four.
function put({ gl, sets }, set, name, values, width) {
  const texels = values.length / width, rows = Math.max(1, Math.ceil(texels / TEXELS)), wide = width === 1 ? 1 : 4;
  const data = new Float32Array(rows * TEXELS * wide);
  if (wide === width) data.set(values);
  else for (let k = 0; k < texels; k++) for (let c = 0; c < width; c++) data[4 * k + c] = values[width * k + c];
  const texture = sets[set].textures[name] ||= gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, wide === 1 ? gl.R32F : gl.RGBA32F, TEXELS, rows, 0, wide === 1 ? gl.RED : gl.RGBA, gl.FLOAT, data);
  for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
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

function putCracks(scene) {
  const texels = scene.cracks.flatMap(({ at, radius, normal, key, mode }, k) => [...at, radius, ...normal, key, mode, k, 0, 0]);
  put(scene, "crack", "things", Float32Array.from(texels), 4);
  scene.sets.crack.count = scene.cracks.length;
}

// Two triangles a square, of four corners.
function putSquares(scene, count) {
  const { gl } = scene;
  if (count <= scene.squares) return;
  scene.squares = count;
  const corner = new Uint32Array(6 * count);
  for (let k = 0; k < count; k++) corner.set([4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 2, 4 * k + 1, 4 * k + 3], 6 * k);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, scene.corners ||= gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corner, gl.STATIC_DRAW);
}

// Takes what visibleOf found.
function putBody(scene, seen) {
  const { body: { grain, throat, node } } = scene, grains = seen.grains.all, throats = seen.throats.all;
  const sphere = new Float32Array(4 * grains.length), tube = new Float32Array(12 * throats.length);
  for (let k = 0; k < grains.length; k++) {
    for (let axis = 0; axis < 3; axis++) sphere[4 * k + axis] = grain.at[3 * grains[k] + axis];
    sphere[4 * k + 3] = grain.radius[grains[k]];
  }
  for (let k = 0; k < throats.length; k++) {
    const t = throats[k];
    for (let axis = 0; axis < 3; axis++) {
      tube[12 * k + axis] = node.at[3 * throat.first[t] + axis];
      tube[12 * k + 4 + axis] = node.at[3 * throat.second[t] + axis];
    }
    tube[12 * k + 3] = throat.radius[t]; tube[12 * k + 7] = t;
    tube[12 * k + 8] = throat.leaves[t]; tube[12 * k + 9] = throat.ends[t];
  }
  put(scene, "grain", "things", sphere, 4);
  put(scene, "grain", "numbers", Float32Array.from(grains), 1);
  put(scene, "throat", "things", tube, 4);
  putSquares(scene, throats.length);
  scene.sets.arrow.textures.things = scene.sets.grain.textures.things;
  scene.shown = { grains, throats };
  Object.assign(scene.sets.grain, { count: grains.length, bold: seen.grains.bold });
  Object.assign(scene.sets.throat, { count: throats.length, bold: seen.throats.bold });
  scene.sets.arrow.count = grains.length;
}

// Colours from COLOUR (index to 0..1) of what is shown.
function putTints(scene, kind, colour) {
  const tint = Float32Array.from(scene.shown[`${kind}s`], (index) => {
    const [r, g, b] = colour(index);
    return Math.round(255 * r) + 256 * Math.round(255 * g) + 65536 * Math.round(255 * b);
  });
  put(scene, kind, "tints", tint, 1);
}

// FORCES (3 a grain, shares of the largest).
function putForces(scene, forces) {
  const { grains } = scene.shown, shown = new Float32Array(3 * grains.length);
  for (let k = 0; k < grains.length; k++)
    for (let axis = 0; axis < 3; axis++) shown[3 * k + axis] = forces[3 * grains[k] + axis];
  put(scene, "arrow", "forces", shown, 3);
}

// The throats from FROM to END that there are to draw: those that empty last stand first.
function drawThroats({ gl, shown: { throats }, body: { throat } }, view, from, end) {
  let low = view.show.empty ? end : from, high = end;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (throat.ends[throats[middle]] > view.key) low = middle + 1; else high = middle;
  }
  if (low > from) gl.drawElements(gl.TRIANGLES, 6 * (low - from), gl.UNSIGNED_INT, 24 * from);
}

function drawSet(scene, name, view, mode, picking = false, opacity = 1) {
  const { gl } = scene, { program, uniform } = scene.programs[name], { count, bold = count, textures } = scene.sets[name];
  if (!count) return;
  const set = (key, how, ...values) => uniform[key] && gl[how](uniform[key], ...values);
  gl.useProgram(program);
  gl.uniformMatrix3fv(uniform.turn, true, view.turn);
  set("frame", "uniform4fv", view.frame);
  set("clip", "uniform4fv", view.clip);
  set("now", "uniform1f", view.key);
  set("picking", "uniform1f", picking ? 1 : 0);
  set("kind", "uniform2f", (KINDS[name] || 0) / 255, opacity);
  set("grow", "uniform1f", view.grow);
  set("least", "uniform1f", view.pixel * 0.6);
  set("drawEmpty", "uniform1f", view.show.empty ? 1 : 0);
  set("drawLiquid", "uniform1f", view.show.liquid ? 1 : 0);
  set("emptyColour", "uniform3fv", view.colours.empty);
  set("modeColour", "uniform3fv", [...view.colours.tension, ...view.colours.shear]);
  set("rimColour", "uniform3fv", view.colours.rim);
  set("arrowColour", "uniform3fv", view.colours.force);
  set("lineColour", "uniform3fv", view.colours.line);
  set("longest", "uniform1f", view.longest);
  TEXTURES.forEach((key, unit) => {
    set(key, "uniform1i", unit);
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, textures[key] || textures.things);
  });
  gl.activeTexture(gl.TEXTURE0);
  if (name !== "throat") return gl.drawArrays(mode, 0, (view.plain ? bold : count) * CORNERS[name]);
  drawThroats(scene, view, 0, bold);
  if (!view.plain) drawThroats(scene, view, bold, count);
}

function drawThings(scene, view, picking) {
  const { gl } = scene, { show } = view;
  if (show.grains) drawSet(scene, "grain", view, gl.TRIANGLES, picking);
  if (show.liquid || show.empty) drawSet(scene, "throat", view, gl.TRIANGLES, picking);
  if (show.cracks) drawSet(scene, "crack", view, gl.TRIANGLES, picking);
}

// Broken bonds that something hides shine through it, pale.
function drawHiddenCracks(scene, view) {
  const { gl } = scene;
  gl.depthFunc(gl.GREATER);
  gl.depthMask(false);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  drawSet(scene, "crack", view, gl.TRIANGLES, false, 0.55);
  gl.disable(gl.BLEND);
  gl.depthMask(true);
  gl.depthFunc(gl.LEQUAL);
}

function drawScene(scene, view) {
  const { gl, canvas } = scene;
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.clearColor(...view.colours.panel, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  drawSet(scene, "line", view, gl.LINES);
  drawThings(scene, view, false);
  if (view.show.cracks) drawHiddenCracks(scene, view);
  if (view.show.forces) drawSet(scene, "arrow", view, gl.TRIANGLES);
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
