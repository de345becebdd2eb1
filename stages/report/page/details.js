// The numbers of one grain, throat or broken bond, and what prints them.

const MODES = ["tension", "shear"];

function placeText(body, at, k) {
  return [0, 1, 2].map((axis) => withUnit(at[3 * k + axis] * body.unit + body.middle[axis], "m")).join(", ");
}

function whenText(course, key) {
  if (!course.rows) return "";
  return (course.saturation ? `saturation ${short(course.at(course.saturation, key))}, ` : "") + withUnit(course.at(course.time, key), "s");
}

function printing(dataset, files, filter) {
  const file = files.find((name) => meta_has(name, dataset)) || files[0];
  return `craquelure inspect --data ${dataset} ${file} | jq '${filter}'`;
}

// Which artifact has a dataset, the first that may.
function meta_has(name, dataset) {
  const within = { "/particles": /^(packing|drying|forces|response|flow|motion)\.h5/, "/throats": /^(drying|network|flow)\.h5/, "/contacts": /^motion\.h5/, "/bonds": /^(packing|response|motion)\.h5/, "/cracks": /^response\.h5/, "/force": /^forces\.h5/ };
  return within[`/${dataset.split("/")[1]}`].test(name);
}

// EARLIER: before the run began.
const brokeText = (course, key, mode, earlier) => (earlier ? `had broken before, in ${MODES[mode]}` : `broke in ${MODES[mode]} at ${whenText(course, key)}`);

function describeGrain(body, course, i) {
  const { grain, bond, arrays, meta } = body, history = [];
  let bonds = 0, whole = 0;
  for (let b = 0; b < bond.n; b++) {
    if (bond.first[b] !== i && bond.second[b] !== i) continue;
    bonds++;
    if (bond.breaks[b] > course.key) whole++;
    if (bond.breaks[b] === NEVER) continue;
    history.push([bond.breaks[b], `bond with grain ${bond.first[b] === i ? bond.second[b] : bond.first[b]} ${brokeText(course, bond.breaks[b], bond.mode[b], bond.earlier[b])}`]);
  }
  const rows = [["centre", placeText(body, grain.at, i)], ["diameter", withUnit(2 * grain.radius[i] * body.unit, "m")]];
  if (bonds) rows.push(["bonds", `${whole} of ${bonds} whole`]);
  if (arrays["grain.largest"]) rows.push([wordsOf(body).most, withUnit(arrays["grain.largest"][i], wordsOf(body).unit) + (course.rows ? ` at ${whenText(course, arrays["grain.largest_key"][i])}` : "")]);
  for (const { array, label, of, kinds, unit } of fieldsOf(body)) if (of === "grain") rows.push([label.replace("grains by ", ""), kinds ? String(arrays[array][i]) : withUnit(arrays[array][i], unit)]);
  return { title: `Grain ${i}`, rows, history: history.sort((a, b) => a[0] - b[0]).map(([, text]) => text), command: printing("/particles/position", meta.files, `.[${i}]`) };
}

function describeContact(body, t) {
  const { throat, arrays, meta, grain } = body, id = throat.id[t], j = arrays["chain.second"][id];
  return { title: "Contact", rows: [["of", `grain ${throat.first[t]} with ${j === grain.n ? "a wall" : `grain ${j}`}`], ["force", withUnit(arrays["chain.force"][id] / 255 * meta.shown.contact, "N")]], history: [], command: printing("/contacts/force", meta.files, ".") };
}

function describeThroat(body, course, t) {
  if (body.moves) return describeContact(body, t);
  const { throat, node, meta } = body, id = throat.id[t], a = throat.first[t], b = throat.second[t];
  const length = Math.hypot(...[0, 1, 2].map((axis) => node.at[3 * a + axis] - node.at[3 * b + axis])) * body.unit;
  const rows = [["radius", withUnit(throat.radius[t] * body.unit, "m")], ["length", withUnit(length, "m")]];
  if (meta.tension > 0 && throat.radius[t] > 0) rows.push(["entry suction", withUnit(2 * meta.tension / (throat.radius[t] * body.unit), "Pa")]);
  for (const { array, label, of, unit } of fieldsOf(body)) if (of === "throat") rows.push([label.replace("pores by ", ""), withUnit(body.arrays[array][id], unit)]);
  const history = meta.subject === "flow" ? [] : throat.ends[t] === NEVER ? ["never empties"] : [`begins to empty at ${whenText(course, throat.leaves[t])}`, `is empty at ${whenText(course, throat.ends[t])}`];
  return { title: `Throat ${id}`, rows, history, command: printing("/throats/radius", meta.files, `.[${id}]`) };
}

function describeCrack(body, course, crack) {
  const i = body.bond.first[crack.bond], j = body.bond.second[crack.bond];
  return { title: `Bond ${crack.bond}`, rows: [["grains", `${i} and ${j}`], ["centre", placeText(body, crack.at, 0)]],
    history: [brokeText(course, crack.key, crack.mode, crack.earlier)], command: printing("/bonds/particles", body.meta.files, `.[${crack.bond}]`) };
}

function describe(body, course, cracks, picked) {
  if (picked.kind === "grain") return describeGrain(body, course, picked.index);
  if (picked.kind === "throat") return describeThroat(body, course, picked.index);
  return describeCrack(body, course, cracks[picked.index]);
}

function showDetails(body, course, cracks, picked) {
  const place = document.getElementById("picked");
  if (!picked) return place.replaceChildren(html("p", { textContent: `Nothing there. ${wordsOf(body).pick}` }));
  const { title, rows, history, command } = describe(body, course, cracks, picked);
  place.replaceChildren(html("p", {}, html("b", { textContent: title })),
    html("dl", {}, ...rows.flatMap(([term, text]) => [html("dt", { textContent: term }), html("dd", { textContent: text })])),
    ...history.map((text) => html("p", { textContent: text })), html("p", {}, html("code", { textContent: command })));
}
