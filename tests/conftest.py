"""What tests of several folders need: somebody else's FMUs, and how a refusal has to look."""

from __future__ import annotations

import gc
import importlib.util
import os
import re
import signal
import sys
from pathlib import Path
from typing import Any

import hypothesis
import pytest

SUPPORT = Path(__file__).parent / "support"

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # A shell without job control starts what is in its background deaf to Ctrl-C, which tests send.
    signal.signal(signal.SIGINT, signal.default_int_handler)

# Hundreds of programs are started; none shall compile our modules again, even where Python has been
# told to keep no bytecode.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
# No test fails for having been slow.
hypothesis.settings.register_profile("unhurried", deadline=None)
hypothesis.settings.load_profile("unhurried")
# Half of what numpy's import costs is the start of threads that nothing here uses.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.dont_write_bytecode = False
# Of what is imported and collected, all stays.
gc.set_threshold(50_000, 20, 100)


def _load_support() -> None:
    """Make the package tests/support, which is on no path, known as ``support``."""
    spec = importlib.util.spec_from_file_location(
        "support", SUPPORT / "__init__.py", submodule_search_locations=[str(SUPPORT)]
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["support"] = module
    spec.loader.exec_module(module)


_load_support()
pytest_plugins = [
    "support.any_scenario",
    "support.browser",
    "support.clips",
    "support.recorded_corridor",
    "support.recorded_crossing",
    "support.commands",
    "support.plug_ins",
    "support.replay_pages",
    "support.running",
    "support.runs",
    "support.scenarios",
    "support.simple_car",
    "support.streets",
    "support.studies",
]


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config: pytest.Config) -> None:
    """With several workers (``-n``), keep neighbours together: they share expensive fixtures."""
    if getattr(config.option, "numprocesses", None) and config.option.dist == "no":
        config.option.dist = "worksteal"


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the tests of ``fmus``, which need no compiled kernels, behind the first half.

    Two workers begin at the two halves: so one of them compiles the kernels, and the other finds
    them compiled when it comes to tests that need them.
    """
    needs_none = [item for item in items if "fmus" in item.path.parent.parts]
    others = [item for item in items if "fmus" not in item.path.parent.parts]
    half = len(items) // 2
    items[:] = [*others[:half], *needs_none, *others[half:]]


def pytest_collection_finish() -> None:
    """Leave all that is imported and collected out of each later search for garbage."""
    gc.freeze()


@pytest.fixture(scope="session")
def zoo(tmp_path_factory: pytest.TempPathFactory, pytestconfig: pytest.Config) -> Any:
    """FMUs of every kind, built on demand (tests/support/fmus/README.md is the menu)."""
    if importlib.util.find_spec("ziglang") is None:
        pytest.skip("ziglang is not installed: pip install giveway[build]")
    from support.fmus import Zoo

    assert pytestconfig.cache is not None
    return Zoo(tmp_path_factory.mktemp("zoo"), pytestconfig.cache.mkdir("fmu_zoo"))


@pytest.fixture(scope="session")
def refused() -> Any:
    """Expects an error of a class, on one line, whose message names all of these."""

    def expect(kind: type[Exception], *named: object) -> Any:
        lookaheads = "".join(f"(?=.*{re.escape(str(word))})" for word in named)
        return pytest.raises(kind, match=rf"^{lookaheads}[^\n]+\Z")

    return expect
