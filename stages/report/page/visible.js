// What of a large body grains hide: left out of the picture. Found on a plane of points as
// wide as the picture, where each grain is a disc at the depth of its centre, as it is
// drawn (camera.js says why that is enough).

const ALWAYS_ALL = { things: 20000 }; // things that any machine draws
const HIDDEN = -1e9;
const BLOCK = 2; // log2 of the points along a block

// Whether more than any machine draws.
const isLarge = ({ grain, throat }) => grain.n + throat.n > ALWAYS_ALL.things;

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

// Whether a ball is behind the front wherever it may be.
function isBallBehind({ far, blocks, points, wide, high }, { turn: m, frame }, px, py, pz, radius) {
  const reach = radius * points + 1, near = m[6] * px + m[7] * py + m[8] * pz + radius;
  const x = (m[0] * px + m[1] * py + m[2] * pz - frame[0] + frame[2]) * points, y = (m[3] * px + m[4] * py + m[5] * pz - frame[1] + frame[3]) * points;
  const left = Math.max(0, Math.floor(x - reach)) >> BLOCK, right = Math.min(wide - 1, Math.ceil(x + reach)) >> BLOCK;
  const top = Math.min(high - 1, Math.ceil(y + reach)) >> BLOCK;
  for (let v = Math.max(0, Math.floor(y - reach)) >> BLOCK; v <= top; v++)
    for (let u = left; u <= right; u++) if (near > far[u + blocks * v]) return false;
  return true;
}

// The cell of each throat, in a grid of COUNT cells from LOW of a SIDE along each axis.
function throatCells({ throat: { n, first, second }, node: { at } }, low, side, count) {
  const cell = new Uint32Array(n);
  for (let t = 0; t < n; t++) {
    const a = 3 * first[t], b = 3 * second[t];
    for (let axis = 2; axis >= 0; axis--) {
      const place = Math.floor(((at[a + axis] + at[b + axis]) / 2 - low[axis]) / side);
      cell[t] = cell[t] * count[axis] + Math.min(count[axis] - 1, Math.max(0, place));
    }
  }
  return cell;
}

const TUBE = 8; // numbers a throat: its middle, how far it reaches from there, from an end to the middle, radius

// Throats by cells two mean grains wide: those of a cell that is hidden need no look of
// their own, and those of one that is not stand side by side in memory. Throat members[k]
// is tubes[TUBE k ...], k from begin[cell] to begin[cell + 1]; a ball (middle, radius) is
// around those of each cell.
function cellsOf(body) {
  const { throat: { n, first, second, radius }, node: { at }, half, meanRadius } = body;
  const side = 4 * meanRadius, low = half.map((far) => -far), count = half.map((far) => Math.max(1, Math.ceil(2 * far / side)));
  const cell = throatCells(body, low, side, count), cells = count[0] * count[1] * count[2], begin = new Uint32Array(cells + 2);
  for (let t = 0; t < n; t++) begin[cell[t] + 2]++;
  for (let c = 2; c < begin.length; c++) begin[c] += begin[c - 1];
  const members = new Uint32Array(n), tubes = new Float32Array(TUBE * n), balls = new Float32Array(4 * cells);
  for (let t = 0; t < n; t++) {
    const k = begin[cell[t] + 1]++, to = TUBE * k, a = 3 * first[t], b = 3 * second[t], c = cell[t];
    members[k] = t;
    let length = 0, far = 0, rest = c;
    for (let axis = 0; axis < 3; axis++) {
      const middle = (at[a + axis] + at[b + axis]) / 2, along = middle - at[a + axis], place = rest % count[axis];
      const centre = balls[4 * c + axis] = low[axis] + (place + 0.5) * side;
      tubes[to + axis] = middle;
      tubes[to + 4 + axis] = along;
      length += along * along;
      far += (middle - centre) * (middle - centre);
      rest = (rest - place) / count[axis];
    }
    tubes[to + 3] = Math.sqrt(length) + radius[t];
    tubes[to + 7] = radius[t];
    balls[4 * c + 3] = Math.max(balls[4 * c + 3], Math.sqrt(far) + tubes[to + 3]);
  }
  return { balls, begin, members, tubes };
}

// How many points of the picture throat K of the cells covers, as thick as it gets, before
// the front: by the share of fifteen points of it, or of the five along its axis while a
// large body moves.
function pointsOfThroat(tubes, k, view, front) {
  const { turn: m, frame, clip } = view, { depth, wide, high, points } = front, from = TUBE * k;
  const mx = tubes[from], my = tubes[from + 1], mz = tubes[from + 2];
  if (clip[0] * mx + clip[1] * my + clip[2] * mz > clip[3] || isBallBehind(front, view, mx, my, mz, tubes[from + 3])) return 0;
  const midX = (m[0] * mx + m[1] * my + m[2] * mz - frame[0] + frame[2]) * points, midY = (m[3] * mx + m[4] * my + m[5] * mz - frame[1] + frame[3]) * points;
  const midZ = m[6] * mx + m[7] * my + m[8] * mz;
  const dx = tubes[from + 4], dy = tubes[from + 5], dz = tubes[from + 6], r = Math.max(0.5, tubes[from + 7] * view.grow * points);
  const across = (m[0] * dx + m[1] * dy + m[2] * dz) * points, up = (m[3] * dx + m[4] * dy + m[5] * dz) * points, near = m[6] * dx + m[7] * dy + m[8] * dz;
  const far = Math.sqrt(across * across + up * up), sideX = far > 0 ? -up / far * r : 0, sideY = far > 0 ? across / far * r : r;
  const sides = view.plain ? 0 : 1;
  let count = 0;
  for (let k = -2; k <= 2; k++)
    for (let side = -sides; side <= sides; side++) {
      const u = Math.floor(midX + across * k / 2 + side * sideX + 0.5), v = Math.floor(midY + up * k / 2 + side * sideY + 0.5);
      if (u >= 0 && u < wide && v >= 0 && v < high && midZ + near * k / 2 > depth[u + wide * v]) count++;
    }
  return count / (5 + 10 * sides) * 4 * (far + r) * r;
}

// How many points each throat covers; 0 of those that cannot be seen.
function throatPoints(body, view, front) {
  const { throat } = body, { balls, begin, members, tubes } = throat.cells ||= cellsOf(body), worth = new Float32Array(throat.n);
  for (let c = 0; c + 2 < begin.length; c++) {
    if (begin[c] === begin[c + 1] || isBallBehind(front, view, balls[4 * c], balls[4 * c + 1], balls[4 * c + 2], balls[4 * c + 3])) continue;
    for (let k = begin[c]; k < begin[c + 1]; k++) worth[members[k]] = pointsOfThroat(tubes, k, view, front);
  }
  return worth;
}

// Numbers of those with any WORTH in two parts, each in its order: those of the largest,
// MOST at most, and the others.
function boldFirst(worth, most) {
  const bins = 4096, count = new Uint32Array(bins), binOf = (k) => Math.min(bins - 1, Math.floor(worth[k] * 4));
  let seen = 0;
  for (let k = 0; k < worth.length; k++) if (worth[k] > 0) { count[binOf(k)]++; seen++; }
  let least = bins, bold = 0;
  while (least > 0 && bold + count[least - 1] <= most) bold += count[--least];
  const all = new Uint32Array(seen);
  let first = 0, second = bold;
  for (let k = 0; k < worth.length; k++) if (worth[k] > 0) all[binOf(k) >= least ? first++ : second++] = k;
  return { all, bold };
}

const MOVING = { grains: 6000, throats: 10000 }; // most that are drawn while a body moves that a machine cannot follow

// {grains, throats}, each {all, bold}: numbers of what may be seen, BOLD of them by far the
// most of the picture.
function seenOf(body, view, width, height) {
  const front = frontOf(body, view, width, height), points = new Float32Array(body.grain.n);
  for (const i of front.number) if (i >= 0) points[i]++;
  const worth = view.show.liquid || view.show.empty ? throatPoints(body, view, front) : [];
  return { grains: boldFirst(points, MOVING.grains), throats: boldFirst(worth, MOVING.throats) };
}

function allOf({ grain, throat }) {
  const all = (n) => ({ all: Array.from({ length: n }, (_, k) => k), bold: n });
  return { grains: all(grain.n), throats: all(throat.n) };
}

// The same; all of a small body, and of one whose grains are not shown.
function visibleOf(body, view, width, height) {
  return isLarge(body) && view.show.grains ? seenOf(body, view, width, height) : allOf(body);
}
