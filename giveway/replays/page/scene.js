// What is drawn on the stage, from the ground up.

const ROAD = (() => {
  const start = unpack(RUN.road.start, Uint32Array);
  const x = metres(RUN.road.x);
  const y = metres(RUN.road.y);
  const road = new Path2D();
  for (let line = 0; line + 1 < start.length; line++) {
    const outline = new Path2D(); // of its own: overlapping outlines are no holes
    for (let i = start[line]; i < start[line + 1]; i++) outline.lineTo(x[i], y[i]);
    road.addPath(outline);
  }
  return road;
})();

/** Paint on the road: one path of quadrangles. */
function quadrangles(packed) {
  const x = metres(packed.x);
  const y = metres(packed.y);
  const path = new Path2D();
  for (let i = 0; i + 3 < x.length; i += 4) {
    path.moveTo(x[i], y[i]);
    for (let k = 1; k < 4; k++) path.lineTo(x[i + k], y[i + k]);
    path.closePath();
  }
  return path;
}

const CROSSINGS = quadrangles(RUN.marks.ground);
const STRIPES = quadrangles(RUN.marks.stripes);

/** The stop lines of lights: their ends, and what they show from when on. */
const LIGHTS = (() => {
  const { heads } = RUN.marks;
  const x = metres(heads.x);
  const y = metres(heads.y);
  return heads.letters.map((letters, k) => ({
    letters,
    times: unpack(heads.times[k], Float64Array),
    ends: [[x[2 * k], y[2 * k]], [x[2 * k + 1], y[2 * k + 1]]],
  }));
})();
const LIGHT_COLOURS = { G: "green", y: "yellow", r: "red", "-": "dark" };

/** What a light shows at a time: G, y, r, or - where that is not known. */
function lightAt(light, t) {
  return light.letters[lastBefore(light.times.length, (k) => light.times[k], t)] ?? "-";
}

const LABEL_SIDES = [[-1, 0], [0, 1], [1, 0]]; // of 10, 100, 1000 N in the vehicle's frame

/** Lines of equal force: one path per speed and level, in the vehicle's frame. */
const CONTOURS = RUN.contours.map((kind) => {
  const x = metres(kind.x);
  const y = metres(kind.y);
  const paths = kind.lines.map((levels) =>
    levels.map((starts, level) => {
      const outwards = LABEL_SIDES[level % LABEL_SIDES.length];
      const path = new Path2D();
      let label = null; // each level has its own side: at the nose they meet
      for (let piece = 0; piece + 1 < starts.length; piece++) {
        for (let i = starts[piece]; i < starts[piece + 1]; i++) {
          if (i === starts[piece]) path.moveTo(x[i], y[i]);
          else path.lineTo(x[i], y[i]);
          const out = x[i] * outwards[0] + y[i] * outwards[1];
          if (!label || out > label.out) label = { x: x[i], y: y[i], out, outwards };
        }
      }
      return { path, label };
    }),
  );
  return { speeds: kind.speeds, levels: kind.levels, paths };
});

const layers = { corridor: true, sight: true, influence: true, predictions: true, people: true, road: true, lights: true, trails: false };
const selected = { person: -1, ego: 0 };
const FADED = [1, 0.3]; // opacity of the nearest and the farthest prediction
const CORRIDOR_BEYOND = 12; // [m] of corridor drawn beyond the safe distance
const LEAD = 3; // [m] that the middle of the picture is ahead of a followed ego
const TRAIL = 5; // [s] of way behind everybody
const SIGHT = 100; // [m] along its path an ego looks out for people

function toScene() {
  const k = view.scale * view.ratio;
  pen.setTransform(k, 0, 0, -k, (view.width * view.ratio) / 2 - view.x * k,
    (view.height * view.ratio) / 2 + view.y * k);
}

function toPixels() {
  pen.setTransform(view.ratio, 0, 0, view.ratio, 0, 0);
}

function drawScene(t) {
  const states = EGOS.map((ego) => ego.at(t));
  if (view.follow) {
    const state = states[selected.ego];
    if (state) [view.x, view.y] = [state.x + LEAD * state.cos, state.y + LEAD * state.sin];
  }
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.fillStyle = colours.ground;
  pen.fillRect(0, 0, stage.width, stage.height);
  if (layers.road) drawRoad();
  const present = EGOS.map((ego, e) => [ego, states[e]]).filter(([, state]) => state);
  if (layers.sight && states[selected.ego] && EGOS[selected.ego].sight) {
    drawSight(EGOS[selected.ego], states[selected.ego], present, t);
  }
  if (layers.corridor) for (const [ego, state] of present) drawCorridor(ego, state);
  if (layers.influence) for (const [ego, state] of present) drawInfluence(ego, state);
  if (layers.predictions) for (const [ego] of present) drawPredictions(ego, t);
  if (layers.trails) drawTrails(t, present);
  if (layers.lights) drawLights(t);
  VEHICLES.each(t, drawVehicle);
  const person = drawPeople(t, present);
  for (const [ego, state] of present) drawEgo(ego, state);
  toPixels();
  if (person) drawSelection(person);
  drawScale();
  return { states, person };
}

function drawRoad() {
  toScene();
  pen.strokeStyle = colours.kerb;
  pen.lineWidth = 3 / view.scale;
  pen.stroke(ROAD);
  pen.fillStyle = colours.road;
  pen.fill(ROAD, "nonzero"); // of the kerbs, what is inside the road is gone
  pen.globalAlpha = 0.45; // lanes cross on a junction
  pen.lineWidth = 1 / view.scale;
  pen.stroke(ROAD);
  pen.globalAlpha = 1;
  pen.fillStyle = colours.unpainted;
  pen.fill(CROSSINGS);
  pen.fillStyle = colours.paint;
  pen.fill(STRIPES);
}

/** A bar along each stop line in the colour of its light, a lamp at its end. */
function drawLights(t) {
  toPixels();
  pen.lineCap = "butt";
  for (const light of LIGHTS) {
    const [[x0, y0], [x1, y1]] = light.ends.map(([x, y]) => [toScreenX(x), toScreenY(y)]);
    const thick = clamp(0.5 * view.scale, 3, 8);
    pen.strokeStyle = pen.fillStyle = colours[LIGHT_COLOURS[lightAt(light, t)]];
    pen.lineWidth = thick;
    pen.beginPath();
    pen.moveTo(x0, y0);
    pen.lineTo(x1, y1);
    pen.stroke();
    pen.beginPath(); // at the kerb, on the driver's right where people drive on the right
    dot(x1, y1, 0.9 * thick);
    pen.fill();
    pen.strokeStyle = colours.ink;
    pen.lineWidth = 1;
    pen.stroke();
  }
}

/** The last seconds of everybody's way. */
function drawTrails(t, present) {
  toScene();
  pen.lineWidth = 1.6 / view.scale;
  pen.lineJoin = pen.lineCap = "round";
  pen.globalAlpha = 0.75;
  for (const [tracks, colour] of [[VEHICLES, "car"], [PEOPLE, "person"]]) {
    pen.strokeStyle = colours[colour];
    pen.beginPath();
    tracks.each(t, (at) => {
      pen.moveTo(at.x, at.y);
      for (let i = at.sample; i >= at.first && FRAMES[tracks.frame[i]] >= t - TRAIL; i--) {
        pen.lineTo(tracks.x[i], tracks.y[i]);
      }
    });
    pen.stroke();
  }
  for (const [ego, state] of present) {
    pen.strokeStyle = colours[state.kind.acting] ?? colours.mpc;
    pen.beginPath();
    pen.moveTo(state.x, state.y);
    for (let i = state.i; i >= 0 && ego.time(i) >= t - TRAIL; i--) pen.lineTo(ego.x[i], ego.y[i]);
    pen.stroke();
  }
  pen.globalAlpha = 1;
}

/** The corridor ahead; its first part is the distance to keep. */
function drawCorridor(ego, state) {
  const from = state.station - (ego.fromCentre ? ego.length / 2 : 0);
  strip(ego.path.piece(state.station, from + ego.safe + CORRIDOR_BEYOND), ego.corridor, "corridor");
  if (from + ego.safe > state.station) {
    strip(ego.path.piece(state.station, from + ego.safe), ego.corridor, "safe");
  }
}

function strip(points, halfWidth, colour) {
  toScene();
  pen.lineWidth = 2 * halfWidth;
  pen.lineCap = "butt";
  pen.lineJoin = "round";
  pen.strokeStyle = colours[colour];
  pen.beginPath();
  for (const [x, y] of points) pen.lineTo(x, y);
  pen.stroke();
}

function drawInfluence(ego, state) {
  const { speeds, levels, paths } = CONTOURS[ego.contours];
  let nearest = 0;
  for (let i = 1; i < speeds.length; i++) {
    const better = Math.abs(speeds[i] - state.speed) < Math.abs(speeds[nearest] - state.speed);
    if (better) nearest = i;
  }
  pen.strokeStyle = pen.fillStyle = colours.influence;
  levels.forEach((level, l) => {
    const { path, label } = paths[nearest][l];
    if (!label) return;
    toScene();
    pen.translate(state.centreX, state.centreY);
    pen.rotate(state.heading);
    pen.globalAlpha = 0.6 + 0.2 * l;
    pen.lineWidth = (0.9 + 0.45 * l) / view.scale;
    pen.stroke(path);
    if (view.scale < 9) return;
    const [dx, dy] = turned(state, ...label.outwards);
    const [x, y] = turned(state, label.x, label.y);
    toPixels();
    pen.globalAlpha = 1;
    pen.fillStyle = colours.ink;
    pen.font = "10px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    const text = `${level} N`;
    const away = 8 + 14 * Math.abs(dx); // wide to the sides
    pen.fillText(
      text, toScreenX(state.centreX + x) + away * dx, toScreenY(state.centreY + y) - away * dy,
    );
  });
  pen.globalAlpha = 1;
}

/** A direction of a vehicle's frame in the scene's. */
function turned(state, X, Y) {
  return [X * state.cos - Y * state.sin, X * state.sin + Y * state.cos];
}

function drawPredictions(ego, t) {
  const entry = ego.prediction(t);
  if (entry < 0) return;
  const { start, look, looks, x, y } = ego.predicted;
  toPixels();
  pen.fillStyle = colours.prediction;
  const radius = clamp(0.11 * view.scale, 1.5, 5);
  for (let l = looks.length - 1; l >= 0; l--) {
    const share = looks.length > 1 ? l / (looks.length - 1) : 0;
    pen.globalAlpha = FADED[0] + share * (FADED[1] - FADED[0]);
    pen.beginPath();
    for (let i = start[entry]; i < start[entry + 1]; i++) {
      if (look[i] === l) dot(toScreenX(x[i]), toScreenY(y[i]), radius);
    }
    pen.fill();
  }
  pen.globalAlpha = 1;
}

function dot(px, py, radius) {
  pen.moveTo(px + radius, py);
  pen.arc(px, py, radius, 0, 2 * Math.PI);
}

function drawVehicle(at) {
  const [length, width] = VEHICLES.bodies[at.who];
  toScene();
  pen.translate(at.x, at.y);
  pen.rotate(at.heading);
  pen.fillStyle = colours.car;
  pen.beginPath();
  pen.roundRect(-length, -width / 2, length, width, 0.3);
  pen.fill();
  pen.fillStyle = colours.road; // its windscreen: where the front is
  pen.fillRect(-0.32 * length, -0.38 * width, 0.1 * length, 0.76 * width);
}

const kindOf = ["person", "close", "inside"];

/** Everybody in sight, in three colours; the selected one is handed back. */
function drawPeople(t, present) {
  const around = present.map(([ego, state]) => ({
    ego,
    state,
    ahead: ego.path.piece(state.station, state.station + SIGHT),
  }));
  const bodies = kindOf.map(() => new Path2D());
  const hollow = new Path2D(); // people whom no camera sees
  const ticks = new Path2D();
  const radius = Math.max(RUN.radius * view.scale, 2);
  let found = null;
  PEOPLE.each(t, (at) => {
    if (at.who === selected.person) found = { ...at };
    const [px, py] = [toScreenX(at.x), toScreenY(at.y)];
    if (px < -9 || py < -9 || px > view.width + 9 || py > view.height + 9) return;
    let kind = 0;
    for (const { ego, state, ahead } of around) {
      if (inCorridor(ahead, ego.corridor, at.x, at.y)) kind = 2;
      else if (kind < 1 && clearance(ego, state, at.x, at.y) < ego.safe / 2) kind = 1;
    }
    const body = unseen(at.who, t) ? hollow : bodies[kind];
    body.moveTo(px + radius, py);
    body.arc(px, py, radius, 0, 2 * Math.PI);
    if (radius > 3.5) { // smaller ones would be hidden by them
      ticks.moveTo(px, py);
      ticks.lineTo(px + 1.7 * radius * Math.cos(at.heading), py - 1.7 * radius * Math.sin(at.heading));
    }
  });
  toPixels();
  if (!layers.people) return found;
  pen.lineWidth = 1.4;
  pen.strokeStyle = colours.ink;
  pen.stroke(ticks);
  pen.stroke(hollow);
  kindOf.forEach((name, kind) => {
    pen.lineWidth = Math.min(0.6 * radius, 2); // half of it is under the body
    if (kind && radius > 2.5) pen.stroke(bodies[kind]);
    pen.fillStyle = colours[name];
    pen.fill(bodies[kind]);
  });
  return found;
}

/** The ego's rectangle in the colour of who drives it, its front marked. */
function drawEgo(ego, state) {
  toScene();
  pen.translate(state.centreX, state.centreY);
  pen.rotate(state.heading);
  const [a, b] = [ego.length / 2, ego.width / 2];
  pen.fillStyle = colours[state.kind.acting] ?? colours.mpc;
  pen.strokeStyle = state.kind.infeasible ? colours.overlap : colours.ink;
  pen.lineWidth = (state.kind.infeasible ? 2.5 : 1.2) / view.scale;
  pen.beginPath();
  pen.roundRect(-a, -b, 2 * a, 2 * b, 0.35);
  pen.fill();
  pen.stroke();
  pen.fillStyle = colours.panel;
  pen.beginPath();
  pen.moveTo(a - 0.35, 0);
  pen.lineTo(a - 1.2, 0.55 * b);
  pen.lineTo(a - 1.2, -0.55 * b);
  pen.fill();
}

function drawSelection(person) {
  const [px, py] = [toScreenX(person.x), toScreenY(person.y)];
  pen.strokeStyle = colours.ink;
  pen.lineWidth = 2;
  pen.beginPath();
  pen.arc(px, py, Math.max(RUN.radius * view.scale, 2) + 5, 0, 2 * Math.PI);
  pen.stroke();
}

/** A round number of metres, as long as it is. */
function drawScale() {
  const wanted = 90 / view.scale;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const length = [5, 2, 1].find((times) => times * power <= wanted) * power;
  const [x, y] = [16, view.height - 16];
  pen.strokeStyle = pen.fillStyle = colours.quiet;
  pen.lineWidth = 1.5;
  pen.beginPath();
  pen.moveTo(x, y - 5);
  pen.lineTo(x, y);
  pen.lineTo(x + length * view.scale, y);
  pen.lineTo(x + length * view.scale, y - 5);
  pen.stroke();
  pen.font = "11px system-ui, sans-serif";
  pen.textAlign = "left";
  pen.textBaseline = "alphabetic";
  pen.fillText(`${length} m`, x + 5, y - 5);
}
