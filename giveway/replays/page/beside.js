// Two replays in step: whichever is moved, the other goes to the same time since its beginning.

const frames = [...document.querySelectorAll("iframe")];
const shown = frames.map(() => 0); // [s] since the beginning, as last set or seen

function replays() {
  return frames.map((frame) => frame.contentWindow.replay);
}

function inStep() {
  const all = replays();
  if (all.every(Boolean)) {
    const now = all.map((replay) => replay.time - replay.start);
    const moved = now.findIndex((time, i) => Math.abs(time - shown[i]) > 1e-9);
    if (moved >= 0) {
      all.forEach((replay, i) => {
        if (i !== moved) replay.seek(replay.start + now[moved]);
        shown[i] = replay.time - replay.start;
      });
    }
  }
  requestAnimationFrame(inStep);
}

requestAnimationFrame(inStep);
