"""A step of a run does not wait for a look at all that exists, and garbage goes all the same."""

import gc
import weakref

import pytest

from giveway.processes.garbage import full_collections_put_off, rarely_collected


class Knot:
    """Refers to itself: only a collection finds it."""

    def __init__(self) -> None:
        self.itself = self


@pytest.fixture
def often():
    """Collections of all generations after next to nothing, however much the process holds.

    CPython skips a full collection while what is new is less than a quarter of what is old.
    """
    before = gc.get_threshold()
    gc.collect()
    gc.freeze()
    gc.collect()  # what is frozen does not count as old
    gc.set_threshold(50, 1, 1)
    yield
    gc.set_threshold(*before)


def full_collections() -> int:
    return gc.get_stats()[2]["collections"]


def test_in_the_meantime_only_what_is_new_is_looked_at(often):
    before, frozen = full_collections(), gc.get_freeze_count()
    with full_collections_put_off():
        new = weakref.ref(Knot())
        kept = [[] for _ in range(5000)]
        assert new() is None
        assert full_collections() == before
    assert gc.get_threshold() == (50, 1, 1)
    assert gc.get_freeze_count() == frozen
    kept += [[] for _ in range(100_000)]
    assert full_collections() > before


def test_imports_are_looked_through_rarely_and_garbage_goes_all_the_same(often):
    with rarely_collected():
        new = weakref.ref(Knot())
        kept = [[] for _ in range(5000)]
        assert new() is not None
        kept += [[] for _ in range(100_000)]
        assert new() is None


@pytest.mark.parametrize("schedule", [full_collections_put_off, rarely_collected])
def test_an_error_ends_it(often, schedule):
    with pytest.raises(ValueError, match="run"), schedule():
        raise ValueError("run")
    assert gc.get_threshold() == (50, 1, 1)
