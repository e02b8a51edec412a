"""Does giveway stay civil, whatever it is given? A campaign of mutated inputs tells.

    python benchmarks/tools/campaign.py --seed 3001-3005 --count 1000 --out FOLDER [--again]
    python benchmarks/tools/campaign.py --seed 1 --kind replay --count 150 --out FOLDER
    python benchmarks/tools/campaign.py --seed 1 --only 1234 --out FOLDER

Scenarios, settings, studies, vehicle profiles, FMUs, trajectories, presets, the records of a
study, results of runs and journals are mutated, and the command that reads them is run. It is civil
if it does what was asked, or says in one line why not. It is not if it ends with a traceback or by
a signal, hangs, fails without its one line, says more than that, or if a resumed study silently has
other tables.

Each case is determined by seed and number (but for a study's records, which tell when they were
made) and has a process of its own, forked from one in which everything is imported. There, runs are
not isolated once more; a case that dies is typed again as a user does, and that is judged.

One line of ``FOLDER/seed_1.jsonl`` per case: what is done is not done again, but with ``--again``
what was not civil, since it may have been mended. The inputs of cases that are not civil stay in
``FOLDER/cases``; so does that of ``--only``. The end prints a table and every case that is not
civil; the exit code tells whether there is any. A case that is busy for a minute is tried once more
with five: a scenario may be slow without hanging. Linux and macOS.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, replace
from pathlib import Path
from threading import Lock
from time import monotonic
from typing import TYPE_CHECKING, Final

from campaign_bases import Bases
from campaign_kinds import KINDS, make_case
from campaign_nursery import Nursery
from campaign_verdicts import BAD, Verdict, judge, read_verdicts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

LIMIT: Final = 60  # [s] for one case; and
PATIENCE: Final = 5  # times as long for one that is not done then: SUMO's step may be 1 ms


def try_case(
    options: argparse.Namespace, number: int, bases: Bases, nursery: Nursery, folder: Path
) -> Verdict:
    """Make a case, type its command, judge what it came to.

    Args:
        options: of the campaign: its seed, the kind of its cases, the limit [s] for a command.
        number: of the case.
        bases: what is mutated.
        nursery: where it is typed.
        folder: for the input, which stays there.
    """
    began = monotonic()
    for patience in (1, PATIENCE):
        case = make_case(options.seed, number, bases, folder, options.kind)
        ended = nursery.type(case.words, folder, patience * options.limit, case.cache)
        if not ended.hung:
            break
    original = bases.study if case.kind == "records" else None
    return judge(case, ended, monotonic() - began, original)


def main() -> int:
    """Go on with a campaign, or repeat one case."""
    options = _parser().parse_args()
    first, _, last = options.seed.partition("-")
    verdicts = []
    for seed in range(int(first), int(last or first) + 1):
        options.seed = seed
        verdicts += _of_seed(options)
    return 0 if options.only is not None else _table(verdicts)


def _of_seed(options: argparse.Namespace) -> list[Verdict]:
    """Go on with one seed of a campaign, or repeat one case of it; the verdicts."""
    out: Path = options.out.absolute()
    kind = f"_{options.kind}" if options.kind else ""
    results = out / f"seed_{options.seed}{kind}.jsonl"
    out.mkdir(parents=True, exist_ok=True)
    if options.only is not None:
        _go_on(options, out, [options.only], lambda verdict: print(json.dumps(asdict(verdict))))
        print(f"its input is in {out / 'cases' / f'{options.seed}-{options.only}'}")
        return []
    known, lock = read_verdicts(results), Lock()
    again = {number for number in known if options.again and known[number].bad}
    left = [number for number in range(options.count) if number not in known or number in again]

    def keep(verdict: Verdict) -> None:
        with lock, results.open("a", encoding="utf-8") as file:
            file.write(json.dumps(asdict(verdict)) + "\n")
        if not verdict.bad:
            _remove(out / "cases" / f"{options.seed}-{verdict.number}")

    _go_on(options, out, left, keep)
    verdicts = [v for v in read_verdicts(results).values() if v.number < options.count]
    return [replace(v, mutations=f"of seed {options.seed}: {v.mutations}") for v in verdicts]


def _go_on(
    options: argparse.Namespace, out: Path, numbers: Sequence[int], keep: Callable[[Verdict], None]
) -> None:
    """Try cases in as many nurseries as there are jobs."""

    def some(place: int) -> None:
        with Nursery(out / "cache") as nursery:
            bases = Bases(out / "bases" / str(place), nursery)
            for number in numbers[place :: options.jobs]:
                folder = out / "cases" / f"{options.seed}-{number}"
                keep(try_case(options, number, bases, nursery, folder))

    with ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(some, range(options.jobs)))


def _remove(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    for name in ("out", "err"):
        folder.with_name(f"{folder.name}.{name}").unlink(missing_ok=True)


def _table(verdicts: Iterable[Verdict]) -> int:
    """Print how many cases of each kind came to what, and those that are not civil."""
    verdicts = list(verdicts)
    outcomes = sorted({v.outcome for v in verdicts} - set(BAD)) + list(BAD)
    print(f"{'':13}", *(f"{name:>10}" for name in outcomes), f"{'seconds':>10}")
    for kind in [*KINDS, "all"]:
        mine = [v for v in verdicts if kind in (v.kind, "all")]
        counts = Counter(v.outcome for v in mine)
        seconds = sum(v.seconds for v in mine)
        print(f"{kind:13}", *(f"{counts[name]:10}" for name in outcomes), f"{seconds:10.0f}")
    bad = [v for v in verdicts if v.bad]
    for v in sorted(bad, key=lambda v: (v.outcome, v.kind)):
        said = v.line.splitlines()[-1][:200] if v.line else ""
        print(f"\n{v.outcome}: case {v.number}, {v.mutations}\n    {v.command}\n    {said!r}")
    return 1 if bad else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seed", default="1", help="one, or the first and last: 3001-3005")
    parser.add_argument("--count", type=int, default=5000, help="cases of each seed, from 0 on")
    parser.add_argument("--kind", choices=tuple(KINDS), help="of all cases; default: drawn")
    parser.add_argument("--again", action="store_true", help="try what was not civil once more")
    parser.add_argument("--only", type=int, help="number of one case, which is tried again")
    parser.add_argument("--out", type=Path, required=True, help="folder of the campaign")
    parser.add_argument("--jobs", type=int, choices=(1, 2), default=1)
    parser.add_argument("--limit", type=int, default=LIMIT, help="[s] for one case")
    return parser


if __name__ == "__main__":
    sys.exit(main())
