"""The rewriting of XML as a stream: only some attributes change, all other bytes stay."""

import codecs
import html
import re
from collections.abc import Callable, Mapping
from typing import IO
from xml.sax.saxutils import escape

Changes = Mapping[str, str]
Visitor = Callable[[str, Mapping[str, str], str], Changes]

_CHUNK = 1 << 20  # Size of one read [bytes]
_ENDS = ((b"<!--", b"-->"), (b"<![CDATA[", b"]]>"), (b"<?", b"?>"))
_TAG = re.compile(rb"<(/?)([\w:.-]+)((?:[^<>\"']|\"[^\"]*\"|'[^']*')*)>")
_ATTRIBUTE = re.compile(rb"([\w:.-]+)\s*=\s*(\"[^\"]*\"|'[^']*')")
_ENCODING = re.compile(rb"<\?xml[^>]*encoding\s*=\s*[\"']([\w.-]+)")


def rewrite(source: IO[bytes], target: IO[bytes], visit: Visitor, names: frozenset[str]) -> None:
    """Copy XML from ``source`` to ``target``, with some attributes changed.

    Nothing is checked, and nothing else changes. Malformed XML stays malformed, and SUMO reports
    it. The memory needed grows with the depth of the nesting, not with the file.

    Args:
        source: XML in an encoding that contains ASCII.
        target: Stream that receives the copy.
        visit: Function of an element's name, its attributes and its parent's name. It returns the
            new values of the attributes that change; attributes that the element lacks are ignored.
        names: Names of the elements for which ``visit`` is called.
    """
    copy = _Copy(target, visit, names)
    pending = b""
    while chunk := source.read(_CHUNK):
        pending = copy.feed(pending + chunk)
    target.write(pending)


class _Copy:
    """The state of a copy: the open elements and the encoding."""

    def __init__(self, target: IO[bytes], visit: Visitor, names: frozenset[str]) -> None:
        self._target = target
        self._visit = visit
        self._names = frozenset(name.encode() for name in names)
        self._open: list[bytes] = []
        self._encoding = "utf-8"

    def feed(self, text: bytes) -> bytes:
        """Copy the complete part of ``text``, and return the rest."""
        written = position = 0
        while (start := text.find(b"<", position)) >= 0:
            tag = _TAG.match(text, start)
            if tag is None:
                end = self._end_of_other(text, start)
                if end is None:  # the rest of the tag has not been read yet
                    self._target.write(text[written:start])
                    return text[start:]
                position = end
                continue
            position = tag.end()
            changed = self._changed(tag)
            if changed is not None:
                self._target.write(text[written:start])
                self._target.write(changed)
                written = position
        self._target.write(text[written:])
        return b""

    def _end_of_other(self, text: bytes, start: int) -> int | None:
        """Return the end of the comment, declaration or literal text at ``start``, or None."""
        for opening, closing in _ENDS:
            if text.startswith(opening, start):
                end = text.find(closing, start + len(opening))
                if end < 0:
                    return None
                end += len(closing)
                self._note_encoding(text[start:end])
                return end
        if text.startswith(b"<!", start) and len(text) - start > len("<![CDATA["):
            end = text.find(b">", start)  # a document type
            return None if end < 0 else end + 1
        return None

    def _note_encoding(self, markup: bytes) -> None:
        declared = _ENCODING.match(markup)
        if declared is not None:
            try:
                self._encoding = codecs.lookup(declared[1].decode("ascii")).name
            except LookupError:
                self._encoding = "utf-8"

    def _changed(self, tag: re.Match[bytes]) -> bytes | None:
        """Return the tag with its new values, or None if it stays."""
        closing, name, inside = tag.groups()
        if closing:
            if self._open:
                self._open.pop()
            return None
        parent = self._open[-1] if self._open else b""
        if not inside.endswith(b"/"):
            self._open.append(name)
        if name not in self._names:
            return None
        attributes = {
            found[1].decode("ascii", "replace"): html.unescape(
                found[2][1:-1].decode(self._encoding, "replace")
            )
            for found in _ATTRIBUTE.finditer(inside)
        }
        changes = self._visit(name.decode(), attributes, parent.decode("ascii", "replace"))
        if not changes:
            return None
        changed = _ATTRIBUTE.sub(lambda found: self._replaced(found, changes), inside)
        return b"<" + name + changed + b">"

    def _replaced(self, attribute: re.Match[bytes], changes: Changes) -> bytes:
        value = changes.get(attribute[1].decode("ascii", "replace"))
        if value is None:
            return attribute[0]
        quoted = escape(value, {'"': "&quot;"}).encode(self._encoding, "xmlcharrefreplace")
        return attribute[1] + b'="' + quoted + b'"'
