"""The doctor command: tables and the exit code."""

from __future__ import annotations

from typing import TYPE_CHECKING

from giveway.cli.commands.doctor_command import doctor_command

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    import pytest


def test_the_command_prints_tables_and_its_exit_code_tells(
    small_scenario: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    config = small_scenario()
    assert doctor_command(str(config)) == 0
    shown = capsys.readouterr().out
    assert "Environment" in shown
    whole = f"  giveway run {config} --ego=car --pedestrians 20 --spawn-area="
    assert any(line.startswith(whole) for line in shown.splitlines())
    config.with_name("car.rou.xml").unlink()
    assert doctor_command(str(config)) == 1
    shown = capsys.readouterr().out
    assert "-> put it there, or correct it" in shown
    assert "1 error: a run will not work until this is corrected." in shown
