// The same body without WebGL, and for print: circles, strokes and ellipses on a plain
// canvas, those behind first.

const css = ([r, g, b], opacity = 1) => `rgba(${Math.round(255 * r)},${Math.round(255 * g)},${Math.round(255 * b)},${opacity})`;

function flatThings(body, cracks, view, seen) {
  const { grain, throat, node } = body, m = view.turn, things = [];
  const eye = (at, k) => applyTurn(m, at[3 * k], at[3 * k + 1], at[3 * k + 2]);
  const isCut = (x, y, z) => view.clip[0] * x + view.clip[1] * y + view.clip[2] * z > view.clip[3];
  for (const i of view.show.grains ? seen.grains.all : [])
    if (!isCut(...grain.at.subarray(3 * i, 3 * i + 3))) things.push({ kind: "grain", index: i, eye: eye(grain.at, i), radius: grain.radius[i] * view.grow });
  for (const t of view.show.liquid || view.show.empty ? seen.throats.all : []) {
    const wet = throat.ends[t] > view.key;
    if (wet ? !view.show.liquid : !view.show.empty) continue;
    const a = eye(node.at, throat.first[t]), b = eye(node.at, throat.second[t]);
    if (isCut(...[0, 1, 2].map((axis) => (node.at[3 * throat.first[t] + axis] + node.at[3 * throat.second[t] + axis]) / 2))) continue;
    things.push({ kind: "throat", index: t, eye: [0, 1, 2].map((axis) => (a[axis] + b[axis]) / 2), a, b, wet, radius: throat.radius[t] * view.grow });
  }
  cracks.forEach((crack, k) => {
    if (!view.show.cracks || crack.key > view.key || isCut(...crack.at)) return;
    things.push({ kind: "crack", index: k, eye: applyTurn(m, ...crack.at), normal: applyTurn(m, ...crack.normal), radius: crack.radius, mode: crack.mode });
  });
  return things.sort((p, q) => p.eye[2] - q.eye[2]);
}

function drawFlatThing(pen, thing, view, x, y, pixels) {
  const { colours } = view;
  pen.beginPath();
  if (thing.kind === "grain") {
    pen.arc(x(thing.eye[0]), y(thing.eye[1]), thing.radius * pixels, 0, 7);
    pen.fillStyle = css(view.grainTint(thing.index)); pen.fill();
    pen.strokeStyle = css(colours.line); pen.lineWidth = 0.6 * view.dense; pen.stroke();
  } else if (thing.kind === "throat") {
    pen.moveTo(x(thing.a[0]), y(thing.a[1])); pen.lineTo(x(thing.b[0]), y(thing.b[1]));
    pen.strokeStyle = css(thing.wet ? view.throatTint(thing.index) : colours.empty);
    pen.lineWidth = thing.wet ? Math.max(view.dense, 2 * thing.radius * pixels) : 0.8 * view.dense; pen.stroke();
  } else {
    const [nx, ny, nz] = thing.normal;
    pen.ellipse(x(thing.eye[0]), y(thing.eye[1]), thing.radius * pixels, thing.radius * pixels * Math.max(0.16, Math.abs(nz)), Math.atan2(nx, ny), 0, 7);
    pen.fillStyle = css(thing.mode ? colours.shear : colours.tension); pen.fill();
    pen.strokeStyle = css(colours.rim); pen.lineWidth = view.dense; pen.stroke();
  }
}

// Draws on CANVAS; returns what is where, the hindmost first.
function drawFlat(canvas, body, cracks, view, seen) {
  const pen = canvas.getContext("2d"), [cx, cy, wide, high] = view.frame;
  const pixels = canvas.width / (2 * wide);
  const x = (across) => (across - cx + wide) * pixels, y = (up) => (cy + high - up) * pixels;
  pen.fillStyle = css(view.colours.panel);
  pen.fillRect(0, 0, canvas.width, canvas.height);
  const lines = boxLines(body);
  pen.beginPath();
  for (let k = 0; k < lines.length; k += 3) {
    const [u, v] = applyTurn(view.turn, lines[k], lines[k + 1], lines[k + 2]);
    pen[k % 6 ? "lineTo" : "moveTo"](x(u), y(v));
  }
  pen.strokeStyle = css(view.colours.line); pen.lineWidth = view.dense; pen.stroke();
  const things = flatThings(body, cracks, view, seen);
  for (const thing of things) drawFlatThing(pen, thing, view, x, y, pixels);
  pen.globalAlpha = 0.5; // those that something hides shine through it
  for (const thing of things) if (thing.kind === "crack") drawFlatThing(pen, thing, view, x, y, pixels);
  pen.globalAlpha = 1;
  return things;
}

function pickFlat(things, view, canvas, px, py) {
  const [cx, cy, wide, high] = view.frame, pixels = canvas.width / (2 * wide);
  const u = px / pixels - wide + cx, v = py / pixels - high + cy;
  for (let k = things.length - 1; k >= 0; k--) {
    const { kind, index, eye, radius, a, b } = things[k];
    let far = Math.hypot(u - eye[0], v - eye[1]);
    if (kind === "throat") {
      const dx = b[0] - a[0], dy = b[1] - a[1], t = Math.min(1, Math.max(0, ((u - a[0]) * dx + (v - a[1]) * dy) / (dx * dx + dy * dy || 1)));
      far = Math.hypot(u - a[0] - t * dx, v - a[1] - t * dy);
    }
    if (far <= Math.max(radius, 1 / pixels)) return { kind, index };
  }
  return null;
}
