"""Sequential stopping: when it looks, at what, and how often the interval is right then."""

import numpy as np
import pytest

from giveway.errors import ConfigError
from giveway.studies.definition import Precision
from giveway.studies.statistics import PRECISION_COLUMNS, compare, looks, precise_enough
from giveway.studies.statistics.bootstrap import mean_interval, seed_of

RULE = Precision(width=1.0, minimum=20, batch=10)


def noisy(new_study, seeds: int, spread: float = 1.0, **rule):
    """A study of two controllers with that many seeds, and what the rule says about it."""
    study = new_study({"controller": ["mpc", "pid"]})
    noise = np.random.default_rng(4).normal(size=1000)[:seeds] * spread
    study.add("mpc", completion_time=noise).add("pid", completion_time=np.zeros(seeds))
    return study, RULE.model_copy(update=rule)


def ask(study, rule: Precision, **more):
    return precise_enough(study.runs, study.design, study.comparison, rule, **more)


def test_looks_at_the_minimum_after_every_batch_and_at_the_end() -> None:
    assert list(looks(RULE, 45)) == [20, 30, 40, 45]
    assert list(looks(RULE, 40)) == [20, 30, 40]
    assert list(looks(RULE, 12)) == [12]


def test_does_not_look_before_the_minimum(new_study) -> None:
    enough, found = ask(*noisy(new_study, 19, spread=0.0))
    assert not enough
    assert found.empty
    assert list(found.columns) == [column.name for column in PRECISION_COLUMNS]


def test_narrow_enough_is_narrower_than_the_width(new_study) -> None:
    study, rule = noisy(new_study, 20)
    _, found = ask(study, rule)
    width = found["width"].item()
    assert 0.5 < width < 1.5
    assert found["ci_high"].item() - found["ci_low"].item() == pytest.approx(width, abs=2e-6)
    assert ask(study, rule.model_copy(update={"width": width + 1e-5}))[0]
    assert not ask(study, rule.model_copy(update={"width": width - 1e-5}))[0]


def test_interval_is_the_one_of_the_comparison(new_study) -> None:
    study, rule = noisy(new_study, 20)
    _, found = ask(study, rule)
    table = compare(study.runs, study.design, study.comparison)
    same = table[(table["metric"] == "completion_time") & (table["situation"] == "general")]
    for name in ("n", "mean_difference", "ci_low", "ci_high"):
        assert found[name].item() == same[name].item()


def test_runs_beyond_the_look_do_not_matter(new_study) -> None:
    """A worker may be ahead: what it has finished already must not move the stop."""
    exact, rule = noisy(new_study, 30)
    ahead, _ = noisy(new_study, 39)
    ahead.add("mpc", completion_time=[99.0], seeds=[77])
    assert ask(ahead, rule)[1].equals(ask(exact, rule)[1])
    assert ask(ahead, rule)[1]["seeds"].item() == 30


def test_a_run_that_is_missing_holds_the_look_back(new_study) -> None:
    study, rule = noisy(new_study, 40)
    study.rows = [row for row in study.rows if row["run"] != "c2-s31"]
    assert ask(study, rule)[1]["seeds"].item() == 30
    assert not ask(study, rule, seeds=40)[0]


def test_a_lost_run_does_not(new_study) -> None:
    study, rule = noisy(new_study, 40)
    study.rows = [row for row in study.rows if row["run"] != "c2-s31"]
    study.lose("pid", seeds=[31])
    found = ask(study, rule)[1]
    assert (found["seeds"].item(), found["n"].item()) == (40, 39)


def test_the_caller_may_name_the_look(new_study) -> None:
    study, rule = noisy(new_study, 45)
    assert ask(study, rule, seeds=45)[1]["n"].item() == 45
    assert ask(study, rule, seeds=20)[1]["n"].item() == 20


def test_every_context_has_to_be_precise(new_study) -> None:
    study = new_study({"crowd.pedestrians": [30, 10], "controller": ["mpc", "pid"]})
    noise = np.random.default_rng(4).normal(size=20)
    for pedestrians, spread in ((30, 10.0), (10, 0.1)):
        study.add(pedestrians, "mpc", completion_time=noise * spread)
        study.add(pedestrians, "pid", completion_time=np.zeros(20))
    enough, found = ask(study, RULE)
    assert not enough
    assert list(found["precise"]) == [False, True]


def test_a_situation_with_too_few_pairs_is_never_precise(new_study) -> None:
    enough, found = ask(*noisy(new_study, 20, spread=0.0, situation="stop-and-wait"))
    assert not enough
    assert found["n"].item() == 0
    assert np.isnan(found["width"].item())


def test_no_runs_no_answer(new_study) -> None:
    assert not ask(new_study({"controller": ["mpc", "pid"]}), RULE)[0]


def test_unknown_metric_is_named_with_the_one_that_was_meant(new_study, refused) -> None:
    with refused(ConfigError, "completion_tme", "completion_time"):
        ask(*noisy(new_study, 20, metric="completion_tme"))


@pytest.mark.parametrize(
    ("draw", "true", "deviation"),
    [
        (lambda rng: rng.normal(-1.0, 3.0, 1500), -1.0, 3.0),
        (lambda rng: rng.exponential(1.0, 1500), 1.0, 1.0),
    ],
    ids=["normal", "exponential"],
)
def test_interval_at_the_stop_covers_nearly_as_often_as_it_says(
    draw, true: float, deviation: float
) -> None:
    """The width aims at 300 pairs. Stopping when it looks good costs some coverage, not much."""
    width = 2.0 * 1.96 * deviation / np.sqrt(300.0)
    rule = Precision(width=width)
    hits, stops = 0, []
    for study in range(300):
        differences = draw(np.random.default_rng(study))
        for seeds in looks(rule, differences.size):
            found = mean_interval(
                differences[:seeds], confidence=0.95, resamples=499, seed=seed_of([str(study)])
            )
            if found.width < width:
                break
        hits += found.low <= true <= found.high
        stops.append(seeds)
    assert 0.92 <= hits / 300 <= 0.97
    assert 280 <= np.mean(stops) <= 380
