"""Machine code is made of what Python calls, and of the rest when somebody asks for its address."""

import pytest
from numba import cfunc, njit

from giveway._kernels.cache import LINKED
from giveway.geometry.kernel import inner, kernel

pytestmark = pytest.mark.skipif(not LINKED, reason="numba is newer than what this was tried with")


def uncached(function, **options):
    return njit(error_model="numpy", no_cfunc_wrapper=True, **options)(function)


def library(dispatcher):
    (compiled,) = dispatcher.overloads.values()
    return compiled.library


def test_a_function_without_python_entry_is_only_linked():
    half = uncached(lambda x: x / 2.0, no_cpython_wrapper=True)
    quarter = uncached(lambda x: half(half(x)))
    assert quarter(3.0) == 0.75
    assert library(half)._only_linked
    assert not hasattr(library(quarter), "_only_linked")


def test_who_asks_for_its_address_gets_machine_code():
    @cfunc("float64(float64)")
    def double(x):
        return 2.0 * x

    assert double.ctypes(1.5) == 3.0
    assert not double._library._only_linked


def test_what_is_kept_of_a_linked_function_is_machine_code_too():
    half = uncached(lambda x: x / 2.0, no_cpython_wrapper=True)
    assert uncached(lambda x: half(x))(1.0) == 0.5
    _, kind, (machine_code, _) = library(half).serialize_using_object_code()
    assert (kind, machine_code[:4] != b"") == ("object", True)


def test_an_error_in_an_inner_function_reaches_python():
    def checked(x):
        if x < 0.0:
            raise ValueError("below zero")
        return x

    checked = inner(checked)
    root = uncached(lambda x: checked(x) ** 0.5)
    assert root(4.0) == 2.0
    with pytest.raises(ValueError, match="below zero"):
        root(-1.0)


def test_an_inner_function_is_plain_python_and_can_be_a_kernel():
    def third(x):
        return x / 3.0

    assert inner(third) is third
    assert kernel(third)(1.0) == third(1.0)


def test_numba_has_what_this_stands_on():
    from giveway._kernels import linking

    assert linking._Library.finalize is linking._finalize
