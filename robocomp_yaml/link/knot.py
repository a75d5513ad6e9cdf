"""Linked documents lead to each other: a component has its parameters, and these have their component.

They are frozen, so the knots are tied here, while a program is linked and nobody else has it. Only this package may.
"""

from __future__ import annotations

import msgspec
from msgspec.structs import force_setattr


def tie(linked: msgspec.Struct, **facts: object) -> None:
    """Gives a linked document what is known of it only now."""
    for name, value in facts.items():
        force_setattr(linked, name, value)


def grow(linked: msgspec.Struct, name: str, *more: object) -> None:
    """Adds to one of its tuples."""
    force_setattr(linked, name, (*getattr(linked, name), *more))
