"""What a traffic light is said to show next is what SUMO shows then."""

from types import SimpleNamespace

import libsumo
import pytest

from giveway.sumo.signal_plans import SignalPlans
from sumo_scenarios import find


def test_a_minute_and_a_half_of_the_junction_s_lights():
    libsumo.start(["sumo", "-c", str(find("junction").config_file), "--no-step-log"])
    try:
        plans, changes, step = SignalPlans(libsumo), 0, libsumo.simulation.getDeltaT()
        (system,) = libsumo.trafficlight.getIDList()
        read = libsumo.trafficlight.getRedYellowGreenState
        expected = None
        while libsumo.simulation.getTime() < 90.0:
            libsumo.simulationStep()
            now, state = libsumo.simulation.getTime(), read(system)
            if expected is not None and state != expected[0]:
                assert (now, state) == (pytest.approx(expected[1] + step), expected[2])
                changes += 1
            change = plans.change(system)
            assert change is not None
            expected = (state, now + change.time, change.state)
        assert changes >= 6
    finally:
        libsumo.close()


def lights(phases, phase):
    """One light as SUMO's library has it, in a phase of one program."""
    logic = SimpleNamespace(
        programID="0",
        phases=[SimpleNamespace(state=state, next=next, duration=5.0) for state, next in phases],
    )
    return SimpleNamespace(
        trafficlight=SimpleNamespace(
            getProgram=lambda _: "0",
            getPhase=lambda _: phase,
            getNextSwitch=lambda _: 12.0,
            getAllProgramLogics=lambda _: [logic],
        ),
        simulation=SimpleNamespace(getTime=lambda: 10.0),
    )


@pytest.mark.parametrize(
    ("phases", "phase", "expected"),
    [
        ([("G", ()), ("r", ())], 0, (2.0, "r")),
        ([("G", ()), ("r", ())], 1, (2.0, "G")),  # round again
        ([("G", (2,)), ("r", ()), ("y", ())], 0, (2.0, "y")),  # an actuated one that leaps
        ([("G", (1, 2)), ("r", ()), ("y", ())], 0, None),  # or may do either
        ([("G", ())], 4, None),  # set by somebody, and in no program
    ],
)
def test_programs_that_leap(phases, phase, expected):
    assert SignalPlans(lights(phases, phase)).change("tls") == expected
