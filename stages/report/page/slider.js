// The moment that everything shows: a key of the course, set by the slider, by play, by
// a click on a curve or on "show".

function newCourse(body) {
  const { arrays, meta } = body, slider = document.getElementById("moment"), button = document.getElementById("play");
  const course = {
    rows: meta.rows, last: body.lastKey, key: 0, listeners: [],
    time: arrays["course.time"], saturation: arrays["course.saturation"],
    at: (column, key) => {
      const row = Math.min(meta.rows - 1, key / meta.keysARow), low = Math.floor(row), high = Math.min(meta.rows - 1, low + 1);
      return column[low] + (row - low) * (column[high] - column[low]);
    },
    step: (column, key) => column[Math.min(meta.rows - 1, Math.floor(key / meta.keysARow + 1e-9))],
    set: (key) => {
      course.key = Math.min(course.last, Math.max(0, Math.round(key)));
      slider.value = course.key;
      for (const listener of course.listeners) listener(course.key);
    },
  };
  slider.max = course.last;
  slider.addEventListener("input", () => course.set(Number(slider.value)));
  button.addEventListener("click", () => play(course, button));
  document.addEventListener("keydown", (event) => {
    if (event.target.closest("input, select, textarea, button, summary, a") && event.key !== "," && event.key !== ".") return;
    if (event.target.closest("textarea")) return;
    if (event.key === " ") play(course, button);
    else if (event.key === ",") course.set(course.key - course.last / 200);
    else if (event.key === ".") course.set(course.key + course.last / 200);
    else return;
    event.preventDefault();
  });
  return course;
}

const PLAY_SECONDS = 12;

// Starts, or stops. From the end it begins again.
function play(course, button) {
  const label = (text, name) => { button.textContent = text; button.setAttribute("aria-label", name); };
  if (course.playing) {
    course.playing = false;
    label("\u25b6", "Play");
    return;
  }
  course.playing = true;
  label("\u275a\u275a", "Pause");
  let from = performance.now() - 1000 * PLAY_SECONDS * (course.key < course.last ? course.key / course.last : 0);
  const next = (time) => {
    if (!course.playing) return;
    const share = (time - from) / (1000 * PLAY_SECONDS);
    course.set(share * course.last);
    if (share < 1) requestAnimationFrame(next); else play(course, button);
  };
  requestAnimationFrame(next);
}
