"""What numba does no more comes to the same."""

import pytest
from llvmlite import ir
from numba import cfunc
from numba.core import codegen
from numba.core.compiler import Flags
from numba.core.registry import cpu_target

from giveway._kernels.cache import LINKED

pytestmark = pytest.mark.skipif(not LINKED, reason="numba is newer than what this was tried with")

DOUBLE, BYTE = ir.DoubleType(), ir.IntType(8)


def flags(**options):
    made = Flags()
    for name, value in options.items():
        setattr(made, name, value)
    return made


def test_configurations_are_equal_if_each_option_is():
    assert flags() == flags(no_cfunc_wrapper=Flags.options["no_cfunc_wrapper"].default)
    assert flags(nrt=True) == flags(nrt=True)
    assert flags(nrt=True) != flags(nrt=False)
    assert flags(nrt=True) != flags(release_gil=True)
    assert flags() != {}


@pytest.mark.parametrize(
    ("kind", "size"),
    [
        (DOUBLE, 8),
        (ir.LiteralStructType([BYTE, DOUBLE]), 16),
        (ir.LiteralStructType([BYTE, DOUBLE], packed=True), 9),
        (ir.ArrayType(DOUBLE, 3), 24),
    ],
)
def test_a_type_has_the_size_that_llvm_says(kind, size):
    data = cpu_target.target_context.codegen().target_data
    assert [kind.get_abi_size(data) for _ in range(2)] == [size, size]


def test_a_function_has_an_entry_for_c_and_numbas_helpers_none(monkeypatch):
    made, add_as_ever = [], codegen.CPUCodeLibrary.add_ir_module

    def add(library, module):
        made.extend(each.name for each in module.functions if not each.is_declaration)
        add_as_ever(library, module)

    monkeypatch.setattr(codegen.CPUCodeLibrary, "add_ir_module", add)

    @cfunc("int16(int16, int16)")  # of no other function in the process
    def at_least_one(x, one):
        return max(one, x)

    assert at_least_one.ctypes(3, 1) == 3
    assert any("ol_max" in name for name in made)
    (entry,) = (name for name in made if name.startswith("cfunc."))
    assert "at_least_one" in entry
