"""Model Exchange: the FMU gives derivatives and event indicators, and giveway integrates.

One step of the co-simulation is: event mode with the new inputs; then continuous time up to the
first of a state event, a time event, an event that the FMU wants after an integrator's step, and
the end of the step; event mode again; and so on (FMI 2.0.4, section 3.2; FMI 3.0.1, section 3).
"""

from functools import partial
from math import inf
from typing import Any, Literal

from fmus.errors import FmuInterfaceError
from fmus.fmi import cvode
from fmus.fmi.calls import CallFailedError, Calls
from fmus.fmi.continuous import ContinuousSystem, IntegrationError, Solver, UndefinedError, locate
from fmus.fmi.runge_kutta import RungeKutta
from fmus.fmi.running import Instance, Tick
from fmus.fmi.status import ENDED, ERROR, PENDING, WARNING
from fmus.fmi.values import Transfer

TOLERANCE = 1e-6  # Relative tolerance of the solver
RESOLUTION = 1e-12  # resolution of times, relative to the greater of the time and 1 s
ROUNDS = 100  # largest number of rounds of one event iteration
EVENTS = 200  # largest number of events in one step
INTERNAL_STEPS = 5_000  # largest number of internal steps in one step
PATIENCE = 500  # internal steps of CVode in one step, before another solver is tried
DENSE = 500  # Largest number of states for CVode's dense Jacobian


class _EndedError(Exception):
    """The FMU wants the simulation to end."""


class ModelExchange(Instance):
    """An FMU that is integrated.

    Args:
        calls: The FMU's functions.
        tolerance: Relative tolerance of the solver, or None for :data:`TOLERANCE`.
        solver: Name of the solver, or None for CVode if it runs.

    Raises:
        FmuInterfaceError: CVode does not run here.
        FmuPlatformError: a function is missing.
    """

    def __init__(
        self, calls: Calls, tolerance: float | None, solver: Literal["cvode", "rk4"] | None
    ) -> None:
        super().__init__(calls, TOLERANCE if tolerance is None else tolerance)
        if solver == "cvode" and not cvode.available():
            raise FmuInterfaceError(
                f"{self.path}: solver cvode does not run on this platform; "
                'write `solver = "rk4"` under [fmu] of the profile'
            )
        self._wanted = solver
        self._solver: Solver | None = None
        self._next_event: float | None = None
        self._update_nominals = False
        for what in ("set_time", *(("get_derivatives",) if calls.model.states else ())):
            calls.function(calls.exchange_names()[what])

    def prepare(self) -> None:  # noqa: D102 - as in Instance
        try:
            self._system = ContinuousSystem(self.calls)
            self._iterate(self.calls.start_time, ticks=False)
            self.calls.enter_continuous_time_mode()
            self._solver = self._make_solver()
            self._nominals = self._system.nominals()
        except _EndedError:
            self.messages.add(ERROR, "it wants to end the simulation at its start")
            raise CallFailedError("the event iteration", ENDED) from None
        except (IntegrationError, UndefinedError) as error:
            self.messages.add(ERROR, str(error))
            raise CallFailedError("the initialisation", ERROR) from error

    def make_tick(self, into: Transfer, out: Transfer) -> Tick:  # noqa: D102
        set_inputs, set_arguments = into.function, into.arguments
        get_outputs, get_arguments = out.function, out.arguments
        self._set_inputs = partial(set_inputs, *set_arguments)

        def tick(time: float, size: float) -> int:
            try:
                self._begin(time)
                status = self.note_status(set_inputs(*set_arguments))
                if status > WARNING:
                    return status
                self._run(time, time + size)
            except _EndedError:
                return ENDED
            except CallFailedError as error:
                if error.status <= PENDING:
                    self.messages.add(ERROR, str(error))
                return self.note_status(error.status)
            except (IntegrationError, UndefinedError) as error:
                self.messages.add(ERROR, str(error))
                return self.note_status(ERROR)
            return self.note_status(get_outputs(*get_arguments))

        return tick

    @property
    def solver(self) -> Solver:
        """The solver in use."""
        assert self._solver is not None  # prepare() has made it
        return self._solver

    # ---- one step ----

    def _begin(self, time: float) -> None:
        """Enter event mode at the start of a step, before the inputs are set."""
        upcoming = self._next_event
        if upcoming is not None and 0.0 < upcoming - time <= _resolution(time):
            time = upcoming  # the event is left over from the last step
        self._system.set_time(time)  # in event mode FMI 3 does not allow it
        self.calls.enter_event_mode()

    def _run(self, time: float, end: float) -> None:
        """Go from event mode at the start of a step to continuous-time mode at its end."""
        system, start = self._system, time
        negligible = _resolution(end)
        self._settle(time)
        events = 0
        while end - time > negligible:
            upcoming = self._next_event
            if self.clocks is not None:
                upcoming = min(self.clocks.next, inf if upcoming is None else upcoming)
            timed = upcoming is not None and upcoming < end - negligible
            stop = upcoming if timed and upcoming is not None else end
            time, happened = self._integrate(time, stop)
            if happened or (timed and time >= stop - negligible):
                events += 1
                if events > EVENTS:
                    raise IntegrationError(
                        f"more than {EVENTS} events between {start:.9g} s and {time:.9g} s: "
                        "it chatters"
                    )
                self.calls.enter_event_mode()
                self._settle(time)
                self.solver.expect_events()
        system.set(end, self.solver.x)

    def _settle(self, time: float) -> None:
        """Do the event iteration, then start continuous time and the solver."""
        self._iterate(time)
        self.calls.enter_continuous_time_mode()
        if self._update_nominals:
            self._update_nominals = False
            self._nominals = self._system.nominals()
        self.solver.restart(time, self._system.states(), self._nominals)

    def _iterate(self, time: float, *, ticks: bool = True) -> None:
        """Update the discrete states until nothing changes any more; clocks may tick."""
        if ticks and self.clocks is not None:
            self.clocks.activate(time)
            if self.calls.active:
                self.note_status(int(self._set_inputs()))
        for _ in range(ROUNDS):
            info = self.calls.update_discrete_states()
            self._update_nominals |= info.nominals_changed
            if info.ended:
                raise _EndedError
            if not info.again:
                break
        else:
            raise IntegrationError(
                f"its event iteration at {time:.9g} s has not ended after {ROUNDS} rounds"
            )
        if self.clocks is not None:
            self.clocks.ask(time)
        upcoming = info.next_time
        # A time event that is over has just been handled, but some FMUs keep naming it.
        later = upcoming is not None and upcoming > time + _resolution(time)
        self._next_event = upcoming if later else None

    def _integrate(self, time: float, stop: float) -> tuple[float, bool]:
        """Integrate up to ``stop`` or an event; return the time, and whether there was an event.

        The FMU is left at that point.
        """
        system = self._system
        if stop - time <= _resolution(stop):
            system.set_time(stop)
            return stop, False
        start = time
        before = system.signs(time, self.solver.x)
        for count in range(INTERNAL_STEPS):
            after = self._advance(time, stop, count)
            crossed = (system.signs(after, self.solver.x) != before).any()
            if crossed:
                after = self._first_crossing(time, after, before)
                self.solver.restart(after, self.solver.at(after).copy(), self._nominals)
            system.set(after, self.solver.x)
            time = after
            if self._completed() or crossed:
                return time, True
            if time >= stop:
                return stop, False
        raise IntegrationError(
            f"more than {INTERNAL_STEPS} internal steps between {start:.9g} s and {time:.9g} s; "
            f"use {self.solver.remedy} under [fmu]"
        )

    def _advance(self, time: float, stop: float, count: int) -> float:
        """Do one internal step from ``time``, after ``count`` steps since the last event."""
        if count == PATIENCE:
            self._fall_back(time)
        try:
            return self.solver.step(stop)
        except IntegrationError:
            if not self._fall_back(time):
                raise
            return self.solver.step(stop)

    def _fall_back(self, time: float) -> bool:
        """Continue with Runge-Kutta if CVode makes no progress and the profile names no solver.

        CVode reduces its steps without end if derivatives jump and no event is declared: dry
        friction that is written as a sign of the speed holds a car at rest by such jumps.
        """
        if self._wanted is not None or not isinstance(self._solver, cvode.Cvode):
            return False
        x = self._solver.x.copy()
        self._close_solver()
        self._solver = RungeKutta(self._system, self.tolerance or TOLERANCE)
        self._solver.restart(time, x, self._nominals)
        return True

    def _first_crossing(self, time: float, after: float, before: Any) -> float:
        """Return the time [s] in the last step at which an event indicator changes its sign."""
        system, solver = self._system, self.solver

        def crossed(moment: float) -> bool:
            return bool((system.signs(moment, solver.at(moment)) != before).any())

        return locate(crossed, time, after, _resolution(after))

    def _completed(self) -> bool:
        if not self.interface.completed_step_needed:
            return False
        event, end = self.calls.completed_step()
        if end:
            raise _EndedError
        return event

    def _make_solver(self) -> Solver:
        self._close_solver()
        system, tolerance = self._system, self.tolerance or TOLERANCE
        able = system.nx > 0 and (self._wanted == "cvode" or system.nx <= DENSE)
        if self._wanted != "rk4" and able and cvode.available():
            return cvode.Cvode(system, tolerance)
        return RungeKutta(system, tolerance)

    # ---- end ----

    def stop(self) -> None:  # noqa: D102
        super().stop()
        self._close_solver()

    def _close_solver(self) -> None:
        if self._solver is not None:
            self._solver.close()
            self._solver = None


def _resolution(time: float) -> float:
    """Return the difference [s] below which two times are the same."""
    return RESOLUTION * max(1.0, abs(time))
