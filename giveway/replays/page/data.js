// What the page was given: JSON with arrays in base64, integers in millimetres about an origin.

const RUN = JSON.parse(document.getElementById("run").textContent);

function unpack(text, Type) {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) bytes[i] = letters.charCodeAt(i);
  return new Type(bytes.buffer);
}

/** Metres in the page's own frame. */
function metres(text) {
  const millimetres = unpack(text, Int32Array);
  const values = new Float32Array(millimetres.length);
  for (let i = 0; i < values.length; i++) values[i] = millimetres[i] / 1000;
  return values;
}

const FRAMES = unpack(RUN.time, Float64Array);
const START = FRAMES[0];
const END = FRAMES[FRAMES.length - 1];

/** The index of the last of `times(0) ... times(count - 1)` that is not after `t`; -1: none. */
function lastBefore(count, times, t) {
  let low = 0;
  let high = count;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times(middle) <= t + 1e-9) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

function clamp(value, low, high) {
  return Math.min(Math.max(value, low), high);
}

/** A number for people to read; an absent one is a dash. */
function readable(value, digits = 2, unit = "") {
  if (value === null || !Number.isFinite(value)) return "–";
  const zero = Math.abs(value) < 0.5 * 10 ** -digits; // without a sign
  const text = (zero ? 0 : value).toFixed(digits).replace("-", "−");
  return unit ? `${text} ${unit}` : text;
}
