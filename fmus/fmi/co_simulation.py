"""Co-Simulation: the FMU brings its own solver and is asked to step.

An FMU may discard a step. It then reports how far it came, and the rest is done from there. If that
fails, the state before the step is restored and the step is done in halves, quarters, ...

FMI 3 FMUs with events may need the importer to handle them (event mode). They are first run without
it, unless they have input clocks to tick or make no other instance. If a step fails, a new instance
is made with event mode and brought to the same point.
"""

from collections.abc import Iterator
from contextlib import suppress
from ctypes import c_double, c_void_p

from fmus.errors import FmuPlatformError
from fmus.fmi.calls import CallFailedError, Calls, NoInstanceError
from fmus.fmi.clocks import NEGLIGIBLE as TICK
from fmus.fmi.running import Instance, Tick
from fmus.fmi.status import DISCARD, ENDED, ERROR, FATAL, WARNING
from fmus.fmi.values import Transfer

HALVINGS = 6  # largest number of halvings of a step that an FMU discards
CONTINUATIONS = 100  # largest number of continuations of one step from where the FMU stopped
NEGLIGIBLE = 1e-9  # share of a step that counts as nothing
ROUNDS = 100  # largest number of rounds of one event iteration
REMEMBERED = 100_000  # largest number of past steps that a restart with event mode repeats


class CoSimulation(Instance):
    """An FMU that steps by itself.

    Args:
        calls: The FMU's functions.
        tolerance: Relative tolerance that the FMU is given, or None for its own.
        rewinds: True to save the state before every step, so that it can be repeated in smaller
            ones.
    """

    def __init__(self, calls: Calls, tolerance: float | None, *, rewinds: bool) -> None:
        super().__init__(calls, tolerance)
        self._rewinds = rewinds and calls.interface.saves_state
        self._start, self._step = c_double(), c_double()
        self._before: c_void_p | None = None  # state before the last step
        self._before_time = 0.0  # [s] time of that state
        self._now = calls.start_time  # [s] time of the present event
        calls.function(calls.name("DoStep"))
        self._past: list[tuple[float, float, bytes]] | None = (
            None  # steps, as long as it may matter
        )

    def make_tick(self, into: Transfer, out: Transfer) -> Tick:  # noqa: D102 - as in the base
        set_inputs, set_arguments = into.function, into.arguments
        get_outputs, get_arguments = out.function, out.arguments
        start, step = self._start, self._step
        self._stepper = stepper = self.calls.stepper(start, step)
        do_step, arguments, flags = stepper.do_step, stepper.arguments, stepper.flags
        note_status, complete = self.note_status, self._complete
        save = self._save if self._rewinds else None
        calls, with_events = self.calls, self._with_events
        has_events = "hasEventMode" in self.interface.flags and self.model.fmi_version == "3.0"
        past = self._past = [] if has_events and not calls.event_mode else None
        inputs = self.inputs

        def events(time: float) -> int:
            self._now = time
            calls.enter_event_mode()
            if self.clocks is not None:
                self.clocks.activate(time)
            status = note_status(set_inputs(*set_arguments))
            return status if status > WARNING else self._handle_events()

        def event_tick(time: float, size: float) -> int:
            try:
                if (status := events(time)) > WARNING:
                    return status
                for part, length, ticks in self._parts(time, size):
                    if save:
                        save()
                    start.value, step.value = part, length
                    status = do_step(*arguments)
                    if (status or flags[0]) and (
                        status := complete(status, part, length)
                    ) > WARNING:
                        return status
                    status = 0
                    if ticks:
                        status = events(part + length)
                    elif stepper.event.value:
                        self._now = part + length
                        calls.enter_event_mode()
                        status = self._handle_events()
                    if status > WARNING:
                        return status
            except CallFailedError as error:
                self.messages.add(ERROR, str(error))
                return note_status(error.status if error.status > WARNING else ERROR)
            return note_status(get_outputs(*get_arguments))

        def tick(time: float, size: float) -> int:
            if calls.event_mode:
                return event_tick(time, size)
            if past is not None and len(past) <= REMEMBERED:
                past.append((time, size, bytes(inputs)))
            status = plain_tick(time, size)
            if past and status in (DISCARD, ERROR) and len(past) <= REMEMBERED:
                return with_events(event_tick, status)
            return status

        def plain_tick(time: float, size: float) -> int:
            status = set_inputs(*set_arguments)
            if status and (status := note_status(status)) > WARNING:
                return status
            if save:
                save()
            start.value = time
            step.value = size
            status = do_step(*arguments)
            if (status or flags[0]) and (status := complete(status, time, size)) > WARNING:
                return status
            status = get_outputs(*get_arguments)
            return note_status(status) if status else 0

        return tick if has_events else plain_tick

    # ---- event mode (FMI 3) ----

    def prepare(self) -> None:  # noqa: D102 - as in Instance
        if self.calls.event_mode and (status := self._handle_events()) > WARNING:
            raise CallFailedError("the event iteration", status)

    def _instantiate(self) -> None:
        self.calls.event_mode |= bool(self.tickings)
        try:
            super()._instantiate()
        except NoInstanceError:  # some FMUs want event mode, others refuse it
            if self.calls.event_mode or "hasEventMode" not in self.interface.flags:
                raise
            self.messages.take()
            self.calls.event_mode = True
            super()._instantiate()

    def _parts(self, time: float, size: float) -> Iterator[tuple[float, float, bool]]:
        """Yield the parts of a step between ticks: begin, length, whether a tick ends it."""
        end = time + size
        while self.clocks is not None and time < (tick := self.clocks.next) < end - TICK:
            yield time, tick - time, True
            time, size = tick, end - tick
        yield time, size, False

    def _handle_events(self) -> int:
        """Do the event iteration, then return to step mode.

        Raises:
            CallFailedError: the FMU refuses.
        """
        for _ in range(ROUNDS):
            info = self.calls.update_discrete_states()
            if info.ended:
                return ENDED
            if not info.again:
                if self.clocks is not None:
                    self.clocks.ask(self._now)
                self.calls.enter_step_mode()
                return 0
        self.messages.add(ERROR, f"its event iteration has not ended after {ROUNDS} rounds")
        return ERROR

    def _with_events(self, event_tick: Tick, failed: int) -> int:
        """Repeat all steps with event mode; the last of them has failed without it.

        Args:
            event_tick: Function that does a step.
            failed: Status without event mode, which is returned if no instance has event mode.
        """
        past, self._past = self._past, None
        component = self.calls.component
        assert past is not None
        assert component is not None
        self._drop_state()
        self.calls.free()
        self.calls.event_mode = True
        self._worst, self._initialised = 0, False
        try:
            self._initialise()
        except CallFailedError as error:
            self.messages.add(ERROR, f"with event mode: {error}")
            return self.note_status(max(failed, error.status))
        # The arguments of all calls hold the first instance's pointer: it becomes the new one's.
        fresh = self.calls.component
        assert fresh is not None
        component.value = fresh.value
        self.calls.component = component
        status = 0
        for time, size, raw in past:
            self.inputs[:] = memoryview(raw).cast("d")
            status = event_tick(time, size)
            if status > WARNING:
                break
        return status

    def _save(self) -> None:
        """Keep the state before a step in a new handle, since some FMUs do not reuse an old one."""
        if self._rewinds:
            before, self._before = self._before, None
            try:
                if before is not None:
                    self.calls.free_state(before)
                self._before = self.calls.save()
            except (CallFailedError, FmuPlatformError):  # the FMU can do less than it declares
                self._rewinds = False

    def _complete(self, status: int, time: float, size: float) -> int:
        """Finish a step that the FMU did not complete."""
        self._before_time = time
        try:
            return self._finish(status, time, size)
        finally:
            self._stepper.final.value = True

    def _finish(self, status: int, time: float, size: float) -> int:
        status = self._continue(self.note_status(status), time, time + size, size)
        for halving in range(1, HALVINGS + 1):
            if status != DISCARD or self._before is None:
                break
            try:
                self.calls.restore(self._before)
            except CallFailedError as error:
                return self.note_status(error.status)
            parts = 1 << halving
            for part in range(parts):
                begin, end = time + size * part / parts, time + size * (part + 1) / parts
                status = self._do(begin, end)
                status = self._continue(status, begin, end, size)
                if status > WARNING:
                    break
        if status == DISCARD:
            self._worst = DISCARD
            tried = (
                f"and steps down to 1/{1 << HALVINGS} of it"
                if self._before
                else ("and cannot return to the state before it")
            )
            advice = "try a smaller `step` under [fmu] of the profile"
            self.messages.add(DISCARD, f"it discards the step, {tried}; {advice}")
        return status

    def _continue(self, status: int, time: float, end: float, size: float) -> int:
        """Continue from where the FMU has stopped in a step that was to reach ``end``."""
        for _ in range(CONTINUATIONS):
            if status > DISCARD or not (status == DISCARD or self._stepper.flags[0]):
                return status
            progress = self._stepper.progress()
            if progress.ended:
                return ENDED
            reached = progress.reached
            nothing = NEGLIGIBLE * size
            if reached is None or not time + nothing < reached <= end + nothing:
                return DISCARD
            if reached >= end - nothing:
                return WARNING
            time = reached
            status = self._do(time, end)
        return DISCARD

    def _do(self, begin: float, end: float) -> int:
        # If this part fails, too, the state before the first part may be restored.
        self._stepper.final.value = self._before is None or begin <= self._before_time
        self._start.value = begin
        self._step.value = end - begin
        return self.note_status(self._stepper.do_step(*self._stepper.arguments))

    def _drop_state(self) -> None:
        before, self._before = self._before, None
        if before is not None and self.calls.component and self._worst != FATAL:
            # a state that is not freed does no harm
            with suppress(CallFailedError, FmuPlatformError):
                self.calls.free_state(before)

    def stop(self) -> None:  # noqa: D102
        self._drop_state()
        super().stop()
