// What of a large body grains hide: left out of the picture. Found on a plane of points as
// wide as the picture, where each grain is a disc at the depth of its centre, as it is
// drawn (camera.js says why that is enough).

const ALWAYS_ALL = 20000; // things that any machine draws
const HIDDEN = -1e9;

// The nearest grain at each point: its depth, and its number.
function frontOf({ grain }, view, wide, high) {
  const depth = new Float32Array(wide * high).fill(HIDDEN), number = new Int32Array(wide * high).fill(-1);
  const { turn: m, clip, frame } = view, points = wide / (2 * frame[2]);
  for (let i = 0; i < grain.n; i++) {
    const px = grain.at[3 * i], py = grain.at[3 * i + 1], pz = grain.at[3 * i + 2];
    if (clip[0] * px + clip[1] * py + clip[2] * pz > clip[3]) continue;
    const x = (m[0] * px + m[1] * py + m[2] * pz - frame[0] + frame[2]) * points;
    const y = (m[3] * px + m[4] * py + m[5] * pz - frame[1] + frame[3]) * points;
    const near = m[6] * px + m[7] * py + m[8] * pz, r = grain.radius[i] * view.grow * points;
    const top = Math.min(high - 1, Math.floor(y + r));
    for (let v = Math.max(0, Math.ceil(y - r)); v <= top; v++) {
      const half = Math.sqrt(Math.max(0, r * r - (v - y) * (v - y))), end = Math.min(wide - 1, Math.floor(x + half));
      for (let at = Math.max(0, Math.ceil(x - half)) + v * wide; at <= end + v * wide; at++)
        if (near > depth[at]) { depth[at] = near; number[at] = i; }
    }
  }
  return { depth, number, wide, high, points };
}

// Whether a throat, as thick as it gets, is before the front at one of fifteen points.
function showsThroat({ node, throat }, t, view, front) {
  const { turn: m, frame } = view, { depth, wide, high, points } = front;
  const a = 3 * throat.first[t], b = 3 * throat.second[t], r = throat.radius[t] * view.grow * points;
  const ax = node.at[a], ay = node.at[a + 1], az = node.at[a + 2], dx = node.at[b] - ax, dy = node.at[b + 1] - ay, dz = node.at[b + 2] - az;
  if (view.clip[0] * (ax + dx / 2) + view.clip[1] * (ay + dy / 2) + view.clip[2] * (az + dz / 2) > view.clip[3]) return false;
  const x = (m[0] * ax + m[1] * ay + m[2] * az - frame[0] + frame[2]) * points, across = (m[0] * dx + m[1] * dy + m[2] * dz) * points;
  const y = (m[3] * ax + m[4] * ay + m[5] * az - frame[1] + frame[3]) * points, up = (m[3] * dx + m[4] * dy + m[5] * dz) * points;
  const z = m[6] * ax + m[7] * ay + m[8] * az, near = m[6] * dx + m[7] * dy + m[8] * dz;
  const far = Math.hypot(across, up) || 1, sideX = -up / far * r, sideY = across / far * r;
  for (let k = 0; k < 5; k++)
    for (let side = -1; side <= 1; side++) {
      const u = Math.round(x + across * k / 4 + side * sideX), v = Math.round(y + up * k / 4 + side * sideY);
      if (u >= 0 && u < wide && v >= 0 && v < high && z + near * k / 4 > depth[u + wide * v]) return true;
    }
  return false;
}

// {grains, throats}: numbers of what may be seen; null: all.
function visibleOf(body, view, width, height) {
  const { grain, throat } = body;
  if (grain.n + throat.n <= ALWAYS_ALL || !view.show.grains) return null;
  const front = frontOf(body, view, width, height);
  const shown = new Uint8Array(grain.n), grains = [], throats = [];
  for (const i of front.number) if (i >= 0) shown[i] = 1;
  for (let i = 0; i < grain.n; i++) if (shown[i]) grains.push(i);
  for (let t = 0; (view.show.liquid || view.show.empty) && t < throat.n; t++) if (showsThroat(body, t, view, front)) throats.push(t);
  return { grains, throats };
}
