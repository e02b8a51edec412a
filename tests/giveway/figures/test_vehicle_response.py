"""The pictures of checks and identifications: they are drawn whatever an FMU did."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fmus.checking import (
    CheckReport,
    Convergence,
    Mpc,
    Trace,
    check,
    expected_of,
    identify,
    told_of,
)
from fmus.checking.expected import Expected
from giveway.figures.vehicle_response import check_figure, identification_figure

EXPECTED = Expected(1000.0, 100.0, 4.0, 3000.0, 8000.0, None, told_of(None, None))


def trace(speed):
    speed = np.asarray(speed, float)
    force = np.full(speed.size - 1, 3000.0)
    return Trace(0.05, force, speed, speed, speed, 0.0 * force, ())


def test_a_check_shows_vehicle_beside_model_and_halved_steps(car, tmp_path):
    figure = check_figure(check(car(), expected_of(), step_size=0.05), title="car")
    assert figure is not None
    labels = {line.get_label() for axes in figure.axes for line in axes.lines}
    assert {"vehicle", "controller's model", "steps of 50 ms", "steps of 25 ms"} <= labels
    figure.savefig(tmp_path / "car.png")


@pytest.mark.parametrize("speed", [[0.0], [0.0, 1e300, -1e300], [0.0, 1.0]])
def test_a_diverging_check_can_be_drawn(tmp_path, speed):
    halved = Convergence(0.05, 0.025, "diverges", None, (trace(speed), trace(np.zeros(61))))
    figure = check_figure(CheckReport(EXPECTED, convergence=halved))
    assert figure is not None
    figure.savefig(tmp_path / "car.png")


def test_without_a_drive_there_is_no_picture():
    assert check_figure(CheckReport(EXPECTED)) is None


def test_an_identification_shows_measured_and_fitted(car, tmp_path):
    found = identify(
        car(lag=0.2), Mpc(0.05, 15, 8000.0), path=Path("car.fmu"), speeds=(0.0, 4.0),
    )  # fmt: skip
    figure = identification_figure(found, title="car")
    assert len(figure.axes) == 5
    figure.savefig(tmp_path / "car.png")


def test_a_model_without_error_leaves_no_panel_empty(car):
    found = identify(
        car(), Mpc(0.05, 15, 8000.0), path=Path("car.fmu"), speeds=(0.0, 4.0),
    )  # fmt: skip
    model = found.model.model_copy(update={"position_error": 1.4e-14})  # the bundled FMU's
    figure = identification_figure(replace(found, model=model), title="car")
    assert len(figure.axes) == 4
    assert any("within a micrometre" in text.get_text() for text in figure.axes[-1].texts)
