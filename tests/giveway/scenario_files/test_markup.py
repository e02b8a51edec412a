"""A rewritten file is the original in every byte that was not asked to change."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.scenario_files import markup
from giveway.scenario_files.markup import rewrite

if TYPE_CHECKING:
    from collections.abc import Mapping

TEXT = b"""<?xml version="1.0" encoding="ISO-8859-1"?>
<!DOCTYPE additional>
<!-- <a file="x"/> > -->
<root>  <a id='1'   file = "old > name.xml"
    other="y"/><![CDATA[ <a file="x"/> ]]>
    <b file="x"><param key="file" value="d&amp;e"/></b> text
</root>
"""


def rewritten(text: bytes, new: str = "new") -> tuple[bytes, list[tuple[str, str]]]:
    seen = []

    def visit(name: str, attributes: Mapping[str, str], parent: str) -> dict[str, str]:
        seen.append((name, parent))
        return {"file": new} if name == "a" else {}

    target = io.BytesIO()
    names = frozenset({"root", "a", "b", "param"})
    rewrite(io.BytesIO(text), target, visit, names)
    return target.getvalue(), seen


@pytest.mark.parametrize("chunk", [1, 2, 7, 64, 1 << 20])
def test_only_what_is_asked_for_changes(chunk: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(markup, "_CHUNK", chunk)
    text, seen = rewritten(TEXT)
    assert text == TEXT.replace(b'file = "old > name.xml"', b'file="new"')
    assert seen == [("root", ""), ("a", "root"), ("b", "root"), ("param", "b")]


def test_new_values_are_quoted_in_the_files_own_encoding() -> None:
    text, _ = rewritten(TEXT, 'Köln & "Ω" <')
    assert b'file="K\xf6ln &amp; &quot;&#937;&quot; &lt;"' in text


@pytest.mark.parametrize("broken", [b"<root><a file='x'", b"<!-- never ends <a file='x'/>", b"< a"])
def test_what_is_not_well_formed_stays_for_sumo_to_refuse(broken: bytes) -> None:
    assert rewritten(broken)[0] == broken


@given(st.binary(max_size=300))
def test_any_bytes_pass_through(text: bytes) -> None:
    target = io.BytesIO()
    rewrite(io.BytesIO(text), target, lambda name, attributes, parent: {}, frozenset({"a"}))
    assert target.getvalue() == text
