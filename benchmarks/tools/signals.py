"""The campaign of signals: commands that a user ends at seeded instants.

    python benchmarks/tools/signals.py --seed 1 --count 200 --out FOLDER
    python benchmarks/tools/signals.py --seed 1 --count 200 --out FOLDER --commands run,replay
    python benchmarks/tools/signals.py --seed 1 --out FOLDER --only run:17

Each case starts a command in a session of its own and sends SIGINT, SIGTERM or SIGHUP, to the
process alone or to its whole group. The instant is between the one from which giveway hears
signals, a millisecond after its first line, and the end of the command, by the command's measured
duration: uniform in 60 % of the cases, in the first half second in 25 %, in the last 5 % of the
duration in 15 %. A case is right if the exit code is 128 + n with one line, or the regular one of
finished work, nothing is left behind and every file is whole (``signals_verdicts.py``). An earlier
signal is not judged, and counts as ``early``.

One line of ``FOLDER/signals_SEED.jsonl`` per case; a case that is done is not done again, but with
``--again`` those that were not right. Folders of such cases stay in ``FOLDER/cases``. The end
prints a table and every case that was not right; the exit code tells whether there is any. Linux.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shutil
import signal
import subprocess
import sys
from collections import Counter
from dataclasses import asdict, dataclass
from pathlib import Path
from time import monotonic, sleep
from typing import TYPE_CHECKING, Final

from campaign_bases import Bases
from campaign_nursery import Nursery
from campaign_verdicts import read_lines
from signals_commands import COMMANDS
from signals_verdicts import BAD, CASE, OUTCOMES, Ended, Verdict, judge, left_processes

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

SIGNALS: Final = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
LIMIT: Final = 60.0  # Time [s] for a command to end after its signal
TRIALS: Final = 1  # Number of undisturbed starts by which a duration is measured
_TICK: Final = 0.005  # Time [s] between two looks whether a command has ended
# Code that a Python process runs first: it stores the instant at which giveway is looked for.
_MARK: Final = """
import os, sys, time

class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == "giveway._start.environment":  # signals are heard from here
            sys.meta_path.remove(self)
            try:
                handle = os.open(os.environ["SIGNALS_MARK"], os.O_CREAT | os.O_EXCL | os.O_WRONLY)
                os.write(handle, str(time.monotonic()).encode())
                os.close(handle)
            except OSError:
                pass

sys.meta_path.insert(0, Finder())
"""


@dataclass(frozen=True)
class Shot:
    """A signal and its instant.

    Attributes:
        number: Number of the signal.
        group: True if it goes to the whole process group, as a terminal sends it.
        share: Instant as a share of the time from giveway's first line to the end.
        early: True if the instant is in the first half second.
    """

    number: int
    group: bool
    share: float
    early: bool

    def instant(self, first: float, duration: float) -> float:
        """Return the time [s] from the start of the process to the signal."""
        end = min(first + 0.5, duration) if self.early else duration
        return first + self.share * (end - first)


def draw(seed: int, command: str, number: int) -> Shot:
    """Return the signal of a case, which seed, command and number determine."""
    drawn = random.Random(f"{seed} {command} {number}")
    where, within = drawn.random(), drawn.random()
    share = within if where < 0.85 else 0.95 + 0.05 * within
    early = 0.6 <= where < 0.85
    return Shot(drawn.choice(SIGNALS), drawn.random() < 0.5, share, early)


class Campaign:
    """The commands of a campaign, and the processes in which they run.

    Args:
        out: Folder of the campaign.
        nursery: Nursery that makes the inputs.

    Attributes:
        times: Times [s] to giveway's first line and to the end, by command.
    """

    def __init__(self, out: Path, nursery: Nursery) -> None:
        out.mkdir(parents=True, exist_ok=True)
        self._out = out
        self._bases = Bases(out / "bases", nursery)
        paths = [str(out / "first"), *filter(None, [os.environ.get("PYTHONPATH")])]
        self._environment = nursery.environment | {"PYTHONPATH": os.pathsep.join(paths)}
        (out / "first").mkdir(exist_ok=True)
        (out / "first" / "sitecustomize.py").write_text(_MARK)
        self.times: dict[str, tuple[float, float]] = {}

    def measured(self, command: str) -> tuple[float, float]:
        """Return the times [s] to giveway's first line and to the end, without a signal.

        Raises:
            RuntimeError: the command does not work.
        """
        if command not in self.times:
            firsts, durations = [], []
            for _ in range(TRIALS + 1):
                folder, ended = self._run(command, "undisturbed", None)
                if ended.code:
                    raise RuntimeError(f"giveway {command}: {ended.err}")
                firsts.append(ended.first)
                durations.append(ended.seconds)
                shutil.rmtree(folder)
            # the very first start may load files from the disk
            self.times[command] = min(firsts[1:]), min(durations[1:])
        return self.times[command]

    def try_case(self, seed: int, command: str, number: int) -> Verdict:
        """Run a command, send the signal of the case, and return the verdict."""
        shot = draw(seed, command, number)
        at = shot.instant(*self.measured(command))
        folder, ended = self._run(command, f"{seed}-{command}-{number}", (shot, at))
        name = f"{signal.Signals(shot.number).name} to {'all' if shot.group else 'one'}"
        verdict = judge(command, number, ended, folder, COMMANDS[command], shot.number, name)
        if not verdict.bad:
            shutil.rmtree(folder)
        return verdict

    def _run(self, command: str, name: str, shot: tuple[Shot, float] | None) -> tuple[Path, Ended]:
        """Run a command in a new folder.

        Args:
            command: Name of the command.
            name: Name of the folder.
            shot: Signal and the time [s] after the start at which it is sent; None for none.
        """
        folder = self._out / "cases" / name
        shutil.rmtree(folder, ignore_errors=True)
        (folder / "tmp").mkdir(parents=True)
        words = COMMANDS[command].prepare(self._bases, folder)
        environment = self._environment | {
            "TMPDIR": str(folder / "tmp"),
            "SIGNALS_MARK": str(folder / "mark"),
            CASE: name,
        }
        with (folder / "stdout").open("wb") as out, (folder / "stderr").open("wb") as err:
            began = monotonic()
            process = subprocess.Popen(
                [sys.executable, "-m", "giveway", *map(str, words)],
                cwd=folder,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=err,
                start_new_session=True,
            )
            sent = _fire(process, began, shot) if shot else 0.0
            hung = _await(process, LIMIT)
        return folder, Ended(
            code=process.returncode,
            hung=hung,
            sent=max(0.0, sent - began),
            first=_first_line(folder, began),
            seconds=monotonic() - began,
            out=(folder / "stdout").read_text(errors="replace"),
            err=(folder / "stderr").read_text(errors="replace"),
            left=left_processes(name),
        )


def _fire(process: subprocess.Popen[bytes], began: float, shot: tuple[Shot, float]) -> float:
    """Send the signal at its instant unless the process has ended, and return when [s]."""
    what, at = shot
    while (left := began + at - monotonic()) > 0.0:
        if process.poll() is not None:
            return 0.0
        sleep(min(left, 0.02))
    sent = monotonic()
    if process.poll() is None:
        (os.killpg if what.group else os.kill)(process.pid, what.number)
        return sent
    return 0.0


def _await(process: subprocess.Popen[bytes], limit: float) -> bool:
    """Wait for the end of a process; return whether it had to be killed at the limit [s]."""
    end = monotonic() + limit
    while process.poll() is None:
        if monotonic() > end:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return True
        sleep(_TICK)
    return False


def _first_line(folder: Path, began: float) -> float:
    """Return the time [s] to giveway's first line; inf if it was not reached."""
    try:
        return float((folder / "mark").read_text()) - began
    except (OSError, ValueError):
        return float("inf")


def main() -> int:
    """Go on with a campaign, or repeat one case."""
    options = _parser().parse_args()
    hear_signals()
    out: Path = options.out.absolute()
    with Nursery(out / "cache") as nursery:
        campaign = Campaign(out, nursery)
        if options.only:
            command, _, number = options.only.partition(":")
            verdict = campaign.try_case(options.seed, command, int(number))
            print(json.dumps(asdict(verdict), indent=1))
            return int(verdict.bad)
        results = out / f"signals_{options.seed}.jsonl"
        known = _read(results)
        for number in range(options.count):
            for command in options.commands:
                before = known.get((command, number))
                if before is not None and not (options.again and before.bad):
                    continue
                verdict = campaign.try_case(options.seed, command, number)
                known[command, number] = verdict
                with results.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(asdict(verdict)) + "\n")
        for command, (first, duration) in campaign.times.items():
            print(f"{command}: first line after {first:.3f} s, end after {duration:.2f} s")
    wanted = [v for (c, n), v in known.items() if c in options.commands and n < options.count]
    return _table(options.commands, wanted)


def hear_signals() -> None:
    """Let the commands hear all signals: a job behind ``&`` or ``nohup`` ignores some for them."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    for number in SIGNALS[1:]:
        signal.signal(number, signal.SIG_DFL)


def _read(file: Path) -> dict[tuple[str, int], Verdict]:
    """Return the verdicts so far by command and number."""
    return {(verdict.command, verdict.number): verdict for verdict in read_lines(file, Verdict)}


def _table(commands: Sequence[str], verdicts: Iterable[Verdict]) -> int:
    """Print the number of cases of each command and outcome, and those that are not right."""
    verdicts = list(verdicts)
    print(f"{'':13}", *(f"{name:>10}" for name in OUTCOMES))
    for command in [*commands, "all"]:
        counts = Counter(v.outcome for v in verdicts if command in (v.command, "all"))
        print(f"{command:13}", *(f"{counts[name]:10}" for name in OUTCOMES))
    bad = sorted((v for v in verdicts if v.outcome in BAD), key=lambda v: (v.outcome, v.command))
    for v in bad:
        print(f"\n{v.outcome}: {v.command}:{v.number}, {v.signal} at {v.sent:.3f} s: {v.why}")
        print(f"    exit {v.code}, {v.line[-300:]!r}")
    return 1 if bad else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200, help="cases of each command, from 0 on")
    parser.add_argument(
        "--commands",
        type=lambda text: text.split(","),
        default=list(COMMANDS),
        help=f"of {', '.join(COMMANDS)}; default: all",
    )
    parser.add_argument("--again", action="store_true", help="try what was not right once more")
    parser.add_argument("--only", metavar="COMMAND:NUMBER", help="one case, which is tried again")
    parser.add_argument("--out", type=Path, required=True, help="folder of the campaign")
    return parser


if __name__ == "__main__":
    sys.exit(main())
