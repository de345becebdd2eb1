// Curves over the drying, which show the moment and set it; with their numbers as text.

const CHART = { width: 480, height: 290, left: 62, right: 14, top: 30, bottom: 46 };

function svg(name, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  element.append(...children);
  return element;
}

function html(name, properties, ...children) {
  const element = Object.assign(document.createElement(name), properties);
  element.append(...children);
  return element;
}

// Even steps of 1, 2 or 5 from LOW to HIGH.
function ticksOf(low, high) {
  let step = roundDown((high - low) / 3.9 || 1);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) ticks.push(Number((k * step).toPrecision(12)));
  return ticks;
}

// A prefix for an axis up to MOST: "ms" and 1e3.
function axisUnit(most, unit) {
  if (!unit || !(most > 0)) return ["", 1];
  const k = Math.min(10, Math.max(0, Math.floor(Math.log10(most * 1.0005) / 3) + 6));
  return [`${PREFIXES[k]}${unit}`, 10 ** (3 * (6 - k))];
}

// SPEC: title, label, unit, lines [{name, colour, dash, y}], x (values, the same number of
// them), xLabel, xUnit, backwards (x runs from high to low), steps; keyOf and xOf lead
// between x and the moment (none: the chart has no moment).
function newChart(spec, course) {
  const { width, height, left, right, top, bottom } = CHART;
  const [xWord, xFactor] = axisUnit(spec.xMost || Math.max(...spec.x), spec.xUnit), reach = (of) => spec.lines.reduce((all, line) => line.y.reduce((a, b) => Number.isFinite(b) ? of(a, b) : a, all), 0);
  const most = reach(Math.max), least = reach(Math.min);
  const [yWord, yFactor] = axisUnit(Math.max(most, -least), spec.unit);
  const xEnd = (spec.xMost || Math.max(...spec.x)) * xFactor || 1, yEnd = (most * yFactor || (least < 0 ? 0 : 1)) * 1.06, yBegin = least * yFactor * 1.06;
  const x = (value) => { const share = value * xFactor / xEnd; return left + (width - left - right) * (spec.backwards ? 1 - share : share); };
  const y = (value) => height - bottom - (height - bottom - top) * (value * yFactor - yBegin) / (yEnd - yBegin);
  const picture = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "chart", tabindex: 0, role: "img", "aria-label": spec.title });
  for (const tick of ticksOf(0, xEnd)) picture.append(svg("line", { class: "grid", x1: x(tick / xFactor), x2: x(tick / xFactor), y1: top, y2: height - bottom }),
    svg("text", { x: x(tick / xFactor), y: height - bottom + 18, "text-anchor": "middle" }, String(tick)));
  for (const tick of ticksOf(yBegin, yEnd)) picture.append(svg("line", { class: "grid", x1: left, x2: width - right, y1: y(tick / yFactor), y2: y(tick / yFactor) }),
    svg("text", { x: left - 7, y: y(tick / yFactor) + 4, "text-anchor": "end" }, String(tick)));
  picture.append(svg("path", { class: "axis", d: `M${left} ${top}V${height - bottom}H${width - right}` }),
    svg("text", { x: (left + width - right) / 2, y: height - 8, "text-anchor": "middle" }, spec.xLabel + (xWord ? ` (${xWord})` : "")),
    svg("text", { x: 14, y: (top + height - bottom) / 2, "text-anchor": "middle", transform: `rotate(-90 14 ${(top + height - bottom) / 2})` }, spec.label + (yWord ? ` (${yWord})` : "")));
  spec.lines.forEach((line, k) => drawLine(picture, spec, line, k, x, y));
  const cursor = svg("line", { class: "cursor", y1: top, y2: height - bottom });
  if (spec.xOf) picture.append(cursor);
  const setKey = (key) => {
    if (!spec.xOf) return;
    const at = x(spec.xOf(key));
    cursor.setAttribute("x1", at);
    cursor.setAttribute("x2", at);
  };
  if (spec.keyOf) picture.addEventListener("click", (event) => {
    const box = picture.getBoundingClientRect();
    let share = ((event.clientX - box.left) / box.width * width - left) / (width - left - right);
    share = Math.min(1, Math.max(0, spec.backwards ? 1 - share : share));
    course.set(spec.keyOf(share * xEnd / xFactor));
  });
  picture.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step || !course) return;
    event.preventDefault();
    course.set(course.key + step * course.last / 100);
  });
  return { element: html("figure", {}, html("figcaption", { textContent: spec.title }), picture, numbersOf(spec)), setKey, picture, spec };
}

function drawLine(picture, spec, line, k, x, y) {
  let path = "";
  for (let p = 0; p < spec.x.length; p++) {
    if (!Number.isFinite(line.y[p])) continue; // not known then
    const at = x(spec.x[p]).toFixed(1), up = y(line.y[p]).toFixed(1);
    path += path ? (spec.steps ? `H${at}V${up}` : `L${at} ${up}`) : `M${at} ${up}`;
  }
  const stroke = svg("path", { class: "line", d: path });
  stroke.style.stroke = `var(--${line.colour})`;
  if (line.dash) stroke.setAttribute("stroke-dasharray", line.dash);
  picture.append(stroke);
  line.element = stroke;
  if (!line.name) return;
  const from = CHART.left + 8 + 390 / Math.max(3, spec.lines.length) * k, sample = svg("path", { class: "line", d: `M${from} 14h22` });
  sample.style.stroke = stroke.style.stroke;
  if (line.dash) sample.setAttribute("stroke-dasharray", line.dash);
  picture.append(sample, svg("text", { x: from + 28, y: 18 }, line.name));
}

function tsvOf(spec) {
  const head = [spec.xLabel + (spec.xUnit ? ` (${spec.xUnit})` : ""), ...spec.lines.map((line) => (line.name || spec.label) + (spec.unit ? ` (${spec.unit})` : ""))];
  const rows = spec.x.map((value, k) => [value, ...spec.lines.map((line) => line.y[k])].map((v) => v === null ? "" : Number(v.toPrecision(7))).join("\t"));
  return [head.join("\t"), ...rows].join("\n") + "\n";
}

// Made when it is opened.
function numbersOf(spec) {
  const text = html("textarea", { readOnly: true, ariaLabel: `Data of: ${spec.title}` });
  const copy = html("button", { type: "button", textContent: "Copy" }), save = html("button", { type: "button", textContent: "Save as TSV" });
  const details = html("details", {}, html("summary", { textContent: "Data" }), copy, " ", save, text);
  details.addEventListener("toggle", () => { if (details.open) text.value = tsvOf(spec); });
  copy.addEventListener("click", () => { text.select(); document.execCommand("copy"); });
  save.addEventListener("click", () => {
    const link = html("a", { href: URL.createObjectURL(new Blob([tsvOf(spec)], { type: "text/tab-separated-values" })), download: `${spec.title.replace(/\W+/g, "-").toLowerCase()}.tsv` });
    link.click();
    URL.revokeObjectURL(link.href);
  });
  return details;
}

// Mean suction of the throats that empty, in even shares of the course.
function suctionOf({ throat, lastKey, meta, unit }) {
  const bins = 60, sum = new Array(bins).fill(0), count = sum.slice(), keys = [], value = [];
  for (let t = 0; t < throat.n; t++) {
    if (throat.ends[t] === NEVER || !(throat.radius[t] > 0)) continue;
    const bin = Math.min(bins - 1, Math.floor(throat.ends[t] / (lastKey + 1) * bins));
    sum[bin] += 2 * meta.tension / (throat.radius[t] * unit);
    count[bin]++;
  }
  for (let bin = 0; bin < bins; bin++) if (count[bin]) { keys.push((bin + 0.5) / bins * lastKey); value.push(sum[bin] / count[bin]); }
  return { keys, value };
}

const LINE_COLOURS = ["liquid", "shear", "force", "second"], DASHES = [null, "8 5", "3 3", "12 4 3 4"];

// Charts that the program names, over COMMON or over their own x.
function namedSpecs({ arrays, meta }, common) {
  const named = (meta.shown && meta.shown.charts) || [];
  return named.map((chart) => ({ ...(chart.x ? { xUnit: "" } : common), steps: false, ...chart,
    lines: chart.lines.map((line, k) => ({ name: line.name, y: line.y || Array.from(arrays[line.array]), colour: LINE_COLOURS[k], dash: DASHES[k] })) }));
}

function specsOf(body, course, along) {
  const { arrays, meta } = body;
  if (!course) return namedSpecs(body, {});
  const specs = [], keys = Array.from({ length: meta.rows }, (_, row) => row * meta.keysARow);
  const bySaturation = along === "saturation";
  const over = (column) => (key) => course.at(column, key);
  const axis = (column, label, unit, backwards) => ({
    xLabel: label, xUnit: unit, backwards, xOf: over(column), xMost: column.reduce((a, b) => Math.max(a, b), 0),
    keyOf: (x) => { const [row, share] = placeIn(backwards ? Array.from(column, (v) => -v) : column, backwards ? -x : x); return (row + share) * meta.keysARow; },
  });
  const time = { ...axis(course.time, "time", "s", false) }, saturation = course.saturation && axis(course.saturation, "saturation (drying runs to the right)", "", true);
  const common = bySaturation && saturation ? saturation : time;
  const add = (title, label, unit, lines, at = keys, steps = true) => specs.push({ ...common, title, label, unit, steps, lines, x: at.map(common.xOf) });
  const line = (name, colour, y, dash) => ({ name, colour, y, dash });
  if (arrays["course.tension"]) add("Broken bonds so far", "bonds", "", [line("in tension", "tension", arrays["course.tension"]), line("in shear", "shear", arrays["course.shear"], "8 5")]);
  const rate = arrays["course.rate"];
  if (rate) add("Drying rate, of the first", "rate / first rate", "", [line("", "liquid", Array.from(rate, (r) => r / (rate[0] || 1)))]);
  if (saturation) specs.push({ ...time, title: "Saturation over time", label: "saturation", unit: "", steps: false, lines: [line("", "liquid", course.saturation)], x: Array.from(course.time) });
  if (arrays["course.clusters"]) add("Liquid clusters", "clusters", "", [line("", "liquid", arrays["course.clusters"])]);
  if (arrays["load.key"]) add(wordsOf(body).arrowChart, wordsOf(body).arrow, wordsOf(body).unit, [line("largest", "force", arrays["load.largest"]), line("mean", "force", arrays["load.mean"], "8 5")], Array.from(arrays["load.key"]), false);
  specs.push(...namedSpecs(body, { ...common, x: keys.map(common.xOf) }));
  if (meta.tension > 0 && body.throat.n) {
    const { keys: at, value } = suctionOf(body);
    if (at.length > 1) add("Suction at which throats empty, mean", "2 γ cos θ / r", "Pa", [line("", "liquid", value)], at, false);
  }
  return specs;
}

function profileChart({ meta }, course) {
  if (!meta.profiles) return null;
  const lines = meta.profiles.levels.map((level) => ({ name: "", colour: "liquid", y: level.slices }));
  const chart = newChart({ title: "Saturation of slices, at steps of the drying", label: "saturation", unit: "", xLabel: "depth below the open side, of the whole", xUnit: "", x: meta.profiles.depth, lines, steps: false }, course);
  lines.forEach((line, k) => { line.name = `at saturation ${short(meta.profiles.levels[k].saturation)}`; });
  chart.setKey = (key) => {
    let nearest = 0;
    meta.profiles.levels.forEach((level, k) => { if (Math.abs(level.key - key) < Math.abs(meta.profiles.levels[nearest].key - key)) nearest = k; });
    lines.forEach((line, k) => { line.element.style.opacity = k === nearest ? 1 : 0.25; line.element.style.strokeWidth = k === nearest ? 3.5 : 1.5; });
  };
  return chart;
}

// Fills the page; returns what sets the moment of all.
function drawCurves(body, course) {
  const place = document.getElementById("curves"), along = document.getElementById("along");
  let charts = [];
  document.getElementById("along-label").hidden = !course || !course.saturation;
  const redraw = () => {
    charts = specsOf(body, course, along.value).map((spec) => newChart(spec, course));
    const profile = course && profileChart(body, course);
    if (profile) charts.push(profile);
    place.replaceChildren(...charts.map((chart) => chart.element));
    document.getElementById("curves-section").hidden = !charts.length;
    if (course) charts.forEach((chart) => chart.setKey(course.key));
  };
  along.addEventListener("change", redraw);
  if (course) course.listeners.push((key) => charts.forEach((chart) => chart.setKey(key)));
  redraw();
}
