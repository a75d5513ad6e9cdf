"""A file of the user, with the skeletons for it."""

from __future__ import annotations

import msgspec


class UserFile(msgspec.Struct, frozen=True):
    """A file of the user for which a plan has a skeleton: `new` is the new skeleton, `base` the one that the file was
    written from (None if it is unknown or not needed). `accepted` is code with signatures that are right, too. `yours`
    is the text of the file, '' if it is not UTF-8. A link is never written to."""

    path: str
    new: str
    data: bytes
    yours: str
    base: str | None = None
    accepted: str = ""
    is_text: bool = True
    is_link: bool = False

    @property
    def is_up_to_date(self) -> bool:
        """Whether the file is the new skeleton."""
        return self.data == self.new.encode()
