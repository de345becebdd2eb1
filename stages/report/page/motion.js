// Grains that move: places between two snapshots, contacts of the snapshot before.

// How many of 0..M come before each m, of the numbers COUNT.
function runningSum(count) {
  const sum = [0];
  for (const n of count) sum.push(sum[sum.length - 1] + n);
  return sum;
}

function movesOf({ arrays, grain, place, half }) {
  if (!arrays["moment.x"]) return null;
  const moments = arrays["moment.key"].length, far = new Float32Array(grain.n);
  ["x", "y", "z"].forEach((name, axis) => { // the eye sees wherever grains go, but for the furthest fiftieth
    for (let m = 0; m < moments; m++) {
      for (let i = 0; i < grain.n; i++) far[i] = Math.abs(place.from[axis] + place.scale * arrays[`moment.${name}`][i * moments + m]);
      half[axis] = Math.max(half[axis], far.sort()[Math.floor(0.98 * (grain.n - 1))]);
    }
  });
  const begin = runningSum(arrays["chain.count"]), second = arrays["chain.second"], walls = new Uint32Array(second.length + 1);
  for (let k = 0; k < second.length; k++) walls[k + 1] = walls[k] + (second[k] === grain.n);
  return { begin, walls };
}

// Contacts at moment M, as throats that are as thick as their force; ends in walls, and in
// the next box where the box repeats, are nodes of their own.
function chainsAt(body, m) {
  const { arrays, grain, moves: { begin, walls }, meta, place, size } = body, from = begin[m], n = begin[m + 1] - from;
  const ends = Array.from(grain.at), second = new Uint32Array(n), radius = new Float32Array(n), thickest = 0.6 * body.meanRadius;
  const push = (point) => { ends.push(...point); return ends.length / 3 - 1; };
  for (let k = 0; k < n; k++) {
    const i = arrays["chain.first"][from + k], j = arrays["chain.second"][from + k];
    second[k] = j;
    radius[k] = thickest * arrays["chain.force"][from + k] / 255;
    if (j === grain.n) {
      const wall = walls[from + k];
      second[k] = push([0, 1, 2].map((axis) => place.from[axis] + place.scale * arrays[`chain.${"xyz"[axis]}`][wall]));
      continue;
    }
    const turns = [0, 1, 2].map((axis) => meta.periodic[axis] ? Math.round((grain.at[3 * j + axis] - grain.at[3 * i + axis]) / size[axis]) : 0);
    if (turns.some((t) => t)) second[k] = push(turns.map((t, axis) => grain.at[3 * j + axis] - t * size[axis]));
  }
  const never = new Uint16Array(n).fill(NEVER);
  body.node = { at: Float32Array.from(ends) };
  body.throat = throatsOf({ first: arrays["chain.first"].subarray(from, from + n), second, radius, leaves: never, ends: never, id: Uint32Array.from({ length: n }, (_, k) => from + k) });
}

// Brings the grains of BODY to where they are at KEY.
function moveBody(body, key) {
  const { arrays, grain, place } = body, keys = arrays["moment.key"], moments = keys.length, m = momentAt(body, key), next = Math.min(m + 1, moments - 1);
  const share = next > m ? Math.max(0, (key - keys[m]) / (keys[next] - keys[m])) : 0;
  ["x", "y", "z"].forEach((name, axis) => {
    const column = arrays[`moment.${name}`];
    for (let i = 0; i < grain.n; i++) {
      const now = column[i * moments + m];
      grain.at[3 * i + axis] = place.from[axis] + place.scale * (now + share * (column[i * moments + next] - now));
    }
  });
  chainsAt(body, m);
}
