"""Tables of TOML files: `true` is no number in any of them, whatever reads it."""

import pkgutil
from collections.abc import Iterator
from importlib import import_module
from typing import Any, get_args

import pytest
from pydantic import ValidationError

from fmus.strict_table import NO_TRUTH, StrictTable, is_truth_for_number

PACKAGES = ("fmus.profile", "giveway.config", "giveway.recordings", "giveway.studies")


def tables(of: type[StrictTable] = StrictTable) -> Iterator[type[StrictTable]]:
    """Yield every class of tables of the product that is imported."""
    for kind in of.__subclasses__():
        yield from tables(kind)
        if kind.__module__.startswith(PACKAGES):
            yield kind


def numbers(annotation: Any) -> Iterator[Any]:
    """Yield true in each form in which an annotation takes a number."""
    if annotation in {int, float}:
        yield True
    for part in get_args(annotation):
        for value in numbers(part):
            yield from (value, [value], [value, value], [1.0, 2.0, 3.0, value], {"child": value})


def test_no_number_of_any_table_takes_true() -> None:
    tried = 0
    for name in PACKAGES:
        package = import_module(name)
        for module in pkgutil.walk_packages(package.__path__, f"{name}."):
            import_module(module.name)
    fields = [(kind, *field) for kind in set(tables()) for field in kind.model_fields.items()]
    for kind, attribute, field in fields:
        key = field.alias or attribute
        values = [] if "bool" in str(field.annotation) else numbers(field.annotation)
        for value in values:
            with pytest.raises(ValidationError) as caught:
                kind.model_validate({key: value})
            assert NO_TRUTH in [e["msg"] for e in caught.value.errors() if e["loc"] == (key,)]
            tried += 1
    assert tried > 150


def test_true_stays_true_where_it_is_meant() -> None:
    assert not is_truth_for_number([True], list[bool | float])
    assert not is_truth_for_number(1.0, float)
    assert is_truth_for_number({"a": [1.0, False]}, dict[str, list[float]])
