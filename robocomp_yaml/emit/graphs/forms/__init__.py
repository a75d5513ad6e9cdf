"""One module a form, each with `draw(picture) -> text`."""

from __future__ import annotations

import importlib
import pkgutil
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robocomp_yaml.emit.graphs.picture import Picture


def forms() -> list[str]:
    """What `draw` can make."""
    return sorted(module.name for module in pkgutil.iter_modules(__path__))


def draw(picture: Picture, form: str) -> str:
    """The picture in a form, which is called as its module."""
    text: str = importlib.import_module(f"{__name__}.{form}").draw(picture)
    return text
