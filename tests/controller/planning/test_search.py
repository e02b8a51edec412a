"""The search: which manoeuvre is chosen, and how many are tried."""

import numpy as np
import pytest

from controller import (
    Evaluation,
    LongitudinalModel,
    Manoeuvre,
    ManoeuvreParameters,
    PlannerParameters,
)
from controller.planning.search import Search

MODEL = LongitudinalModel(mass=1000.0, friction=100.0, time_step=0.05)
PARAMETERS = PlannerParameters()
N = PARAMETERS.horizon
FREE = np.full(N, np.inf)


class Wall:
    """Somebody who stays in the middle of the way, whatever the ego does."""

    def __init__(self, distance: float) -> None:
        self.distance = distance

    def evaluate(self, manoeuvre: Manoeuvre, *, creeps: bool = False) -> Evaluation:
        return Evaluation(self.distance - manoeuvre.distance[1:], FREE, FREE)

    def prefer(self) -> None:
        pass


def chosen(search: Search, speed: float, foresight: Wall | None, **more: float) -> str:
    allowed = np.full(N, np.inf)
    return search.choose(speed, 0.0, 4.0, allowed, foresight, more.get("end", np.inf))


def test_with_nobody_ahead_it_drives_on_and_tries_nothing_else() -> None:
    search = Search(MODEL, PARAMETERS)
    assert chosen(search, 4.0, None) == "clear"
    assert search.tried == 1
    assert search.best[1] == pytest.approx(4.0)


def test_before_somebody_who_stays_it_brakes() -> None:
    search = Search(MODEL, PARAMETERS)
    assert chosen(search, 4.0, Wall(10.0)) != "drive on"
    distance, speed, _ = search.best
    assert speed[-1] < 4.0
    assert distance[-1] < 10.0
    assert search.tried > 2


def test_what_was_planned_is_tried_again() -> None:
    search = Search(MODEL, PARAMETERS)
    chosen(search, 4.0, Wall(10.0))
    plan = Manoeuvre(*(values.copy() for values in search.best))
    search.keep(plan, holds=True)
    assert chosen(search, float(plan.speed[1]), Wall(10.0 - plan.distance[1])) == "as planned"
    search.reset()
    assert chosen(search, 4.0, None) == "clear"


def test_where_the_way_ends_it_may_drive_up_to_there() -> None:
    search = Search(MODEL, PlannerParameters(manoeuvres=ManoeuvreParameters()))
    chosen(search, 3.0, None, end=3.0)
    assert search.tried >= 1
    assert np.isfinite(search.best[0]).all()
