"""A file of the user beside the skeleton that a plan has for it."""

from __future__ import annotations

import msgspec

from robocomp_yaml.transactions.plan import FilePlan


class Own(msgspec.Struct, frozen=True):
    """A file of the user that a plan has a skeleton for. Texts are None where they are no UTF-8; `base` also where
    there is none, or none is needed. A link is not written through."""

    plan: FilePlan
    data: bytes
    yours: str | None
    base: str | None = None
    is_link: bool = False

    @property
    def is_settled(self) -> bool:
        """Whether it is what would be written today."""
        return self.data == self.plan.text.encode()
