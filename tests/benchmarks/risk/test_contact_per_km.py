"""The table of contacts per km: the kept one is whole, and the command makes such tables."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import contact_per_km
from contact_per_km import CONTROLLERS, SETTINGS, Cell, Setting, table

KEPT = Path(contact_per_km.__file__).with_name("contact_per_km.csv")
DOCS = Path(contact_per_km.__file__).parents[2] / "docs" / "risk.md"


def kept():
    with KEPT.open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    whole, texts = {"runs", "events", "failed"}, {"scenario", "controller", "layer"}
    read = dict.fromkeys(whole, int) | dict.fromkeys(texts, str)
    return [
        Cell(**{key: read.get(key, float)(value) for key, value in row.items()}) for row in rows
    ]


def test_the_kept_table_has_every_controller_with_and_without_the_layer():
    cells = {(one.scenario, one.controller, one.layer) for one in kept()}
    assert cells == {
        (setting.name, controller, layer)
        for setting in SETTINGS
        for controller in CONTROLLERS
        for layer in ("off", "on")
    }
    assert all(one.low <= one.per_km <= one.high for one in kept())


def test_the_page_has_the_kept_table():
    assert "\n".join(table(kept())) in DOCS.read_text("utf-8")


def test_a_cell_without_a_contact_has_an_upper_bound_and_no_estimate():
    none = replace(kept()[0], events=0, low=0.0, high=0.25, per_km=0.0)
    assert list(table([none]))[-1].endswith("| 0 | none met | 0 | 0.25 |")


def test_the_command_makes_its_table_and_goes_on(tmp_path, monkeypatch, capsys):
    run = {"scenario": "shared_space", "time_limit": 0.5, "crowd": {"pedestrians": 1}}
    monkeypatch.setattr(contact_per_km, "SETTINGS", (Setting("short", 2, run, {}),))
    monkeypatch.setattr(contact_per_km, "CONTROLLERS", ("pid-tuned",))
    monkeypatch.setattr("sys.argv", ["x", "--out", str(tmp_path), "--jobs", "1"])
    contact_per_km.main()
    made = capsys.readouterr().out.splitlines()
    monkeypatch.setattr("sys.argv", ["x", "--out", str(tmp_path), "--table"])
    contact_per_km.main()
    assert capsys.readouterr().out.splitlines() == made[-4:]
    assert made[-1].startswith("| short | pid-tuned | on | 2 | 0 |")
