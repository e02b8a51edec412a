"""Print docs/validation.md's tables: every bundled model and preset beside recorded people.

    python benchmarks/tuning/behaviour_tables.py CITR_FOLDER --dataset citr
    python benchmarks/tuning/behaviour_tables.py HERMES_FOLDER --dataset hermes
    python benchmarks/tuning/behaviour_tables.py HERMES_FOLDER --dataset hermes --speeds 1.48 0.19
    python benchmarks/tuning/behaviour_tables.py --corridors

The first compares simulated with recorded people as ``giveway data behave`` does. The next two do
so in corridors, with desired speeds of this mean and deviation [m/s]. The last one lets people walk
in periodic corridors, one way and both ways: their speeds beside Weidmann's, and the order
parameter of lanes. JuPedSim's models are left out if they are not installed (extra ``jupedsim``),
and of the periodic corridors, whose people have images.
"""

import argparse
from importlib.util import find_spec
from pathlib import Path

import pandas as pd

from giveway.config import RunConfig
from giveway.config.plug_in_names import BUNDLED_MODELS
from giveway.crowd.models import model_of
from giveway.crowd.roster import Roster
from giveway.recordings import dataset_of, read_recordings
from giveway.validation.behaviour.comparison import DRAWS, RECORDED, Yardstick, counts_of
from giveway.validation.behaviour.corridor import DENSITIES, FREE_SPEEDS, walk, weidmann
from giveway.validation.behaviour.measures import ALL, MEASURES, together
from giveway.validation.corridors import compare_in_corridors
from pedestrian_model import JUPEDSIM_MODELS, PRESETS

_STEP = 0.05  # Time step [s] in the corridors
_ONE_WAY, _BOTH_WAYS = 40.0, 120.0  # Times [s] in the corridors
_SKIPPED = set() if find_spec("jupedsim") else JUPEDSIM_MODELS
_OTHERS = sorted({*BUNDLED_MODELS} - {"vci", RECORDED, *_SKIPPED})
CROWDS = {f"`vci`, {name}": {"preset": name} for name in PRESETS} | {
    f"`{name}`": {"model": name} for name in _OTHERS
}
"""Table of the configuration of each crowd that is compared."""


def compared(folder: Path, dataset: str) -> None:
    """Print a row for the recorded people and for each crowd."""
    site = Yardstick(read_recordings(folder, dataset_of(dataset)))
    print(
        "| |", " | ".join(each.title for each in ALL), "| mean of six | close | contacts | 95 % |"
    )
    print("|---" * (len(ALL) + 5) + "|")
    real = counts_of([site.recorded])
    print("| recorded |" + " |" * (len(ALL) + 1), _counted(real))
    for name, crowd in CROWDS.items():
        draws = site.simulated(RunConfig.model_validate({"crowd": crowd}), DRAWS)
        ratios = site.ratios(together(draws))
        mean = sum(ratios[each.name] for each in MEASURES) / len(MEASURES)
        row = " | ".join(f"{ratios[each.name]:.2f}" for each in ALL)
        print(f"| {name} | {row} | {mean:.2f} |", _counted(counts_of(draws)), flush=True)


def _counted(counts: object) -> str:
    share, contacts = counts.close_share, counts.contacts
    return f"{share:.1%} | {contacts:g} | {counts.acceleration:.2f} |"


def in_corridors(folder: Path, dataset: str, speeds: list[float]) -> None:
    """Print a row of speeds and flows for each crowd; those outside of the bar are bold."""
    recordings = read_recordings(folder, dataset_of(dataset))
    for number, (name, crowd) in enumerate(CROWDS.items()):
        config = RunConfig.model_validate({"crowd": crowd})
        table = compare_in_corridors(recordings, config, speeds=tuple(speeds)).table
        if not number:
            print("| |", " | ".join(table["of"]), "| within |")
            print("|---" * (len(table) + 2) + "|")
            print("| recorded |", " | ".join(table["recorded"].map("{:.2f}".format)), "| |")
        told = table["simulated"].map("{:.2f}".format).where(table["within_bar"], _bold)
        told[table["simulated"].isna()] = "-"
        within = f"{table['within_bar'].sum()} of {len(table)}"
        print(f"| {name} |", " | ".join(told), f"| {within} |", flush=True)


def _bold(values: pd.Series) -> pd.Series:
    return "**" + values + "**"


def corridors() -> None:
    """Print the speeds and lanes of each crowd."""
    print("| |", " | ".join(f"{density:g} /m^2" for density in DENSITIES), "| lanes |")
    print("|---" * (len(DENSITIES) + 2) + "|")
    print("| Weidmann |", " | ".join(f"{speed:.2f}" for speed in weidmann()), "| |")
    for name, crowd in CROWDS.items():
        if crowd.get("model") in JUPEDSIM_MODELS:
            continue
        config = RunConfig.model_validate({"crowd": crowd})
        model = model_of(config, _STEP, Roster(()))
        speeds = walk(model, _ONE_WAY).speed
        lanes = walk(model, _BOTH_WAYS, both_ways=True).lanes
        told = " | ".join(f"{speed:.2f}" for speed in speeds)
        print(f"| {name} | {told} |", ", ".join(f"{each:.2f}" for each in lanes), "|", flush=True)


def main() -> None:
    """Print the tables that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="?", help="folder of the recordings")
    parser.add_argument("--dataset", help="name or description of the data set")
    parser.add_argument("--speeds", type=float, nargs=2, default=[*FREE_SPEEDS], help="desired")
    parser.add_argument("--corridors", action="store_true", help="people alone in corridors")
    chosen = parser.parse_args()
    if chosen.corridors:
        corridors()
    elif chosen.folder and chosen.dataset and dataset_of(chosen.dataset).corridor:
        in_corridors(chosen.folder, chosen.dataset, chosen.speeds)
    elif chosen.folder and chosen.dataset:
        compared(chosen.folder, chosen.dataset)
    else:
        parser.error("name a folder with --dataset, or --corridors")


if __name__ == "__main__":
    main()
