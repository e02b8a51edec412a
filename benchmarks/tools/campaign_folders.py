"""The campaign's kinds of results folders, studies and journals that somebody else has prepared.

Each case has an expectation beside civility: what must be refused is refused, and what lies outside
the folder stays as it is.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import socket
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import random
    from collections.abc import Callable

    from campaign_bases import Bases

Words = list[object]

_PRECIOUS: Final = "what is mine\n"
_DEVICES: Final = ("/dev/zero", "/dev/urandom", "/dev/stdin", "/dev/full")
_JOURNAL: Final = ("meta.json", "rows", "heartbeat")  # what every journal has
_READ: Final = ("config.toml", "manifest.json", "ego.csv", "trajectories.csv", "pedestrians.csv")
_FORMATS: Final = ("pedpy", "fcd", "trj")
_BOMBS: Final = (
    lambda drawn: "[" * drawn.randint(30, 200_000),
    lambda drawn: _nested(drawn.choice(("[", '{"a":')), drawn.randint(21, 5000)),
    lambda drawn: f'{{"road": [[[0.0, {"9" * drawn.randint(19, 9000)}]]], "bodies": null}}',
    lambda drawn: f'{{"road": [], "bodies": {{"ego": [1e{drawn.randint(308, 9999)}, 2]}}}}',
    lambda drawn: f'{{"road": {drawn.choice(("1", "[1]", "[[1]]", "{}", "[[[NaN, 0]]]"))}}}',
    lambda drawn: f'{{"road": [], "bodies": {{}}, "ways": {_nested("[", drawn.randint(1, 30))}}}',
)


@dataclass(frozen=True)
class Expected:
    """The expectation of a case, beside civility.

    Attributes:
        refused: text of the line by which the command has to refuse; "": it need not.
        quiet: whether the command has to do its work without any message.
        precious: file outside the folder, which must stay as it is; None: there is none.
        same: a table and the one whose bytes it must have; None: no table is compared.
    """

    refused: str = ""
    quiet: bool = False
    precious: Path | None = None
    same: tuple[Path, Path] | None = None

    def broken(self, code: int, err: str) -> bool:
        """Whether a command that has ended so, with these messages, does not meet it."""
        kept = self.precious is None or _is_kept(self.precious)
        said = not self.refused or (code != 0 and self.refused in err)
        if self.same and (code or self.same[0].read_bytes() != self.same[1].read_bytes()):
            return True
        return not kept or not said or (self.quiet and bool(code or err.strip()))


CIVIL: Final = Expected()
"""Nothing but civility is expected."""


def _is_kept(precious: Path) -> bool:
    if precious.is_dir():
        return [f.read_text() for f in precious.iterdir()] == [_PRECIOUS]
    return precious.is_file() and precious.read_text() == _PRECIOUS


def journal_links(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str, Expected]:
    """A journal with links in place of files, or with a folder for its rows that is not its own."""
    journal = Path(shutil.copytree(bases.journal, folder / "journal"))
    precious = _precious(folder, "file")
    if drawn.random() < 0.2:
        meta = json.loads((journal / "meta.json").read_text())
        meta["results"] = drawn.choice((str(folder / "elsewhere"), str(precious), "../out", "/"))
        (journal / "meta.json").write_text(json.dumps(meta))
        refused = "whose folder for the results"
        return ["recover", "journal"], "another folder", Expected(refused, precious=precious)
    name = drawn.choice(_JOURNAL)
    done = _linked(drawn, journal / name, folder)
    words: Words = ["recover", "journal", *drawn.choice(([], ["--out", "out"]))]
    return words, f"{name}: {done}", Expected(f"{name}: is a", precious=precious)


def pipes(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str, Expected]:
    """A named pipe, a socket or a device in place of a file of a run, study or journal."""
    what = drawn.choices(("run", "study", "journal"), (5, 3, 2))[0]
    if what == "run":
        run = Path(shutil.copytree(drawn.choice(bases.runs), folder / "run"))
        file = run / drawn.choice([f.name for f in sorted(run.iterdir()) if f.is_file()])
        words, expected = _reading(drawn), Expected(".")
    elif what == "study":
        study = Path(shutil.copytree(bases.study, folder / "out"))
        file = drawn.choice(sorted(f for f in study.rglob("*") if f.is_file()))
        words, expected = ["report", "out", "--no-replays"], CIVIL
    else:
        journal = Path(shutil.copytree(bases.journal, folder / "journal"))
        file = journal / drawn.choice(_JOURNAL)
        words, expected = ["recover", "journal", "--out", "out"], Expected("error: ")
    return words, f"{file.name}: {_special(drawn, file)}", expected


def tables(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str, Expected]:
    """A table of another run, or one that is cut, shuffled or changed, in a run's folder."""
    one = drawn.randrange(len(bases.runs))
    run = Path(shutil.copytree(bases.runs[one], folder / "run"))
    other = bases.runs[one - 1]
    names = sorted(file.name for file in run.glob("*.csv"))
    file = run / drawn.choice(names)
    before, content = file.read_bytes(), file.read_bytes()
    lines = content.splitlines(keepends=True)
    what = drawn.choice(
        ("another run's", "another table", "cut", "shuffled", "changed", "as it is")
    )
    if what == "another run's" and (other / file.name).is_file():
        content = (other / file.name).read_bytes()
    elif what == "another":
        content = (run / drawn.choice(names)).read_bytes()
    elif what == "cut":
        content = content[: drawn.randrange(len(content))]
    elif what == "shuffled":
        rows = lines[1:]
        drawn.shuffle(rows)
        content = b"".join([*lines[:1], *rows])
    elif what == "changed":
        at = drawn.choice([m.start() for m in re.finditer(rb"\w", content)])
        digit = drawn.choice([d for d in b"0123456789x" if d != content[at]])
        content = content[:at] + bytes([digit]) + content[at + 1 :]
    file.write_bytes(content)
    same = content == before
    expected = Expected(quiet=True) if same else Expected(f"{file.name}: has ")
    words = _reading(drawn)
    if not same and drawn.random() < 0.2:
        words, expected = [*words, "--unsealed"], CIVIL
    return words, f"{file.name}: {what}", expected


def targets(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str, Expected]:
    """A link in place of what a command writes: pages, figures, their folders."""
    if drawn.random() < 0.6:
        shutil.copytree(drawn.choice(bases.runs), folder / "run")
        name = drawn.choice(("replay.html", ".replay.html.new"))
        place, words = folder / "run" / name, ["replay", "run", "--no-rerun"]
        precious = _precious(folder, "file")
    else:
        shutil.copytree(bases.study, folder / "out")
        names = ("report.html", ".report.html.new", "figures", "broken", "replays", "runs.csv")
        name = drawn.choice((*names, ".runs.csv.new", "figures/forest.svg"))
        place, words = folder / "out" / name, ["report", "out", "--no-replays"]
        is_folder = name in ("figures", "broken", "replays")
        precious = _precious(folder, "folder" if is_folder else "file")
        if drawn.random() < 0.3:
            with suppress(FileNotFoundError):  # the tables are written again
                (folder / "out" / "cells.csv").write_text("x")
    place.parent.mkdir(exist_ok=True)
    place.unlink(missing_ok=True)
    relative = drawn.random() < 0.5
    place.symlink_to(os.path.relpath(precious, place.parent) if relative else precious)
    return words, f"{name}: a link", Expected(precious=precious)


def scenes(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str, Expected]:
    """A bomb in a JSON file of a run, whose seal is not looked at."""
    run = Path(shutil.copytree(drawn.choice(bases.runs), folder / "run"))
    name = drawn.choices(("scene.json", "summary.json", "manifest.json"), (6, 1, 1))[0]
    number = drawn.randrange(len(_BOMBS))
    (run / name).write_text(_BOMBS[number](drawn))
    return [*_reading(drawn), "--unsealed"], f"{name}: bomb {number}", CIVIL


def vehicles(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str, Expected]:
    """A results folder that names the code of a vehicle FMU: somebody else's, or a swapped one."""
    run = Path(shutil.copytree(bases.driven, folder / "run"))
    manifest, config, car = run / "manifest.json", run / "config.toml", run / "car.fmu"
    content = json.loads(manifest.read_text())
    refused = "somebody else's results folder names code"
    what = drawn.choice(("another maker", "no maker", "other settings", "another FMU"))
    if what == "another maker":
        manifest.write_text(json.dumps(content | {"maker": f"{drawn.getrandbits(256):064x}"}))
    elif what == "no maker":
        del content["maker"]
        manifest.write_text(json.dumps(content))
    elif what == "other settings":
        config.write_text(config.read_text() + "\n" * drawn.randint(1, 9))
    else:
        before = bases.driven.with_name("car.fmu")
        config.write_text(config.read_text().replace(str(before), str(car)))
        car.write_bytes(before.read_bytes() + drawn.randbytes(drawn.randint(1, 99)))
    words: Words = ["run", "--config", "run/config.toml", "--no-pictures", "--out", "out"]
    if what == "another FMU" and drawn.random() < 0.5:
        return [*words, "--trust", "car.fmu"], what, Expected("car.fmu")
    return words, what, Expected(refused)


def _precious(folder: Path, kind: str) -> Path:
    """Make something outside the results that must not change."""
    place = folder / "precious"
    if kind == "folder":
        place.mkdir()
        (place / "mine").write_text(_PRECIOUS)
    else:
        place.write_text(_PRECIOUS)
    return place


def _reading(drawn: random.Random) -> Words:
    """A command that reads the folder ``run`` and makes no run."""
    export = ["export", "run", "run", "--format", drawn.choice(_FORMATS)]
    return ["replay", "run", "--no-rerun"] if drawn.random() < 0.5 else export


def _linked(drawn: random.Random, file: Path, folder: Path) -> str:
    """Put a link in place of a file: to itself elsewhere, to nothing, to a device."""
    what = drawn.choice(("itself", "nothing", "device", "another file"))
    there = folder / "there"
    shutil.copy(file, there)
    file.unlink()
    to = {"itself": there, "nothing": folder / "nothing", "another file": folder / "precious"}
    file.symlink_to(to.get(what, Path(drawn.choice(_DEVICES))))
    return f"a link to {what}"


def _special(drawn: random.Random, file: Path) -> str:
    """Put something in place of a file that is no file."""
    what = drawn.choice(("pipe", "socket", "device"))
    file.unlink()
    if what == "pipe":
        os.mkfifo(file)
    elif what == "device":
        file.symlink_to(drawn.choice(_DEVICES))
    else:
        before = Path.cwd()
        os.chdir(file.parent)  # the name of a socket must be short
        try:
            with socket.socket(socket.AF_UNIX) as end:
                end.bind(file.name)
        finally:
            os.chdir(before)
    return what


def _nested(opening: str, depth: int) -> str:
    closing = "]" if opening == "[" else "}"
    return opening * depth + "1" + closing * depth


FOLDER_KINDS: Final[dict[str, tuple[int, Callable[..., tuple[Words, str, Expected]]]]] = {
    "journal_links": (9, journal_links),
    "pipes": (9, pipes),
    "tables": (9, tables),
    "targets": (5, targets),
    "scenes": (5, scenes),
    "vehicles": (5, vehicles),
}
"""Each kind's share, and what makes a case of it."""
