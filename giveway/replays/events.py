"""The events of a run in words: the reasons of controllers, and the content of the time line."""

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.config import EgoRunConfig
from giveway.run_data.tracks import FALSE

_INFEASIBLE = {
    "infeasible: too close": "no plan: the next position is already inside the safe distance",
    "infeasible: cannot stop": "no plan: not even full braking keeps the safe distance",
    "infeasible: speed bounds": "no plan: the speed is outside its bounds",
    "infeasible: cannot hold speed": "no plan: the speed cannot be held within its bounds",
    "infeasible: certified": "no plan keeps all constraints (proven)",
}
_REASONS = {
    "optimal": "the MPC's plan keeps every constraint",
    "selected": "this run is driven by the PID alone",
    "infeasible": "no plan keeps all constraints",
}
_MANOEUVRES = {
    "clear": "nobody is in the way of driving on",
    "drive on": "driving on costs least, for all that people may answer to it",
    "as planned": "it keeps to its plan: no other one costs less",
}
_MOST_SIGHTS = 30  # first sights on the time line
_NUMBER = r"\d+(?:\.\d+)?(?:e[-+]?\d+)?"
_AIMED = re.compile(rf"(?P<rate>[-+]{_NUMBER} m/s\^2) to (?P<speed>-?{_NUMBER} m/s)")
_SAFETY = {
    "safety layer": "the safety layer brakes: a stop must stay possible",
    "vehicle ahead": "the safety layer brakes: it keeps a safe distance to the vehicle ahead",
    "unavoidable": "the safety layer brakes: no braking is surely enough",
}


def why(reason: str, status: str) -> dict[str, Any]:
    """Return why a controller acted, and whether the QP was infeasible.

    Args:
        reason: Reason as written in ``ego.csv``.
        status: Status of the solver.
    """
    infeasible = reason.startswith("infeasible") or status.startswith("infeasible")
    text = _SAFETY.get(reason) or _INFEASIBLE.get(status) or _REASONS.get(reason)
    text = text or _manoeuvre(reason)
    if text is None:
        text = f"the plan was rejected ({reason})" if reason.startswith("solver") else reason
    return {"text": text, "infeasible": infeasible}


def _manoeuvre(name: str) -> str | None:
    """Return why the planning MPC chose a manoeuvre.

    The result is None if the word is not one of its manoeuvres.
    """
    aimed = _AIMED.fullmatch(name)
    if aimed is None:
        return _MANOEUVRES.get(name)
    if float(aimed["rate"].split()[0]) == 0.0:
        return "keeping the speed costs least"
    return f"slowing down to {aimed['speed']} at {aimed['rate'].lstrip('-')} costs least"


def events(
    rows: pd.DataFrame, met: pd.DataFrame, config: EgoRunConfig, sights: pd.DataFrame
) -> list[dict[str, Any]]:
    """Return the events on the time line, in the order of time.

    Args:
        rows: Rows of this ego in ``ego.csv``.
        met: Rows of this ego in ``pedestrians.csv``.
        config: Configuration of this ego.
        sights: Rows of this ego in ``sights.csv``.

    Returns:
        For each event its ``kind``, ``from`` and ``to`` [s], a ``text``, and ``who``: the people
        met.
    """
    time = rows["time"].to_numpy(dtype=np.float64)
    found = []
    for start, end in _phases(rows["speed"].to_numpy() < config.record.stop_speed, time):
        found.append(_event("stop", start, end, f"stands for {end - start:.1f} s"))
    for acting in ("pid", "safety") if config.optimises else ("safety",):
        for start, end in _phases(rows["controller"].to_numpy() == acting, time):
            at = int(np.searchsorted(time, start))
            told = why(str(rows["reason"].iloc[at]), str(rows["solver_status"].iloc[at]))
            found.append(_event(acting, start, end, told["text"]))
    found += [*_encounters(met), *_first_sights(sights, float(time[0]))]
    return sorted(found, key=lambda event: (event["from"], event["to"], event["kind"]))


def _encounters(met: pd.DataFrame) -> Iterator[dict[str, Any]]:
    """Yield the closest approach of all, and every pedestrian whom the ego touched."""
    if not {"id", "minimum_clearance", "time_of_minimum_clearance"} <= set(met):
        return
    known = met.dropna(subset=["minimum_clearance", "time_of_minimum_clearance"])
    if not len(known):
        return
    closest = known["minimum_clearance"].idxmin()
    for index, row in known.iterrows():
        clearance, at = float(row["minimum_clearance"]), float(row["time_of_minimum_clearance"])
        if clearance < 0.0:
            text = f"overlaps with {row['id']} by {-clearance:.2f} m"
            yield _event("overlap", at, at, text, str(row["id"]))
        elif index == closest:
            text = f"closest approach: {clearance:.2f} m to {row['id']}"
            yield _event("closest", at, at, text, str(row["id"]))


def _first_sights(sights: pd.DataFrame, departure: float) -> Iterator[dict[str, Any]]:
    """Yield the first sight of the people who come in sight during the drive, the nearest ones."""
    if not len(sights):
        return
    first = sights.drop_duplicates("id")
    nearest = first[first["time"] > departure].nsmallest(_MOST_SIGHTS, "distance")
    for who, at, distance in nearest[["id", "time", "distance"]].to_numpy():
        what = "false detection" if str(who).startswith(FALSE) else "in sight"
        yield _event("sight", at, at, f"{what}, {distance:.1f} m from the front: {who}", str(who))


def _event(kind: str, start: float, end: float, text: str, who: str = "") -> dict[str, Any]:
    return {"kind": kind, "from": round(start, 6), "to": round(end, 6), "text": text, "who": who}


def _phases(active: NDArray[np.bool_], time: NDArray[np.float64]) -> Iterator[tuple[float, float]]:
    """Yield start and end [s] of each active phase.

    A command holds until the next instant.
    """
    edges = np.flatnonzero(np.diff(np.concatenate(([False], active, [False])).astype(np.int8)))
    for start, end in zip(edges[::2], edges[1::2], strict=True):
        yield float(time[start]), float(time[min(end, len(time) - 1)])
