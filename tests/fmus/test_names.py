"""The public names of ``fmus`` come at their first use; one of its modules needs less."""

from __future__ import annotations

import subprocess
import sys

import pytest

import fmus
from fmus import names


def test_they_are_those_of_the_package():
    brought: dict[str, object] = {}
    exec("from fmus import *", brought)
    assert {name: brought.get(name) for name in names.__all__} == {
        name: getattr(names, name) for name in names.__all__
    }
    with pytest.raises(AttributeError, match="module 'fmus' has no attribute 'describ'"):
        _ = fmus.describ


@pytest.mark.parametrize("module", ["fmus.archive.own_folder", "giveway.sumo.plain_drive"])
def test_a_module_that_knows_no_profiles_imports_none(module):
    program = f"import sys, {module}; sys.exit('pydantic' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
