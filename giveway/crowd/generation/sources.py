"""All people who come in during a run, from flows and from recordings."""

from collections.abc import Sequence
from typing import Protocol, Self

from giveway.crowd.roster import Roster


class Source(Protocol):
    """Something that people come from, which lets them into a crowd."""

    def afresh(self, roster: Roster) -> Self:
        """Return the same source from its beginning, for another crowd."""

    def enter(self, step: int) -> list[list[str]]:
        """Let people in at a control step; return their ids, in one list for each entry."""

    @property
    def identity(self) -> bytes:
        """The bytes that differ if others come, as far as the configuration does not tell."""

    @property
    def keeps_coming(self) -> bool:
        """Return whether somebody is known to be still to come in."""

    @property
    def remarks(self) -> list[str]:
        """The remarks for the user."""


class Sources:
    """Several sources as one.

    Args:
        sources: Sources, in the order in which they let people in.
    """

    def __init__(self, sources: Sequence[Source]) -> None:
        self._sources = tuple(sources)

    def afresh(self, roster: Roster) -> Self:
        """Return the same sources from their beginning, for another crowd."""
        return type(self)([source.afresh(roster) for source in self._sources])

    def enter(self, step: int) -> list[list[str]]:
        """Let people in at the control step ``step``; return the ids for each entry in order."""
        return [names for source in self._sources for names in source.enter(step)]

    @property
    def identity(self) -> bytes:
        """The bytes that differ if others come, as far as the configuration does not tell."""
        return b"".join(source.identity for source in self._sources)

    @property
    def keeps_coming(self) -> bool:
        """Return whether somebody is known to be still to come in."""
        return any(source.keeps_coming for source in self._sources)

    @property
    def remarks(self) -> list[str]:
        """The remarks of all sources."""
        return [remark for source in self._sources for remark in source.remarks]
