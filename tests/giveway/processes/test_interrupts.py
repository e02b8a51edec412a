"""What a signal by which the user ends us does to the main thread."""

import os
import signal
import sys
import time
from collections.abc import Iterator

import pytest

import giveway
from giveway.processes.interrupts import (
    DeferredInterrupt,
    RaisedSignals,
    TerminatedError,
    exit_code_of,
    who_ended,
)
from giveway.run_data.progress import Ending

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")


@pytest.fixture(autouse=True)
def handlers() -> Iterator[None]:
    """Those that Python starts with in a terminal, whatever we inherited."""
    wanted = {
        signal.SIGINT: signal.default_int_handler,
        signal.SIGTERM: signal.SIG_DFL,
        signal.SIGHUP: signal.SIG_DFL,
    }
    before = {number: signal.signal(number, handler) for number, handler in wanted.items()}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_in_the_loop_each_of_them_is_a_request(number: int) -> None:
    with DeferredInterrupt() as interrupt:
        assert not interrupt.requested
        os.kill(os.getpid(), number)
        assert interrupt.requested


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_run_that_is_told_to_end_in_the_loop_is_interrupted(number: int) -> None:
    settings = {"crowd": {"pedestrians": 0}, "time_limit": 2.0}
    result = giveway.run(settings, watcher=lambda _: os.kill(os.getpid(), number))
    assert result.ending is Ending.INTERRUPTED
    assert result.error is None


@pytest.mark.parametrize("handler", [DeferredInterrupt, RaisedSignals])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_that_we_were_told_to_ignore_is_ignored(handler: type, number: int) -> None:
    signal.signal(number, signal.SIG_IGN)
    with handler() as active:
        assert signal.getsignal(number) is signal.SIG_IGN
        os.kill(os.getpid(), number)
        assert not getattr(active, "requested", False)
    assert signal.getsignal(number) is signal.SIG_IGN


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_elsewhere_it_is_raised_and_named(number: signal.Signals) -> None:
    with RaisedSignals(), pytest.raises(TerminatedError) as raised:
        os.kill(os.getpid(), number)
    assert who_ended(raised.value) == f"ended by {number.name}"
    assert exit_code_of(raised.value) == 128 + number
    assert signal.getsignal(number) is signal.SIG_DFL


def test_a_terminal_and_a_supervisor_interrupt_once() -> None:
    with RaisedSignals(once=True):
        with pytest.raises(KeyboardInterrupt) as raised:
            os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGHUP)
    assert (who_ended(raised.value), exit_code_of(raised.value)) == ("interrupted", 130)


def test_an_impatient_ctrl_c_is_noted_and_python_goes_on() -> None:
    import signal

    with DeferredInterrupt() as interrupt:
        assert not interrupt.requested
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        assert interrupt.requested
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_one_that_a_destructor_cannot_raise_is_raised_afterwards(
    capsys: pytest.CaptureFixture[str],
) -> None:
    class Dying:
        def __del__(self) -> None:
            os.kill(os.getpid(), signal.SIGTERM)

    def drop() -> None:
        Dying()
        time.sleep(60.0)

    with RaisedSignals(), pytest.raises(TerminatedError):
        drop()
    assert capsys.readouterr().err == ""
