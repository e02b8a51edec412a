"""What a disk, an editor or a copy has changed in a study is named, put aside and made again."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from giveway.cli.commands.report_command import write_all
from giveway.studies.folder.folder_contents import broken_files
from giveway.studies.folder.sealing import SEAL, BrokenFileError
from giveway.studies.folder.study_folder import StudyFolder


def victim(folder: Path) -> Path:
    return min(folder.glob("records/*/*.json"))


def edit(file: Path, change) -> None:
    """Change what a JSON file says."""
    content = json.loads(file.read_text(encoding="utf-8"))
    change(content)
    file.write_text(json.dumps(content), encoding="utf-8")


def other_number(record: Path) -> None:
    edit(record, lambda values: values["rows"][0].update(mean_speed=1.25))


def markup_for_a_number(record: Path) -> None:
    edit(record, lambda values: values["rows"][0].update(mean_speed="<b>"))


def no_seal(record: Path) -> None:
    edit(record, lambda values: values.pop(SEAL))


def other_maker(record: Path) -> None:
    edit(record, lambda values: values[SEAL].update(software="somebody else"))


def another_run(record: Path) -> None:
    shutil.copy(max(record.parent.parent.glob("*/*.json")), record)


def one_bit(record: Path) -> None:
    content = bytearray(record.read_bytes())
    content[len(content) // 2] ^= 1
    record.write_bytes(content)


def half(record: Path) -> None:
    record.write_bytes(record.read_bytes()[:100])


def a_folder(record: Path) -> None:
    record.unlink()
    record.mkdir()


@pytest.fixture
def copy(small_study, tmp_path) -> Path:
    return Path(shutil.copytree(small_study.path, tmp_path / "copy"))


@pytest.mark.parametrize(
    "break_",
    [
        *(other_number, markup_for_a_number, no_seal, other_maker, another_run, one_bit, half),
        a_folder,
    ],
)
def test_a_broken_record_is_named_put_aside_and_made_again(
    small_study, study_of, small_study_text, tables_of, copy, capsys, break_
):
    record = victim(copy)
    whole = record.read_bytes()
    break_(record)
    broken = record.read_bytes() if record.is_file() else None
    with pytest.raises(BrokenFileError, match=rf"{record.name}.*with --resume"):
        _ = StudyFolder.open(copy).runs
    states = []
    study_of(small_study_text, copy, states.append, resume=True)
    assert states[-1].made == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"note: {record}: ")
    aside = copy / "broken" / record.relative_to(copy)
    assert str(aside) in line
    assert (aside.read_bytes() if aside.is_file() else None) == broken
    made, former = json.loads(record.read_bytes()), json.loads(whole)
    assert made["rows"] == former["rows"]
    assert tables_of(copy) == tables_of(small_study.path)


@pytest.mark.parametrize(
    ("name", "before", "after"),
    [
        ("manifest.json", '"seeds": 5', '"seeds": 4'),
        ("manifest.json", '"study": "small"', '"study": "smelt"'),
        ("manifest.json", "{", "["),
        ("study.toml", "resamples = 99", "resamples = 98"),
        ("runs.csv", "c1-s2", "c1-s3"),
        ("comparison.csv", "mean_speed", "mean_spree"),
        ("datapackage.json", "m/s", "km/h"),
    ],
)
def test_a_broken_file_is_named_put_aside_and_made_again(
    small_study, study_of, small_study_text, tables_of, copy, capsys, name, before, after
):
    file = copy / name
    text = file.read_text(encoding="utf-8")
    assert before in text
    file.write_text(text.replace(before, after, 1), encoding="utf-8")
    study_of(small_study_text, copy, resume=True)
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"note: {file}: is not what giveway wrote; put aside in {copy}")
    assert (copy / "broken" / name).is_file()
    assert tables_of(copy) == tables_of(small_study.path)
    assert broken_files(copy) == []


@pytest.mark.parametrize("name", ["datapackage.json", "manifest.json"])
def test_a_sealed_file_in_the_place_of_another_is_made_again(
    small_study, study_of, small_study_text, tables_of, copy, capsys, name
):
    shutil.copy(victim(copy), copy / name)
    study_of(small_study_text, copy, resume=True)
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"note: {copy / name}: is not what giveway wrote; put aside")
    assert tables_of(copy) == tables_of(small_study.path)
    assert broken_files(copy) == []


@pytest.mark.parametrize("name", ["study.toml", "manifest.json"])
def test_a_report_is_not_made_of_a_broken_definition(copy, name):
    text = (copy / name).read_text(encoding="utf-8")
    (copy / name).write_text(text.replace("5", "4", 1), encoding="utf-8")
    with pytest.raises(BrokenFileError, match=rf"{name}: is not what giveway wrote.*--resume"):
        StudyFolder.open(copy)


def test_a_broken_comparison_is_not_reported(small_study, tables_of, copy, capsys, monkeypatch):
    from rich.console import Console

    file = copy / "comparison.csv"
    file.write_text(file.read_text(encoding="utf-8").replace("1", "2"), encoding="utf-8")
    assert StudyFolder.open(copy).comparison.equals(small_study.comparison)
    monkeypatch.setattr("giveway.reports.with_replays.write_report_of", lambda *_, **__: copy)
    write_all(StudyFolder.open(copy), Console(quiet=True))
    assert f"note: {file}: is not what giveway wrote" in capsys.readouterr().err
    assert tables_of(copy) == tables_of(small_study.path)


def test_a_study_of_an_earlier_giveway_is_read_and_rerun(
    small_study, study_of, small_study_text, tables_of, copy, capsys
):
    """It has sealed nothing."""

    def unseal(content):
        del content[SEAL]
        content.pop("definition", None)
        if "identity" in content:
            content["identity"] = "0123456789abcdef"
        for resource in content.get("resources", ()):
            del resource["hash"], resource["bytes"]

    for file in (*copy.glob("records/*/*.json"), *copy.glob("*.json")):
        edit(file, unseal)
    assert StudyFolder.open(copy).runs.equals(small_study.runs)
    for file in copy.glob("records/*/*.json"):
        file.unlink()  # their names are hashes of the code that made them
    states = []
    study_of(small_study_text, copy, states.append, resume=True)
    assert states[-1].made == 20
    (line,) = capsys.readouterr().err.splitlines()
    assert "another giveway" in line
    assert "0123456789abcdef" in line
    assert tables_of(copy) == tables_of(small_study.path)
