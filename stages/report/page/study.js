"use strict";
// Sorts the table by the column whose heading is clicked: numbers by size, words by name;
// a second click turns it round.

const runs = document.getElementById("runs"), heads = [...runs.tHead.rows[0].cells];

function compare(a, b) {
  const x = parseFloat(a), y = parseFloat(b);
  if (a === "" || b === "") return (a === "") - (b === "");
  return isNaN(x) || isNaN(y) ? a.localeCompare(b, "en", { numeric: true }) : x - y;
}

heads.forEach((head, column) => head.firstElementChild.addEventListener("click", () => {
  const turn = head.getAttribute("aria-sort") === "ascending" ? -1 : 1, body = runs.tBodies[0];
  for (const other of heads) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", turn > 0 ? "ascending" : "descending");
  body.append(...[...body.rows].sort((p, q) => turn * compare(p.cells[column].textContent, q.cells[column].textContent)));
}));
