"""Keys of runs: other settings and files make other keys."""

from __future__ import annotations

import platform
from dataclasses import replace
from pathlib import Path

import pytest

from giveway.errors import ConfigError
from giveway.studies.identity import require_same
from giveway.studies.plan import plan


def test_other_settings_make_other_keys(small_study, small_study_text):
    from giveway.studies.definition import parse_definition

    changed = parse_definition(
        small_study_text.replace(
            "time_limit = 2.0", "time_limit = 2.0\n[run.vehicle]\nmass = 1100.0"
        ),
        "s",
        Path(),
    )
    ours = plan(changed, "s")
    theirs = plan(small_study.definition, "s")
    assert {r.key for r in ours.runs(ours.seeds)}.isdisjoint(
        r.key for r in theirs.runs(theirs.seeds)
    )


def test_a_worker_elsewhere_is_refused_and_told_what_differs(small_study):
    run = next(iter(plan(small_study.definition, "s").runs(range(1, 2))))
    task = run.task()
    require_same(task)
    versions = task.versions | {"numpy": "1.0", "machine": "riscv64"}
    told = rf"machine {platform.machine()} instead of riscv64, numpy \S+ instead of 1.0\)"
    with pytest.raises(ConfigError, match=told):
        require_same(replace(task, software="other", versions=versions))
    assert {"machine", "C library"} < set(task.versions)


def test_a_scenarios_place_does_not_matter_but_its_contents_do(small_study_text, tmp_path):
    import shutil

    from giveway.studies.definition import parse_definition
    from sumo_scenarios import find

    def keys(folder):
        text = small_study_text.replace("[run]", f"[run]\nscenario = '{folder.as_posix()}'")
        planned = plan(parse_definition(text, "s", Path()), "s")
        return [run.key for run in planned.runs(planned.seeds)]

    source = find("shared_space").config_file.parent
    for name in ("here", "there"):
        shutil.copytree(source, tmp_path / name / "shared_space")
    here, there = (tmp_path / name / "shared_space" for name in ("here", "there"))
    assert keys(here) == keys(there)
    net = next(there.glob("*.net.xml"))
    net.write_text(net.read_text(encoding="utf-8") + "<!-- touched -->\n", encoding="utf-8")
    assert set(keys(here)).isdisjoint(keys(there))
