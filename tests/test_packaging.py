"""What makes packages of giveway agrees with pyproject.toml."""

from __future__ import annotations

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def read(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def test_the_conda_recipe_requires_what_the_project_requires() -> None:
    run = read("conda/meta.yaml").partition("  run:\n")[2].partition("\n\n")[0]
    asked = [line.removeprefix("    - ").replace(" ", "", 1) for line in run.splitlines()]
    assert asked == [f"python{PROJECT['requires-python']}", *PROJECT["dependencies"]]


@pytest.mark.parametrize("file", ["conda/meta.yaml", "CITATION.cff"])
def test_the_version_is_that_of_the_project(file: str) -> None:
    found = re.search(r'^ *version: "?([\d.]+)"?$', read(file), re.MULTILINE)
    assert found is not None
    assert found[1] == PROJECT["version"]


def test_the_dockerfile_copies_what_is_there() -> None:
    copied = re.findall(r"^COPY (?!--from)(\S+) ", read("Dockerfile"), re.MULTILINE)
    assert copied == [".", ".ci/requirements-run.txt"]
    assert all((ROOT / path).exists() for path in copied)
    left_out = read(".dockerignore").split()
    assert not any(path.startswith(".ci") for path in left_out)


@pytest.mark.parametrize("script", ["run", "latest", "wheels"])
def test_the_scripts_are_valid_bash(script: str) -> None:
    subprocess.run(["bash", "-n", ROOT / ".ci" / script], check=True)


def test_the_weekly_job_knows_the_bounded_packages() -> None:
    named = re.search(r"printf '%s\\n' (.+) >", read(".ci/latest"))
    assert named is not None
    names = set(named[1].split())
    dependencies = {re.split(r"[><=]", text)[0] for text in PROJECT["dependencies"]}
    assert names - dependencies == {"eclipse-sumo"}  # of the extra new, with libsumo's version
