"""``giveway study`` and its companions, as a user types them."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import time

import pytest


def one_line(done, code):
    assert done.returncode == code, done.stderr
    lines = done.stderr.strip().splitlines()
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("error: ")
    return lines[0]


def test_a_study_from_start_to_replay(type_here, small_study_text, tmp_path):
    (tmp_path / "small.toml").write_text(small_study_text, encoding="utf-8")
    done = type_here("study", "small.toml", "--jobs", "2", "--no-report")
    assert done.returncode == 0, done.stderr
    assert "20 runs in" in done.stdout
    assert "controller: mpc minus pid" in done.stdout
    study = tmp_path / "results" / "study_small"
    done = type_here("report", str(study))
    assert done.returncode == 0, done.stderr
    page = (study / "report.html").read_text(encoding="utf-8")
    links = set(re.findall(r'href="(replays/[^"#]+)', page))
    assert links
    assert all((study / link).is_file() for link in links)
    assert {path.suffix for path in (study / "figures").iterdir()} == {".png", ".svg"}

    done = type_here("rerun", str(study), "c1-s2", "--no-pictures")
    assert done.returncode == 0, done.stderr
    assert "Its numbers are those of the study's row." in done.stdout
    done = type_here("replay", str(study / "reruns" / "c1-s2"), "--no-rerun")
    assert done.returncode == 0, done.stderr
    assert (study / "reruns" / "c1-s2" / "replay.html").stat().st_size > 50_000
    other = str(study / "reruns" / "c1-s2")
    both = tmp_path / "both.html"
    done = type_here("replay", other, "--beside", other, "--out", str(both), "--no-rerun")
    assert done.returncode == 0, done.stderr
    assert both.read_text(encoding="utf-8").count("<iframe") == 2

    assert "a study is there" in one_line(type_here("study", "small.toml"), 2)
    done = type_here("study", "small.toml", "--resume", "--no-report")
    assert done.returncode == 0, done.stderr


def test_a_dry_run_tells_the_plan_and_leaves_nothing(type_here, small_study_text, tmp_path):
    (tmp_path / "small.toml").write_text(small_study_text, encoding="utf-8")
    done = type_here("study", "small.toml", "--dry-run", "--runs", "700", "--jobs", "1")
    assert done.returncode == 0, done.stderr
    assert "2,800 runs: 4 cells with seeds 1 to 700" in " ".join(done.stdout.split())
    assert not (tmp_path / "results").exists()


def test_a_dry_run_tells_which_cells_fail(type_here, tmp_path):
    (tmp_path / "f.toml").write_text(
        'name = "f"\n[run]\ntime_limit = 0.5\n[factors.ego_of]\n'
        '"ours" = {}\n"nobody" = { ego = { take_over = ["nobody"] } }\n',
        encoding="utf-8",
    )
    done = type_here("study", "f.toml", "--dry-run", "--jobs", "1")
    assert done.returncode == 0, done.stderr
    assert re.search(r"nobody │ +failed", done.stdout)
    assert re.search(r"ours │ +0\.\d\d\d", done.stdout)


def test_the_bundled_studies_are_listed(type_here):
    done = type_here("studies")
    names = [line.split()[0] for line in done.stdout.splitlines() if line and line[0].isalpha()]
    assert {"ablation", "controllers", "law", "paper", "readings"} <= set(names)


def test_the_papers_table_stands_beside_ours(type_here, tmp_path):
    done = type_here("study", "paper", "--runs", "1", "--no-report", "--jobs", "1", "--out", "p")
    assert done.returncode == 0, done.stderr
    assert "paper -1.27" in done.stdout
    assert json.loads((tmp_path / "p" / "manifest.json").read_text())["seeds"] == 1


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("study", "nothing"), "no such study"),
        (("study", "nothing.toml"), "no such file"),
        (("study", "paper", "--runs", "0"), "--runs"),
        (("study", "paper", "--jobs", "0"), "--jobs"),
        (("study", "paper", "--first-seed", "2147483647"), "beyond"),
        (("study", "paper", "--cluster", "nonsense", "--runs", "1"), "tcp://"),
        (("report", "nowhere"), "no study there"),
        (("rerun", "nowhere", "c1-s1"), "no study there"),
        (("replay", "nowhere"), "nowhere"),
    ],
)
def test_what_cannot_be_done_is_said_in_one_line(type_here, words, said):
    done = type_here(*words)
    assert said in one_line(done, done.returncode)
    assert done.returncode in {1, 2}


def test_runs_that_fail_make_the_exit_code_1(type_here, tmp_path):
    (tmp_path / "f.toml").write_text(
        'name = "f"\nreplications = 1\n[run]\ntime_limit = 0.5\n[factors.ego_of]\n'
        '"ours" = {}\n"nobody" = { ego = { take_over = ["nobody"] } }\n',
        encoding="utf-8",
    )
    done = type_here("study", "f.toml", "--no-report", "--jobs", "1")
    assert done.returncode == 1
    assert "1 of 2 runs has no result (cell 2), see failures.csv" in done.stdout
    assert "nobody" in done.stdout
    assert "--resume --retry-failed makes them again" in " ".join(done.stdout.split())
    again = type_here("rerun", "results/study_f", "c2-s1")
    assert "nobody" in one_line(again, again.returncode)


@pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGINT to send")
def test_ctrl_c_keeps_what_is_finished_and_leaves_no_process(small_study_text, tmp_path):
    import psutil

    (tmp_path / "small.toml").write_text(
        small_study_text.replace("replications = 5", "replications = 500"), encoding="utf-8"
    )
    command = [sys.executable, "-m", "giveway", "study", "small.toml", "--out", "s"]
    child = subprocess.Popen(
        command, cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True
    )
    records = tmp_path / "s" / "records"
    deadline = time.monotonic() + 120.0
    while len(list(records.glob("*/*.json"))) < 5:
        assert child.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.02)
    family = psutil.Process(child.pid).children(recursive=True)
    assert family
    child.send_signal(signal.SIGINT)
    _, errors = child.communicate(timeout=180)
    assert child.returncode == 130
    assert re.search(r"error: interrupted; [\d,]+ of 2,000 runs are kept in s: .*--resume", errors)
    _, alive = psutil.wait_procs(family, timeout=60)
    assert alive == []
    assert (tmp_path / "s" / "runs.csv").is_file()
