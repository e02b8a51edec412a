"""Which run is which: keys, cells and ids, and a run that is made again."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from giveway.errors import ResultsError
from giveway.journal.journal import Journal
from giveway.processes.heartbeat import Phase
from giveway.studies.execution.perform import perform
from giveway.studies.folder.store import RecordStore
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.identity import software_identity
from giveway.studies.plan import plan
from giveway.studies.repeated_run import OtherNumbersError, rerun


def test_other_settings_make_other_keys(small_study, small_study_text):
    from giveway.studies.definition import parse_definition

    changed = parse_definition(
        small_study_text.replace(
            "time_limit = 2.0", "time_limit = 2.0\n[run.pid]\nintegral_gain = 11.0"
        ),
        "s",
        Path(),
    )
    ours = plan(changed, "s")
    theirs = plan(small_study.definition, "s")
    assert {r.key for r in ours.runs(ours.seeds)}.isdisjoint(
        r.key for r in theirs.runs(theirs.seeds)
    )


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


def test_a_rerun_gives_the_studys_row_and_all_trajectories(small_study, tmp_path):
    result = rerun(small_study, "c3-s2", tmp_path / "again", pictures=False)
    assert len(result.egos) == 1
    summary = pd.read_csv(tmp_path / "again" / "summary.csv").iloc[0]
    row = pd.read_csv(small_study.path / "runs.csv").set_index("run").loc["c3-s2"]
    shared = [name for name in summary.index if name in row.index]
    assert len(shared) > 15
    pd.testing.assert_series_equal(summary[shared], row[shared], check_names=False)
    assert (tmp_path / "again" / "trajectories.csv").stat().st_size > 1000


def test_a_rerun_with_other_numbers_says_which(small_study, study_of, small_study_text, tmp_path):
    study = study_of(small_study_text.replace("= 5", "= 1"), tmp_path / "forged")
    store = RecordStore(study.path, software_identity())
    record = study.record("c1-s1")
    import dataclasses

    rows = ({**record.rows[0], "mean_speed": 3.21},)
    store.put(dataclasses.replace(record, rows=rows))
    with pytest.raises(OtherNumbersError, match=r"mean_speed = .* where .* has 3\.21"):
        rerun(StudyFolder.open(study.path), "c1-s1", None)


def test_the_folder_names_the_cells_as_they_were_run(study_of, tmp_path):
    """A named factor stands first: the file that keeps the study must not move it."""
    text = """
        name = "order"
        replications = 1
        [run]
        time_limit = 0.5
        [factors.crowd_of]
        "two" = { crowd = { pedestrians = 2 } }
        "one" = { crowd = { pedestrians = 1 } }
        [factors]
        controller = ["mpc-paper", "pid-paper"]
    """
    study = study_of(text, tmp_path / "order")
    rows = study.runs.set_index("run")
    for name, crowd, controller in (
        ("c2-s1", "two", "pid-paper"),
        ("c3-s1", "one", "mpc-paper"),
    ):
        assert (rows["crowd_of"][name], rows["controller"][name]) == (crowd, controller)
        again = rerun(study, name, None)
        assert again.config.controller == controller
        assert again.config.crowd.pedestrians == {"two": 2, "one": 1}[crowd]


def test_cells_with_the_same_settings_share_their_records(study_of, tmp_path):
    text = """
        name = "twins"
        replications = 3
        [run]
        time_limit = 0.5
        crowd.pedestrians = 1
        [factors.vehicle]
        "default" = {}
        "as by default" = { vehicle = { mass = 1000.0 } }
    """
    from giveway.config import RunConfig

    text = text.replace("1000.0", str(RunConfig().vehicle.mass))
    states = []
    study = study_of(text, tmp_path / "twins", states.append)
    assert list(study.runs["run"]) == [f"c{c}-s{s}" for c in (1, 2) for s in (1, 2, 3)]
    assert list(study.execution["run"]) == list(study.runs["run"])
    assert len(list(study.path.glob("records/*/*.json"))) == 3
    assert (states[-1].total, states[-1].made) == (6, 6)
    study_of(text, study.path, states.append, resume=True)
    assert (states[-1].kept, states[-1].made) == (6, 0)


def test_a_level_that_is_added_in_front_renumbers_the_runs(study_of, small_study_text, tmp_path):
    text = small_study_text.replace("= 5", "= 1").replace("[3, 2]", "[2]")
    folder = study_of(text, tmp_path / "more").path
    kept = {path: path.read_bytes() for path in folder.glob("records/*/*.json")}
    study_of(text.replace("[2]", "[1, 2]"), folder, resume=True)
    runs = pd.read_csv(folder / "runs.csv")
    assert list(runs["run"]) == [f"c{cell}-s1" for cell in (1, 2, 3, 4)]
    assert list(runs["crowd.pedestrians"]) == [1, 1, 2, 2]
    assert list(pd.read_csv(folder / "execution.csv")["run"]) == list(runs["run"])
    assert {path: path.read_bytes() for path in kept} == kept
    assert StudyFolder.open(folder).record("c3-s1").run == "c3-s1"


@pytest.mark.parametrize("run", ["c9-s1", "c01-s1", "1-s1", "c1-s99", "c1", "17", "", "c1-s-1"])
def test_a_run_that_is_not_in_the_study(small_study, run):
    with pytest.raises(ResultsError, match="expected c<cell>-s<seed>, c1-s1 to c4-s5"):
        rerun(small_study, run, None)


def test_a_task_survives_json(small_study):
    """What a worker reads is what was planned, down to the last bit."""
    planned = plan(small_study.definition, "s")
    run = next(planned.runs(planned.seeds))
    from giveway.config import RunConfig

    assert RunConfig.model_validate_json(run.task().config) == run.config
    journal = Journal(None)
    record = perform(run.task(), journal)
    assert journal.heartbeat.read().phase is Phase.MEASURING  # the last thing that may crash
    kept = small_study.record("c1-s1")
    assert kept is not None
    assert repr(record.rows) == repr(kept.rows)
