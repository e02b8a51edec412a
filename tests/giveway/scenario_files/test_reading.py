"""Files of a scenario as streams of bytes."""

import gzip
from pathlib import Path

import pytest

from giveway.scenario_files import reading
from giveway.scenario_files.reading import opened, pieces

ROUTES = b"<routes>" + b"".join(b'<vehicle id="%d"/>' % n for n in range(50)) + b"</routes>"


@pytest.mark.parametrize("name", ["plain.xml", "compressed.xml.gz", "compressed.xml"])
def test_content_decides_whether_a_file_is_compressed(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    file.write_bytes(gzip.compress(ROUTES) if "compressed" in name else ROUTES)
    with opened(file) as stream:
        assert stream.read() == ROUTES


@pytest.mark.parametrize("chunk", [16, 37, 1 << 22])
def test_pieces_begin_and_end_between_two_tags(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, chunk: int
) -> None:
    monkeypatch.setattr(reading, "_CHUNK", chunk)
    (tmp_path / "a.xml").write_bytes(ROUTES)
    found = [piece for piece in pieces(tmp_path / "a.xml") if piece]
    assert b"".join(found) == ROUTES
    assert all(piece[:1] == b"<" and piece[-1:] == b">" for piece in found)


def test_a_compressed_file_that_is_cut_off_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "a.xml.gz").write_bytes(gzip.compress(ROUTES)[:-20])
    with pytest.raises(EOFError):
        list(pieces(tmp_path / "a.xml.gz"))


def test_what_unpacks_to_far_more_than_its_size_is_a_bomb(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reading, "_JUDGED", 1 << 20)
    usual = b"".join(b'<trip id="%d" depart="%d"/>' % (n, n * n % 9973) for n in range(40_000))
    for content, bomb in ((b" " * (1 << 22), True), (usual, False), (ROUTES, False)):
        (tmp_path / "a.xml").write_bytes(gzip.compress(content))
        assert reading.is_bomb(tmp_path / "a.xml") is bomb
        (tmp_path / "a.xml").write_bytes(content)
        assert not reading.is_bomb(tmp_path / "a.xml")
