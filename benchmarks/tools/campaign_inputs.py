"""The campaign's kinds of inputs with one fault that has to be refused: what is no number or size.

The line that refuses a case must name the fault.
"""

from __future__ import annotations

import gzip
import re
import shutil
from typing import TYPE_CHECKING, Final

from campaign_folders import Expected

if TYPE_CHECKING:
    import random
    from collections.abc import Callable
    from pathlib import Path

    from campaign_bases import Bases

Words = list[object]

_NUMBER: Final = re.compile(r"(?:(?<== )|(?<=\[)|(?<=, ))-?\d[\d.eE+-]*(?=\s*(?:[,\]}#]|$))", re.M)
_PLACES: Final = re.compile(r'\b((?:\w*[sS]hape|x|y|length|width|\w+Boundary)=")([^"]*)(?=")')
_BLOCK: Final = 1 << 26  # [B] of a piece of a bomb, packed once
_SHORT: Final = ("--time-limit", 0.5, "--no-pictures", "--out", "out")


def booleans(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str, Expected]:
    """A file of settings, a study, a profile or a preset, with true or false for a number."""
    what = drawn.choices(("run", "study", "profile", "preset"), (5, 2, 2, 1))[0]
    texts = {"run": [*bases.settings.values()], "study": [*bases.studies.values()]}
    texts |= {"profile": [bases.profile], "preset": bases.presets}
    commands: dict[str, Words] = {
        "run": drawn.choice((["config", "--config"], ["run", *_SHORT, "--config"])),
        "study": ["study", "--out", "out", "--no-report"],
        "profile": ["run", *_SHORT, "--vehicle", drawn.choice(bases.fmus), "--profile"],
        "preset": ["run", "shared_space", *_SHORT, "--crowd-preset"],
    }
    text = drawn.choice(texts[what])
    befores = [(m, _before(text, m.start())) for m in _NUMBER.finditer(text)]
    # A flag of the command replaces the file's time limit, which is then not looked at
    places = [m for m, before in befores if not re.search("#|time_limit", before)]
    place = drawn.choice(places)
    value = drawn.choice(("true", "false"))
    (folder / f"{what}.toml").write_text(text[: place.start()] + value + text[place.end() :])
    line = _before(text, place.start())
    return [*commands[what], f"{what}.toml"], f"{what}: {line}{value}", Expected(value.title())


def networks(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str, Expected]:
    """A network that is not in metres or whose lanes have other names; routes that are a bomb."""
    name = drawn.choice(list(bases.scenarios))
    shutil.copytree(bases.scenarios[name], folder, dirs_exist_ok=True)
    net = folder / f"{name}.net.xml"
    what = drawn.choice(("millimetres", "a million", "lanes", "bomb"))
    if what == "lanes":
        lanes = re.findall(r'<lane id="([^":]*)"', net.read_text())
        named = re.compile(rf'(?<=["\s])({"|".join(map(re.escape, lanes))})(?=["\s])')
        for file in folder.glob("*.xml"):
            file.write_text(named.sub(r"\1.lane", file.read_text()))
        refused = "expected the name"
    elif what == "bomb" and (routes := folder / f"{name}.rou.xml").exists():
        blank = drawn.choice((b" ", b"\n", b"<!-- -->", b"<routes>"))
        piece = gzip.compress(blank * (_BLOCK // len(blank)))
        routes.write_bytes(piece * drawn.randint(5, 100))
        refused = "unpacks to more than"
    else:
        factor = 1e6 if what == "a million" else 1e3
        net.write_text(_PLACES.sub(lambda m: m[1] + _scaled(m[2], factor), net.read_text()))
        refused = "a network is in metres"
    ego: Words = ["--ego", "me"] if name == "town" else []
    who = drawn.choice((ego, ["--no-ego", "--zone", "everywhere"]))
    return ["run", f"{name}.sumocfg", *who, *_SHORT], f"{name}: {what}", Expected(refused)


def _before(text: str, place: int) -> str:
    """Return the part of a line before a place in it."""
    return text[text.rfind("\n", 0, place) + 1 : place]


def _scaled(numbers: str, factor: float) -> str:
    return re.sub(r"-?\d+(?:\.\d+)?", lambda m: f"{float(m[0]) * factor:.2f}", numbers)


INPUT_KINDS: Final[dict[str, tuple[int, Callable[..., tuple[Words, str, Expected]]]]] = {
    "booleans": (9, booleans),
    "networks": (3, networks),
}
"""Each kind's share, and what makes a case of it."""
