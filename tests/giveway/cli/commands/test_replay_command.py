"""The replay command: it repeats a run for its predictions."""

from __future__ import annotations

import json
import shutil
from typing import TYPE_CHECKING, Any

import pytest
from support.runs import unseal

from giveway.cli.commands.replay_command import PlayChoice, replay_command
from giveway.replays import write_replay

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def folder(recorded: Path, tmp_path: Path) -> Path:
    """A copy of the recorded run, to be tampered with."""
    return unseal(shutil.copytree(recorded, tmp_path / "run"))


def content(page: Path) -> dict[str, Any]:
    """The data that a page holds."""
    text = page.read_text(encoding="utf-8")
    data = text.split('<script type="application/json" id="run">')[1].split("</script>")[0]
    return json.loads(data)


def test_the_command_makes_the_run_again_for_its_predictions(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recorded = (folder / "predictions.csv").read_bytes()
    (folder / "predictions.csv").unlink()
    assert replay_command(folder) == 0
    assert "replay.html" in capsys.readouterr().out
    made = content(folder / "replay.html")
    (folder / "predictions.csv").write_bytes(recorded)
    assert made["egos"] == content(write_replay(folder, folder / "own.html"))["egos"]


def test_predictions_of_a_run_that_differed_are_not_shown(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "predictions.csv").unlink()
    rows = (folder / "ego.csv").read_text().splitlines(keepends=True)
    rows[5] = rows[6]
    (folder / "ego.csv").write_text("".join(rows))
    assert replay_command(folder) == 0
    assert "went differently" in capsys.readouterr().err
    made = content(folder / "replay.html")
    assert made["egos"][0]["predicted"] is None
    assert any("went differently" in note for note in made["notes"])


def test_no_rerun_makes_no_run(folder: Path) -> None:
    (folder / "predictions.csv").unlink()
    (folder / "config.toml").write_text((folder / "config.toml").read_text() + "# as it was\n")
    assert replay_command(folder, PlayChoice(rerun=False)) == 0
    made = content(folder / "replay.html")
    assert made["egos"][0]["predicted"] is None
    assert any("--record-predictions" in note for note in made["notes"])
