"""Reading an FMU's XML without the features of XML that a hostile file could use.

A model description needs elements and attributes, but no document type. A file that declares
entities or refers to other files is refused as soon as ``<!DOCTYPE`` is met, in any encoding,
by the same parser (expat) that reads the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Final, NoReturn
from xml.parsers import expat

from fmus.errors import FmuArchiveError, FmuFileError
from fmus.text import printable

MAX_DEPTH: Final = 64  # largest depth of elements; FMI's own go to 6, annotations are free
MAX_ELEMENTS: Final = 600_000  # 50,000 variables make 150,000
MAX_TOKEN: Final = 4 << 20  # [bytes] largest tag; a list of dependencies can be long
CHUNK: Final = 1 << 20  # [bytes] size of one read
MAX_ATTRIBUTES: Final = 100  # largest number per element; FMI's elements have at most 20


@dataclass(slots=True)
class Element:
    """An XML element; its text, which FMI does not use, is left out."""

    tag: str
    attributes: dict[str, str]
    line: int
    children: list[Element] = field(default_factory=list)

    def get(self, name: str, default: str = "") -> str:
        """Return the value of an attribute."""
        return self.attributes.get(name, default)

    def every(self, *tags: str) -> Iterator[Element]:
        """Yield all descendants at the end of a chain of tags."""
        for child in self.children:
            if child.tag == tags[0]:
                if len(tags) == 1:
                    yield child
                else:
                    yield from child.every(*tags[1:])

    def first(self, *tags: str) -> Element | None:
        """Return the first of :meth:`every`, or None."""
        return next(self.every(*tags), None)


def check_xml(data: bytes, where: str, root: str, *, namespaces: bool = False) -> None:
    """Refuse an XML file that cannot be a model description; nothing of it is kept.

    Args:
        data: Contents of the XML file.
        where: Name of the file in errors.
        root: Name of the first element.
        namespaces: True if names count without the prefixes of their namespaces.

    Raises:
        FmuArchiveError: the file has a document type or is too large.
        FmuFileError: the file is not well-formed or has another first element.
    """
    _LimitedParser(where, root, None, lambda _tag: None, namespaces=namespaces).go(data)


def parse(
    data: bytes, where: str, root: str, kept: frozenset[str], *, namespaces: bool = False
) -> Element:
    """Return the first element, with the descendants whose names are among ``kept``.

    With ``namespaces``, names count without the prefixes of their namespaces.

    Raises:
        FmuArchiveError: the file has a document type or is too large.
        FmuFileError: the file is not well-formed or has another first element.
    """
    top = Element("", {}, 0)
    open_elements = [top]
    skipped = 0  # levels below an element that is left out

    def start(tag: str, attributes: dict[str, str], line: int) -> None:
        nonlocal skipped
        if skipped or (tag not in kept and tag != root):
            skipped += 1
            return
        element = Element(tag, attributes, line)
        open_elements[-1].children.append(element)
        open_elements.append(element)

    def end(_tag: str) -> None:
        nonlocal skipped
        if skipped:
            skipped -= 1
        else:
            open_elements.pop()

    _LimitedParser(where, root, start, end, namespaces=namespaces).go(data)
    return top.children[0]


class _LimitedParser:
    """One pass over a document that enforces the limits.

    Args:
        where: Name of the document in messages.
        root: Name of the first element.
        start: Function that receives each element's name, attributes and line, or None.
        end: Function that receives each element's name at its end.
        namespaces: True if names count without the prefixes of their namespaces.
    """

    def __init__(
        self,
        where: str,
        root: str,
        start: Callable[[str, dict[str, str], int], None] | None,
        end: Callable[[str], None],
        *,
        namespaces: bool,
    ) -> None:
        self._where, self._root, self._start, self._end = where, root, start, end
        self._depth = self._count = 0
        self._parser = parser = expat.ParserCreate(namespace_separator=" " if namespaces else None)
        parser.StartDoctypeDeclHandler = self._on_doctype
        parser.StartElementHandler = self._on_start
        parser.EndElementHandler = self._on_end

    def go(self, data: bytes) -> None:
        """Parse the whole document.

        Raises:
            FmuArchiveError: the document has a document type or is too large.
            FmuFileError: the document is not well-formed or has another first element.
        """
        parser = self._parser
        try:
            for place in range(0, len(data), CHUNK):
                parser.Parse(data[place : place + CHUNK], False)
                if place + CHUNK - parser.CurrentByteIndex > MAX_TOKEN:
                    self._refuse(f"a tag of more than {MAX_TOKEN >> 20} MB")
            parser.Parse(b"", True)
        except expat.ExpatError as error:
            raise FmuFileError(
                f"{self._where}: not well-formed XML: {printable(error)}; export the model again"
            ) from None
        except (LookupError, ValueError) as error:  # an unknown encoding
            raise FmuFileError(
                f"{self._where}: {printable(error)}; expected UTF-8; export the model again"
            ) from None

    def _on_start(self, tag: str, attributes: dict[str, str]) -> None:
        line = self._parser.CurrentLineNumber
        tag = tag.rpartition(" ")[2]
        if not self._count and tag != self._root:
            what = f"<{printable(tag, 60)}> instead of <{self._root}>; export the model again"
            raise FmuFileError(f"{self._where}, line {line}: {what}")
        self._depth += 1
        self._count += 1
        if self._depth > MAX_DEPTH:
            self._refuse(f"more than {MAX_DEPTH} elements within each other")
        if self._count > MAX_ELEMENTS:
            self._refuse(f"more than {MAX_ELEMENTS} elements")
        if len(attributes) > MAX_ATTRIBUTES:
            self._refuse(f"an element with {len(attributes)} attributes")
        if self._start is not None:
            self._start(tag, attributes, line)

    def _on_end(self, tag: str) -> None:
        self._depth -= 1
        self._end(tag)

    def _on_doctype(self, *_declaration: object) -> None:
        self._refuse("a document type (<!DOCTYPE ...>); a model description has none")

    def _refuse(self, what: str) -> NoReturn:
        line = self._parser.CurrentLineNumber
        raise FmuArchiveError(f"{self._where}, line {line}: {what}; no tool exports such a file")
