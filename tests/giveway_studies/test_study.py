"""A study as a whole: its rows, its resumption, its folder."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

from giveway.errors import ConfigError, GivewayError, ResultsError
from giveway.heartbeat import Phase
from giveway.journal import Journal
from giveway.studies.folder import StudyFolder
from giveway.studies.performing import perform
from giveway.studies.plan import plan
from giveway.studies.rerun import OtherNumbersError, rerun
from giveway.studies.store import RecordStore
from giveway.studies.study import StudyInterruptedError, StudyOptions, run_study


def test_runs_csv_has_a_row_per_run_and_the_summarys_numbers(small):
    runs = pd.read_csv(small.path / "runs.csv", dtype={"ego": str})
    assert list(runs["run"]) == [f"c{c}-s{s}" for c in range(1, 5) for s in range(1, 6)]
    import giveway

    settings = {"controller": "pid", "crowd": {"pedestrians": 2}, "seed": 4, "time_limit": 2.0}
    alone = giveway.run(settings).summary
    row = runs[runs["run"] == "c4-s4"].iloc[0]
    assert row["controller"] == "pid"
    assert row["crowd.pedestrians"] == 2
    for name in ("travelled_distance", "mean_speed", "minimum_clearance", "rms_jerk"):
        assert row[name] == pytest.approx(alone[name], abs=5e-7)


def test_pairs_meet_the_same_crowd(small):
    """Until the ego reacts, nothing but the controller differs."""
    mpc, pid = (rerun(small, f"c{cell}-s3", None) for cell in (1, 2))
    assert mpc.config.controller != pid.config.controller
    first = [(r.crowd_track.x[:3].tolist(), r.crowd_track.y[:3].tolist()) for r in (mpc, pid)]
    assert first[0] == first[1]


def test_comparison_csv_holds_the_mean_of_the_paired_differences(small):
    runs = pd.read_csv(small.path / "runs.csv", dtype={"ego": str})
    comparison = pd.read_csv(small.path / "comparison.csv")
    row = comparison.query(
        "`crowd.pedestrians` == 3 and situation == 'general' and metric == 'mean_speed'"
    ).iloc[0]
    chosen = runs[runs["crowd.pedestrians"] == 3].pivot_table(
        index="seed", columns="controller", values="mean_speed"
    )
    assert row["mean_difference"] == pytest.approx((chosen["mpc"] - chosen["pid"]).mean(), abs=1e-6)
    assert row["n"] == 5


def test_every_table_is_described_by_the_data_package(small):
    import json

    package = json.loads((small.path / "datapackage.json").read_text(encoding="utf-8"))
    for resource in package["resources"]:
        header = (small.path / resource["path"]).read_text(encoding="utf-8").splitlines()[0]
        names = [field["name"] for field in resource["schema"]["fields"]]
        assert header.split(",") == names
        assert all(field["description"] for field in resource["schema"]["fields"])
    assert {r["name"] for r in package["resources"]} == {
        path.stem for path in small.path.glob("*.csv")
    }


def test_the_number_of_workers_does_not_matter(small, study_of, small_text, tables_of, tmp_path):
    two = study_of(small_text, tmp_path / "two", jobs=2)
    assert tables_of(two.path) == tables_of(small.path)


def test_an_interrupted_study_goes_on_where_it_was(
    small, study_of, small_text, tables_of, tmp_path
):
    def interrupt(progress):
        if progress.made == 7:
            raise KeyboardInterrupt

    with pytest.raises(StudyInterruptedError, match="7 of 20 runs are kept"):
        study_of(small_text, tmp_path / "half", interrupt)
    half = StudyFolder.open(tmp_path / "half")
    assert len(half.records) == 7
    assert len(pd.read_csv(half.path / "runs.csv")) == 7

    states = []
    whole = study_of(small_text, tmp_path / "half", states.append, resume=True)
    assert states[-1].kept == 7
    assert states[-1].made == 13
    assert tables_of(whole.path) == tables_of(small.path)


def test_ctrl_c_twice_while_the_tables_are_made_is_still_one_line(
    small, study_of, small_text, tables_of, tmp_path, monkeypatch
):
    import shutil

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    folder = shutil.copytree(small.path, tmp_path / "copy")
    monkeypatch.setattr("giveway.studies.study.write_tables", interrupted)
    with pytest.raises(StudyInterruptedError, match="20 of 20 runs are kept"):
        study_of(small_text, folder, resume=True)
    monkeypatch.undo()
    assert not StudyFolder.open(folder).complete
    study_of(small_text, folder, resume=True)
    assert tables_of(folder) == tables_of(small.path)


def test_a_folder_that_has_become_read_only_is_said_in_one_line(
    small, study_of, small_text, tmp_path, monkeypatch
):
    import shutil

    def read_only(self, missing_ok=False):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(self))

    folder = shutil.copytree(small.path, tmp_path / "copy")
    monkeypatch.setattr(Path, "unlink", read_only)
    with pytest.raises(ResultsError, match=r"cannot be removed \(Read-only file system\)"):
        study_of(small_text, folder, resume=True)


@pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGKILL")
def test_a_killed_study_goes_on_where_it_was(small, small_text, tables_of, tmp_path):
    file = tmp_path / "small.toml"
    file.write_text(small_text, encoding="utf-8")
    command = [sys.executable, "-m", "giveway", "study", str(file), "--out", str(tmp_path / "out")]
    command += ["--jobs", "2", "--quiet", "--no-report"]
    child = subprocess.Popen(command, start_new_session=True)
    records = tmp_path / "out" / "records"
    deadline = time.monotonic() + 120.0
    while len(list(records.glob("*/*.json"))) < 3:
        assert child.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.01)
    os.kill(child.pid, signal.SIGKILL)
    child.wait()
    made = {path: path.read_bytes() for path in records.glob("*/*.json")}
    assert 3 <= len(made) < 20

    done = subprocess.run([*command, "--resume"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert {path: path.read_bytes() for path in made} == made  # none was made again
    ours, theirs = tables_of(tmp_path / "out"), tables_of(small.path)
    assert ours.keys() == theirs.keys()
    assert [name for name in ours if ours[name] != theirs[name]] == []


def test_a_record_that_somebody_broke_is_made_again(
    small, study_of, small_text, tables_of, tmp_path
):
    folder = study_of(small_text, tmp_path / "broken").path
    victims = sorted(folder.glob("records/*/*.json"))[:2]
    victims[0].write_text('{"run": "c1-s1"', encoding="utf-8")
    victims[1].unlink()
    (victims[0].parent / "left-over.new").write_text("half")
    states = []
    study_of(small_text, folder, states.append, resume=True)
    assert states[-1].made == 2
    assert tables_of(folder) == tables_of(small.path)


def test_more_seeds_can_be_added_later(study_of, small_text, tmp_path):
    few = small_text.replace("replications = 5", "replications = 2")
    folder = study_of(few, tmp_path / "grown").path
    states = []
    grown = study_of(few.replace("= 2\n[run]", "= 4\n[run]"), folder, states.append, resume=True)
    assert (states[-1].kept, states[-1].made) == (8, 8)
    assert len(grown.runs) == 16


def test_other_settings_make_other_keys(small, small_text):
    from giveway.studies.definition import parse_definition

    changed = parse_definition(
        small_text.replace("time_limit = 2.0", "time_limit = 2.0\n[run.pid]\nintegral_gain = 11.0"),
        "s",
        Path(),
    )
    ours = plan(changed, "s")
    theirs = plan(small.definition, "s")
    assert {r.key for r in ours.runs(ours.seeds)}.isdisjoint(
        r.key for r in theirs.runs(theirs.seeds)
    )


def test_where_the_scenario_lies_does_not_matter_but_what_it_holds_does(small_text, tmp_path):
    import shutil

    from giveway.studies.definition import parse_definition
    from sumo_scenarios import find

    def keys(folder):
        text = small_text.replace("[run]", f"[run]\nscenario = '{folder.as_posix()}'")
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


def test_a_study_is_not_overwritten_unasked(small, study_of, small_text):
    with pytest.raises(ResultsError, match="a study is there; go on with it by --resume"):
        study_of(small_text, small.path)


def test_a_folder_with_somebody_elses_files_is_left_alone(study_of, small_text, tmp_path):
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(ResultsError, match=r"holds 'thesis\.tex'"):
        study_of(small_text, tmp_path, force=True)
    assert list(tmp_path.iterdir()) == [tmp_path / "thesis.tex"]


def test_two_processes_do_not_work_on_one_study(study_of, small_text, tmp_path):
    def second(progress):
        if progress.made == 1:
            with pytest.raises(ResultsError, match="another giveway study is at work"):
                study_of(small_text, tmp_path / "one", resume=True)

    study_of(small_text.replace("= 5", "= 1"), tmp_path / "one", second)


def test_a_full_disk_keeps_what_is_there(study_of, small_text, tables_of, tmp_path, monkeypatch):
    real = Path.replace
    written = []

    def full(self, target):
        if self.parent.parent.name == "records":
            written.append(self)
            if len(written) > 4:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(self))
        return real(self, target)

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(ResultsError, match=r"No space left.*go on with --resume"):
        study_of(small_text, tmp_path / "full")
    monkeypatch.undo()
    states = []
    study_of(small_text, tmp_path / "full", states.append, resume=True)
    assert states[-1].kept == 4


def test_failed_runs_are_listed_with_the_command_that_repeats_them(study_of, tmp_path):
    """An ego that the scenario never lets depart."""
    text = """
        name = "lost"
        replications = 2
        [run.ego]
        depart_position = 1.0
        [factors.where]
        "on the road" = { time_limit = 0.5 }
        "nowhere" = { ego = { take_over = ["nobody"] } }
    """
    study = study_of(text, tmp_path / "lost")
    failures = pd.read_csv(study.path / "failures.csv")
    assert list(failures["run"]) == ["c2-s1", "c2-s2"]
    assert failures["cause"].str.contains("nobody").all()
    assert failures["reproduce"].iloc[0] == f"giveway rerun {study.path} c2-s1"
    runs = pd.read_csv(study.path / "runs.csv")
    assert list(runs["ending"]) == ["time limit"] * 2 + ["failed"] * 2
    assert runs["travelled_distance"].notna().tolist() == [True, True, False, False]
    states = []
    study_of(text, study.path, states.append, resume=True)
    assert states[-1].made == 0
    study_of(text, study.path, states.append, resume=True, retry_failed=True)
    assert states[-1].made == 2


def test_a_rerun_gives_the_studys_row_and_all_trajectories(small, tmp_path):
    result = rerun(small, "c3-s2", tmp_path / "again", pictures=False)
    assert len(result.egos) == 1
    summary = pd.read_csv(tmp_path / "again" / "summary.csv").iloc[0]
    row = pd.read_csv(small.path / "runs.csv").set_index("run").loc["c3-s2"]
    shared = [name for name in summary.index if name in row.index]
    assert len(shared) > 15
    pd.testing.assert_series_equal(summary[shared], row[shared], check_names=False)
    assert (tmp_path / "again" / "trajectories.csv").stat().st_size > 1000


def test_a_rerun_with_other_numbers_says_which(small, study_of, small_text, tmp_path):
    study = study_of(small_text.replace("= 5", "= 1"), tmp_path / "forged")
    store = RecordStore(study.path)
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
        "none" = { crowd = { pedestrians = 0 } }
        [factors]
        controller = ["mpc", "pid"]
    """
    study = study_of(text, tmp_path / "order")
    rows = study.runs.set_index("run")
    for name, crowd, controller in (("c2-s1", "two", "pid"), ("c3-s1", "none", "mpc")):
        assert (rows["crowd_of"][name], rows["controller"][name]) == (crowd, controller)
        again = rerun(study, name, None)
        assert again.config.controller == controller
        assert again.config.crowd.pedestrians == {"two": 2, "none": 0}[crowd]


def test_cells_with_the_same_settings_share_their_records(study_of, tmp_path):
    text = """
        name = "twins"
        replications = 3
        [run]
        time_limit = 0.5
        crowd.pedestrians = 1
        [factors.gains]
        "default" = {}
        "as by default" = { pid = { proportional_gain = 2400.0 } }
    """
    from giveway.config import RunConfig

    text = text.replace("2400.0", str(RunConfig().pid.proportional_gain))
    states = []
    study = study_of(text, tmp_path / "twins", states.append)
    assert list(study.runs["run"]) == [f"c{c}-s{s}" for c in (1, 2) for s in (1, 2, 3)]
    assert list(study.execution["run"]) == list(study.runs["run"])
    assert len(list(study.path.glob("records/*/*.json"))) == 3
    assert (states[-1].total, states[-1].made) == (6, 6)
    study_of(text, study.path, states.append, resume=True)
    assert (states[-1].kept, states[-1].made) == (6, 0)


def test_a_level_that_is_added_in_front_renumbers_the_runs(study_of, small_text, tmp_path):
    text = small_text.replace("= 5", "= 1").replace("[3, 2]", "[2]")
    folder = study_of(text, tmp_path / "more").path
    kept = {path: path.read_bytes() for path in folder.glob("records/*/*.json")}
    study_of(text.replace("[2]", "[1, 2]"), folder, resume=True)
    runs = pd.read_csv(folder / "runs.csv")
    assert list(runs["run"]) == [f"c{cell}-s1" for cell in (1, 2, 3, 4)]
    assert list(runs["crowd.pedestrians"]) == [1, 1, 2, 2]
    assert list(pd.read_csv(folder / "execution.csv")["run"]) == list(runs["run"])
    assert {path: path.read_bytes() for path in kept} == kept
    assert StudyFolder.open(folder).record("c3-s1").run == "c3-s1"


def test_a_comparison_of_half_a_study_is_not_taken_for_the_whole(
    small, study_of, small_text, tables_of, tmp_path
):
    """Somebody has the report written while the study is at work."""
    from giveway.studies.output import write_tables

    def look(progress):
        if progress.made == 17:
            write_tables(StudyFolder.open(tmp_path / "out"), whole=True)

    study = study_of(small_text, tmp_path / "out", look)
    assert tables_of(study.path) == tables_of(small.path)


def test_what_is_read_back_is_what_was_computed(small, tmp_path):
    import shutil

    folder = shutil.copytree(small.path, tmp_path / "copy")
    kept = StudyFolder.open(folder).comparison
    (folder / "comparison.csv").unlink()
    pd.testing.assert_frame_equal(kept, StudyFolder.open(folder).comparison, check_dtype=False)


@pytest.mark.parametrize("name", ["runs.csv", "study.toml", "manifest.json", "datapackage.json"])
def test_a_kill_while_a_file_is_written_does_not_keep_it_from_going_on(
    small, study_of, small_text, tables_of, tmp_path, monkeypatch, name
):
    import shutil

    class KilledError(BaseException):
        pass

    def killed(self, target):
        if target.name == name:
            raise KilledError
        return real(self, target)

    folder = shutil.copytree(small.path, tmp_path / "copy")
    real = Path.replace
    monkeypatch.setattr(Path, "replace", killed)
    with pytest.raises(KilledError):
        study_of(small_text, folder, resume=True)
    monkeypatch.undo()
    study_of(small_text, folder, resume=True)
    assert tables_of(folder) == tables_of(small.path)


def test_definition_and_manifest_of_two_studies_are_not_mixed(
    study_of, small_text, tmp_path, monkeypatch
):
    folder = study_of(small_text.replace("= 5", "= 1"), tmp_path / "mixed").path
    text = (folder / "study.toml").read_text(encoding="utf-8")
    (folder / "study.toml").write_text(text.replace("[3, 2]", "[2, 3]"), encoding="utf-8")
    with pytest.raises(ResultsError, match=r"other cells than study\.toml.*--resume"):
        StudyFolder.open(folder)


def test_another_study_does_not_go_on_in_this_folder(study_of, small_text, small):
    other = small_text.replace('"small"', '"other"')
    with pytest.raises(ResultsError, match="holds the study 'small'; expected 'other'"):
        study_of(other, small.path, resume=True)


def test_a_note_beside_a_study_does_no_harm(small, study_of, small_text, tmp_path):
    import shutil

    folder = shutil.copytree(small.path, tmp_path / "noted")
    (folder / "note.txt").touch()
    study_of(small_text, folder, resume=True)
    with pytest.raises(ResultsError, match=r"holds 'note\.txt'"):
        study_of(small_text, folder, force=True)
    assert (folder / "note.txt").is_file()


def test_what_contradicts_itself_is_refused():
    with pytest.raises(ConfigError, match="--resume and --force"):
        StudyOptions(resume=True, force=True)
    with pytest.raises(ConfigError, match="--jobs and --cluster"):
        StudyOptions(jobs=2, cluster="local:2")


def test_a_cluster_that_is_not_there_costs_nothing(small, study_of, small_text, tmp_path):
    import shutil

    folder = shutil.copytree(small.path, tmp_path / "kept")
    before = {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    with pytest.raises(GivewayError, match="cannot be reached"):
        study_of(small_text, folder, resume=True, jobs=None, cluster="tcp://127.0.0.1:1")
    after = {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    assert before == after


@pytest.mark.parametrize("run", ["c9-s1", "c01-s1", "1-s1", "c1-s99", "c1", "17", "", "c1-s-1"])
def test_a_run_that_is_not_in_the_study(small, run):
    with pytest.raises(ResultsError, match="expected c<cell>-s<seed>, c1-s1 to c4-s5"):
        rerun(small, run, None)


def test_a_folder_without_a_study(tmp_path):
    with pytest.raises(ResultsError, match="no study there"):
        StudyFolder.open(tmp_path)


def test_seeds_are_added_until_the_interval_is_narrow(study_of, tmp_path):
    text = """
        name = "narrow"
        replications = 60
        [run]
        time_limit = 1.0
        crowd.pedestrians = 1
        [factors]
        controller = ["mpc", "pid"]
        [comparison]
        minimum_pairs = 5
        resamples = 199
        [precision]
        metric = "mean_speed"
        width = WIDTH
        minimum = 10
        batch = 10
    """
    wide = study_of(text.replace("WIDTH", "1.0"), tmp_path / "wide")
    assert len(wide.runs) == 20  # enough at the first look
    narrow = study_of(text.replace("WIDTH", "1e-12"), tmp_path / "narrow")
    assert len(narrow.runs) in {20, 120}  # 20 only if nothing varies at all
    assert narrow.planned == len(narrow.runs)


def test_the_order_of_the_runs_keeps_pairs_together(small):
    planned = plan(small.definition, "s")
    order = [run.id for run in planned.runs(planned.seeds)]
    assert order[:4] == ["c1-s1", "c2-s1", "c3-s1", "c4-s1"]


def test_a_task_survives_json(small):
    """What a worker reads is what was planned, down to the last bit."""
    planned = plan(small.definition, "s")
    run = next(planned.runs(planned.seeds))
    from giveway.config import RunConfig

    assert RunConfig.model_validate_json(run.task().config) == run.config
    journal = Journal(None)
    record = perform(run.task(), journal)
    assert journal.heartbeat.read().phase is Phase.MEASURING  # the last thing that may crash
    kept = small.record("c1-s1")
    assert kept is not None
    assert repr(record.rows) == repr(kept.rows)


def test_an_unusable_number_of_jobs_is_refused(study_of, small_text, tmp_path):
    with pytest.raises(GivewayError):
        run_study(
            _definition(small_text),
            "s",
            tmp_path / "x",
            StudyOptions(hang_limit=-1.0, jobs=1),
        )


def _definition(text):
    from giveway.studies.definition import parse_definition

    return parse_definition(text, "s", Path())
