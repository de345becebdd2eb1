// Where the eye is. Without perspective, so that lengths can be compared; then also a
// flat disc at the depth of its centre hides what a sphere would, as long as spheres do
// not overlap: no depth needs to be computed for every point.

function newCamera() {
  return { yaw: -0.62, pitch: 0.35, zoom: 1, x: 0, y: 0 };
}

// Whether one sees nearly the same: three degrees, and a twentieth of the picture.
function seesAlike(a, b) {
  return Math.abs(a.yaw - b.yaw) + Math.abs(a.pitch - b.pitch) < 0.052 && Math.abs(a.zoom / b.zoom - 1) + Math.abs(a.x - b.x) + Math.abs(a.y - b.y) < 0.05 / b.zoom;
}

// Rows: to the right, up, and towards the eye.
function turnOf({ yaw, pitch }) {
  const c = Math.cos(yaw), s = Math.sin(yaw), cp = Math.cos(pitch), sp = Math.sin(pitch);
  return [c, s, 0, -s * sp, c * sp, cp, s * cp, -c * cp, sp];
}

function applyTurn(m, x, y, z) {
  return [m[0] * x + m[1] * y + m[2] * z, m[3] * x + m[4] * y + m[5] * z, m[6] * x + m[7] * y + m[8] * z];
}

// Half the width and height of what is seen.
function extentOf(camera, width, height, body) {
  const m = turnOf(camera), half = body.half;
  const reach = (row) => Math.abs(m[row]) * half[0] + Math.abs(m[row + 1]) * half[1] + Math.abs(m[row + 2]) * half[2];
  const up = Math.max(reach(3), reach(0) * height / width) * 1.08 / camera.zoom || 1;
  return [up * width / height, up];
}

// Calls MOVED with whether it goes on whenever someone turns, moves or zooms.
function steer(canvas, camera, body, moved, clicked) {
  let from = null, rest = 0;
  const changed = () => {
    camera.pitch = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, camera.pitch));
    camera.zoom = Math.min(50, Math.max(0.3, camera.zoom));
    moved(true);
    clearTimeout(rest);
    rest = setTimeout(() => moved(false), 160);
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    from = { x: event.clientX, y: event.clientY, far: 0 };
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!from) return;
    const dx = event.clientX - from.x, dy = event.clientY - from.y;
    Object.assign(from, { x: event.clientX, y: event.clientY, far: from.far + Math.abs(dx) + Math.abs(dy) });
    if (from.far < 4) return;
    if (event.shiftKey || event.buttons & 6) {
      const [wide] = extentOf(camera, canvas.clientWidth, canvas.clientHeight, body);
      camera.x += 2 * wide * dx / canvas.clientWidth;
      camera.y -= 2 * wide * dy / canvas.clientWidth;
    } else {
      camera.yaw -= dx * 0.008;
      camera.pitch += dy * 0.008;
    }
    changed();
  });
  canvas.addEventListener("pointerup", (event) => {
    if (from && from.far < 4) clicked(event);
    from = null;
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.zoom *= Math.exp(-event.deltaY * 0.0012);
    changed();
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const step = 0.1, looks = { x: [Math.PI / 2, 0], y: [0, 0], z: [0, Math.PI / 2] };
    if (event.key in looks) [camera.yaw, camera.pitch] = looks[event.key];
    else if (event.key === "0") Object.assign(camera, newCamera());
    else if (event.key === "ArrowLeft") camera.yaw += step;
    else if (event.key === "ArrowRight") camera.yaw -= step;
    else if (event.key === "ArrowUp") camera.pitch += step;
    else if (event.key === "ArrowDown") camera.pitch -= step;
    else if (event.key === "+" || event.key === "=") camera.zoom *= 1.15;
    else if (event.key === "-") camera.zoom /= 1.15;
    else return;
    event.preventDefault();
    changed();
  });
}
