"""The command ``giveway data behave``: simulated people compared with recorded ones.

The recordings of a data set with a corridor are compared in it, all others near vehicles.
"""

from functools import partial
from pathlib import Path

import pandas as pd
from rich.console import Console
from rich.table import Column, Table

from giveway.cli.screen.printing import escape, numbers_of, print_place
from giveway.cli.screen.recordings import cite, counted, read
from giveway.config import RunConfig
from giveway.config.files.presets import parameters_of, require_steady_preset
from giveway.config.plug_in_names import BUNDLED_MODELS
from giveway.errors import ConfigError, retold, suggestion
from giveway.precompile import compile_kernels_once
from giveway.recordings import dataset_of
from giveway.results.folder import check_folder
from giveway.validation.behaviour import Comparison, compare
from giveway.validation.behaviour.comparison import DRAWS, HALVES, RECORDED, SEED, SIMULATED
from giveway.validation.behaviour.measures import MEASURES
from giveway.validation.behaviour.output import FILES, write_behaviour
from giveway.validation.corridors import BAR, InCorridors, compare_in_corridors
from giveway.validation.corridors.output import CORRIDOR_FILES, write_corridors
from pedestrian_model import LONGEST_STEP, PedestrianModelError


def behave_command(
    folder: Path,
    dataset: str | None,
    model: str,
    preset: str,
    out: Path | None,
    *,
    force: bool,
    quiet: bool,
) -> None:
    """Read recordings, simulate their people, print the comparison, and write it.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=quiet)
    described = dataset_of(dataset)
    if model not in BUNDLED_MODELS:
        raise ConfigError(f"--model {model}: unknown model; {suggestion(model, BUNDLED_MODELS)}")
    parameters_of(preset)
    require_steady_preset(preset, LONGEST_STEP, "--preset")
    if out is not None:
        ours = FILES | CORRIDOR_FILES
        check_folder(out, force=force, ours=ours, writer="giveway data behave")
    config = RunConfig.model_validate({"crowd": {"model": model, "preset": preset}})
    recordings = read(console, folder, described)
    compile_kernels_once(console)
    title = f"{described.name}, {model}" + (f", {preset}" if model == "vci" else "")
    with (
        counted(console, "Simulating", len(recordings)) as advance,
        retold(PedestrianModelError, ConfigError),
    ):
        if described.corridor is None:
            near = compare(recordings, config, advance)
            tables = [_distributions(near, title), _counts(near)]
            write = partial(write_behaviour, near, title)
        else:
            inside = compare_in_corridors(recordings, config, advance)
            tables = [_corridors(inside, title)]
            write = partial(write_corridors, inside, title)
    for table in tables:
        console.print(table)
    cite(console, described)
    if out is not None:
        with console.status("Drawing ..."):
            write(out)
        print_place(console, "Tables and picture", out)


def _corridors(found: InCorridors, title: str) -> Table:
    rows, names, free = found.table, found.flows.index, pd.Series(found.free)
    table = Table(
        *numbers_of("recorded", "simulated", "difference", f"within {BAR:.0%}"),
        title=escape(f"{title}: {len(free)} people in {len(names)} corridors"),
        caption=escape(
            "mean speed [m/s] per density, flow [1/s] through the exit; people are simulated "
            f"{DRAWS} times; within {BAR:.0%}: {rows['within_bar'].sum()} of {len(rows)}; "
            f"people ever free: {free.count()}, at {_number(free.mean(), 2)} ± "
            f"{_number(free.std(ddof=0), 2)} m/s; recordings left out: {found.read - len(names)}"
        ),
    )
    for row in rows.to_dict("records"):
        table.add_row(
            escape(f"{row['measure']}, {row['of']}"),
            *(_number(row[who], 2) for who in (RECORDED, SIMULATED)),
            _number(100.0 * row["difference"], 0) + " %",
            "yes" if row["within_bar"] else "no",
        )
    return table


def _distributions(found: Comparison, title: str) -> Table:
    columns = numbers_of(RECORDED, SIMULATED, "W1", "floor", "ratio")
    table = Table(
        Column(no_wrap=True),
        *columns[1:],
        title=escape(f"{title}: {found.near} people near a vehicle, {_clips(found)}"),
        caption=(
            "medians; speed, acceleration: within 3 m of a moving vehicle; W1: the "
            "Wasserstein-1 distance; floor: its mean between two halves of the "
            f"{found.near} recorded people, {HALVES} times, seed {SEED}; people are simulated "
            f"{DRAWS} times"
        ),
    )
    for number, each in enumerate(found.distributions):
        if number == len(MEASURES):
            table.add_section()
            table.add_row("mean of the six ratios", "", "", "", "", _number(found.mean_ratio, 2))
            table.add_section()
        table.add_row(
            escape(f"{each.measure.title} [{each.measure.unit}]"),
            *(_number(median, 2) for median in each.medians),
            *(_number(value, 3) for value in (each.distance, each.floor)),
            _number(each.ratio, 2),
        )
    return table


def _clips(found: Comparison) -> str:
    return "1 clip" if found.recordings == 1 else f"{found.recordings} clips"


def _counts(found: Comparison) -> Table:
    table = Table(*numbers_of(RECORDED, SIMULATED), title="Near recorded vehicles")
    recorded, simulated = found.counts[RECORDED], found.counts[SIMULATED]
    both = (recorded, simulated)
    table.add_row(f"contacts, of {found.people} people", *(f"{each.contacts:g}" for each in both))
    table.add_row(
        f"close passes, of {recorded.pairs} pairs within 4 m",
        *(f"{each.close:g} ({each.close_share:.1%})" for each in both),
    )
    table.add_row("the person goes first, of those who cross", *(f"{e.first:.0%}" for e in both))
    table.add_row(
        escape("95 % of accelerations are below [m/s^2]"),
        *(_number(each.acceleration, 2) for each in both),
    )
    return table


def _number(value: float, decimals: int) -> str:
    return f"{value:.{decimals}f}" if value == value else "-"  # nan is not there
