"""The search: it finds a known least value, repeats, and goes on from its journal."""

from __future__ import annotations

import math

import pytest

from giveway.errors import ConfigError, ResultsError
from giveway.validation.behaviour.search import RANGES, Journal, Search
from pedestrian_model import SIM, VciParameters

NAMES = ("vehicle_strength", "max_acceleration", "sway")


def valley(parameters: VciParameters) -> float:
    """The least value is at 2000 N, 1 m/s^2 and 0.2 m/s^2."""
    best = {"vehicle_strength": 2000.0, "max_acceleration": 1.0, "sway": 0.2}
    return sum(math.log(getattr(parameters, name) / value) ** 2 for name, value in best.items())


def test_it_finds_the_least_value() -> None:
    found = Search(valley, SIM, NAMES, evaluations=560).run(Journal(None, ()))
    assert found.value < 1e-3
    assert found.parameters.vehicle_strength == pytest.approx(2000.0, rel=0.05)
    assert found.parameters.max_acceleration == pytest.approx(1.0, rel=0.05)
    assert found.parameters.sway == pytest.approx(0.2, rel=0.05)
    assert found.parameters.destination_gain == SIM.destination_gain
    assert found.evaluations == 560
    assert not found.at_bound
    assert max(found.spread.values()) < 0.1


def test_a_parameter_at_the_end_of_its_range_is_named() -> None:
    found = Search(lambda p: -p.sway, SIM, ("sway",), evaluations=280).run(Journal(None, ()))
    assert found.at_bound == ("sway",)


def test_a_killed_search_goes_on_from_its_journal(tmp_path) -> None:
    calls = 0

    def counted(parameters: VciParameters) -> float:
        nonlocal calls
        calls += 1
        return valley(parameters)

    whole = Search(counted, SIM, NAMES, evaluations=56).run(Journal(None, ()))
    assert calls == 56
    file = tmp_path / "fit.journal"
    journal = Journal(file, "settings")
    Search(counted, SIM, NAMES, evaluations=28).run(journal)
    with file.open("a") as cut_off:
        cut_off.write("0.1e")
    calls = 0
    journal = Journal(file, "settings")
    assert journal.known == 28
    again = Search(counted, SIM, NAMES, evaluations=56).run(journal)
    assert calls == 28
    assert again == whole
    assert Journal(file, "other settings").known == 0


def test_another_seed_asks_elsewhere() -> None:
    one, two = (
        Search(valley, SIM, NAMES, seed=seed, evaluations=14).run(Journal(None, ()))
        for seed in (0, 1)
    )
    assert one.parameters != two.parameters


def test_what_cannot_be_fitted_is_refused(tmp_path) -> None:
    with pytest.raises(ConfigError, match="--parameters mass: cannot be fitted for behaviour"):
        Search(valley, SIM, ("mass",))
    with pytest.raises(ResultsError, match="journal of the fit cannot be used"):
        Journal(tmp_path / "missing" / "fit.journal", ())
    assert all(low < high for low, high in RANGES.values())
