// The window onto the scene: where a metre is on the canvas.

const stage = document.getElementById("stage");
const pen = stage.getContext("2d");

const view = {
  x: 0,
  y: 0,
  scale: 10,
  follow: false,
  company: false, // following began with people in view
  chosen: false, // by hand: not to be fitted to another size
  width: 0,
  height: 0,
  ratio: 1,
};

const toScreenX = (x) => view.width / 2 + (x - view.x) * view.scale;
const toScreenY = (y) => view.height / 2 - (y - view.y) * view.scale;
const toSceneX = (px) => view.x + (px - view.width / 2) / view.scale;
const toSceneY = (py) => view.y - (py - view.height / 2) / view.scale;

/** Sets a canvas to its place's size; whether that has changed. */
function fitCanvas(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const { clientWidth: width, clientHeight: height } = canvas;
  const wanted = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width === wanted[0] && canvas.height === wanted[1]) return false;
  [canvas.width, canvas.height] = wanted;
  return true;
}

function measureStage() {
  fitCanvas(stage);
  view.width = stage.clientWidth;
  view.height = stage.clientHeight;
  view.ratio = stage.width / Math.max(view.width, 1);
}

/** Everything that moves, and half a vehicle's length around. */
const EXTENT = (() => {
  const extent = [Infinity, Infinity, -Infinity, -Infinity];
  for (const { x, y } of [PEOPLE, VEHICLES, ...EGOS]) {
    for (let i = 0; i < x.length; i++) {
      if (x[i] < extent[0]) extent[0] = x[i];
      if (y[i] < extent[1]) extent[1] = y[i];
      if (x[i] > extent[2]) extent[2] = x[i];
      if (y[i] > extent[3]) extent[3] = y[i];
    }
  }
  return [extent[0] - 3, extent[1] - 3, extent[2] + 3, extent[3] + 3];
})();

function showAll() {
  const [left, bottom, right, top] = EXTENT;
  view.follow = view.chosen = false;
  view.x = (left + right) / 2;
  view.y = (bottom + top) / 2;
  view.scale = clamp(Math.min(view.width / (right - left), view.height / (top - bottom)), 0.05, 60);
}

const NEARBY = 36; // [m] of way that following shows
const WHOLE = 110; // [m] a larger scene is followed, not shown whole, to begin with

/** Keep the ego in view; with `company`, from so far above that people around are in it. */
function follow(on, company = false) {
  view.follow = on && EGOS.length > 0;
  view.company = company;
  if (view.follow) {
    const across = Math.min(view.width, 1.6 * view.height);
    view.scale = Math.max(view.scale, Math.min(across / NEARBY, company ? scaleForCompany() : Infinity));
  }
}

const COMPANY = 5; // people to be seen around a followed ego, if there are so many

/** The largest scale that has `COMPANY` people, or all there are, around the ego in view. */
function scaleForCompany() {
  const state = EGOS[selected.ego].at(player.time);
  if (!state) return Infinity;
  const scales = [];
  PEOPLE.each(player.time, (at) => {
    const dx = Math.abs(at.x - state.x - LEAD * state.cos) + 1;
    const dy = Math.abs(at.y - state.y - LEAD * state.sin) + 1;
    scales.push(Math.min(view.width / dx, view.height / dy) / 2);
  });
  scales.sort((a, b) => b - a);
  return scales[Math.min(COMPANY, scales.length) - 1] ?? Infinity;
}

/** The same in a window of another size. */
function refit() {
  if (view.chosen) return;
  const { follow: followed, company } = view;
  showAll();
  if (followed) follow(true, company);
}

/** Magnifies about a point of the canvas; the ego stays where it is while it is followed. */
function zoom(factor, px = view.width / 2, py = view.height / 2) {
  const [x, y] = [toSceneX(px), toSceneY(py)];
  view.scale = clamp(view.scale * factor, 0.05, 300);
  view.chosen = true;
  if (view.follow) return;
  view.x += x - toSceneX(px);
  view.y += y - toSceneY(py);
}

function pan(dx, dy) {
  view.follow = false;
  view.chosen = true;
  view.x -= dx / view.scale;
  view.y += dy / view.scale;
}

/** Colours live in the style sheet, which knows whether it is dark. */
let colours = {};
function readColours() {
  const style = getComputedStyle(document.documentElement);
  const names = [
    "ground", "road", "kerb", "ink", "quiet", "line", "mpc", "pid", "safety", "person", "close",
    "inside", "prediction", "influence", "car", "corridor", "safe", "speed", "gap", "stop", "overlap",
    "panel", "shadow", "paint", "unpainted", "green", "yellow", "red", "dark",
  ];
  colours = Object.fromEntries(
    names.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]),
  );
}
