"""The command ``giveway data behave``: simulated people compared with recorded ones."""

from pathlib import Path

from rich.console import Console
from rich.table import Column, Table

from giveway.cli.screen.printing import escape, numbers_of, print_place
from giveway.cli.screen.recordings import cite, counted, read
from giveway.config import RunConfig
from giveway.config.files.layers import Layer, build_config
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
    config = config_of(model, preset)
    if out is not None:
        check_folder(out, force=force, ours=FILES, writer="giveway data behave")
    recordings = read(console, folder, described)
    compile_kernels_once(console)
    with (
        counted(console, "Simulating", len(recordings)) as advance,
        retold(PedestrianModelError, ConfigError),
    ):
        found = compare(recordings, config, advance)
    title = f"{described.name}, {called(model, preset)}"
    console.print(_distributions(found, title))
    console.print(_counts(found))
    cite(console, described)
    if out is not None:
        with console.status("Drawing ..."):
            write_behaviour(found, title, out)
        print_place(console, "Tables and picture", out)


def config_of(model: str, preset: str, **crowd: float) -> RunConfig:
    """Return the configuration of a crowd that ``--model`` and ``--preset`` name.

    Args:
        model: Name of a bundled pedestrian model.
        preset: Preset of VCI.
        crowd: Other keys of [crowd], by flags of their names.

    Raises:
        ConfigError: a value cannot be used, or people tremble with the preset.
    """
    if model not in BUNDLED_MODELS:
        raise ConfigError(f"--model {model}: unknown model; {suggestion(model, BUNDLED_MODELS)}")
    parameters_of(preset)
    require_steady_preset(preset, LONGEST_STEP, "--preset")
    values = {"crowd": {"model": model, "preset": preset, **crowd}}
    return build_config([Layer("command line", values, from_flags=True)])


def called(model: str, preset: str) -> str:
    """Return how titles call a crowd."""
    return f"{model}, {preset}" if model == "vci" else model


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
