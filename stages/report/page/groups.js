// Connected things: pieces of grains that whole bonds join, clusters of wet throats.

function joined(n, pairs) {
  const root = new Int32Array(n);
  for (let k = 0; k < n; k++) root[k] = k;
  const find = (k) => {
    while (root[k] !== k) k = root[k] = root[root[k]];
    return k;
  };
  pairs((a, b) => {
    a = find(a); b = find(b);
    if (a < b) root[b] = a; else root[a] = b;
  });
  for (let k = 0; k < n; k++) root[k] = find(k);
  return root;
}

// The lowest grain of the piece of each grain at KEY.
function piecesAt({ grain, bond }, key) {
  return joined(grain.n, (join) => {
    for (let b = 0; b < bond.n; b++) if (bond.breaks[b] > key) join(bond.first[b], bond.second[b]);
  });
}

// The lowest node of the cluster of each throat; meaningless where it is empty.
function clustersAt({ node, throat }, key) {
  const root = joined(node.at.length / 3, (join) => {
    for (let t = 0; t < throat.n; t++) if (throat.ends[t] > key) join(throat.first[t], throat.second[t]);
  });
  return Int32Array.from(throat.first, (a) => root[a]);
}

// Groups by size, the largest first; those of one member are not counted.
function largestFirst(root) {
  const count = new Map();
  for (const r of root) count.set(r, (count.get(r) || 0) + 1);
  return [...count].filter(([, size]) => size > 1).sort((a, b) => b[1] - a[1] || a[0] - b[0]);
}

const GROUP_COLOURS = [[230, 226, 216], [74, 163, 223], [204, 121, 167], [27, 158, 119], [230, 159, 0], [127, 164, 207], [237, 162, 159], [150, 120, 200]];

// A colour (0 to 255) a group: the largest has the first, single ones are dark.
function groupColours(root) {
  const place = new Map(largestFirst(root).map(([r], k) => [r, k]));
  return (member) => {
    const k = place.get(root[member]);
    return k === undefined ? [90, 90, 90] : k === 0 ? GROUP_COLOURS[0] : GROUP_COLOURS[1 + (k - 1) % 7];
  };
}
