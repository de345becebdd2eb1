// What of a large body grains hide: left out of the picture. Found on a plane of points as
// wide as the picture, where each grain is a disc at the depth of its centre, as it is
// drawn (camera.js says why that is enough).

const ALWAYS_ALL = 20000; // things that any machine draws
const HIDDEN = -1e9;
const BLOCK = 3; // log2 of the points along a block

// Whether more than any machine draws.
const isLarge = ({ grain, throat }) => grain.n + throat.n > ALWAYS_ALL;

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
  return { depth, number, wide, high, points, ...blocksOf(depth, wide, high) };
}

// How far one sees in each block of points.
function blocksOf(depth, wide, high) {
  const blocks = ((wide - 1) >> BLOCK) + 1, far = new Float32Array(blocks * (((high - 1) >> BLOCK) + 1)).fill(1e9);
  for (let v = 0; v < high; v++)
    for (let u = 0; u < wide; u++) {
      const block = (u >> BLOCK) + blocks * (v >> BLOCK), d = depth[u + wide * v];
      if (d < far[block]) far[block] = d;
    }
  return { blocks, far };
}

// Whether a ball at X, Y (points) and depth NEAR is behind the front wherever it may be.
function isBehind({ far, blocks, wide, high }, x, y, near, reach) {
  const left = Math.max(0, Math.floor(x - reach)) >> BLOCK, right = Math.min(wide - 1, Math.ceil(x + reach)) >> BLOCK;
  const top = Math.min(high - 1, Math.ceil(y + reach)) >> BLOCK;
  for (let v = Math.max(0, Math.floor(y - reach)) >> BLOCK; v <= top; v++)
    for (let u = left; u <= right; u++) if (near > far[u + blocks * v]) return false;
  return true;
}

// How many points of the picture a throat covers, as thick as it gets, before the front:
// by the share of fifteen points of it.
function pointsOfThroat({ node, throat }, t, view, front) {
  const { turn: m, frame, clip } = view, { depth, wide, high, points } = front;
  const mx = throat.middle[4 * t], my = throat.middle[4 * t + 1], mz = throat.middle[4 * t + 2], reach = throat.middle[4 * t + 3];
  if (clip[0] * mx + clip[1] * my + clip[2] * mz > clip[3]) return 0;
  const midX = (m[0] * mx + m[1] * my + m[2] * mz - frame[0] + frame[2]) * points, midY = (m[3] * mx + m[4] * my + m[5] * mz - frame[1] + frame[3]) * points;
  const midZ = m[6] * mx + m[7] * my + m[8] * mz;
  if (isBehind(front, midX, midY, midZ + reach, reach * points + 1)) return 0;
  const a = 3 * throat.first[t], r = Math.max(0.5, throat.radius[t] * view.grow * points);
  const dx = mx - node.at[a], dy = my - node.at[a + 1], dz = mz - node.at[a + 2];
  const across = (m[0] * dx + m[1] * dy + m[2] * dz) * points, up = (m[3] * dx + m[4] * dy + m[5] * dz) * points, near = m[6] * dx + m[7] * dy + m[8] * dz;
  const far = Math.hypot(across, up), sideX = far > 0 ? -up / far * r : 0, sideY = far > 0 ? across / far * r : r;
  let count = 0;
  for (let k = -2; k <= 2; k++)
    for (let side = -1; side <= 1; side++) {
      const u = Math.round(midX + across * k / 2 + side * sideX), v = Math.round(midY + up * k / 2 + side * sideY);
      if (u >= 0 && u < wide && v >= 0 && v < high && midZ + near * k / 2 > depth[u + wide * v]) count++;
    }
  return count / 15 * 4 * (far + r) * r;
}

// LIST in two parts, each in its order: those of the largest WORTH, MOST at most, and the
// others.
function boldFirst(list, worth, most) {
  const bins = 4096, count = new Uint32Array(bins), binOf = (k) => Math.min(bins - 1, Math.floor(worth[k] * 4));
  for (let k = 0; k < list.length; k++) count[binOf(k)]++;
  let least = bins, sum = 0;
  while (least > 0 && sum + count[least - 1] <= most) sum += count[--least];
  const bold = list.filter((_, k) => binOf(k) >= least);
  return { all: bold.concat(list.filter((_, k) => binOf(k) < least)), bold: bold.length };
}

const MOVING = { grains: 6000, throats: 10000 }; // most that are drawn while a body moves that a machine cannot follow

// {grains, throats}, each {all, bold}: numbers of what may be seen, BOLD of them by far the
// most of the picture.
function seenOf(body, view, width, height) {
  const { grain, throat } = body, front = frontOf(body, view, width, height);
  const points = new Uint32Array(grain.n), grains = [], throats = [], worth = [];
  for (const i of front.number) if (i >= 0) points[i]++;
  for (let i = 0; i < grain.n; i++) if (points[i]) grains.push(i);
  for (let t = 0; (view.show.liquid || view.show.empty) && t < throat.n; t++) {
    const seen = pointsOfThroat(body, t, view, front);
    if (seen > 0) { throats.push(t); worth.push(seen); }
  }
  return { grains: boldFirst(grains, grains.map((i) => points[i]), MOVING.grains), throats: boldFirst(throats, worth, MOVING.throats) };
}

function allOf({ grain, throat }) {
  const all = (n) => ({ all: Array.from({ length: n }, (_, k) => k), bold: n });
  return { grains: all(grain.n), throats: all(throat.n) };
}

// The same; all of a small body, and of one whose grains are not shown.
function visibleOf(body, view, width, height) {
  return isLarge(body) && view.show.grains ? seenOf(body, view, width, height) : allOf(body);
}
