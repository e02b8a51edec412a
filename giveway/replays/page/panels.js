// The words beside the stage: now, the selected pedestrian, events, summary, layers.

const $ = (id) => document.getElementById(id);
const NO_EGO = "no ego on the road";
const shown = new Map();

/** Writes a text where it has changed: the page is laid out again only then. */
function write(id, text) {
  if (shown.get(id) === text) return;
  shown.set(id, text);
  $(id).textContent = text;
}

function element(tag, text, className) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  return made;
}

function writeNow(t, states) {
  write("clock", `${t.toFixed(2)} s`);
  const ego = EGOS[selected.ego];
  const state = states[selected.ego];
  const acting = state ? state.kind.acting : "none";
  if (shown.get("badge") !== acting) {
    shown.set("badge", acting);
    $("badge").dataset.acting = acting;
    $("badge").textContent = state ? acting.toUpperCase() : "–";
  }
  write("why", state ? state.kind.text : NO_EGO);
  write("infeasible", state && state.kind.infeasible ? "no solution" : "");
  const of = (values) => (state ? values[state.i] : NaN);
  write("now-speed", readable(state ? state.speed : NaN, 2));
  write("now-reference", readable(of(ego?.reference_speed ?? []), 2));
  const gap = of(ego?.gap ?? []);
  write("now-gap", Number.isFinite(gap) || !state ? readable(gap, 2) : "nobody");
  write("now-safe", ego ? readable(ego.safe, 1) : "–");
  write("now-force", readable(of(ego?.force ?? []) / 1000, 2));
}

function writePerson(person, states) {
  $("person").hidden = selected.person < 0;
  if (selected.person < 0) return;
  write("person-id", PEOPLE.names[selected.person]);
  const ego = EGOS[selected.ego];
  const state = states[selected.ego];
  const both = person && state;
  write("person-speed", person ? readable(Math.hypot(person.vx, person.vy), 2, "m/s") : "not here");
  write("person-distance", both ? readable(clearance(ego, state, person.x, person.y), 2, "m") : "–");
  const ttc = both ? timeToCollision(ego, state, person) : NaN;
  write("person-ttc", ttc === Infinity ? "no collision course" : readable(ttc, 2, "s"));
  const closest = ego?.met[selected.person];
  write("person-closest", closest === undefined ? "–" : readable(closest, 2, "m"));
}

const EVENT_NAMES = {
  stop: "Stop", pid: "PID", safety: "Safety", overlap: "Overlap", closest: "Closest", sight: "In sight",
};

/** What changes only with the ego that is looked at. */
function writeEgo() {
  const ego = EGOS[selected.ego];
  const events = $("events");
  events.replaceChildren();
  for (const event of ego ? ego.events : []) {
    const button = element("button");
    button.type = "button";
    button.append(
      element("span", EVENT_NAMES[event.kind], `mark ${event.kind}`),
      element("span", `${event.from.toFixed(2)} s`, "when"),
      element("span", event.text, "what"),
    );
    button.addEventListener("click", () => {
      if (event.who) selected.person = PEOPLE.names.indexOf(event.who);
      player.seek(event.from);
    });
    const item = element("li");
    item.append(button);
    events.append(item);
  }
  showBelow();
  $("no-events").hidden = events.children.length > 0;
  const summary = $("summary");
  summary.replaceChildren();
  for (const { label, value, unit, meaning } of ego ? ego.summary : []) {
    const name = element("dt", label);
    name.title = meaning;
    const digits = Number.isInteger(value) ? 0 : 2;
    summary.append(name, element("dd", readable(value, digits, unit)));
  }
}

/** Key and words of the lower chart. */
function showBelow() {
  const ego = EGOS[selected.ego];
  $("key-gap").hidden = below !== "gap";
  $("key-vehicle").hidden = below !== "gap" || !ego?.vehicle_gap.some(Number.isFinite);
  $("key-light").hidden = below !== "gap" || !ego?.stop_gap.some(Number.isFinite);
  $("key-ttc").hidden = below !== "ttc";
  $("key-force").hidden = below !== "force";
  $("charts").setAttribute("aria-label", chartWords(ego));
}

function writeOnce() {
  document.title = `Replay: ${RUN.title}`;
  $("ending").textContent = RUN.ending;
  $("ending").dataset.ending = RUN.ending;
  const notes = $("notes");
  for (const note of RUN.notes) notes.append(element("li", note));
  $("notes-box").hidden = RUN.notes.length === 0;
  const picker = $("ego");
  EGOS.forEach((ego, index) => {
    const option = element("option", `${ego.id} (${ego.controller.toUpperCase()})`);
    option.value = index;
    picker.append(option);
  });
  $("ego-box").hidden = EGOS.length < 2;
  picker.addEventListener("change", () => {
    selected.ego = Number(picker.value);
    writeEgo();
    player.redraw();
  });
  for (const box of document.querySelectorAll("[data-layer]")) {
    box.addEventListener("change", () => {
      layers[box.dataset.layer] = box.checked;
      player.redraw();
    });
  }
  for (const box of document.querySelectorAll(".sight-only")) box.hidden = !CAMERAS;
  $("lights-box").hidden = LIGHTS.length === 0;
  const predicted = EGOS.some((ego) => ego.predicted);
  if (!predicted) {
    const box = document.querySelector("[data-layer=predictions]");
    box.checked = layers.predictions = false;
    box.disabled = true;
  }
  document.body.classList.toggle("without-ego", EGOS.length === 0);
}
