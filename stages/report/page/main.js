// The page.

const element = (id) => document.getElementById(id);

function readColours() {
  const style = getComputedStyle(document.documentElement), colours = {};
  for (const [name, key] of Object.entries({ panel: "panel", empty: "empty", tension: "tension", shear: "shear", force: "force", liquid: "liquid", grain: "grain", picked: "picked", rim: "paper", line: "soft" })) {
    const hex = style.getPropertyValue(`--${key}`).trim().slice(1), long = hex.length === 3 ? [...hex].map((c) => c + c).join("") : hex;
    colours[name] = [0, 2, 4].map((k) => parseInt(long.slice(k, k + 2), 16) / 255);
  }
  return colours;
}

const mix = (a, b, share) => a.map((v, k) => v + (b[k] - v) * share);

// The moment of the forces that are shown: the last that is not after now.
function momentAt({ arrays }, key) {
  const keys = arrays["moment.key"] || [];
  let m = 0;
  while (m + 1 < keys.length && keys[m + 1] <= key) m++;
  return m;
}

function forcesAt({ arrays, grain }, m) {
  const all = arrays["moment.force"], forces = new Float32Array(3 * grain.n);
  for (let k = 0; all && k < 3 * grain.n; k++) forces[k] = (all[3 * grain.n * m + k] - 128) / 127;
  return forces;
}

// Shares of each colour at a grain or throat, 0 to 1.
function tintsOf(page, key) {
  const { body, colours, colourBy, picked } = page;
  let grainTint = () => colours.grain, throatTint = () => colours.liquid;
  const field = fieldsOf(body).find(({ array }) => array === colourBy);
  if (field && field.of === "grain") grainTint = fieldTint(body, field, colours);
  if (field && field.of === "throat") throatTint = fieldTint(body, field, colours);
  if (colourBy === "force") {
    const forces = forcesAt(body, momentAt(body, key));
    grainTint = (i) => mix(colours.grain, colours.force, Math.min(1, Math.hypot(forces[3 * i], forces[3 * i + 1], forces[3 * i + 2])));
  } else if (colourBy === "broken") {
    const broken = new Uint8Array(body.grain.n), { bond } = body;
    for (let b = 0; b < bond.n; b++) if (bond.breaks[b] <= key) { broken[bond.first[b]]++; broken[bond.second[b]]++; }
    grainTint = (i) => mix(colours.grain, colours.shear, Math.min(1, broken[i] / 4));
  } else if (colourBy === "pieces") {
    const colour = groupColours(piecesAt(body, key));
    grainTint = (i) => colour(i).map((v) => v / 255);
  } else if (colourBy === "clusters") {
    const colour = groupColours(clustersAt(body, key));
    throatTint = (t) => mix(colour(t).map((v) => v / 255), colours.liquid, 0.35);
  }
  const marked = (kind, tint) => (index) => picked && picked.kind === kind && picked.index === index ? colours.picked : tint(index);
  return { grain: marked("grain", grainTint), throat: marked("throat", throatTint) };
}

const dependsOnMoment = (colourBy) => colourBy !== "none";

function viewOf(page, width, height) {
  const { body, camera, course } = page, axis = Number(element("clip-axis").value);
  const [wide, high] = extentOf(camera, width, height, body), clip = [0, 0, 0, 1];
  if (axis >= 0) {
    clip[axis] = 1;
    clip[3] = (Number(element("clip").value) / 1000 - 0.5) * body.size[axis] * 1.02;
  }
  const show = Object.fromEntries([...element("shown").querySelectorAll("input")].map((box) => [box.name, box.checked]));
  return { turn: turnOf(camera), frame: [-camera.x, -camera.y, wide, high], clip, key: course ? course.key : 0, show, colours: page.colours,
    grow: Number(element("size").value) / 100, dense: page.dense, pixel: 2 * wide / width * page.dense, longest: page.longest, plain: page.moving && (page.lateFrames > 2 || page.first) };
}

// ---- drawing ------------------------------------------------------------------------

// DENSE points for each of the page's.
function resize(page, dense) {
  const { canvas } = page;
  page.dense = dense;
  const width = Math.max(1, Math.round(canvas.clientWidth * dense)), height = Math.max(1, Math.round(canvas.clientHeight * dense));
  if (canvas.width === width && canvas.height === height) return;
  canvas.width = width;
  canvas.height = height;
}

function updateShown(page, view) {
  page.seen = visibleOf(page.body, view, page.canvas.width, page.canvas.height);
  if (page.scene) putBody(page.scene, page.seen);
  page.stale = false;
  page.shownFrom = view.plain ? { ...page.camera } : null;
  page.tinted = page.forced = null;
  sayDrawn(page);
}

function updateMoment(page, view) {
  const tinted = `${page.colourBy} ${dependsOnMoment(page.colourBy) ? view.key : ""} ${page.picked ? page.picked.kind + page.picked.index : ""}`;
  if (page.tinted !== tinted) {
    page.tints = tintsOf(page, view.key);
    if (page.scene) {
      putTints(page.scene, "grain", page.tints.grain);
      putTints(page.scene, "throat", page.tints.throat);
    }
    page.tinted = tinted;
  }
  sayLegend(page);
  const m = momentAt(page.body, view.key);
  if (page.scene && view.show.forces && page.forced !== m) {
    putForces(page.scene, forcesAt(page.body, m));
    page.forced = m;
  }
}

// A small body at rest has twice the points of the screen, so that its edges are smooth. A
// large one that a machine cannot follow thirty times a second is drawn with only what is
// bold while it moves, and if that is not enough, with half of the points.
function followMotion(page) {
  const now = performance.now(), since = now - page.drawnAt;
  page.drawnAt = now;
  if (page.moving && isLarge(page.body) && since > 33 && since < 1000) page.lateFrames++;
  const screen = Math.min(2, window.devicePixelRatio || 1), still = isLarge(page.body) ? screen : Math.max(2, screen);
  resize(page, !page.moving ? still : page.lateFrames > 4 || page.first ? screen / 2 : screen);
}

function draw(page) {
  page.waiting = false;
  followMotion(page);
  const view = viewOf(page, page.canvas.width, page.canvas.height);
  if (page.body.moves && page.movedTo !== view.key) moveTo(page, view.key);
  if (page.stale && !(view.plain && page.shownFrom && seesAlike(page.camera, page.shownFrom))) updateShown(page, view);
  updateMoment(page, view);
  if (page.scene) drawScene(page.scene, view);
  else page.things = drawFlat(page.canvas, page.body, page.cracks, { ...view, grainTint: page.tints.grain, throatTint: page.tints.throat }, page.seen);
  sayScale(view);
}

// A large body at first as while it moves, and soon as at rest.
function drawFirst(page) {
  page.first = page.moving = isLarge(page.body);
  draw(page);
  if (!page.first) return;
  page.first = false;
  page.stale = true;
  keepMoving(page);
}

function moveTo(page, key) {
  moveBody(page.body, key);
  page.cracks = cracksOf(page.body);
  if (page.scene) { page.scene.cracks = page.cracks; putCracks(page.scene); }
  page.movedTo = key;
  page.shownFrom = null;
  page.stale = true;
}

function askDraw(page) {
  if (page.waiting) return;
  page.waiting = true;
  requestAnimationFrame(() => draw(page));
}

// For as long as the moment goes on.
function keepMoving(page) {
  page.moving = true;
  clearTimeout(page.rest);
  page.rest = setTimeout(() => { page.moving = false; askDraw(page); }, 160);
}

function sayDrawn(page) {
  const { body, seen } = page, words = [];
  const count = (n) => n.toLocaleString("en");
  if (seen.grains.all.length < body.grain.n || seen.throats.all.length < body.throat.n) words.push(`Of ${count(body.grain.n)} grains and ${count(body.throat.n)} throats, ${count(seen.grains.all.length)} and ${count(seen.throats.all.length)} are drawn; grains hide the others.`);
  if (body.meta.dryThroats) words.push(`${count(body.meta.dryThroats)} ${wordsOf(body).left}`);
  if (body.moves) words.push(`A contact is as thick as its force: the largest, ${withUnit(body.meta.shown.contact, "N")}, as 0.6 of the mean grain. Between snapshots (${body.arrays["moment.key"].length}) grains go straight and contacts are those of the one before.`);
  words.push(`Places are within a thousandth of a grain; arrows within 1/250 of the largest.`);
  element("drawn").textContent = words.join(" ");
}

function sayScale(view) {
  const { body, canvas } = page, pixel = 2 * view.frame[2] / canvas.clientWidth * body.unit, length = roundDown(110 * pixel);
  element("scale").style.width = `${length / pixel}px`;
  element("scale").firstElementChild.textContent = withUnit(length, "m");
}

function sayNow(page) {
  const { course, body, cracks } = page;
  if (!course) return;
  const broken = [0, 0];
  for (const crack of cracks) if (crack.key <= course.key && !crack.earlier) broken[crack.mode]++;
  const earlier = cracks.filter((crack) => crack.earlier).length;
  const saturation = course.saturation ? `saturation ${course.at(course.saturation, course.key).toFixed(3)}, ` : "";
  const words = saturation + withUnit(course.at(course.time, course.key), "s");
  const cracked = body.arrays["course.tension"] ? `; broken: ${broken[0]} in tension, ${broken[1]} in shear${earlier ? `, ${earlier} before` : ""}` : "";
  element("now").textContent = words + cracked;
  element("moment").setAttribute("aria-valuetext", words + cracked);
  page.canvas.setAttribute("aria-label", `The body in 3D, ${body.grain.n} grains, at ${words}${cracked}`);
}

// ---- what people do -----------------------------------------------------------------

function pick(page, event) {
  const { canvas } = page, box = canvas.getBoundingClientRect(), view = viewOf(page, canvas.width, canvas.height);
  const x = Math.floor((event.clientX - box.left) / box.width * canvas.width), y = canvas.height - 1 - Math.floor((event.clientY - box.top) / box.height * canvas.height);
  choose(page, page.scene ? pickAt(page.scene, view, x, y) : pickFlat(page.things, view, canvas, x, y));
}

function choose(page, picked) {
  page.picked = picked;
  showDetails(page.body, page.course || { rows: 0, key: 0 }, page.cracks, picked);
  askDraw(page);
}

function listen(page) {
  const again = (stale) => () => { page.stale ||= stale; askDraw(page); };
  steer(page.canvas, page.camera, page.body, (moving) => {
    page.moving = moving;
    page.stale ||= isLarge(page.body) || !moving;
    askDraw(page);
  }, (event) => pick(page, event));
  element("shown").addEventListener("change", again(true));
  element("size").addEventListener("input", again(true));
  element("clip").addEventListener("input", again(true));
  element("clip-axis").addEventListener("change", () => {
    element("clip-label").hidden = element("clip-axis").value === "-1";
    again(true)();
  });
  element("colour").addEventListener("change", (event) => { page.colourBy = event.target.value; askDraw(page); });
  let size = "";
  new ResizeObserver(() => {
    const now = `${page.canvas.clientWidth} ${page.canvas.clientHeight}`;
    if (size && size !== now) again(isLarge(page.body))();
    size = now;
  }).observe(page.canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { page.colours = readColours(); page.tinted = null; askDraw(page); });
  for (const button of document.querySelectorAll("button.go")) button.addEventListener("click", () => {
    page.course.set(Number(button.dataset.key));
    if (button.dataset.grain) choose(page, { kind: "grain", index: Number(button.dataset.grain) });
    page.canvas.scrollIntoView({ block: "nearest" });
  });
  window.addEventListener("beforeprint", () => drawStrip(page));
}

// Five moments side by side, for paper.
function drawStrip(page) {
  const { course, body } = page, shares = course ? [0.1, 0.25, 0.4, 0.7, 1] : [1];
  const figures = shares.map((share) => {
    const canvas = html("canvas", { width: 440, height: 640 }), colours = readColours();
    const key = course ? Math.round(share * course.last) : 0;
    if (body.moves) moveTo(page, key);
    const view = { ...viewOf(page, 440, 640), key, colours, dense: 1 };
    const tints = tintsOf({ ...page, colours, picked: null }, key);
    drawFlat(canvas, body, page.cracks, { ...view, grainTint: tints.grain, throatTint: tints.throat }, body.moves ? visibleOf(body, view, 440, 640) : page.seen);
    return html("figure", {}, canvas, html("figcaption", { textContent: course ? whenText(course, key) : "" }));
  });
  element("strip").replaceChildren(...figures);
}

// ---- the beginning ------------------------------------------------------------------

function prepareControls(body) {
  const small = !isLarge(body);
  nameControls(body);
  page.colourBy = element("colour").value;
  element("size").value = body.moves ? 80 : small ? 62 : 100;
  element("shown").querySelector("[name=empty]").checked = small && body.grain.n < 1000;
  const without = (name, there) => { if (!there) { const box = element("shown").querySelector(`[name=${name}]`); box.checked = false; box.disabled = true; } };
  without("liquid", body.moves || body.throat.n);
  without("empty", body.throat.n);
  without("cracks", body.bond.n);
  without("forces", body.arrays["moment.key"]);
}

function startScene(page) {
  try {
    page.scene = location.hash === "#flat" ? null : newScene(page.canvas, page.body, page.cracks);
  } catch (error) {
    page.scene = null;
  }
  if (page.scene) return;
  element("missing").textContent = "WebGL is missing here, so the body is drawn plainly: without shading, and forces not at all.";
  element("missing").hidden = false;
}

// When half of what breaks has broken.
function telling(cracks, last) {
  const keys = cracks.filter((crack) => !crack.earlier).map((crack) => crack.key).sort((a, b) => a - b);
  return keys.length ? keys[keys.length >> 1] : last / 2;
}

const page = { camera: newCamera(), canvas: element("view"), colourBy: "none", drawnAt: 0, dense: 1, lateFrames: 0, stale: true, longest: 1 };

async function start() {
  const meta = JSON.parse(element("meta").textContent);
  page.body = bodyOf(meta, await readArrays(meta));
  page.cracks = cracksOf(page.body);
  page.colours = readColours();
  page.longest = 3 * page.body.grain.radius.reduce((a, b) => Math.max(a, b), 0);
  prepareControls(page.body);
  startScene(page);
  if (meta.rows > 1) {
    page.course = newCourse(page.body);
    page.course.listeners.push(() => { sayNow(page); askDraw(page); });
    page.course.set(telling(page.cracks, page.course.last));
    page.course.listeners.push(() => keepMoving(page));
  } else {
    element("course").hidden = true;
  }
  listen(page);
  drawFirst(page);
  drawCurves(page.body, page.course);
  document.documentElement.dataset.ready = "yes";
}

start().catch((error) => {
  element("missing").textContent = `The picture cannot be drawn here: ${error.message}`;
  element("missing").hidden = false;
});
