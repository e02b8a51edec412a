"""The campaign's kinds of cases: what is mutated, and which command reads it then."""

from __future__ import annotations

import random
import shutil
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from campaign_folders import CIVIL, FOLDER_KINDS, Expected
from campaign_inputs import INPUT_KINDS
from campaign_kernels import kernels
from campaign_mutations import mutate

if TYPE_CHECKING:
    from collections.abc import Callable

    from campaign_bases import Bases

Words = list[object]

_FORMS: Final = {".xml": "xml", ".sumocfg": "xml", ".toml": "toml", ".csv": "csv", ".json": "json"}
_AS_CITR: Final = ("--dataset", "citr")
_SHORT: Final = ("--no-pictures", "--out", "out")


@dataclass(frozen=True)
class Case:
    """One mutated input, and what is typed.

    Attributes:
        number: of the case.
        kind: one of :data:`KINDS`.
        words: of the command, typed in ``folder``.
        folder: where the input lies.
        mutations: what has been done to which file.
        expected: what has to hold beside civility.
        cache: folder of kernels for a process of its own; None: the nursery's child.
    """

    number: int
    kind: str
    words: Words
    folder: Path
    mutations: str
    expected: Expected = CIVIL
    cache: Path | None = None


def make_case(seed: int, number: int, bases: Bases, folder: Path, only: str | None = None) -> Case:
    """The case that ``seed`` and ``number`` determine.

    Args:
        seed: of the campaign.
        number: of the case.
        bases: what is mutated.
        folder: for the input; one that is there is replaced.
        only: the kind of all cases; None: they are drawn.
    """
    drawn = random.Random(f"{seed} {number}")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    kind = drawn.choices(list(KINDS), [weight for weight, _ in KINDS.values()])[0]
    kind = only or kind
    words, mutations, *expected = KINDS[kind][1](drawn, bases, folder)
    return Case(number, kind, words, folder, mutations, *expected)


def _mutated(drawn: random.Random, file: Path) -> str:
    """Mutate a file; what has been done."""
    content, done = mutate(drawn, file.read_bytes(), _FORMS.get(file.suffix, ""))
    file.write_bytes(content)
    return f"{file.name}: {done}"


def _scenario(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str]:
    name = drawn.choice(list(bases.scenarios))
    shutil.copytree(bases.scenarios[name], folder, dirs_exist_ok=True)
    files = sorted(folder.iterdir())
    done = "; ".join(_mutated(drawn, f) for f in drawn.sample(files, drawn.choice((1, 1, 1, 2))))
    config = f"{name}.sumocfg"
    if drawn.random() < 0.1:
        return ["doctor", config], done
    ego: Words = ["--ego", "me"] if name == "town" else []
    if drawn.random() < 0.3:
        ego = ["--no-ego", "--zone", "everywhere"]
    elif name == "town" and drawn.random() < 0.3:
        ego = ["--ego-route", "A0A1,A1B1", "--zone", "everywhere"]
    return ["run", config, *ego, "--time-limit", drawn.choice((1, 1, 3)), *_SHORT], done


def _settings(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str]:
    file = folder / "run.toml"
    file.write_text(bases.settings[drawn.choice(list(bases.settings))])
    done = _mutated(drawn, file)
    if drawn.random() < 0.2:
        return ["config", "--config", file.name], done
    return ["run", "--config", file.name, "--time-limit", 0.5, *_SHORT], done


def _study(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str]:
    file = folder / "study.toml"
    name = drawn.choice(list(bases.studies))
    file.write_text(bases.studies[name])
    done = _mutated(drawn, file)
    runs: Words = [] if name == "precise" else ["--runs", 1]
    return ["study", file.name, "--out", "out", "--no-report", *runs], done


def _profile(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str]:
    file = folder / "vehicle.toml"
    file.write_text(bases.profile)
    done = _mutated(drawn, file)
    fmu = drawn.choice(bases.fmus)
    if drawn.random() < 0.5:
        return ["fmu", "check", fmu, "--profile", file.name, "--out", "out"], done
    words: Words = ["run", "--vehicle", fmu, "--profile", file.name]
    return [*words, "--pedestrians", 2, "--time-limit", 0.5, *_SHORT], done


def _fmu(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str]:
    fmu = folder / "vehicle.fmu"
    source = drawn.choice(bases.fmus)
    if drawn.random() < 0.3:
        shutil.copy(source, fmu)
        return ["fmu", "inspect", fmu.name], _mutated(drawn, fmu)
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(fmu, "w") as new:
        for member in old.namelist():
            content = old.read(member)
            if member == "modelDescription.xml":
                content, done = mutate(drawn, content, "xml")
            new.writestr(zipfile.ZipInfo(member), content)
    return ["fmu", "inspect", fmu.name], f"modelDescription.xml: {done}"


def _trajectories(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str]:
    for name, content in bases.clips.items():
        (folder / name).write_bytes(content)
    done = _mutated(drawn, folder / drawn.choice(list(bases.clips)))
    dataset = ("--dataset", "mine.toml") if done.startswith("mine") else _AS_CITR
    if drawn.random() < 0.7:
        return ["validate", ".", *dataset, "--out", "out"], done
    return ["data", "describe", ".", *dataset], done


def _preset(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str]:
    file = folder / "mine.toml"
    file.write_text(drawn.choice(bases.presets))
    done = _mutated(drawn, file)
    if drawn.random() < 0.2:
        for name, content in bases.clips.items():
            if name != file.name:
                (folder / name).write_bytes(content)
        return ["validate", ".", *_AS_CITR, "--preset", file.name, "--out", "out"], done
    table = drawn.choice(("crowd", "perception"))
    (folder / "run.toml").write_text(f'[{table}]\npreset = "{file.name}"\n')
    words: Words = ["run", "--config", "run.toml", "--pedestrians", 5]
    return [*words, "--time-limit", 0.5, *_SHORT], done


def _records(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str]:
    shutil.copy(bases.study.with_name("small.toml"), folder)
    study = Path(shutil.copytree(bases.study, folder / "out"))
    records = sorted(study.glob("records/*/*.json"))
    others = sorted(file for file in study.iterdir() if file.is_file())
    done = []
    for _ in range(drawn.choice((1, 1, 2, 3))):
        file = drawn.choice(records if drawn.random() < 0.6 else others)
        done.append(_broken(drawn, file, drawn.choice(records)))
    return ["study", "small.toml", "--out", "out", "--resume", "--no-report"], "; ".join(done)


def _broken(drawn: random.Random, file: Path, other: Path) -> str:
    """Mutate a file of a study, or put something else in its place."""
    if not file.is_file() or not other.is_file() or drawn.random() < 0.7:
        return _mutated(drawn, file) if file.is_file() else "nothing more"
    what = drawn.choice(("gone", "a folder", "another record", "two swapped", "moved", "a link"))
    content = file.read_bytes()
    if what in ("gone", "a folder", "a link", "moved"):
        file.unlink()
    if what == "a folder":
        (file / "within").mkdir(parents=True)
    elif what == "a link":
        file.symlink_to("nowhere")
    elif what == "moved":
        file.with_name(f"x{file.name}").write_bytes(content)
    elif what in ("another record", "two swapped"):
        file.write_bytes(other.read_bytes())
        if what == "two swapped":
            other.write_bytes(content)
    return f"{file.name}: {what}"


def _study_folder(drawn: random.Random, bases: Bases, folder: Path) -> str:
    """Copy a finished study to ``out`` and break files of it; what was done."""
    study = Path(shutil.copytree(bases.study, folder / "out"))
    records = sorted(study.glob("records/*/*.json"))
    others = sorted(file for file in study.iterdir() if file.is_file())
    done = []
    for _ in range(drawn.choice((1, 1, 2))):
        file = drawn.choice(records if drawn.random() < 0.5 else others)
        done.append(_broken(drawn, file, drawn.choice(records)))
    return "; ".join(done)


def _report(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str]:
    done = _study_folder(drawn, bases, folder)
    shown: Words = [] if drawn.random() < 0.1 else ["--no-replays"]
    return ["report", "out", *shown], done


def _rerun(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str]:
    done = _study_folder(drawn, bases, folder)
    run = f"c{drawn.randint(1, 4)}-s{drawn.randint(1, 3)}"
    if drawn.random() < 0.1:
        content, how = mutate(drawn, run.encode(), "")
        text = content.decode(errors="replace").replace("\0", "")
        run, done = text if text[:1] != "-" else "x", f"run: {how}; {done}"
    return ["rerun", "out", run, "--no-pictures", "--out", "again"], done


def _replay(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str]:
    run = Path(shutil.copytree(drawn.choice(bases.runs), folder / "run"))
    files = sorted(file for file in run.rglob("*") if file.is_file())
    chosen = drawn.sample(files, drawn.choice((1, 1, 2)))
    done = "; ".join(_broken(drawn, file, drawn.choice(files)) for file in chosen)
    again: Words = [] if drawn.random() < 0.15 else ["--no-rerun"]
    unsealed: Words = [] if drawn.random() < 0.3 else ["--unsealed"]
    return ["replay", "run", *again, *unsealed], done


def _recover(drawn: random.Random, bases: Bases, folder: Path) -> tuple[Words, str]:
    journal = Path(shutil.copytree(bases.journal, folder / "journal"))
    files = sorted(file for file in journal.iterdir() if file.is_file())
    chosen = drawn.sample(files, drawn.choice((1, 1, 2)))
    done = "; ".join(_broken(drawn, file, drawn.choice(files)) for file in chosen)
    where: Words = [] if drawn.random() < 0.3 else ["--out", "out"]
    return ["recover", "journal", *where], done


KINDS: Final[dict[str, tuple[int, Callable[..., tuple[Any, ...]]]]] = {
    "scenario": (28, _scenario),
    "settings": (15, _settings),
    "study": (12, _study),
    "profile": (11, _profile),
    "fmu": (6, _fmu),
    "trajectories": (9, _trajectories),
    "preset": (7, _preset),
    "records": (12, _records),
    "report": (4, _report),
    "rerun": (4, _rerun),
    "replay": (6, _replay),
    "recover": (6, _recover),
    **FOLDER_KINDS,
    **INPUT_KINDS,
    "kernels": (9, kernels),
}
"""Each kind's share, and what makes a case of it."""
