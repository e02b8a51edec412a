// What cameras see: their fields of view, and the shadows that bodies cast, for a child of 1.15 m.

const CHILD = 1.15; // [m]
const AT_IT = 0.01; // [m] from a camera: a wall there is at it
const WALLS = RUN.walls.map(([x0, y0, x1, y1, top]) =>
  [x0 - RUN.origin[0], y0 - RUN.origin[1], x1 - RUN.origin[0], y1 - RUN.origin[1], top]);
const CAMERAS = EGOS.some((ego) => ego.sight);

/** Whether no ego with cameras perceives a person at `t`, though there is one. */
function unseen(who, t) {
  if (!CAMERAS) return false;
  return EGOS.every((ego) => !ego.sight
    || !(ego.sight.stretches[who] ?? []).some(([from, until]) => t > from - 1e-6 && t < (until ?? Infinity) - 1e-6));
}

/** The sides of a rectangle: from its front, along its heading. */
function sidesOf(x, y, heading, length, width, top) {
  const [c, s] = [Math.cos(heading), Math.sin(heading)];
  const corners = [[0, 0.5], [-1, 0.5], [-1, -0.5], [0, -0.5]].map(([a, b]) =>
    [x + a * length * c - b * width * s, y + a * length * s + b * width * c]);
  return corners.map((corner, k) => [...corner, ...corners[(k + 1) % 4], top]);
}

function wallsAround(ego, present, t) {
  const walls = [...WALLS];
  VEHICLES.each(t, (at) => {
    const [length, width] = VEHICLES.bodies[at.who];
    walls.push(...sidesOf(at.x, at.y, at.heading, length, width, VEHICLES.heights[at.who]));
  });
  for (const [other, state] of present) {
    if (other === ego) continue;
    walls.push(...sidesOf(state.x, state.y, state.heading, other.length, other.width, other.height));
  }
  return walls;
}

/** A wall's shadow: its side from the camera, stretched from `near` to `far` times the distance. */
function addShadow(path, [x, y, z, , range], [x0, y0, x1, y1, top]) {
  const [above, rises] = [top - z, CHILD - z];
  const near = above > 0 ? Math.max(1, rises / above) : 1;
  let far = above > 0 ? Infinity : rises < 0 ? rises / above : 0;
  const [ax, ay, dx, dy] = [x0 - x, y0 - y, x1 - x0, y1 - y0];
  const at = clamp(-(ax * dx + ay * dy) / Math.max(dx * dx + dy * dy, 1e-12), 0, 1);
  far = Math.min(far, (1.01 * range) / Math.max(Math.hypot(ax + at * dx, ay + at * dy), AT_IT));
  if (!(far > near)) return;
  const [bx, by] = [x1 - x, y1 - y];
  path.moveTo(x + near * ax, y + near * ay);
  path.lineTo(x + near * bx, y + near * by);
  path.lineTo(x + far * bx, y + far * by);
  path.lineTo(x + far * ax, y + far * ay);
  path.closePath();
}

const [seenLayer, hiddenLayer] = [0, 0].map(() => document.createElement("canvas").getContext("2d"));

function cleared(layer) {
  fitCanvasTo(layer.canvas, stage);
  layer.setTransform(pen.getTransform());
  return layer;
}

/** Dark where no camera sees a child though it is in a field of view; the fields' edges are thin. */
function drawSight(ego, state, present, t) {
  toScene();
  const hidden = cleared(hiddenLayer);
  const walls = wallsAround(ego, present, t);
  const eyes = ego.sight.cameras.map(([ahead, aside, z, turn, range, half]) => {
    const [dx, dy] = turned(state, ahead, aside);
    const [x, y, heading] = [state.x + dx, state.y + dy, state.heading + turn];
    const field = new Path2D();
    if (half < Math.PI) field.moveTo(x, y);
    field.arc(x, y, range, heading - half, heading + half);
    field.closePath();
    return { at: [x, y, z, heading, range], field };
  });
  hidden.fillStyle = colours.shadow;
  for (const { field } of eyes) hidden.fill(field);
  pen.strokeStyle = colours.shadow;
  pen.lineWidth = 1 / view.scale;
  for (const { at, field } of eyes) {
    pen.globalAlpha = 0.35;
    pen.stroke(field);
    const seen = cleared(seenLayer);
    seen.fill(field);
    seen.globalCompositeOperation = "destination-out";
    for (const wall of walls) {
      const shadow = new Path2D(); // of its own: those of two sides turn opposite ways
      addShadow(shadow, at, wall);
      seen.fill(shadow);
    }
    hidden.globalCompositeOperation = "destination-out";
    hidden.setTransform(1, 0, 0, 1, 0, 0);
    hidden.drawImage(seen.canvas, 0, 0);
  }
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.globalAlpha = 0.3;
  pen.drawImage(hidden.canvas, 0, 0);
  pen.globalAlpha = 1;
}
