"""Mutations of a file's content: bytes, lines, values, names; a seeded generator draws them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import random
    from collections.abc import Callable

    Mutation = Callable[[random.Random, bytes], bytes]

# What a value may be turned into, whatever it was.
EXTREMES: Final = (
    *(b"nan", b"inf", b"-inf", b"1e308", b"-1e308", b"1e400", b"1e-308", b"-1", b"0", b"-0.0"),
    *(b"1", b"2", b"0.5", b"1e9", b"99999999999999999999", b"2147483648", b"-9223372036854775809"),
    *(b"", b" ", b"true", b"false", b"null", b"x", b"0x10", b"1,5", b"1_000", b"%s", b"..", b"/"),
    *("\u00fc\u2603\u202e\U0001f600".encode(), b"\x1b[31mred", b"\x00", b"\xff\xfe", b"x" * 5000),
    *(b"<b>", b"&lt;", b"'", b"$HOME", b"a b", b"1 2 3", b"[0]", b"exp(0.1)", b"-"),
)
_TOML_EXTREMES: Final = (
    *(b"[]", b"{}", b"[[]]", b"1979-05-27T07:32:00Z", b"07:32:00", b"true", b"false", b"nan"),
    *(b"inf", b"-inf", b"1e308", b"-1", b"0", b"0.0", b"1e-308", b'""', b"[1, 2]", b'["a", "b"]'),
    *(b"{ a = 1 }", b"1e400", b"99999999999999999999", b"-9223372036854775809", b'"\\u0000"'),
    *(b'"' + b"x" * 5000 + b'"', '"\u00fc\u202e\u2603"'.encode(), b'"\\u001b[31m"', b'" "'),
    *(b"[" * 3000 + b"]" * 3000, b"{ a = { b = { c = 1 } } }", b"[nan, nan]", b"1", b"2", b"100"),
    *(b'"nan"', b'"none"', b'"/"', b'".."', b"[[1, 2], [3]]", b"[true]", b"0x7fffffff", b"1e15"),
)

# Where the values of each form of file stand, and its named parts.
_VALUES: Final = {
    "xml": re.compile(rb'(?<==")[^"]*(?=")'),
    "toml": re.compile(rb"(?m)(?<== )[^#\n]+?(?= *(?:#.*)?$)"),
    "csv": re.compile(rb"[^,\n]+"),
    "json": re.compile(rb'(?<=: )(?:"[^"]*"|[-\w.+]+)'),
}
_PARTS: Final = {
    "xml": re.compile(rb'[ \n]+[\w:]+="[^"]*"|<[a-zA-Z][^<>]*/>|</?[a-zA-Z][^<>]*>'),
    "toml": re.compile(rb"(?m)^[^#\n]+\n"),
    "csv": re.compile(rb"(?m)^[^\n]*\n|,[^,\n]*"),
    "json": re.compile(rb'"[^"]*": (?:"[^"]*"|[-\w.+]+),?|[{}\[\],]'),
}
_DIGIT: Final = re.compile(rb"\d")
_NUMBER: Final = re.compile(rb"(?<![\w.\-])-?\d+(?:\.\d+)?(?![\w.\-])")
_NAMES: Final = {
    "xml": re.compile(rb'[\w:]+(?==")|(?<=<)\w+'),
    "toml": re.compile(rb"(?m)^[\w.\"-]+(?= *=)|(?<=^\[)[^\]]+"),
    "csv": re.compile(rb"(?<![\d.])[a-z_]+"),
    "json": re.compile(rb'(?<=")[^"]+(?=":)'),
}


def mutate(random: random.Random, content: bytes, form: str) -> tuple[bytes, str]:
    """``content`` with one to three mutations, and what they are called.

    Args:
        random: draws them.
        content: of a file.
        form: "xml", "toml", "csv" or "json"; anything else: bytes without a structure.
    """
    names = []
    for _ in range(random.choices((1, 2, 3), (7, 2, 1))[0]):
        structured = form in _VALUES and random.random() < 0.85
        kinds = _structured(form) if structured else _BYTES
        kind = random.choices(list(kinds), list(kinds.values()))[0]
        names.append(kind.__name__.strip("_").replace("_", " "))
        content = kind(random, content)
    return content, ", ".join(names)


def _structured(form: str) -> dict[Mutation, int]:
    """Mutations of a form of file, and how often each is drawn."""
    values, parts, named = _VALUES[form], _PARTS[form], _NAMES[form]
    by_form: dict[str, tuple[bytes, ...]]
    by_form = {"toml": _TOML_EXTREMES, "json": (*EXTREMES, *_TOML_EXTREMES)}
    extremes = by_form.get(form, EXTREMES)

    def extreme(random: random.Random, content: bytes) -> bytes:
        return _replaced(random, content, values, lambda _: random.choice(extremes))

    def other_value(random: random.Random, content: bytes) -> bytes:
        found = values.findall(content)
        return _replaced(random, content, values, lambda _: random.choice(found))

    def digit(random: random.Random, content: bytes) -> bytes:
        letters = b"0123456789.-e"
        return _replaced(random, content, _DIGIT, lambda _: random.choice(letters).to_bytes())

    def part_gone(random: random.Random, content: bytes) -> bytes:
        return _replaced(random, content, parts, lambda _: b"")

    def part_twice(random: random.Random, content: bytes) -> bytes:
        return _replaced(random, content, parts, lambda part: part + part)

    def other_part(random: random.Random, content: bytes) -> bytes:
        found = parts.findall(content)
        return _replaced(random, content, parts, lambda _: random.choice(found))

    def other_name(random: random.Random, content: bytes) -> bytes:
        found = named.findall(content)
        return _replaced(random, content, named, lambda _: random.choice([*found, b"x", b""]))

    def scaled(random: random.Random, content: bytes) -> bytes:
        factor = random.choice((-1.0, 0.0, 0.01, 0.1, 0.5, 0.9, 1.1, 2.0, 10.0, 100.0))
        return _replaced(random, content, _NUMBER, lambda n: repr(float(n) * factor).encode())

    often: dict[Mutation, int] = {extreme: 6, scaled: 4, other_value: 3, digit: 2, part_gone: 3}
    seldom: dict[Mutation, int] = {part_twice: 1, other_part: 1, other_name: 1}
    return often | seldom


def _replaced(
    random: random.Random,
    content: bytes,
    pattern: re.Pattern[bytes],
    by: Callable[[bytes], bytes],
) -> bytes:
    """One of the places where ``pattern`` matches, replaced."""
    matches = list(pattern.finditer(content))
    if not matches:
        return content
    match = random.choice(matches)
    return content[: match.start()] + by(match.group()) + content[match.end() :]


# ---- without a structure ----


def _slice(random: random.Random, content: bytes) -> tuple[int, int]:
    start = random.randrange(len(content) + 1)
    return start, min(len(content), start + random.choice((1, 2, 8, 64, 512)))


def _flip(random: random.Random, content: bytes) -> bytes:
    if not content:
        return content
    place = random.randrange(len(content))
    changed = bytes([content[place] ^ (1 << random.randrange(8))])
    return content[:place] + changed + content[place + 1 :]


def _gone(random: random.Random, content: bytes) -> bytes:
    start, end = _slice(random, content)
    return content[:start] + content[end:]


def _twice(random: random.Random, content: bytes) -> bytes:
    start, end = _slice(random, content)
    return content[:end] + content[start:end] + content[end:]


def _noise(random: random.Random, content: bytes) -> bytes:
    start, end = _slice(random, content)
    return content[:start] + random.randbytes(end - start) + content[end:]


def _inserted(random: random.Random, content: bytes) -> bytes:
    start, _ = _slice(random, content)
    return content[:start] + random.choice(EXTREMES) + content[start:]


def _cut_off(random: random.Random, content: bytes) -> bytes:
    return content[: random.randrange(len(content) + 1)]


def _emptied(_random: random.Random, _content: bytes) -> bytes:
    return b""


def _lines(random: random.Random, content: bytes) -> bytes:
    """Two lines change places, or one is gone, or is there twice."""
    lines = content.splitlines(keepends=True) or [b""]
    one, other = random.randrange(len(lines)), random.randrange(len(lines))
    change = random.choice(("swapped", "gone", "twice"))
    if change == "swapped":
        lines[one], lines[other] = lines[other], lines[one]
    elif change == "gone":
        del lines[one]
    else:
        lines.insert(other, lines[one])
    return b"".join(lines)


_BYTES: Final[dict[Mutation, int]] = {
    _flip: 3,
    _gone: 1,
    _twice: 1,
    _noise: 1,
    _inserted: 1,
    _cut_off: 1,
    _emptied: 1,
    _lines: 3,
}
