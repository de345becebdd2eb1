"use strict";
// Numbers as people read them.

const PREFIXES = ["a", "f", "p", "n", "µ", "m", "", "k", "M", "G", "T"];

// 5e-7, "m": "500 nm"
function withUnit(value, unit) {
  if (!(Math.abs(value) > 0) || !isFinite(value)) return `${value} ${unit}`;
  const k = Math.min(10, Math.max(0, Math.floor(Math.log10(Math.abs(value) * 1.0005) / 3) + 6));
  return `${Number((value / 10 ** (3 * (k - 6))).toPrecision(3))} ${PREFIXES[k]}${unit}`;
}

const short = (value) => String(Number(value.toPrecision(3)));

// The largest of 1, 2, 5, 10, ... that is not above VALUE.
function roundDown(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * (value >= 5 * power ? 5 : value >= 2 * power ? 2 : 1);
}

// The row of RISING below VALUE, and how far it is to the next.
function placeIn(rising, value) {
  let low = 0, high = rising.length - 1;
  if (high < 1 || value <= rising[0]) return [0, 0];
  if (value >= rising[high]) return [high, 0];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (rising[middle] <= value) low = middle; else high = middle;
  }
  return [low, (value - rising[low]) / (rising[high] - rising[low])];
}
