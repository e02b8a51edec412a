// Time and hands: play, seek, zoom, keys; and the loop that draws.

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];
const BIG_STEP = 1; // [s] of Shift and an arrow

const player = {
  time: START,
  playing: false,
  speed: 1,
  loop: false,
  wanted: true, // a picture

  redraw() {
    this.wanted = true;
  },

  seek(t) {
    this.time = clamp(t, START, END);
    this.redraw();
    noteTime();
  },

  /** From instant to instant of the run. */
  step(direction) {
    this.play(false);
    const at = lastBefore(FRAMES.length, (k) => FRAMES[k], this.time);
    const between = direction < 0 && this.time > FRAMES[at] + 1e-9;
    this.seek(FRAMES[clamp(between ? at : at + direction, 0, FRAMES.length - 1)]);
  },

  play(on) {
    if (on && this.time >= END) this.time = START;
    this.playing = on;
    $("play").classList.toggle("playing", on);
    $("play").setAttribute("aria-label", on ? "pause" : "play");
    this.redraw();
    noteTime();
  },

  advance(seconds) {
    this.time += seconds * this.speed;
    if (this.time >= END) {
      if (this.loop) this.time = START;
      else {
        this.time = END;
        this.play(false);
      }
    }
    this.redraw();
  },
};

// --- the address: #t=3.2 points at an instant, #t=3.2&follow at the ego's surroundings then -----

const ADDRESS_REST = 400; // [ms] browsers refuse an address that changes 100 times in 30 s
const FOLLOW = "&follow";
let written = "";
let resting = false;

function noteTime() {
  if (resting || player.playing || window.parent !== window) return; // an embedded page has none
  const address = `#t=${Number(player.time.toFixed(3))}${view.follow ? FOLLOW : ""}`;
  if (address === written) return;
  written = address;
  history.replaceState(null, "", written);
  resting = true;
  setTimeout(() => {
    resting = false;
    noteTime();
  }, ADDRESS_REST);
}

function readTime() {
  const found = /^#t=(-?\d+(?:\.\d*)?|-?\.\d+)(&follow)?$/.exec(location.hash);
  if (!found || location.hash === written) return;
  player.play(false);
  player.seek(Number(found[1]));
  if (found[2] && !view.follow) setFollow(true);
}

// --- the loop -----------------------------------------------------------------------------------

let before = performance.now();

function tick(now) {
  const elapsed = Math.min((now - before) / 1000, 0.25); // a tab in the background does not leap
  before = now;
  if (player.playing) player.advance(elapsed);
  if (player.wanted) {
    player.wanted = false;
    const { states, person } = drawScene(player.time);
    drawCharts(player.time);
    writeNow(player.time, states);
    writePerson(person, states);
    const share = String(player.time);
    if ($("scrubber").value !== share) $("scrubber").value = share;
    if (!player.playing) tellTime(player.time, states[selected.ego]);
  }
  requestAnimationFrame(tick);
}

/** The slider's value in words; while the run plays nobody could follow them. */
function tellTime(t, state) {
  const ego = state
    ? `, ${readable(state.speed, 1)} m/s, ${state.kind.acting.toUpperCase()} acts` : "";
  $("scrubber").setAttribute("aria-valuetext", `${t.toFixed(2)} s of ${END.toFixed(2)} s${ego}`);
}

// --- buttons and keys ---------------------------------------------------------------------------

function setSpeed(speed) {
  player.speed = speed;
  $("speed").value = String(speed);
}

function setLoop(on) {
  player.loop = on;
  $("loop").setAttribute("aria-pressed", String(on));
}

function setFollow(on) {
  if (on) follow(true);
  else showAll();
  showFollow();
}

function showFollow() {
  $("follow").setAttribute("aria-pressed", String(view.follow));
  player.redraw();
}

function zoomBy(factor, px, py) {
  zoom(factor, px, py);
  player.redraw();
}

const KEYS = {
  " ": () => player.play(!player.playing),
  ArrowLeft: (shift) => (shift ? player.seek(player.time - BIG_STEP) : player.step(-1)),
  ArrowRight: (shift) => (shift ? player.seek(player.time + BIG_STEP) : player.step(1)),
  ArrowUp: () => setSpeed(SPEEDS[Math.min(SPEEDS.indexOf(player.speed) + 1, SPEEDS.length - 1)]),
  ArrowDown: () => setSpeed(SPEEDS[Math.max(SPEEDS.indexOf(player.speed) - 1, 0)]),
  Home: () => player.seek(START),
  End: () => player.seek(END),
  "+": () => zoomBy(1.25),
  "=": () => zoomBy(1.25),
  "-": () => zoomBy(0.8),
  f: () => setFollow(!view.follow),
  l: () => setLoop(!player.loop),
  "?": () => $("help").showModal(),
};

function pressed(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || $("help").open) return;
  if (event.target instanceof HTMLSelectElement) return;
  if (event.key === " " && event.target instanceof HTMLButtonElement) return; // it presses that
  if (event.key === " " && event.target.type === "checkbox") return;
  const act = KEYS[event.key];
  if (!act) return;
  event.preventDefault();
  act(event.shiftKey);
}

// --- pointers: drag, pinch, wheel, click --------------------------------------------------------

const pointers = new Map();
let moved = 0; // [px] since the finger came down

function pointerDown(event) {
  stage.setPointerCapture(event.pointerId);
  if (pointers.size === 0) moved = 0;
  pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
}

function pointerMove(event) {
  const last = pointers.get(event.pointerId);
  if (!last) return;
  const here = [event.offsetX, event.offsetY];
  moved += Math.hypot(here[0] - last[0], here[1] - last[1]);
  if (pointers.size === 1 && moved > 4) {
    pan(here[0] - last[0], here[1] - last[1]);
    showFollow();
  } else if (pointers.size === 2) {
    const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
    const distance = (point) => Math.max(Math.hypot(point[0] - other[0], point[1] - other[1]), 1);
    zoomBy(distance(here) / distance(last), (here[0] + other[0]) / 2, (here[1] + other[1]) / 2);
  }
  pointers.set(event.pointerId, here);
}

function pointerUp(event) {
  if (pointers.size === 1 && moved <= 4 && event.type === "pointerup") {
    selected.person = personAt(event.offsetX, event.offsetY);
    player.redraw();
  }
  pointers.delete(event.pointerId);
}

/** The pedestrian nearest to a point of the canvas, if that was meant. */
function personAt(px, py) {
  let [nearest, who] = [Math.max(1.5 * RUN.radius * view.scale, 14), -1];
  PEOPLE.each(player.time, (at) => {
    const distance = Math.hypot(toScreenX(at.x) - px, toScreenY(at.y) - py);
    if (distance < nearest) [nearest, who] = [distance, at.who];
  });
  return who;
}

function chartSeek(event) {
  if (event.buttons & 1) player.seek(chartTime(event.offsetX));
}

// --- the beginning ------------------------------------------------------------------------------

function wire() {
  $("play").addEventListener("click", () => player.play(!player.playing));
  $("back").addEventListener("click", () => player.step(-1));
  $("forth").addEventListener("click", () => player.step(1));
  $("loop").addEventListener("click", () => setLoop(!player.loop));
  $("follow").addEventListener("click", () => setFollow(!view.follow));
  $("whole").addEventListener("click", () => setFollow(false));
  $("closer").addEventListener("click", () => zoomBy(1.25));
  $("farther").addEventListener("click", () => zoomBy(0.8));
  $("ask").addEventListener("click", () => $("help").showModal());
  $("unselect").addEventListener("click", () => {
    selected.person = -1;
    player.redraw();
  });
  $("speed").addEventListener("change", () => setSpeed(Number($("speed").value)));
  $("below").addEventListener("change", () => {
    below = $("below").value;
    showBelow();
    player.redraw();
  });
  const scrubber = $("scrubber");
  [scrubber.min, scrubber.max, scrubber.step] = [START, END, "any"];
  scrubber.addEventListener("input", () => player.seek(Number(scrubber.value)));
  stage.addEventListener("pointerdown", pointerDown);
  stage.addEventListener("pointermove", pointerMove);
  stage.addEventListener("pointerup", pointerUp);
  stage.addEventListener("pointercancel", pointerUp);
  stage.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      zoomBy(Math.exp(-event.deltaY / 500), event.offsetX, event.offsetY);
    },
    { passive: false },
  );
  chart.addEventListener("pointerdown", (event) => {
    chart.setPointerCapture(event.pointerId);
    chartSeek(event);
  });
  chart.addEventListener("pointermove", chartSeek);
  window.addEventListener("keydown", pressed);
  window.addEventListener("hashchange", readTime);
  new ResizeObserver(() => {
    measureStage();
    refit();
    player.redraw();
  }).observe(stage);
  new ResizeObserver(() => player.redraw()).observe(chart);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    readColours();
    player.redraw();
  });
}

readColours();
writeOnce();
writeEgo();
wire();
measureStage();
showAll();
if (EGOS.length && Math.max(EXTENT[2] - EXTENT[0], EXTENT[3] - EXTENT[1]) > WHOLE) follow(true, true);
showFollow();
setSpeed(1);
setLoop(false);
readTime();
requestAnimationFrame(tick);

// For pages that embed this one, and for tests: the time, and where a place [m] is on the canvas.
window.replay = {
  get time() {
    return player.time;
  },
  start: START,
  seek: (t) => player.seek(t),
  place: (x, y) => [toScreenX(x - RUN.origin[0]), toScreenY(y - RUN.origin[1])],
  get scale() {
    return view.scale;
  },
};
