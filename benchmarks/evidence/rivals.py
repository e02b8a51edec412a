"""Makes the kept numbers of the benchmark's rivals anew, and the table of docs/benchmark.md.

Run: python benchmarks/evidence/rivals.py --out runs/rivals [--controller mpc] [--jobs 1]

It runs ``giveway benchmark`` for each of them, writes their rows into
``giveway/studies/benchmark/rivals.csv`` with the commit of the code, and prints the table. With
``--controller`` the rows of the others stay as they are. It can be ended and resumed.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import pandas as pd
from blocks import present_version, write_block
from digests import HOUSE
from tables import header, row

from giveway.studies.benchmark import (
    ALL_SCENES,
    COLUMNS,
    ORIGIN,
    Notation,
    benchmark_of,
    bounded,
    number,
    texts,
    write_benchmark,
)
from giveway.studies.benchmark import rivals as kept_rivals
from giveway.studies.definition import changed
from giveway.studies.study import run_study
from giveway.studies.study_options import StudyOptions

RIVALS = {
    "mpc": ("mpc", None, ""),
    "mpc careful": ("mpc", None, "careful"),
    "mpc assertive": ("mpc", None, "assertive"),
    "pid-tuned": ("pid-tuned", None, ""),
    "idm": ("idm", None, ""),
    "careful-driver": ("careful-driver", None, ""),
    "bilevel": ("controller.reference_drivers.bilevel:BilevelMpc", 20, ""),
}
"""Controller of each rival, its drives of each scene if they are fewer than the benchmark's, and
its driving style if it has one."""
KEPT = HOUSE / "giveway" / "studies" / "benchmark" / "rivals.csv"
PAGE, BLOCK = HOUSE / "docs" / "benchmark.md", "rivals"
FRONT = HOUSE / "docs" / "cookbook.md", "front"
OF_PAGE = Notation(", ", " of ", "-")


def made(name: str, out: Path, jobs: int, runs: int | None) -> pd.DataFrame:
    """The rows of one rival, with the commit of the code that drove."""
    controller, few, style = RIVALS[name]
    settings = None
    if style:
        settings = out / f"{style}.toml"
        out.mkdir(parents=True, exist_ok=True)
        settings.write_text(f'[controller_options]\nstyle = "{style}"\n', encoding="utf-8")
    definition = benchmark_of([controller], settings)
    runs = runs or few
    if runs is not None:
        definition = changed(definition, {"replications": runs}, ORIGIN)
    folder = out / name
    options = StudyOptions(jobs=jobs, resume=(folder / "manifest.json").exists())
    frame = write_benchmark(run_study(definition, ORIGIN, folder, options))
    commit, date = present_version()
    frame["controller"] = name
    frame["made_with"] += f" at {commit} ({date})"
    return frame


def merged(kept: pd.DataFrame, new: pd.DataFrame) -> pd.DataFrame:
    """The kept rows, of which those of the new controllers are replaced, in the order of RIVALS."""
    whole = pd.concat([kept[~kept["controller"].isin(new["controller"])], new], ignore_index=True)
    order = whole["controller"].map({name: i for i, name in enumerate(RIVALS)})
    whole = whole.iloc[order.argsort(kind="stable")]
    counts = [column.name for column in COLUMNS if column.type == "integer"]
    return whole.astype(dict.fromkeys(counts, "Int64")).reset_index(drop=True)


def table(rivals: pd.DataFrame) -> list[str]:
    """Markdown: a row for each rival and people, all scenes together, and the recorded drivers."""
    titles = ["people", "driver", "close [%]", "near a moving one [%]", "close, tight, narrow",
              "people's delay [s]", "serious conflicts", "time [s]", "hard brakings",
              "RMS jerk [m/s³]", "front, side", "arrived"]  # fmt: skip
    lines = header(titles)
    wanted = rivals[(rivals["scene"] == ALL_SCENES) | (rivals["people"] == "recorded")]
    for one in wanted.sort_values("people", kind="stable").to_dict("records"):
        lines.append(row([one["people"], one["controller"], *texts(one, OF_PAGE)]))
    return lines


def front(rivals: pd.DataFrame) -> list[str]:
    """Markdown: closeness, time and people's delay of each driver among people of MIXED."""
    lines = header(["driver", "close passes [%]", "time [s]", "people's delay [s]", "RMS jerk"])
    wanted = rivals[(rivals["scene"] == ALL_SCENES) & (rivals["people"] == "MIXED")]
    wanted = wanted.sort_values("close_pass_share", kind="stable")
    for one in wanted.to_dict("records"):
        columns = ("close_pass_share", 100.0), ("time",), ("people_delay", 1.0, 2)
        told = [bounded(one, *column, missing=OF_PAGE.missing) for column in columns]
        jerk = number(one["rms_jerk"], 1, OF_PAGE.missing)
        lines.append(row([f"`{one['controller']}`", *told, jerk]))
    return lines


def write_page(rivals: pd.DataFrame, lines: list[str]) -> None:
    """Write the table into its page, with the version of each rival's rows."""
    commit, date = present_version()
    made_with = rivals.groupby("controller", sort=False)["made_with"].first()
    of_each = "; ".join(f"`{name}`: {text}" for name, text in made_with.items())
    command = "`python benchmarks/evidence --kept benchmark`"
    write_block(PAGE, BLOCK, lines, f"Kept: {command}. Commit {commit} ({date}); {of_each}.")
    write_block(*FRONT, front(rivals), f"Kept: {command}. Commit {commit} ({date}).")


def main() -> int:
    """Make the rows that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True, help="folder that keeps the drives")
    parser.add_argument("--controller", action="append", choices=RIVALS, help="this one alone")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--runs", type=int, help="drives of each scene; then nothing is written")
    parser.add_argument("--page", action="store_true", help="write docs/benchmark.md, too")
    parser.add_argument(
        "--front", action="store_true", help="print the cookbook's table of kept rows"
    )
    asked = parser.parse_args()
    if asked.front:
        print("\n".join(front(kept_rivals())))
        return 0
    wanted = asked.controller or RIVALS
    new = pd.concat([made(name, asked.out, asked.jobs, asked.runs) for name in wanted])
    kept = kept_rivals()
    recorded = kept[kept["people"] == "recorded"]
    whole = merged(kept.drop(recorded.index), new)
    lines = table(pd.concat([whole, recorded], ignore_index=True))
    if asked.runs is None:
        KEPT.write_text(whole.to_csv(index=False, lineterminator="\n"), encoding="utf-8")
        if asked.page:
            write_page(whole, lines)
    print("\n".join(lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
