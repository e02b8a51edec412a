// Speed and gap over time, with a cursor; who acted is the ground behind them.

const chart = document.getElementById("charts");
const ink = chart.getContext("2d");
const backdrop = document.createElement("canvas"); // all but the cursor
const MARGIN = { left: 46, right: 14 };
const EVENT_STRIP = 18; // [px] above the charts
const AXIS = 16; // [px] below them
const FARTHEST = 40; // [m] of the gaps: what is beyond does not matter yet
const TICK_ROOM = 15; // [px]

let charted = null; // what the backdrop shows

const span = Math.max(END - START, 1e-3);
const timeX = (t) => MARGIN.left + ((t - START) / span) * (plotWidth() || 1);
const plotWidth = () => chart.clientWidth - MARGIN.left - MARGIN.right;
const chartTime = (px) => clamp(START + ((px - MARGIN.left) / plotWidth()) * span, START, END);

function drawCharts(t) {
  const key = [below, chart.clientWidth, chart.clientHeight, devicePixelRatio, selected.ego, colours.ink];
  if (String(key) !== charted) {
    fitCanvas(chart);
    fitCanvasTo(backdrop, chart);
    drawBackdrop(backdrop.getContext("2d"), chart.width / Math.max(chart.clientWidth, 1));
    charted = String(key);
  }
  ink.setTransform(1, 0, 0, 1, 0, 0);
  ink.drawImage(backdrop, 0, 0);
  const ratio = chart.width / Math.max(chart.clientWidth, 1);
  ink.setTransform(ratio, 0, 0, ratio, 0, 0);
  const x = Math.round(timeX(t)) + 0.5;
  ink.strokeStyle = colours.ink;
  ink.lineWidth = 1.5;
  ink.beginPath();
  ink.moveTo(x, 0);
  ink.lineTo(x, chart.clientHeight - AXIS);
  ink.stroke();
  ink.fillStyle = colours.ink;
  ink.beginPath();
  ink.arc(x, 4, 4, 0, 2 * Math.PI);
  ink.fill();
}

function fitCanvasTo(canvas, other) {
  [canvas.width, canvas.height] = [other.width, other.height];
}

function drawBackdrop(g, ratio) {
  g.setTransform(ratio, 0, 0, ratio, 0, 0);
  g.fillStyle = colours.panel;
  g.fillRect(0, 0, chart.clientWidth, chart.clientHeight);
  const top = EVENT_STRIP;
  const height = chart.clientHeight - top - AXIS;
  const ego = EGOS[selected.ego];
  drawTimeAxis(g, top + height);
  if (!ego) return;
  shadePhases(g, ego, top, height);
  const middle = top + height * 0.48;
  const upper = plot(g, "speed [m/s]", top + 2, middle - 8, 0, fastest(ego));
  curve(g, ego, ego.reference_speed, upper, colours.quiet, [5, 3], { steps: true });
  curve(g, ego, ego.speed, upper, colours.speed, []);
  BELOW[below](g, ego, middle + 6, top + height - 2);
  drawEvents(g, ego);
}

let below = "gap"; // what the lower chart shows

const BELOW = {
  gap(g, ego, top, bottom) {
    const [least, most] = gaps(ego);
    const where = plot(g, "gap [m]", top, bottom, least, most);
    level(g, where, ego.safe, "safe distance");
    curve(g, ego, ego.vehicle_gap, where, colours.car, [], { fastest: FASTEST_VEHICLE });
    curve(g, ego, ego.stop_gap, where, colours.overlap, [2, 2], { fastest: 0 });
    curve(g, ego, ego.gap, where, colours.gap, [], { fastest: FASTEST_WALK });
  },
  force(g, ego, top, bottom) {
    const force = ego.force.map((newton) => newton / 1000);
    const most = 1.1 * greatest(force, 1);
    const least = 1.1 * force.reduce((a, b) => (b < a ? b : a), -1);
    curve(g, ego, force, plot(g, "force [kN]", top, bottom, least, most), colours.inside, [], { steps: true });
  },
  ttc(g, ego, top, bottom) {
    const where = plot(g, "TTC [s]", top, bottom, 0, LONGEST_TTC);
    curve(g, ego, ego.ttc ??= leastTtc(ego), where, colours.gap, []);
  },
};

const LONGEST_TTC = 8; // [s] shown
const MOST_TTC = 2000; // instants at which the time to collision is computed

/** The least time to collision [s] with anybody, at the ego's instants; Infinity: with nobody. */
function leastTtc(ego) {
  const least = new Float32Array(ego.count).fill(Infinity);
  const every = Math.ceil(ego.count / MOST_TTC);
  for (let i = 0; i < ego.count; i += every) {
    const state = ego.at(ego.time(i));
    let first = Infinity;
    PEOPLE.each(ego.time(i), (at) => {
      first = Math.min(first, timeToCollision(ego, state, at));
    });
    least.fill(first, i, i + every);
  }
  return least;
}

/** What the charts show, for those who cannot see them. */
function chartWords(ego) {
  if (!ego) return "no ego on the road";
  const finite = (values) => Array.from(values).filter(Number.isFinite);
  const least = (values, unit) =>
    finite(values).length ? `${readable(Math.min(...finite(values)), 2)} ${unit} at least` : "none";
  const lower = {
    gap: () => `gap to the closest person in front: ${least(ego.gap, "m")}`,
    force: () => `force: ${readable(greatest(ego.force, -Infinity) / 1000, 2)} kN at most, `
      + least(ego.force.map((f) => f / 1000), "kN"),
    ttc: () => `time to a collision: ${least(ego.ttc ??= leastTtc(ego), "s")}`,
  }[below]();
  return `Over ${readable(END - START, 1)} s, speed: ${readable(greatest(ego.speed, 0), 2)} m/s at `
    + `most; ${lower}; ${ego.events.length} events`;
}

const greatest = (values, floor) => values.reduce((a, b) => (b > a ? b : a), floor);

function fastest(ego) {
  return 1.1 * greatest(ego.reference_speed, greatest(ego.speed, 1));
}

function gaps(ego) {
  const far = Math.min(greatest(ego.gap, 0), FARTHEST);
  const others = ego.vehicle_gap.some(Number.isFinite) || ego.stop_gap.some(Number.isFinite);
  const least = ego.gap.reduce((a, b) => (b < a ? b : a), 0);
  return [least, 1.05 * Math.max(others ? FARTHEST : far, 1.5 * ego.safe)];
}

/** An empty chart: its frame's heights, its name, round ticks; and how values become pixels. */
function plot(g, name, top, bottom, least, most) {
  const y = (value) => bottom - ((value - least) / (most - least)) * (bottom - top);
  g.fillStyle = colours.quiet;
  g.strokeStyle = colours.line;
  g.lineWidth = 1;
  g.font = "11px system-ui, sans-serif";
  g.textAlign = "right";
  g.textBaseline = "middle";
  const room = (TICK_ROOM * (most - least)) / Math.max(bottom - top, 1);
  const round = [1, 2, 4, 5, 10, 20, 50, 100].find((step) => step >= room) ?? most;
  for (let value = Math.ceil(Math.min(least, 0) / round) * round; value <= most; value += round) {
    const py = Math.round(y(value)) + 0.5;
    g.beginPath();
    g.moveTo(MARGIN.left, py);
    g.lineTo(MARGIN.left + plotWidth(), py);
    g.stroke();
    g.fillText(String(value).replace("-", "−"), MARGIN.left - 6, py);
  }
  g.save();
  g.translate(11, (top + bottom) / 2);
  g.rotate(-Math.PI / 2);
  g.textAlign = "center";
  g.fillText(name, 0, 0);
  g.restore();
  return { y, top, bottom };
}

const FASTEST_WALK = 3; // [m/s] along the way; a gap that changes faster is somebody else's
const FASTEST_VEHICLE = 60; // [m/s]; likewise

/**
 * A line that is broken where there is no number, and stands out where it is a single one.
 *
 * With `fastest` [m/s], values are distances to what moves no faster along the way, and the line is
 * broken where another one is in front from there on.
 */
function curve(g, ego, values, where, colour, dashes, { steps = false, fastest = Infinity } = {}) {
  g.save();
  g.beginPath();
  g.rect(MARGIN.left, where.top - 2, plotWidth() + 2, where.bottom - where.top + 4);
  g.clip();
  g.strokeStyle = g.fillStyle = colour;
  g.lineWidth = 1.6;
  g.setLineDash(dashes);
  g.beginPath();
  let before = false;
  for (let i = 0; i < ego.count; i++) {
    const there = Number.isFinite(values[i]);
    if (there && before) {
      const moved = values[i] - values[i - 1] + ego.station[i] - ego.station[i - 1];
      before = Math.abs(moved) <= fastest * (ego.time(i) - ego.time(i - 1)) + 2e-3;
    }
    const [x, y] = [timeX(ego.time(i)), where.y(values[i])];
    if (there && before) {
      if (steps) g.lineTo(x, where.y(values[i - 1]));
      g.lineTo(x, y);
    } else if (there) {
      g.moveTo(x, y);
      if (!Number.isFinite(values[i + 1])) g.lineTo(x + 1.5, y);
    }
    before = there;
  }
  g.stroke();
  g.restore();
}

function level(g, where, value, name) {
  const y = Math.round(where.y(value)) + 0.5;
  g.save();
  g.strokeStyle = colours.pid;
  g.fillStyle = colours.quiet;
  g.setLineDash([6, 3]);
  g.beginPath();
  g.moveTo(MARGIN.left, y);
  g.lineTo(MARGIN.left + plotWidth(), y);
  g.stroke();
  g.font = "11px system-ui, sans-serif";
  g.textAlign = "right";
  g.textBaseline = "bottom";
  g.fillText(name, MARGIN.left + plotWidth() - 2, y - 1);
  g.restore();
}

function shadePhases(g, ego, top, height) {
  for (let i = 0; i + 1 < ego.count; i++) {
    let end = i + 1;
    const acting = ego.kinds[ego.kind[i]].acting;
    while (end + 1 < ego.count && ego.kinds[ego.kind[end]].acting === acting) end++;
    g.globalAlpha = acting === "mpc" || acting === "plug-in" ? 0.1 : 0.22;
    g.fillStyle = colours[acting] ?? colours.mpc;
    g.fillRect(timeX(ego.time(i)), top, timeX(ego.time(end)) - timeX(ego.time(i)), height);
    i = end - 1;
  }
  g.globalAlpha = 1;
}

function drawTimeAxis(g, y) {
  const steps = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1800, 3600];
  const step = steps.find((s) => (span / s) * 52 < plotWidth()) ?? span;
  const digits = step < 1 ? 1 : 0;
  g.fillStyle = colours.quiet;
  g.strokeStyle = colours.line;
  g.font = "11px system-ui, sans-serif";
  g.textAlign = "center";
  g.textBaseline = "top";
  for (let t = Math.ceil(START / step - 1e-9) * step; t <= END + 1e-9; t += step) {
    const x = Math.round(timeX(t)) + 0.5;
    g.beginPath();
    g.moveTo(x, EVENT_STRIP);
    g.lineTo(x, y);
    g.stroke();
    g.fillText(`${t.toFixed(digits)}${t + step > END ? " s" : ""}`, x, y + 3);
  }
}

const EVENT_COLOURS = {
  stop: "stop", pid: "pid", safety: "safety", overlap: "overlap", closest: "inside", sight: "quiet",
};

function drawEvents(g, ego) {
  for (const event of ego.events) {
    const [from, to] = [timeX(event.from), timeX(event.to)];
    g.fillStyle = colours[EVENT_COLOURS[event.kind]];
    if (event.kind === "stop") g.fillRect(from, 10, Math.max(to - from, 2), 5);
    else if (event.kind === "pid" || event.kind === "safety") g.fillRect(from, 4, Math.max(to - from, 2), 4);
    else {
      g.beginPath();
      g.moveTo(from, EVENT_STRIP + 1);
      g.lineTo(from - 5, 8);
      g.lineTo(from + 5, 8);
      g.fill();
    }
  }
}
