"""The fit for behaviour of ``giveway calibrate``: what it prints, and what it says of itself."""

from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from giveway._version import __version__
from giveway.cli.option_groups import FitSettings
from giveway.cli.screen.printing import escape, numbers_of
from giveway.cli.screen.progress_bars import counting
from giveway.cli.screen.recordings import read
from giveway.config.files.presets import parameters_of, require_steady_preset
from giveway.precompile import compile_kernels_once
from giveway.recordings import Dataset
from giveway.validation.behaviour.comparison import Yardstick
from giveway.validation.behaviour.corridor import DENSITIES, weidmann
from giveway.validation.behaviour.loss import lost
from giveway.validation.behaviour.objective import Likeness, Objective
from giveway.validation.behaviour.search import (
    DEFAULT,
    Found,
    Journal,
    Search,
    require_fittable,
)
from pedestrian_model import LONGEST_STEP, VciParameters

_EVALUATIONS = 1500
_JUDGES = 5  # Number of times that people are simulated to judge the fit
_MORE_CONTACTS = 0.02  # Share of the people near a vehicle who may touch it in addition


def journal_of(preset: Path) -> Path:
    """Return the file that keeps the values of a fit until its preset is written."""
    return preset.with_suffix(".journal")


def fit_behaviour(
    console: Console, places: list[tuple[Path, Dataset]], fit: FitSettings, out: Path
) -> tuple[VciParameters, dict[str, Any], list[str]]:
    """Fit, print the comparison before and after; return parameters, provenance, what is worse.

    A journal beside the preset keeps the values, so that the same command goes on after a kill.

    Args:
        console: Console.
        places: Folder and data set of each site.
        fit: Settings of the fit.
        out: Preset file; the journal is named after it.

    Raises:
        GivewayError: one line that says what to do.
    """
    require_steady_preset(fit.start, LONGEST_STEP, "--preset")
    start = parameters_of(fit.start)
    names = [name.strip() for name in fit.parameters.split(",")] if fit.parameters else [*DEFAULT]
    require_fittable(names)
    sites = [Yardstick(read(console, *place)) for place in places]
    search = Search(
        Objective(sites),
        start,
        names,
        seed=fit.seed,
        evaluations=fit.evaluations or _EVALUATIONS,
    )
    compile_kernels_once(console)
    settings = __version__, start, names, fit.seed, [(site.names, site.floors) for site in sites]
    journal = Journal(journal_of(out), settings)
    if journal.known:
        console.print(f"{journal.known} evaluations are known from an earlier call.")
    with counting(console, "Fitting") as count:
        found = search.run(journal, lambda done, of, best: count(done, of, f"value {best:.3f}"))
    judge = Objective(sites, _JUDGES)
    labels = [f"{dataset.name} {folder.name}" for folder, dataset in places]
    before, after = judge.likenesses(start), judge.likenesses(found.parameters)
    speeds = judge.speeds(start), judge.speeds(found.parameters)
    _print_parameters(console, start, found, names)
    for label, *pair in zip(labels, before, after, strict=True):
        console.print(_likenesses(label, *pair))
    console.print(_corridors(*speeds))
    provenance = {
        "start": fit.start,
        "seed": fit.seed,
        "fitted": list(names),
        "objective": "likeness to recorded people near vehicles, and Weidmann's speeds",
        "datasets": [dataset.name for _, dataset in places],
        "recordings": sorted({name for site in sites for name, _ in site.names}),
        "citations": sorted({d.citation for _, d in places if d.citation}),
        "value": round(found.value, 4),
        "evaluations": found.evaluations,
        "at_bound": list(found.at_bound),
        "spread_of_the_logarithm": {n: round(v, 4) for n, v in found.spread.items()},
        **{f"mean_ratio_{i}": round(each.mean, 3) for i, each in enumerate(after, 1)},
        "corridor_speeds": [round(float(speed), 3) for speed in speeds[1]],
    }
    return found.parameters, provenance, _worse(start, found.parameters, before, after)


def _worse(
    start: VciParameters, fitted: VciParameters, before: list[Likeness], after: list[Likeness]
) -> list[str]:
    """Return a sentence for each thing that the fit makes worse."""
    worse = lost(start, fitted)
    for then, now in zip(before, after, strict=True):
        most = max(then.simulated.contacts, now.recorded.contacts) + _MORE_CONTACTS * now.near
        if now.simulated.contacts > most:
            worse.append(
                f"{now.simulated.contacts:.1f} people touch a recorded vehicle, "
                f"{then.simulated.contacts:.1f} before the fit and {now.recorded.contacts:g} "
                "recorded ones."
            )
    return worse


def _print_parameters(
    console: Console, start: VciParameters, found: Found, names: list[str]
) -> None:
    table = Table(*numbers_of("before", "after"), title="Parameters")
    for name in names:
        before, after = (getattr(p, name) for p in (start, found.parameters))
        table.add_row(name, f"{before:.5g}", f"{after:.5g}")
    console.print(table)
    if found.at_bound:
        console.print(
            f"At the end of their range: {', '.join(found.at_bound)}: the data do not determine "
            "them.",
            highlight=False,
        )


def _likenesses(label: str, before: Likeness, after: Likeness) -> Table:
    table = Table(*numbers_of("recorded", "before", "after"), title=escape(label))
    for name, ratio in after.ratios.items():
        row = (f"{each:.2f}" for each in (before.ratios[name], ratio))
        table.add_row(f"{name}, distance over its floor", "1", *row)
    table.add_row("mean of the six", "1", f"{before.mean:.2f}", f"{after.mean:.2f}")
    table.add_section()
    counts = after.recorded, before.simulated, after.simulated
    table.add_row("contacts", *(f"{each.contacts:.1f}" for each in counts))
    table.add_row("close passes", *(f"{each.close_share:.1%}" for each in counts))
    table.add_row("the person goes first", *(f"{each.first:.0%}" for each in counts))
    table.add_row(
        escape("95 % of accelerations below [m/s^2]"),
        *(f"{each.acceleration:.2f}" for each in counts),
    )
    return table


def _corridors(before: Any, after: Any) -> Table:
    table = Table(
        *numbers_of("Weidmann", "before", "after"), title=escape("Speed [m/s] in a corridor")
    )
    for density, *speeds in zip(DENSITIES, weidmann(), before, after, strict=True):
        table.add_row(f"{density:g} /m^2", *(f"{speed:.2f}" for speed in speeds))
    return table
