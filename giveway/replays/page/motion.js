// Who is where at any time: samples, and straight lines between them.

/** Pedestrians or SUMO's vehicles; a track is one uninterrupted presence. */
class Tracks {
  constructor(packed) {
    this.names = packed.names;
    this.bodies = packed.bodies;
    this.heights = packed.heights;
    this.who = unpack(packed.who, Uint32Array);
    this.start = unpack(packed.start, Uint32Array);
    this.until = unpack(packed.until, Float64Array);
    this.frame = unpack(packed.frame, Uint32Array);
    this.x = metres(packed.x);
    this.y = metres(packed.y);
    this.vx = unpack(packed.vx, Int16Array);
    this.vy = unpack(packed.vy, Int16Array);
    this.angle = unpack(packed.angle, Uint16Array);
    this.cursor = this.start.slice(0, this.who.length);
  }

  /** Calls `see` for everybody present; what it is given changes with the next call. */
  each(t, see) {
    const at = { who: 0, x: 0, y: 0, vx: 0, vy: 0, heading: 0, first: 0, sample: 0 };
    for (let track = 0; track < this.who.length; track++) {
      const first = this.start[track];
      if (t < FRAMES[this.frame[first]] - 1e-9 || t > this.until[track]) continue;
      const i = this.#seek(track, first, this.start[track + 1], t);
      this.#place(at, i, i + 1 < this.start[track + 1], t);
      at.who = this.who[track];
      [at.first, at.sample] = [first, i];
      see(at);
    }
  }

  /** From where the track stood last: while it plays, that is the next sample at most. */
  #seek(track, first, end, t) {
    let i = this.cursor[track];
    while (i + 1 < end && FRAMES[this.frame[i + 1]] <= t + 1e-9) i++;
    while (i > first && FRAMES[this.frame[i]] > t + 1e-9) i--;
    this.cursor[track] = i;
    return i;
  }

  #place(at, i, goesOn, t) {
    const since = t - FRAMES[this.frame[i]];
    at.vx = this.vx[i] / 100;
    at.vy = this.vy[i] / 100;
    const degrees = (this.angle[i] / 65536) * 360; // 0 is north, clockwise
    at.heading = ((90 - degrees) * Math.PI) / 180;
    if (goesOn) {
      const share = since / (FRAMES[this.frame[i + 1]] - FRAMES[this.frame[i]]);
      at.x = this.x[i] + share * (this.x[i + 1] - this.x[i]);
      at.y = this.y[i] + share * (this.y[i + 1] - this.y[i]);
    } else {
      at.x = this.x[i] + since * at.vx;
      at.y = this.y[i] + since * at.vy;
    }
  }
}

/** The way of a front bumper, and stations [m] along it. */
class Path {
  constructor(packed) {
    this.x = metres(packed.x);
    this.y = metres(packed.y);
    this.station = new Float32Array(this.x.length);
    for (let i = 1; i < this.x.length; i++) {
      const length = Math.hypot(this.x[i] - this.x[i - 1], this.y[i] - this.y[i - 1]);
      this.station[i] = this.station[i - 1] + length;
    }
  }

  at(station) {
    const last = this.x.length - 2;
    const i = clamp(lastBefore(this.x.length, (k) => this.station[k], station), 0, last);
    const share = (station - this.station[i]) / (this.station[i + 1] - this.station[i]);
    return [
      this.x[i] + share * (this.x[i + 1] - this.x[i]),
      this.y[i] + share * (this.y[i + 1] - this.y[i]),
    ];
  }

  /** The points of the piece between two stations. */
  piece(from, to) {
    const points = [this.at(from)];
    for (let i = 0; i < this.x.length; i++) {
      if (this.station[i] > from && this.station[i] < to) points.push([this.x[i], this.y[i]]);
    }
    points.push(this.at(to));
    return points;
  }
}

/** Whether a point is at most `halfWidth` from a piece of way, and not behind its beginning. */
function inCorridor(points, halfWidth, x, y) {
  for (let i = 1; i < points.length; i++) {
    const [x0, y0] = points[i - 1];
    const dx = points[i][0] - x0;
    const dy = points[i][1] - y0;
    const along = (x - x0) * dx + (y - y0) * dy;
    const length = Math.hypot(dx, dy);
    const beside = Math.abs((y - y0) * dx - (x - x0) * dy);
    if (along >= 0 && along <= length * length && beside <= halfWidth * length) return true;
  }
  return false;
}

/** One vehicle that giveway drove. */
class Ego {
  constructor(packed) {
    Object.assign(this, packed);
    [this.length, this.width] = packed.body;
    this.frame = unpack(packed.frame, Uint32Array);
    this.kind = unpack(packed.kind, Uint16Array);
    this.x = metres(packed.x);
    this.y = metres(packed.y);
    for (const key of ["heading", "station", "speed", "reference_speed", "force", "gap"]) {
      this[key] = unpack(packed[key], Float32Array);
    }
    this.vehicle_gap = unpack(packed.vehicle_gap, Float32Array);
    this.stop_gap = unpack(packed.stop_gap, Float32Array);
    this.path = new Path(packed.path);
    this.count = this.frame.length;
    this.from = this.time(0);
    this.to = this.time(this.count - 1);
    const predicted = packed.predicted;
    this.predicted = predicted && {
      looks: predicted.looks,
      every: predicted.every,
      frame: unpack(predicted.frame, Uint32Array),
      start: unpack(predicted.start, Uint32Array),
      look: unpack(predicted.look, Uint8Array),
      x: metres(predicted.x),
      y: metres(predicted.y),
    };
  }

  time(i) {
    return FRAMES[this.frame[i]];
  }

  /** Its state at `t`; null when it is not on the road. */
  at(t) {
    const leaves = this.to < END - 1e-9 ? this.to + RUN.step : END;
    if (t < this.from - 1e-9 || t > leaves + 1e-9) return null;
    const i = Math.max(lastBefore(this.count, (k) => this.time(k), t), 0);
    const next = Math.min(i + 1, this.count - 1);
    const span = this.time(next) - this.time(i);
    const share = span > 0 ? clamp((t - this.time(i)) / span, 0, 1) : 0;
    const between = (values) => values[i] + share * (values[next] - values[i]);
    const turn = this.heading[next] - this.heading[i];
    const heading = this.heading[i] + share * Math.atan2(Math.sin(turn), Math.cos(turn));
    const [x, y] = [between(this.x), between(this.y)];
    return {
      i,
      x,
      y,
      heading,
      cos: Math.cos(heading),
      sin: Math.sin(heading),
      centreX: x - (this.length / 2) * Math.cos(heading),
      centreY: y - (this.length / 2) * Math.sin(heading),
      speed: between(this.speed),
      station: between(this.station),
      kind: this.kinds[this.kind[i]],
    };
  }

  /** The entry of the predictions made last before `t`; -1 where none was made just then. */
  prediction(t) {
    if (!this.predicted) return -1;
    const frame = this.predicted.frame;
    const entry = lastBefore(frame.length, (k) => FRAMES[frame[k]], t);
    const fresh = (this.predicted.every + 0.5) * RUN.step;
    return entry >= 0 && t - FRAMES[frame[entry]] < fresh ? entry : -1;
  }
}

/** Where a point is in a body's frame: from its centre, X along its heading. */
function inFrame(state, x, y) {
  const dx = x - state.centreX;
  const dy = y - state.centreY;
  return [dx * state.cos + dy * state.sin, dy * state.cos - dx * state.sin];
}

/** The distance [m] of a circle to the ego's rectangle; negative: overlap. */
function clearance(ego, state, x, y) {
  const [X, Y] = inFrame(state, x, y);
  const beyondX = Math.abs(X) - ego.length / 2;
  const beyondY = Math.abs(Y) - ego.width / 2;
  const outside = beyondX > 0 && beyondY > 0;
  return (outside ? Math.hypot(beyondX, beyondY) : Math.max(beyondX, beyondY)) - RUN.radius;
}

/**
 * Time [s] until circle and rectangle touch if both go on as they do; Infinity: never.
 *
 * In the ego's frame the circle is a point, and the rectangle has grown by the radius: two boxes
 * and four discs at the corners.
 */
function timeToCollision(ego, state, person) {
  if (clearance(ego, state, person.x, person.y) <= 0) return 0;
  const [X, Y] = inFrame(state, person.x, person.y);
  const u = person.vx * state.cos + person.vy * state.sin - state.speed;
  const w = person.vy * state.cos - person.vx * state.sin;
  const [a, b, r] = [ego.length / 2, ego.width / 2, RUN.radius];
  let first = Math.min(entersBox(X, Y, u, w, a + r, b), entersBox(X, Y, u, w, a, b + r));
  for (const cornerX of [-a, a]) {
    for (const cornerY of [-b, b]) {
      first = Math.min(first, entersDisc(X - cornerX, Y - cornerY, u, w, r));
    }
  }
  return first;
}

function entersBox(X, Y, u, w, a, b) {
  let enter = 0;
  let leave = Infinity;
  for (const [place, speed, half] of [[X, u, a], [Y, w, b]]) {
    if (Math.abs(speed) < 1e-9) {
      if (Math.abs(place) > half) return Infinity;
      continue;
    }
    const sides = [(-half - place) / speed, (half - place) / speed];
    enter = Math.max(enter, Math.min(...sides));
    leave = Math.min(leave, Math.max(...sides));
  }
  return enter <= leave ? enter : Infinity;
}

function entersDisc(X, Y, u, w, r) {
  const a = u * u + w * w;
  const b = X * u + Y * w;
  const root = b * b - a * (X * X + Y * Y - r * r);
  if (a < 1e-18 || root < 0) return Infinity;
  const time = (-b - Math.sqrt(root)) / a;
  return time >= 0 ? time : Infinity;
}

const PEOPLE = new Tracks(RUN.tracks.people);
const VEHICLES = new Tracks(RUN.tracks.vehicles);
const EGOS = RUN.egos.map((ego) => new Ego(ego));
