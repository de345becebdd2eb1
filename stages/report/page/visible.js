// What of a large body cannot be seen from here, behind whole grains: left out of the
// picture. The cut takes the front away, so what lies behind it comes back.

const ALWAYS_ALL = 20000; // things that any machine draws
const LAYERS = 4;         // grains deep, behind the front

// {grains, throats}: indices of what may be seen, those in front first; null: all.
function visibleOf(body, camera, clip, grow) {
  const { grain, throat, node } = body;
  if (grain.n + throat.n <= ALWAYS_ALL || !grain.n) return null;
  const m = turnOf(camera);
  let mean = 0;
  for (let i = 0; i < grain.n; i++) mean += grain.radius[i] / grain.n;
  const cell = 2 * mean, wide = Math.ceil(2.2 / cell) + 4, front = new Float32Array(wide * wide).fill(-9);
  const depth = new Float32Array(grain.n), where = (x) => Math.min(wide - 1, Math.max(0, ((x + 1.1) / cell + 2) | 0));
  const isCut = (x, y, z) => clip[0] * x + clip[1] * y + clip[2] * z > clip[3];
  for (let i = 0; i < grain.n; i++) {
    const x = grain.at[3 * i], y = grain.at[3 * i + 1], z = grain.at[3 * i + 2];
    const [across, up, near] = applyTurn(m, x, y, z);
    depth[i] = isCut(x, y, z) ? -8 : near;
    const place = where(across) + wide * where(up);
    if (depth[i] > front[place]) front[place] = depth[i];
  }
  const behind = (grow > 0.95 ? LAYERS : 2 * LAYERS) * cell;
  const limit = lowestAround(front, wide).map((near) => near - behind);
  const grains = [], throats = [];
  for (let i = 0; i < grain.n; i++) {
    const [across, up] = applyTurn(m, grain.at[3 * i], grain.at[3 * i + 1], grain.at[3 * i + 2]);
    if (depth[i] > -8 && depth[i] >= limit[where(across) + wide * where(up)]) grains.push(i);
  }
  for (let t = 0; t < throat.n; t++) {
    const a = 3 * throat.first[t], b = 3 * throat.second[t];
    const x = (node.at[a] + node.at[b]) / 2, y = (node.at[a + 1] + node.at[b + 1]) / 2, z = (node.at[a + 2] + node.at[b + 2]) / 2;
    if (isCut(x, y, z)) continue;
    const [across, up, near] = applyTurn(m, x, y, z);
    if (near >= limit[where(across) + wide * where(up)]) throats.push(t);
  }
  grains.sort((i, j) => depth[j] - depth[i]);
  return { grains, throats };
}

// Of each cell and its neighbours: at an edge of the body one looks past the front.
function lowestAround(front, wide) {
  const low = new Float32Array(front.length);
  for (let y = 0; y < wide; y++)
    for (let x = 0; x < wide; x++) {
      let least = 9;
      for (let v = Math.max(0, y - 1); v <= Math.min(wide - 1, y + 1); v++)
        for (let u = Math.max(0, x - 1); u <= Math.min(wide - 1, x + 1); u++) least = Math.min(least, front[u + wide * v]);
      low[x + wide * y] = least;
    }
  return low;
}
