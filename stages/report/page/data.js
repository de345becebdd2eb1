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
    for (let k = 0, at = from + plane * n; k < n; k++) value[k] |= bytes[at++] << (8 * plane);
  if (entry.float) return new Float32Array(value.buffer);
  for (let k = 0, last = 0; entry.delta && k < n; k++)
    value[k] = last += value[k] & 1 ? -((value[k] + 1) / 2) : value[k] / 2;
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

const NEVER = 65535; // a key: does not happen

// The run in the units of the picture: the middle of the box is the origin, half of its
// diagonal is 1. Lengths in metres are these times `unit`.
function bodyOf(meta, arrays) {
  const size = meta.upper.map((high, axis) => high - meta.lower[axis]);
  const unit = Math.hypot(...size) / 2 || 1;
  const middle = meta.lower.map((low, axis) => low + size[axis] / 2);
  const place = (name) => {
    const columns = ["x", "y", "z"].map((axis) => arrays[`${name}.${axis}`] || []);
    const n = columns[0].length, at = new Float32Array(3 * n);
    for (let axis = 0; axis < 3; axis++)
      for (let k = 0; k < n; k++)
        at[3 * k + axis] = (meta.scales.origin[axis] + meta.scales.step * columns[axis][k] - middle[axis]) / unit;
    return at;
  };
  const length = (name) => Float32Array.from(arrays[name] || [], (value) => value * meta.scales.step / unit);
  const second = (first, apart) => Uint32Array.from(first || [], (value, k) => value + apart[k]);
  return {
    meta, arrays, unit, size: size.map((length) => length / unit), middle,
    grain: { at: place("grain"), radius: length("grain.radius"), n: (arrays["grain.radius"] || []).length },
    node: { at: place("node") },
    throat: {
      first: arrays["throat.first"] || [], second: second(arrays["throat.first"], arrays["throat.second"]),
      radius: length("throat.radius"), leaves: arrays["throat.leaves"], ends: arrays["throat.ends"],
      id: arrays["throat.id"], n: (arrays["throat.id"] || []).length,
    },
    bond: {
      first: arrays["bond.first"] || [], second: second(arrays["bond.first"], arrays["bond.second"]),
      breaks: arrays["bond.breaks"], mode: arrays["bond.mode"], n: (arrays["bond.first"] || []).length,
    },
    lastKey: Math.max(0, meta.rows - 1) * meta.keysARow,
  };
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
      radius: meta.bondRadius * Math.min(grain.radius[i], grain.radius[j]), key: bond.breaks[b], mode: bond.mode[b],
    });
  }
  return cracks;
}
