"""Linked documents refer to each other: a component has its parameters, and the parameters have their component.

Linked documents are frozen. Only this package may change them, and only while a program is linked and not yet returned.
"""

from __future__ import annotations

import msgspec
from msgspec.structs import force_setattr


def tie(linked: msgspec.Struct, **facts: object) -> None:
    """Sets fields of a linked document."""
    for name, value in facts.items():
        force_setattr(linked, name, value)


def grow(linked: msgspec.Struct, name: str, *more: object) -> None:
    """Adds items to the tuple `name` of a linked document."""
    force_setattr(linked, name, (*getattr(linked, name), *more))
