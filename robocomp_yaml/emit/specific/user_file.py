"""A file of the user beside the skeleton that a plan has for it."""

from __future__ import annotations

import msgspec


class UserFile(msgspec.Struct, frozen=True):
    """A file of the user that a plan has a skeleton for: `new` is the skeleton of today. `yours` is '' where the file
    is no UTF-8 text; `base` is None where there is none, or none is needed. A link is not written through."""

    path: str
    new: str
    data: bytes
    yours: str
    base: str | None = None
    is_text: bool = True
    is_link: bool = False

    @property
    def is_settled(self) -> bool:
        """Whether it is what would be written today."""
        return self.data == self.new.encode()
