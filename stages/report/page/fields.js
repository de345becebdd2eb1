// What a page is about, in words; and numbers of grains and throats as colours.

const WORDS = {
  drying: { tube: "liquid", arrows: "forces on grains", arrow: "force", byArrow: "grains by force", unit: "N", most: "largest force", arrowChart: "Force of the liquid on a grain", plain: "liquid and cracks only", left: "throats that never hold liquid are not drawn.", pick: "Click a grain, a throat or a broken bond for its numbers." },
  flow: { tube: "pores", arrows: "drag on grains", arrow: "drag", byArrow: "grains by drag", unit: "N", most: "drag", plain: "grains and pores", left: "closed throats are not drawn.", pick: "Click a grain or a throat between pores for its numbers." },
  motion: { tube: "contact forces", arrows: "velocities of grains", arrow: "speed", byArrow: "grains by speed", unit: "m/s", most: "largest speed", arrowChart: "Speed of a grain, of the snapshots", plain: "grains and contacts", left: "", pick: "Click a grain or a contact for its numbers." },
};

const wordsOf = ({ meta }) => WORDS[meta.subject];
const fieldsOf = ({ meta }) => (meta.shown && meta.shown.fields) || [];

// Least and most of a field that runs from one to the other.
function rangeOf(values) {
  let least = Infinity, most = -Infinity;
  for (const v of values) { least = Math.min(least, v); most = Math.max(most, v); }
  return [least, most];
}

// The colour (0 to 1) of each grain or throat, by FIELD.
function fieldTint({ arrays, throat }, field, colours) {
  const values = arrays[field.array], numberOf = field.of === "throat" ? (t) => values[throat.id[t]] : (i) => values[i];
  if (field.kinds) return (i) => GROUP_COLOURS[numberOf(i) % GROUP_COLOURS.length].map((v) => v / 255);
  const [least, most] = rangeOf(values);
  return (k) => mix(colours.liquid, colours.shear, most > least ? (numberOf(k) - least) / (most - least) : 0);
}

// What the colours mean: [[colour, words], ...].
function legendOf(body, by, colours) {
  const field = fieldsOf(body).find(({ array }) => array === by), words = wordsOf(body);
  if (by === "force") return [[colours.grain, `no ${words.arrow}`], [colours.force, `${withUnit(body.meta.scales.force * 127, words.unit)} and more`]];
  if (by === "broken") return [[colours.grain, "no bond broken"], [colours.shear, "four and more"]];
  if (by === "pieces" || by === "clusters") return [[GROUP_COLOURS[0].map((v) => v / 255), "the largest"], [[90, 90, 90].map((v) => v / 255), "single ones"]];
  if (!field) return [];
  const [least, most] = rangeOf(body.arrays[field.array]);
  if (field.kinds) return Array.from({ length: most + 1 }, (_, k) => [GROUP_COLOURS[k % GROUP_COLOURS.length].map((v) => v / 255), String(k)]);
  return [[colours.liquid, withUnit(least, field.unit)], [colours.shear, withUnit(most, field.unit)]];
}

function sayLegend(page) {
  element("legend").replaceChildren(...legendOf(page.body, page.colourBy, page.colours).flatMap(([colour, words]) => {
    const swatch = html("i", { className: "swatch" });
    swatch.style.background = css(colour);
    return [swatch, `${words} `];
  }));
}

// Controls that fit what the page is about; those without use go.
function nameControls(body) {
  const words = wordsOf(body), select = element("colour");
  element("word-tube").textContent = words.tube;
  element("word-arrows").textContent = words.arrows;
  element("picked").firstElementChild.textContent = words.pick;
  select.querySelector("[value=none]").textContent = words.plain;
  select.querySelector("[value=force]").textContent = words.byArrow;
  const drop = (value, keep) => { if (!keep) select.querySelector(`[value=${value}]`).remove(); };
  drop("force", body.arrays["moment.key"]);
  drop("broken", body.bond.n);
  drop("pieces", body.bond.n);
  drop("clusters", body.meta.subject === "drying" && body.throat.n);
  for (const { array, label } of fieldsOf(body)) select.append(html("option", { value: array, textContent: label }));
  select.value = { drying: "none", flow: "pore.pressure", motion: "force" }[body.meta.subject];
  if (body.meta.subject !== "drying") for (const box of element("shown").querySelectorAll("[name=empty], [name=cracks]"))
    if (box.name === "empty" || !cracksOf(body).length) { box.checked = false; box.parentElement.hidden = true; }
}
