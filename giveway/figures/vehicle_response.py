"""The response of a vehicle FMU: the pictures of a check and of an identification."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from fmus.checking import CheckReport, Identification, Trace
from fmus.checking.model_fit.prediction import position_errors, simulate
from giveway.figures.style import (
    BLACK,
    BLUE,
    GREY,
    ORANGE,
    VERMILION,
    quiet_grid,
    styled,
)

DASHES = (0, (4, 2))
MODEL: dict[str, Any] = {"color": BLACK, "linewidth": 0.9, "linestyle": DASHES, "zorder": 4}
MEASURED: dict[str, Any] = {"color": BLUE, "zorder": 3}
FINER: dict[str, Any] = {"color": ORANGE, "linewidth": 2.6, "zorder": 2.5}
EXACT = 1e-6  # Position error [m] below which there is only rounding, which is not drawn
LARGEST = 1e30  # Largest value that matplotlib can draw; diverging FMUs exceed it
ROWS = ("Force [kN]", "Speed [m/s]", "Acceleration [m/s²]", "Position [m]")


@styled
def check_figure(report: CheckReport, *, title: str = "") -> Figure | None:
    """Draw force, speed, acceleration and position of a check's drives.

    The result is None if there are no drives.

    On the left are the step response and the response of the controller's model. On the right is
    the same drive with the FMU's steps and with finer ones, as far as they went.
    """
    columns: list[tuple[str, list[tuple[Trace, dict[str, Any]]]]] = []
    if "response" in report.traces:
        drawn = [(report.traces["response"], MEASURED | {"label": "vehicle"})]
        columns.append(("Drive, coast, brake", drawn))
    halving = report.convergence
    if halving is not None and halving.traces and halving.finer is not None:
        looks = {}
        if len(halving.traces) == 2:
            looks[halving.traces[1]] = FINER | {"label": _steps(halving.finer)}
        looks[halving.traces[0]] = MEASURED | {"label": _steps(halving.step)}
        columns.append(("Steps halved", list(looks.items())))
    if not columns:
        return None
    width = 4.6 if len(columns) == 1 else 8.2
    figure = Figure(figsize=(width, 7.2), layout="constrained")
    grid = figure.subplots(4, len(columns), sharex="col", squeeze=False)
    for column, (name, drawn) in enumerate(columns):
        _draw_drive(grid[:, column], drawn, report)
        grid[0, column].set_title(name)
        grid[1, column].legend(loc="best")
        grid[3, column].set_xlabel("Time [s]")
    for axes, label in zip(grid[:, 0], ROWS, strict=True):
        axes.set_ylabel(label)
    figure.align_ylabels(grid[:, 0])
    figure.suptitle(title)
    return figure


def _steps(step: float) -> str:
    return f"steps of {1000.0 * step:.4g} ms"


def _draw_drive(
    panels: NDArray[Any], drawn: list[tuple[Trace, dict[str, Any]]], report: CheckReport
) -> None:
    force, speed, acceleration, position = panels
    for axes in panels:
        quiet_grid(axes)
    for trace, look in drawn:
        for axes, values in (
            (speed, trace.speed),
            (position, trace.position - trace.position[0]),
            (acceleration, trace.acceleration),
        ):
            axes.plot(trace.time, np.clip(values, -LARGEST, LARGEST), **look)
    trace = max((trace for trace, _ in drawn), key=lambda trace: trace.force.size)
    _draw_force(force, trace)
    M, alpha = report.expected.mass, report.expected.friction
    model_position, model_speed = simulate(
        trace.force, trace.step_size, M, alpha, min(max(float(trace.speed[0]), 0.0), 100.0)
    )
    speed.plot(trace.time, model_speed, label="controller's model", **MODEL)
    position.plot(trace.time, model_position, **MODEL)
    slope = np.diff(model_speed, prepend=model_speed[0]) / trace.step_size
    acceleration.plot(trace.time, slope, **MODEL)


def _draw_force(axes: Axes, trace: Trace) -> None:
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    held = np.append(trace.force, trace.force[-1:]) / 1000.0
    axes.step(trace.time[: held.size], held, where="post", color=VERMILION, linewidth=1.2, zorder=3)


@styled
def identification_figure(found: Identification, *, title: str = "") -> Figure:
    """Draw measured and fitted motion: the test left out of the fit, all tests, final errors."""
    figure = Figure(figsize=(9.4, 6.4), layout="constrained")
    left, right = figure.subfigures(1, 2, width_ratios=(1.9, 1.0), squeeze=False)[0]
    force, speed, acceleration = left.subplots(3, 1, sharex=True)
    exact = found.model.position_error < EXACT
    tests, *errors = right.subplots(1 if exact else 2, 1, squeeze=False)[:, 0]
    for axes in (force, speed, acceleration, tests, *errors):
        quiet_grid(axes)
    _draw_validation((force, speed, acceleration), found)
    _draw_tests(tests, found)
    for axes in errors:
        _draw_errors(axes, found)
    if exact:
        tests.text(
            0.05, 0.95, f"MPC's prediction, {found.model.horizon:g} s ahead:\nwithin a micrometre",
            transform=tests.transAxes, va="top", fontsize=8,
        )  # fmt: skip
    left.align_ylabels([force, speed, acceleration])
    figure.suptitle(title)
    return figure


def _draw_validation(panels: tuple[Axes, Axes, Axes], found: Identification) -> None:
    force, speed, acceleration = panels
    trace, out, h = found.validation, found.held_out, found.validation.step_size
    sides = enumerate(found.estimate.responses)
    acting = sum(out.acting_everywhere(side, response)[0] for side, response in sides)
    _draw_force(force, trace)
    force.plot(trace.time[1:], acting / 1000.0, **MODEL)
    predicted = np.full(trace.force.size, np.nan)
    predicted[out.used[0]] = found.estimate.predicted(out)
    acceleration.plot(trace.time[1:], np.diff(trace.speed) / h, **MEASURED)
    acceleration.plot(trace.time[1:], predicted, **MODEL)
    # from each standstill, and from the first step that counts, on
    fitted = trace.speed[:-1] + h * predicted
    for k in range(1, fitted.size):
        if np.isfinite(fitted[k] + fitted[k - 1]):
            fitted[k] = fitted[k - 1] + h * predicted[k]
    speed.plot(trace.time, trace.speed, label="measured", **MEASURED)
    speed.plot(trace.time[1:], fitted, label="fitted, from the start on", **MODEL)
    speed.legend(loc="best")
    force.set_title("Held out: a drive that was not fitted")
    for axes, label in zip(panels, ROWS[:3], strict=True):
        axes.set_ylabel(label)
    acceleration.set_xlabel("Time [s]")


def _draw_tests(axes: Axes, found: Identification) -> None:
    measured = found.estimate.measured.acceleration
    fitted = measured - found.estimate.linear.residual
    ends = [float(measured.min()), float(measured.max())]
    axes.plot(ends, ends, **MODEL)
    followed = found.estimate.linear.weights > 0.5
    axes.plot(fitted[followed], measured[followed], ".", color=BLUE, markersize=3, alpha=0.5)
    axes.plot(fitted[~followed], measured[~followed], ".", color=VERMILION, markersize=3)
    share = 100.0 * float(followed.mean())
    title = f"Step tests: {share:.0f} % of the steps follow"
    axes.set(title=title, xlabel="Fitted acceleration [m/s²]", ylabel="Measured [m/s²]")


def _draw_errors(axes: Axes, found: Identification) -> None:
    model = found.model
    horizon = round(model.horizon / model.time_step)
    errors = np.sort(position_errors(found.validation, model.mass, model.friction, horizon))
    share = 100.0 * np.arange(1, errors.size + 1) / max(errors.size, 1)
    axes.step(errors, share, where="post", **MEASURED)
    axes.axvline(model.position_error, **MODEL)
    axes.text(
        model.position_error, 8.0, f" 95 %: {model.position_error:.2g} m", fontsize=8, ha="left"
    )
    axes.set(
        xlim=(0.0, max(1.6 * model.position_error, 1e-3)),
        ylim=(0.0, 102.0),
        title=f"MPC's prediction, {model.horizon:g} s ahead",
        xlabel="Position error [m]",
        ylabel="Share below [%]",
    )
