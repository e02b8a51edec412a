"""The table ``[crowd.people]``: shares of children and of old, distracted, hurried people."""

from __future__ import annotations

from typing import Final, Literal

from pydantic import model_validator

from giveway.config.option import Section, option

Kind = Literal["adult", "child", "elderly", "distracted", "hurried"]
ADULT: Final = "adult"
DISTRACTED: Final = "distracted"
SHARE: Final = "it is a share of all"


class PeopleConfig(Section):
    """Shares of the people that giveway adds; the rest are adults."""

    child: float = option(
        0.0,
        None,
        "Share of the added people who are children with an adult",
        ge=0,
        le=1,
        because=SHARE,
    )
    elderly: float = option(
        0.0, None, "Share of the added people who are older than 65", ge=0, le=1, because=SHARE
    )
    distracted: float = option(
        0.0,
        None,
        "Share of the added people who look at a phone. They are slower, and late to notice a "
        "vehicle",
        ge=0,
        le=1,
        because=SHARE,
    )
    hurried: float = option(
        0.0, None, "Share of the added people who are in a hurry", ge=0, le=1, because=SHARE
    )

    @model_validator(mode="after")
    def _shared_out(self) -> PeopleConfig:
        if sum(self.shares.values()) > 1.0 + 1e-9:
            told = ", ".join(f"{kind} = {share:g}" for kind, share in self.shares.items() if share)
            raise ValueError(f"{told}: expected shares that come to 1 at most; the rest are adults")
        return self

    @property
    def shares(self) -> dict[str, float]:
        """The shares of all kinds of people except adults."""
        return {name: float(getattr(self, name)) for name in type(self).model_fields}

    @property
    def mixed(self) -> bool:
        """True if people differ in kind."""
        return any(self.shares.values())
