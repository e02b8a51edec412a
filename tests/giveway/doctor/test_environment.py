"""The environment, as the doctor checks it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from giveway.doctor import Finding, examine_environment

if TYPE_CHECKING:
    from pathlib import Path


def about(findings: list[Finding], subject: str) -> Finding:
    (found,) = [finding for finding in findings if finding.subject == subject]
    return found


def errors(findings: list[Finding]) -> list[Finding]:
    return [finding for finding in findings if finding.level == "error"]


def test_this_environment_is_sound(tmp_path: Path) -> None:
    findings = examine_environment(tmp_path)
    assert errors(findings) == []
    subjects = {finding.subject for finding in findings}
    assert {"Python", "SUMO", "OSQP", "numba", "vehicle, FMI 2.0", "libsumo"} <= subjects
    assert "1.28" in about(findings, "SUMO").text


def test_a_results_folder_below_a_file_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    finding = about(examine_environment(tmp_path / "file" / "results"), "results folder")
    assert finding.level == "error"
    assert "--out" in finding.remedy
