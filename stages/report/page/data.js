// The arrays of the page, as stages/report/arrays.h keeps them.

async function inflate(text) {
  const packed = atob(text), bytes = new Uint8Array(packed.length);
  for (let k = 0; k < packed.length; k++) bytes[k] = packed.charCodeAt(k);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function decode(entry, bytes, from) {
  const n = entry.count, value = new Uint32Array(n);
  for (let plane = 0; plane < entry.planes; plane++)
    for (let k = 0, at = from + plane * n; k < n; k++) value[k] |= bytes[at + k] << (8 * plane);
  if (entry.float) return new Float32Array(value.buffer);
  for (let k = 0, last = 0; entry.delta && k < n; k++)
    value[k] = last += (value[k] >>> 1) ^ -(value[k] & 1);
  return value;
}

// {"grain.x": ..., ...}; those that the run does not have are missing.
async function readArrays(meta) {
  const bytes = await inflate(document.getElementById("data").textContent);
  const arrays = {};
  let from = 0;
  for (const entry of meta.arrays) {
    arrays[entry.name] = decode(entry, bytes, from);
    from += entry.count * entry.planes;
  }
  return arrays;
}

// Numbers of KEYS by falling key.
function fallingOrder(keys) {
  const place = new Uint32Array(65537), order = new Uint32Array(keys.length);
  for (let k = 0; k < keys.length; k++) place[65536 - keys[k]]++;
  for (let key = 1; key < place.length; key++) place[key] += place[key - 1];
  for (let k = 0; k < keys.length; k++) order[place[65535 - keys[k]]++] = k;
  return order;
}

// The values of COLUMN in ORDER.
function inOrder(column, order) {
  const n = order.length, to = new (Array.isArray(column) ? Uint32Array : column.constructor)(n);
  for (let k = 0; k < n; k++) to[k] = column[order[k]];
  return to;
}

// Throats, those that empty last first.
function throatsOf(columns) {
  const order = fallingOrder(columns.ends), throat = { n: order.length };
  for (const name in columns) throat[name] = inOrder(columns[name], order);
  return throat;
}

const NEVER = 65535; // a key: does not happen

// The run in the units of the picture: the middle of the box is the origin, half of its
// diagonal is 1. Lengths in metres are these times `unit`.
function bodyOf(meta, arrays) {
  const size = meta.upper.map((high, axis) => high - meta.lower[axis]);
  const unit = Math.hypot(...size) / 2 || 1;
  const middle = meta.lower.map((low, axis) => low + size[axis] / 2);
  const scale = meta.scales.step / unit, from = middle.map((m, axis) => (meta.scales.origin[axis] - m) / unit);
  const place = (name) => {
    const columns = ["x", "y", "z"].map((axis) => arrays[`${name}.${axis}`] || []);
    const n = columns[0].length, at = new Float32Array(3 * n);
    columns.forEach((column, axis) => {
      for (let k = 0; k < n; k++) at[3 * k + axis] = from[axis] + scale * column[k];
    });
    return at;
  };
  const length = (name) => new Float32Array(arrays[name] || []).map((value) => value * scale);
  const second = (first, apart) => new Uint32Array(first || []).map((value, k) => value + apart[k]);
  const node = { at: place("node") };
  const body = {
    meta, arrays, unit, size: size.map((length) => length / unit), half: size.map((length) => length / unit / 2), middle,
    grain: { at: place("grain"), radius: length("grain.radius"), n: (arrays["grain.radius"] || []).length },
    node, throat: throatsOf({
      first: arrays["throat.first"] || [], second: second(arrays["throat.first"], arrays["throat.second"]), radius: length("throat.radius"),
      leaves: arrays["throat.leaves"] || [], ends: arrays["throat.ends"] || [], id: arrays["throat.id"] || [],
    }),
    bond: {
      first: arrays["bond.first"] || [], second: second(arrays["bond.first"], arrays["bond.second"]),
      breaks: arrays["bond.breaks"], mode: arrays["bond.mode"], earlier: arrays["bond.earlier"] || [], n: (arrays["bond.first"] || []).length,
    },
    lastKey: Math.max(0, meta.rows - 1) * meta.keysARow, place: { from, scale },
  };
  body.meanRadius = body.grain.radius.reduce((sum, r) => sum + r, 0) / (body.grain.n || 1);
  body.moves = movesOf(body);
  if (body.moves) moveBody(body, 0);
  return body;
}

// A broken bond as a disc: between the surfaces of its two grains.
function cracksOf(body) {
  const { grain, bond, meta } = body, cracks = [];
  for (let b = 0; b < bond.n; b++) {
    if (bond.breaks[b] === NEVER) continue;
    const i = bond.first[b], j = bond.second[b];
    const along = [0, 1, 2].map((axis) => {
      const apart = grain.at[3 * j + axis] - grain.at[3 * i + axis], side = body.size[axis];
      return meta.periodic[axis] ? apart - side * Math.round(apart / side) : apart;
    });
    const distance = Math.hypot(...along) || 1;
    const share = 0.5 + (grain.radius[i] - grain.radius[j]) / (2 * distance);
    cracks.push({
      bond: b, at: along.map((d, axis) => grain.at[3 * i + axis] + share * d), normal: along.map((d) => d / distance),
      radius: meta.bondRadius * Math.min(grain.radius[i], grain.radius[j]), key: bond.breaks[b], mode: bond.mode[b], earlier: Boolean(bond.earlier[b]),
    });
  }
  return cracks;
}
