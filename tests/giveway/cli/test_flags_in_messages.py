"""A message that names a flag names one that exists."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import typer

import fmus
import giveway
from giveway.cli.app import build_app

SOURCES = {
    package: sorted(Path(package.__file__ or "").parent.rglob("*.py"))
    for package in (fmus, giveway)
}


def options(command):
    """Of a command: its flags."""
    return {
        flag
        for parameter in command.params
        for flag in (*parameter.opts, *parameter.secondary_opts)
    }


@pytest.fixture(scope="module")
def run_flags():
    return options(typer.main.get_command(build_app(["run"])).commands["run"])


def named(pattern, paths):
    """(file, flag) of every message that tells to use a flag."""
    for path in paths:
        for match in re.finditer(pattern, re.sub(r'"\s+f?"', "", path.read_text("utf-8"))):
            yield path.name, match[1]


def test_what_a_run_is_told_to_use_is_a_flag_of_run(run_flags):
    told = list(named(r"run (?:it )?with (--[a-z][a-z-]+)", [*SOURCES[fmus], *SOURCES[giveway]]))
    assert told
    assert [(name, flag) for name, flag in told if flag not in run_flags] == []


def test_the_rooms_messages_name_flags_that_exist(run_flags):
    fmu = typer.main.get_command(build_app(["fmu"])).commands["fmu"]
    known = run_flags.union(*map(options, fmu.commands.values()))
    told = named(r"[\s(](--[a-z][a-z-]{3,})\b", SOURCES[fmus])
    assert [(name, flag) for name, flag in told if flag not in known] == []
