"""The gate: which files of results folders are opened, and that nothing goes round it."""

from __future__ import annotations

import ast
import json
import os
import socket
import tomllib
import tracemalloc
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import giveway
from giveway import gate
from giveway.gate import RefusedFileError

if TYPE_CHECKING:
    from collections.abc import Callable

HOUSE = Path(giveway.__file__).parent
READERS = (  # what reads results folders, studies and journals, or writes into them
    "replays/*.py",
    "reports/*.py",
    "studies/folder/*.py",
    "journal/journal_reader.py",
    "run_data/scene.py",
    "config/files/trust.py",
    "recovery.py",
    "figures/style.py",
)
OPENING = {
    *("open", "read_text", "read_bytes", "write_text", "write_bytes", "memmap", "fromfile"),
    *("read_csv", "read_parquet", "read_json", "load", "savez", "savez_compressed"),
}
ALLOWED = {  # (file, what is called): of giveway's own files, of streams, or of a file of the user
    ("reports/report_page.py", "read_text"),
    ("replays/replay_page.py", "read_text"),
    ("reports/kept_runs.py", "read_bytes"),
    ("replays/repetition.py", "read_bytes"),
    ("replays/repetition.py", "open"),
    ("recovery.py", "load"),
}


def linked(file: Path, content: bytes) -> None:
    there = file.with_name("elsewhere")
    there.write_bytes(content)
    file.symlink_to(there)


def piped(file: Path, _content: bytes) -> None:
    os.mkfifo(file)


def endless(file: Path, _content: bytes) -> None:
    file.symlink_to("/dev/zero")


def bound(file: Path, _content: bytes) -> None:
    with socket.socket(socket.AF_UNIX) as end:
        end.bind(str(file))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
@pytest.mark.parametrize("put", [linked, piped, endless, bound])
def test_only_regular_files_are_opened_and_written(
    put: Callable[[Path, bytes], None], tmp_path: Path
) -> None:
    file = tmp_path / "manifest.json"
    put(file, b"{}")
    for use in (
        lambda: gate.read_json(file),
        lambda: gate.fingerprint_of(file),
        lambda: gate.write_whole(file, b"x"),
    ):
        with pytest.raises(RefusedFileError, match=r"manifest\.json: is a"):
            use()
    if put is linked:
        assert (tmp_path / "elsewhere").read_bytes() == b"{}"


def test_a_folder_on_the_way_must_not_be_a_link(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "study").mkdir()
    (tmp_path / "study" / "figures").symlink_to(tmp_path / "there")
    with pytest.raises(RefusedFileError, match="figures: is a link"):
        gate.write_whole(tmp_path / "study/figures/a/b.png", b"x", within=tmp_path / "study")
    assert not list((tmp_path / "there").iterdir())
    (tmp_path / "named").symlink_to(tmp_path / "study")  # the user's own name for the folder
    gate.write_whole(tmp_path / "named" / "report.html", b"x", within=tmp_path / "named")
    assert (tmp_path / "study" / "report.html").read_bytes() == b"x"


def test_a_link_for_the_unfinished_file_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "precious").write_text("mine")
    (tmp_path / ".replay.html.new").symlink_to(tmp_path / "precious")
    gate.write_whole(tmp_path / "replay.html", b"page")
    assert (tmp_path / "precious").read_text() == "mine"
    assert (tmp_path / "replay.html").read_bytes() == b"page"


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("[" * 100_000, "not JSON"),
        ('{"a":' * 30 + "1" + "}" * 30, "more than 20 deep"),
        (f'{{"a": {"9" * 400}}}', "not JSON"),
        ('{"a": NaN}', "not JSON"),
        ("[1]", "not a JSON object"),
        ("\xff", "not JSON"),
    ],
)
def test_json_that_giveway_does_not_write(content: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "scene.json"
    file.write_bytes(content.encode("latin-1"))
    with pytest.raises(RefusedFileError, match=said):
        gate.read_json(file)


def test_a_file_of_too_many_bytes_is_not_read(tmp_path: Path) -> None:
    file = tmp_path / "scene.json"
    with file.open("wb") as stream:
        stream.truncate(gate.LARGEST_TEXT + 1)  # without blocks on the disk
    with pytest.raises(RefusedFileError, match="67,108,865 bytes"):
        gate.read_json(file)


def test_a_small_file_takes_little_memory_however_large_it_may_be(tmp_path: Path) -> None:
    file = tmp_path / "ego.csv"
    file.write_bytes(b"time\n")
    tracemalloc.start()
    try:
        assert gate.read_bytes(file, largest=gate.LARGEST_TABLE) == b"time\n"
        assert tracemalloc.get_traced_memory()[1] < 2**20
    finally:
        tracemalloc.stop()


def test_the_users_key_signs_and_knows_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(gate, "user_cache", lambda: tmp_path / "mine")
    made = json.loads(json.dumps(gate.signed({"a": 0.1, "b": ["ä"]})))
    assert gate.is_own(made)
    assert not gate.is_own(made | {"a": 0.2})
    assert not gate.is_own({"a": 0.1, "b": ["ä"]})
    (key,) = (tmp_path / "mine").iterdir()
    assert key.stat().st_mode & 0o777 == 0o600
    monkeypatch.setattr(gate, "user_cache", lambda: tmp_path / "yours")
    assert not gate.is_own(made)
    monkeypatch.setattr(gate, "user_cache", lambda: tmp_path / "mine")
    key.chmod(0o644)  # others may have read it
    assert not gate.is_own(made)


def test_no_user_without_a_cache_folder_owns_anything(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(gate, "user_cache", lambda: tmp_path / "file" / "below")
    assert gate.signed({"a": 1}) == {"a": 1}
    assert not gate.is_own({"a": 1})


def test_nothing_opens_a_file_of_a_folder_but_the_gate() -> None:
    contracts = tomllib.loads((HOUSE.parent / "pyproject.toml").read_text())["tool"]["importlinter"]
    assert any("at the gate alone" in one["name"] for one in contracts["contracts"])
    found = set()
    for file in (file for reader in READERS for file in HOUSE.glob(reader)):
        name = file.relative_to(HOUSE).as_posix()
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Call):
                called = node.func
                word = getattr(called, "attr", getattr(called, "id", ""))
                if word in OPENING and not _is_safe(node, word):
                    found.add((name, word))
    assert found <= ALLOWED, found - ALLOWED


def _is_safe(call: ast.Call, word: str) -> bool:
    """Whether a call is the gate's, or parses what the gate has opened or other code wrote."""
    imported = isinstance(call.func, ast.Name) and hasattr(gate, word)
    of_gate = isinstance(call.func, ast.Attribute) and ast.unparse(call.func.value) == "gate"
    first = ast.unparse(call.args[0]) if call.args else ""
    return imported or of_gate or first in {"stream", "io.BytesIO(content)", "content"}
