"""Faults of other packages' code, in one line each."""

from giveway.plug_ins.faults import described, shown


class UnspeakableError(Exception):
    """An error that cannot say what it is."""

    def __str__(self) -> str:
        raise RuntimeError("no words")


class Unshowable:
    """An object that cannot be shown."""

    def __repr__(self) -> str:
        raise RuntimeError("no words")


def raised(error: BaseException) -> BaseException:
    try:
        raise error
    except BaseException as caught:
        return caught


def test_an_error_is_told_with_kind_first_line_and_place() -> None:
    told = described(raised(ValueError("bad\nand more")))
    assert told.startswith("ValueError: bad (test_faults.py:")
    assert "and more" not in told


def test_an_error_without_words_has_its_kind() -> None:
    assert described(UnspeakableError()) == "UnspeakableError"
    assert described(KeyError()) == "KeyError"


def test_a_long_message_is_cut() -> None:
    assert len(described(ValueError("x" * 10_000))) < 300


def test_a_value_is_on_one_line_of_80_characters_at_most() -> None:
    assert shown([1, 2]) == "[1, 2]"
    assert shown({"a": "x" * 200}).endswith("...")
    assert len(shown({"a": "x" * 200})) == 80
    assert shown(Unshowable()) == "a Unshowable"
