"""Do two states of the test suite find the same faults? Sixty mutants tell.

    python benchmarks/tools/mutants.py draw --tree OLD --out old/        # writes old/mutants.json
    python benchmarks/tools/mutants.py map  --tree OLD --out old/  # which test file executes what
    python benchmarks/tools/mutants.py run  --tree OLD --out old/        # who finds which mutant
    python benchmarks/tools/mutants.py map  --tree NEW --out new/
    python benchmarks/tools/mutants.py run  --tree NEW --out new/ --mutants old/mutants.json \
                                      [--renames FILE] [--killed-in old/]
    python benchmarks/tools/mutants.py compare old/ new/

``draw`` picks functions of the five packages by a seed and gives each one fault. A mutant bears the
names of its package and function, its operator and its line's text: modules may move, and a file of
renames (``old=new`` a line, names or dotted names) follows functions, classes and variables.

``map`` runs each test file in a pytest of its own, with a recorder in it and in its children, and
keeps how long it took. A file that fails unmutated is left out of everything else. Functions that
numba compiles count as executed where Python functions that mention them are. Children whose
environment a test replaces are not recorded.

``run`` lets only those test files loose on a mutant that execute its function: first those that
name it, then the shortest, several in one pytest, until the first failure. That failing test then
runs without the mutant, and if it fails again it does not count. The verdicts:

    killed      a test fails with the mutant and passes without
    broken      tests can no longer be collected
    timeout     tests take three times as long as they did, plus a minute
    survived    all test files that execute the function pass
    unexecuted  no test file executes it
    unfinished  --limit seconds were not enough
    gone, ambiguous   the tree has no such place, or several

``run --guess`` needs no map, which takes most of the time: it lets those test files loose that are
in the folder which mirrors the function's module, or mention its module, its class or its name.
What it kills is killed; whether the other tests would find a survivor, only a map tells.

Trees are copied, nothing is written into them. Everything is resumable: what is done is not done
again; survivors and unfinished ones go on with test files that were mapped, or seconds that were
granted, since. Linux and macOS; needs the ``test`` extra.
"""

from __future__ import annotations

import argparse
import json
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path
from queue import SimpleQueue
from threading import Lock
from typing import TYPE_CHECKING, Any

from mutants_drawn import Mutant, NoPlaceError, Renames, draw, place
from mutants_functions import executors, functions_of
from mutants_tests import Place, fingerprint, guess_map, map_file, read_map, test_files
from mutants_verdicts import FOUND, Trial, Verdict, read_verdicts, try_mutant

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable


def main() -> int:
    """Parse the command line and run one of the commands."""
    options = _parser().parse_args()
    return int(options.command(options))


def _draw(options: argparse.Namespace) -> int:
    mutants = draw(functions_of(options.tree), options.count, options.seed)
    options.out.mkdir(parents=True, exist_ok=True)
    text = json.dumps([asdict(mutant) for mutant in mutants], indent=1, ensure_ascii=False)
    (options.out / "mutants.json").write_text(text + "\n")
    print(*(mutant.name for mutant in mutants), sep="\n")
    return 0


def _map(options: argparse.Namespace) -> int:
    folder = _folder(options, "map")
    known = read_map(folder)
    files = [f for f in test_files(options.tree) if f not in known]
    files = [f for f in files if not any(part in f for part in options.skip)]
    last = list(enumerate(options.last, 1))
    files.sort(key=lambda f: max((i for i, part in last if part in f), default=0))

    def one(here: Place, file: str) -> None:
        mapped = map_file(here, file, folder, options.limit)
        print(f"{mapped.seconds:7.1f} s  {file}: {mapped.end}", flush=True)

    _in_places(options, files, one)
    return 0


def _run(options: argparse.Namespace) -> int:
    folder = _folder(options, "")
    results = folder / "results.jsonl"
    renames = Renames(options.renames.read_text() if options.renames else "")
    functions = functions_of(options.tree)
    earlier, lock = read_verdicts(folder), Lock()

    def one(here: Place, mutant: Mutant) -> None:
        before = earlier.get(mutant.name)
        try:
            placed = place(mutant, functions, renames)
        except NoPlaceError as reason:
            verdict = Verdict(mutant.name, str(reason))
        else:
            if options.guess:
                keys = executors(placed.function, functions)
                mapped = guess_map(here.tree, placed.function, keys)
            else:
                mapped = read_map(folder / "map")
            trial = Trial(mutant, placed, functions, mapped, options.limit, options.guess)
            if before is not None and not trial.continues(before, here.tree):
                return
            verdict = try_mutant(here, trial, before)
        with lock, results.open("a") as file:
            file.write(json.dumps(asdict(verdict), ensure_ascii=False) + "\n")
        print(
            f"{verdict.seconds:7.1f} s  {verdict.verdict}: {mutant.name} {verdict.by}", flush=True
        )

    _in_places(options, _wanted(options), one)
    return _table(argparse.Namespace(folders=[folder]))


def _wanted(options: argparse.Namespace) -> list[Mutant]:
    """The mutants that the command line names."""
    text = (options.mutants or options.out / "mutants.json").read_text()
    mutants = [Mutant(**values) for values in json.loads(text)]
    if options.only:
        mutants = [m for m in mutants if any(part in m.name for part in options.only)]
    if options.killed_in is not None:
        old = read_verdicts(options.killed_in)
        mutants = [m for m in mutants if m.name in old and old[m.name].verdict in FOUND]
    return mutants


def _in_places(
    options: argparse.Namespace, tasks: Iterable[Any], work: Callable[[Place, Any], None]
) -> None:
    """Do all tasks, each in a private copy of the tree that no other one has at that time."""
    places: SimpleQueue[Place] = SimpleQueue()
    for number in range(options.jobs):
        here = Place(options.tree, options.out / f"place-{options.place + number}")
        here.restore()
        here.prepare_recording()
        places.put(here)

    def one(task: Any) -> None:
        here = places.get()
        try:
            work(here, task)
        finally:
            places.put(here)

    with ThreadPoolExecutor(options.jobs) as pool:
        for future in [pool.submit(one, task) for task in tasks]:
            future.result()


def _folder(options: argparse.Namespace, name: str) -> Path:
    """A folder of ``--out``, which is for one state of one tree."""
    folder: Path = options.out / name
    folder.mkdir(parents=True, exist_ok=True)
    state = options.out / "tree.txt"
    if not state.exists():
        state.write_text(fingerprint(options.tree))
    elif state.read_text() != fingerprint(options.tree):
        sys.exit(f"{options.tree}: has changed since {state} was written; give another --out")
    return folder


def _table(options: argparse.Namespace) -> int:
    """How many mutants have which verdict."""
    for folder in options.folders:
        verdicts = [v.verdict for v in read_verdicts(folder).values()]
        counts = {word: verdicts.count(word) for word in sorted(set(verdicts))}
        print(f"{folder}: {len(verdicts)} mutants,", ", ".join(f"{counts[w]} {w}" for w in counts))
    return 0


def _compare(options: argparse.Namespace) -> int:
    """What the old tests find and the new ones do not; the exit code says whether there is any."""
    _table(options)
    old, new = (read_verdicts(folder) for folder in options.folders)
    both = [name for name in old if name in new]
    missed = [n for n in both if old[n].verdict in FOUND and new[n].verdict not in FOUND]
    for name in missed:
        print(f"{new[name].verdict} (old: {old[name].verdict} by {old[name].by})\n    {name}")
    placeless = sum(new[name].verdict in ("gone", "ambiguous") for name in missed)
    untried = sum(v.verdict in FOUND for n, v in old.items() if n not in new)
    print(
        f"{len(missed) - placeless} found by the old tests only, {placeless} without a place now,"
    )
    print(f"{untried} found by the old tests and not tried with the new ones")
    return 1 if len(missed) > placeless else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    commands = parser.add_subparsers(required=True)

    def add(name: str, command: Callable[[argparse.Namespace], int]) -> argparse.ArgumentParser:
        part = commands.add_parser(name)
        part.set_defaults(command=command)
        part.add_argument("--tree", type=Path, required=True, help="state of the repository")
        part.add_argument("--out", type=Path, required=True, help="folder for what is learned")
        return part

    drawing = add("draw", _draw)
    drawing.add_argument("--count", type=int, default=60)
    drawing.add_argument("--seed", type=int, default=14)
    mapping, running = add("map", _map), add("run", _run)
    for part, limit in ((mapping, 1800.0), (running, 300.0)):
        part.add_argument("--jobs", type=int, default=1)
        part.add_argument("--place", type=int, default=0, help="number of the first private copy")
        part.add_argument("--limit", type=float, default=limit, help="[s] per file, or mutant")
    mapping.add_argument(
        "--last", nargs="*", default=[], help="parts of names of files that come last"
    )
    mapping.add_argument(
        "--skip", nargs="*", default=[], help="parts of names of files that are left out"
    )
    running.add_argument(
        "--guess", action="store_true", help="no map: test files whose text or folder suggests them"
    )
    running.add_argument("--mutants", type=Path, help="list of another --out")
    running.add_argument("--renames", type=Path, help="old=new, one a line")
    running.add_argument("--only", nargs="*", help="parts of names of mutants")
    running.add_argument("--killed-in", type=Path, help="--out whose found mutants are tried only")
    for name, command, number in (("table", _table, "+"), ("compare", _compare, 2)):
        part = commands.add_parser(name)
        part.set_defaults(command=command)
        part.add_argument("folders", type=Path, nargs=number, metavar="OUT")
    return parser


if __name__ == "__main__":
    sys.exit(main())
