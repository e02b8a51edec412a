"""The self-contained page that plays a run, made from a results folder."""

import json
import math
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from jinja2 import Environment, StrictUndefined, Template
from markupsafe import Markup
from shapely import LineString

from giveway.config.files.naming import title
from giveway.config.files.presets import parameters_of
from giveway.config.tables.controllers import PaperPidOptions
from giveway.errors import ResultsError
from giveway.gate import write_whole
from giveway.geometry.path import angle_to_heading, angles_to_headings
from giveway.metrics import SUMMARY_FIELDS
from giveway.replays.contours import influence_contours
from giveway.replays.events import events, why
from giveway.replays.marks import pack_marks
from giveway.replays.packed_sight import heights_of, pack_sight, walls_of
from giveway.replays.packed_tracks import (
    Frame,
    longest_gap,
    pack_predictions,
    pack_tracks,
    packed,
    thinning,
)
from giveway.replays.run_folder import PREDICTIONS, RunFolder, read_predictions
from giveway.run_data.tracks import counted
from giveway.run_data.writing import pretty_unit

_SCRIPTS = (
    "data.js", "motion.js", "view.js", "sight.js",
    "scene.js", "charts.js", "panels.js", "player.js",
)  # fmt: skip
_NUMBERS = ("speed", "reference_speed", "force", "gap", "vehicle_gap", "stop_gap")
_SHOWN = (
    "completion_time", "mean_speed", "stops", "longest_wait", "mpc_feasibility_rate",
    "close_passes", "minimum_gap", "minimum_clearance", "overlaps", "conflicts", "minimum_ttc",
    "minimum_pet",
    "peak_deceleration", "rms_jerk",
)  # fmt: skip
_SPELT = ("mpc", "ttc", "pet", "rms")
_BODY = (5.0, 2.0)  # Length and width [m] of an ego if the folder does not have them
_BEYOND_DRIVE = 150.0  # Length [m] of the corridor after the end of the drive
# Length and width [m] of SUMO's passenger car, if the folder does not have them
_PASSENGER_CAR = (4.3, 1.8)
_MADE_WITHOUT = (
    "No predictions: the run did not record them; 'giveway run --record-predictions 0.25' does."
)


def write_replay(
    folder: Path,
    target: Path,
    *,
    predictions: Path | None = None,
    remark: str = "",
    unsealed: bool = False,
) -> Path:
    """Make the page that plays the run in ``folder``.

    Args:
        folder: Results of ``giveway run``, completed or not.
        target: HTML file to write; it is replaced if it exists.
        predictions: File ``predictions.csv`` of the same run, or None for the folder's own, if any.
        remark: Reason for missing predictions, for the page.
        unsealed: True to play tables that differ from those that the run wrote.

    Returns:
        ``target``.

    Raises:
        ResultsError: the folder holds no run, or the page cannot be written.
    """
    return _written(target, _page(content_of(folder, predictions, remark, unsealed=unsealed)))


def write_beside(contents: Sequence[dict[str, Any]], target: Path) -> Path:
    """Make the page that plays two runs side by side, at equal times since their beginnings.

    Args:
        contents: Content of each page, from :func:`content_of`.
        target: HTML file to write; it is replaced if it exists.

    Returns:
        ``target``.

    Raises:
        ResultsError: the page cannot be written.
    """
    page = _template("beside.html.j2").render(
        titles=[content["title"] for content in contents],
        pages=[_page(content) for content in contents],
        script=_text("beside.js"),
    )
    return _written(target, page)


def content_of(
    folder: Path, predictions: Path | None = None, remark: str = "", *, unsealed: bool = False
) -> dict[str, Any]:
    """Return the content of a run's page.

    The arguments are those of :func:`write_replay`.

    Raises:
        ResultsError: the folder holds no run.
    """
    run = RunFolder.read(folder, unsealed=unsealed)
    if predictions is None and (folder / PREDICTIONS).is_file():
        predictions = folder / PREDICTIONS
    table = None if predictions is None else read_predictions(predictions)
    return _content(run, table, remark)


def _written(target: Path, page: str) -> Path:
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        write_whole(target, page.encode("utf-8"))
    except OSError as error:
        raise ResultsError(
            f"{target}: cannot be written ({error.strerror}); name another file with --out"
        ) from error
    return target


def _text(name: str) -> Markup:
    """Return a file of the page, unchanged."""
    return Markup((files("giveway.replays") / "page" / name).read_text(encoding="utf-8"))


def _template(name: str) -> Template:
    environment = Environment(autoescape=True, undefined=StrictUndefined)
    return environment.from_string(_text(name))


def _page(content: dict[str, Any]) -> str:
    """Return the template filled with style, scripts and data."""
    template = _template("replay.html.j2")
    # This keeps any id from ending the script element that holds the data.
    data = json.dumps(content, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    data = data.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")
    return template.render(
        title=content["title"],
        style=_text("replay.css"),
        scripts=[_text(name) for name in _SCRIPTS],
        data=Markup(data),
    )


def _content(run: RunFolder, predictions: pd.DataFrame | None, remark: str) -> dict[str, Any]:
    """Return the data of the page."""
    frame = Frame.of(run)
    rows = run.trajectories
    walking = (rows["type"] == "pedestrian").to_numpy()
    driven = rows["id"].isin(list(run.egos)).to_numpy()
    pedestrians, vehicles = rows[walking], rows[~walking & ~driven]
    thin, gap = thinning(pedestrians, run.step), longest_gap(run)
    tracks = {
        "people": pack_tracks(pedestrians, frame, hold=run.step, gap=max(gap, 2 * thin), thin=thin),
        "vehicles": pack_tracks(vehicles, frame, hold=run.sumo_step, gap=gap, thin=0.0),
    }
    others = tracks["vehicles"]
    others["bodies"] = [run.scene.body(name, _PASSENGER_CAR) for name in others["names"]]
    others["heights"] = heights_of(run, others["names"])
    names = {name: index for index, name in enumerate(tracks["people"]["names"])}
    contours, egos = _egos(run, frame, predictions, names)
    return {
        "title": _title(run),
        "ending": str(run.summary.get("ending", run.manifest.get("ending", ""))),
        "notes": _notes(run, predictions, remark, thin),
        "origin": [frame.x, frame.y],
        "time": packed(frame.time, np.float64),
        "step": run.step,
        "radius": float(parameters_of(run.config.crowd.preset).body_radius),
        "road": _road(run, frame),
        "marks": pack_marks(run, frame),
        "walls": walls_of(run),
        "tracks": tracks,
        "egos": egos,
        "contours": contours,
    }


def _title(run: RunFolder) -> str:
    scenario = run.summary.get("scenario", run.config.scenario)
    drivers = " + ".join(sorted({one.driver for one in run.egos.values()}))
    pedestrians = run.trajectories.loc[run.trajectories["type"] == "pedestrian", "id"].nunique()
    return title(run.config, str(scenario), counted(pedestrians), drivers)


def _notes(run: RunFolder, predictions: pd.DataFrame | None, remark: str, thin: float) -> list[str]:
    """Return the remarks on the page and the run for its viewers."""
    error = run.manifest.get("error")
    notes = [f"The run did not end well: {error}"] if error else []
    if thin:
        notes.append(
            f"A crowd of this size is thinned: one position in {thin:g} s, a straight line between."
        )
    with_mpc = any(one.optimises for one in run.egos.values())
    if predictions is None and with_mpc:
        notes.append(remark or _MADE_WITHOUT)
    zone = run.config.crowd.zone
    if _walk_unrecorded(run) and zone != "everywhere":
        notes.append(
            f"The scenario's own walkers are on record in the zone alone (--zone {zone}); outside, "
            "SUMO walks them unseen. '--zone everywhere' shows all."
        )
    if not run.scene.road:
        notes.append("No road outlines: this results folder keeps none.")
    remarks = run.manifest.get("remarks")
    return notes + [str(text) for text in (remarks if isinstance(remarks, list) else ())]


def _walk_unrecorded(run: RunFolder) -> bool:
    """Return whether SUMO moves persons who are not recorded.

    These are persons handed back to SUMO, or all persons in a run without an ego.
    """
    counts = run.manifest.get("pedestrians")
    handed_back = isinstance(counts, dict) and bool(counts.get("handed_back"))
    return handed_back or not (run.egos or run.config.crowd.adds_people)


def _road(run: RunFolder, frame: Frame) -> dict[str, Any]:
    outlines = run.scene.road
    points = np.array([point for line in outlines for point in line]).reshape(-1, 2)
    return {
        "start": packed(np.cumsum([0, *map(len, outlines)]), np.uint32),
        "x": frame.across(points[:, 0]),
        "y": frame.up(points[:, 1]),
    }


def _egos(
    run: RunFolder, frame: Frame, predictions: pd.DataFrame | None, names: dict[str, int]
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Return the contours of influence for each vehicle shape, and the egos."""
    kinds: dict[tuple[Any, ...], float] = {}
    for name, config in run.egos.items():
        kind = (_body(run, name), config.crowd.preset, config.crowd.model)
        fastest = float(run.ego.loc[run.ego["id"] == name, "speed"].max())
        kinds[kind] = max(kinds.get(kind, 0.0), fastest)
    contours = [
        influence_contours(body, fastest, parameters_of(preset))
        | ({} if model == "vci" else {"levels": []})  # other models have no such force
        for (body, preset, model), fastest in kinds.items()
    ]
    egos = []
    for name, config in run.egos.items():
        ego = _ego(run, frame, name, names)
        ego["contours"] = list(kinds).index(
            (_body(run, name), config.crowd.preset, config.crowd.model)
        )
        mine = None if predictions is None else predictions[predictions["ego"] == name]
        ego["predicted"] = None if mine is None or mine.empty else pack_predictions(mine, frame)
        egos.append(ego)
    return contours, egos


def _body(run: RunFolder, name: str) -> tuple[float, float]:
    vehicle = run.egos[name].vehicle
    return run.scene.body(name, (vehicle.length or _BODY[0], vehicle.width or _BODY[1]))


def _ego(run: RunFolder, frame: Frame, name: str, names: dict[str, int]) -> dict[str, Any]:
    config = run.egos[name]
    rows = run.ego[run.ego["id"] == name]
    met = run.pedestrians
    met = met[met["ego"] == name] if "ego" in met else met
    length, width = _body(run, name)
    gap = config.own(PaperPidOptions)
    acted = list(zip(rows["controller"], rows["reason"], rows["solver_status"], strict=True))
    kinds = list(dict.fromkeys(acted))
    return {
        "id": name,
        "controller": config.described_controller,
        "body": [length, width],
        **pack_sight(run, name, names),
        "corridor": gap.corridor(width),
        "safe": config.regulation.safe_distance,
        "fromCentre": gap.gap_from == "centre",
        "summary": _summary(run.rows_of(name)),
        "events": events(rows, met, config, run.sights_of(name)),
        "met": _met(met, names),
        "kinds": [{"acting": acting, **why(*told)} for acting, *told in kinds],
        "kind": packed([kinds.index(one) for one in acted], np.uint16),
        "frame": packed(frame.index(rows["time"]), np.uint32),
        "x": frame.across(rows["x"]),
        "y": frame.up(rows["y"]),
        "heading": packed(angles_to_headings(rows["angle"].to_numpy(np.float64)), np.float32),
        "path": _path(rows, frame),
        "station": packed(rows["position"] - rows["position"].iloc[0], np.float32),
        **{key: packed(rows[key].to_numpy(np.float64), np.float32) for key in _NUMBERS},
    }


def _path(rows: pd.DataFrame, frame: Frame) -> dict[str, str]:
    """Return the front bumper's trajectory in centimetres, extended straight on at its end.

    The rest of its path is not recorded.
    """
    points = rows[["x", "y"]].to_numpy(np.float64)
    heading = angle_to_heading(float(rows["angle"].iloc[-1]))
    beyond = points[-1] + _BEYOND_DRIVE * np.array((np.cos(heading), np.sin(heading)))
    line = np.array(LineString([*points, beyond]).simplify(0.01).coords)
    return {"x": frame.across(line[:, 0]), "y": frame.up(line[:, 1])}


def _summary(row: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the lines of the panel: label, value, unit, meaning."""
    columns = {column.name: column for column in SUMMARY_FIELDS}
    return [
        {
            "label": _label(name),
            "value": row[name] if _is_number(row[name]) else None,
            "unit": pretty_unit(columns[name].unit or ""),
            "meaning": columns[name].description,
        }
        for name in _SHOWN
        if name in row
    ]


def _label(name: str) -> str:
    """Return a column's name in words, with abbreviations written out."""
    return " ".join(word.upper() if word in _SPELT else word for word in name.split("_"))


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and math.isfinite(value)


def _met(met: pd.DataFrame, names: dict[str, int]) -> dict[str, Any]:
    """Return each pedestrian's closest approach to this ego, by the index of the id."""
    if not {"id", "minimum_clearance"} <= set(met):
        return {}
    known = met[met["id"].isin(list(names))].dropna(subset=["minimum_clearance"])
    return {
        str(names[who]): round(float(clearance), 3)
        for who, clearance in zip(known["id"], known["minimum_clearance"], strict=True)
    }
