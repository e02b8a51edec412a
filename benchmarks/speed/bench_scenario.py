"""The cost of a city full of walkers: each part of the loop, next to plain SUMO's own step.

    python benchmarks/speed/bench_scenario.py [--walkers N ...] [--profile | --hour]

Grid cities of constant density are built on the spot: 100 m blocks with sidewalks, crossings,
walkingareas and traffic lights, ten walkers and one car per street. All walkers are taken over
(zone everywhere), an ego drives through by MPC. Plain SUMO runs the same scenario by itself
afterwards, in the same process over the same simulated time. Building, loading, taking everybody
over and warming up are not timed; those who depart, arrive and get stuck meanwhile are.
"""

from __future__ import annotations

import argparse
import cProfile
import os
import pstats
import resource
import sys
import tempfile
from collections import defaultdict
from contextlib import ExitStack
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import TYPE_CHECKING, Any, NamedTuple
from unittest import mock

import libsumo
import numpy as np

from giveway.api import RunResult, simulate
from giveway.config.files.layers import Layer
from giveway.config.files.loading import load
from giveway.cosimulation.mirror import Mirror
from giveway.cosimulation.preflight import preflight
from giveway.cosimulation.traffic.yielding import Yielding
from giveway.crowd.exchange import Exchange
from giveway.run_data.tracks import Timings
from giveway.sumo.session import SumoSession

sys.path.append(str(Path(__file__).resolve().parents[1] / "law"))
from cities import City, build_city

if TYPE_CHECKING:
    from collections.abc import Callable

WARM_UP = 5.0  # [s] simulated, from the first instant on
WINDOW = 10.0  # [s] simulated, timed
SPLIT = {  # what the loop's own table lumps together as SUMO's
    "sumo step": (libsumo.libsumo._libsumo, "simulation_step"),  # what the session calls
    "moves": (SumoSession, "mirror"),
    "check": (SumoSession, "_check"),
    "vehicles": (Mirror, "read"),
    "exchange": (Exchange, "update"),
    "yielding": (Yielding, "update"),
}


class Case(NamedTuple):
    """One city and how it is run."""

    walkers: int
    step_length: float  # [s] SUMO's
    walls: bool


CASES = (
    Case(100, 0.1, False),
    Case(1_000, 0.1, False),
    Case(3_000, 0.1, False),
    Case(10_000, 0.1, False),
    Case(100, 0.1, True),
    Case(1_000, 0.1, True),
    Case(3_000, 0.1, True),
    Case(10_000, 0.1, True),
    Case(3_000, 0.05, False),
    Case(3_000, 1.0, False),
)


# --- runs -----------------------------------------------------------------------------------------


class Stopwatch:
    """Adds up the time spent in some functions, while a run lets it."""

    def __init__(self, stack: ExitStack) -> None:
        self.spent: dict[str, float] = defaultdict(float)
        for label, (owner, attribute) in SPLIT.items():
            timed = self._timed(label, getattr(owner, attribute))
            stack.enter_context(mock.patch.object(owner, attribute, timed))

    def _timed(self, label: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def timed(*arguments: Any, **keywords: Any) -> Any:
            began = perf_counter()
            result = function(*arguments, **keywords)
            self.spent[label] += perf_counter() - began
            return result

        return timed

    def split(self, steps: int) -> dict[str, float]:
        """Seconds per control step; moves without the step and the check that they enclose."""
        spent = {label: self.spent[label] / steps for label in SPLIT}
        spent["moves"] -= spent["sumo step"] + spent["check"]
        return spent


class Timed(NamedTuple):
    """A run of giveway's, after its warm-up."""

    result: RunResult
    steps: int
    per_step: float  # [s] mean
    parts: dict[str, float]  # [s] per control step
    split: dict[str, float]  # [s] per control step


def run(city: City, case: Case, window: float, profile: cProfile.Profile | None = None) -> Timed:
    """Run giveway on the city."""
    settings: dict[str, Any] = {
        "scenario": str(city.config_file),
        "controller": "mpc-paper",
        "time_limit": WARM_UP + window,
        "sumo": {"step_length": case.step_length},
        "ego": {"route": city.ego_route.split(","), "depart_position": 6.0},
        "crowd": {"zone": "everywhere", "walls": case.walls},
    }
    checked = preflight(*load([Layer("", settings)]))
    clock: list[float] = []
    with ExitStack() as stack:
        watch = Stopwatch(stack)

        def watcher(progress: Any) -> None:
            if progress.time >= WARM_UP - 1e-6:
                if not clock:
                    watch.spent.clear()
                    if profile is not None:
                        profile.enable()
                clock.append(perf_counter())

        result = simulate(checked, watcher)
    if profile is not None:
        profile.disable()
    if result.error is not None:
        raise result.error
    steps = len(clock) - 1
    seconds = result.timings.seconds[-steps:]
    parts = dict(zip(Timings.NAMES, seconds.mean(axis=0).tolist(), strict=True))
    return Timed(result, steps, (clock[-1] - clock[0]) / steps, parts, watch.split(steps))


def plain(city: City, case: Case, window: float) -> float:
    """Seconds per simulated second that SUMO needs for the same time by itself."""
    libsumo.start(
        ["sumo", "-c", str(city.config_file), "--no-step-log", "--duration-log.disable"]
        + ["--no-warnings", "--step-length", str(case.step_length)]
    )
    while libsumo.simulation.getTime() < WARM_UP - 1e-6:
        libsumo.simulationStep()
    steps = round(window / case.step_length)
    began = perf_counter()
    for _ in range(steps):
        libsumo.simulationStep()
    spent = perf_counter() - began
    libsumo.close()
    return spent / window


# --- what is printed ------------------------------------------------------------------------------


def report(case: Case, timed: Timed, alone: float) -> None:
    """Three lines."""
    h = float(median(np.diff(timed.result.time)))
    walking = timed.result.manifest["pedestrians"]["walking"]
    per_second = timed.per_step / h
    us = {label: 1e6 * value for label, value in (timed.parts | timed.split).items()}
    inside = sum(us[label] for label in timed.split)
    print(
        f"{walking:6} walkers, SUMO step {case.step_length:g} s, "
        f"walls {'on' if case.walls else 'off':3}: "
        f"{1e3 * timed.per_step:7.3f} ms per control step of {h:g} s; real-time factor "
        f"{1.0 / per_second:6.1f}; {1e6 * timed.per_step / max(walking, 1):5.2f} us per walker; "
        f"{per_second / alone:4.1f} x plain SUMO ({1e3 * alone:.1f} ms per simulated s)"
    )
    rest = us["total"] - sum(us[part] for part in Timings.NAMES[:-1])
    print("    " + "  ".join(f"{part} {us[part]:.0f}" for part in Timings.NAMES[:-1]), end="")
    print(f"  recording {rest:.0f}   [us per control step]")
    print("    of sumo: " + "  ".join(f"{label} {us[label]:.0f}" for label in timed.split), end="")
    print(f"  other {us['sumo'] - inside:.0f}", flush=True)


def hour(folder: Path) -> None:
    """One simulated hour with 1,000 walkers at SUMO's step of 1 s: memory and rows."""
    city = build_city(folder, 1_000)
    used: list[float] = []
    case = Case(1_000, 1.0, False)
    settings: dict[str, Any] = {
        "scenario": str(city.config_file),
        "time_limit": 3600.0,
        "sumo": {"step_length": case.step_length},
        "ego": {"none": True},
        "crowd": {"zone": "everywhere"},
    }
    checked = preflight(*load([Layer("", settings)]))

    def watcher(progress: Any) -> None:
        if len(used) <= progress.time / 300.0:
            used.append(resident())

    began = perf_counter()
    result = simulate(checked, watcher)
    spent = perf_counter() - began
    if result.error is not None:
        raise result.error
    rows = len(result.crowd_track.x)
    print(f"{spent:.0f} s for 3600 s; {rows} crowd rows, {48e-6 * rows:.0f} MB of them")
    print(f"    {len(result.background_track.x)} rows of cars; {result.manifest['pedestrians']}")
    print("    resident MB every 5 min: " + " ".join(f"{mb:.0f}" for mb in used))
    print(f"    peak {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")


def resident() -> float:
    """Megabytes of this process in memory."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--walkers", type=int, nargs="*", help="only cities of these sizes")
    parser.add_argument("--window", type=float, default=WINDOW, help="simulated seconds timed")
    parser.add_argument("--profile", action="store_true", help="where Python's time goes")
    parser.add_argument("--hour", action="store_true", help="one simulated hour: memory")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        if options.hour:
            hour(Path(scratch))
            return
        cities: dict[int, City] = {}
        run_cases = [c for c in CASES if not options.walkers or c.walkers in options.walkers]
        for case in run_cases:
            if case.walkers not in cities:
                folder = Path(scratch) / str(case.walkers)
                folder.mkdir()
                cities[case.walkers] = build_city(folder, case.walkers)
            profile = cProfile.Profile() if options.profile else None
            timed = run(cities[case.walkers], case, options.window, profile)
            report(case, timed, plain(cities[case.walkers], case, options.window))
            if profile is not None:
                pstats.Stats(profile).sort_stats("tottime").print_stats(30)


if __name__ == "__main__":
    main()
