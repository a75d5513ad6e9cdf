"""One module a form, each with `draw(picture) -> text`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robocomp_yaml.registry import Modules

if TYPE_CHECKING:
    from robocomp_yaml.emit.graphs.picture import Picture

FORMS = Modules(__name__, "form")


def forms() -> list[str]:
    """What `draw` can make."""
    return [*FORMS.table()]


def draw(picture: Picture, form: str) -> str:
    """The picture in a form, which is called as its module."""
    text: str = FORMS.load(form).draw(picture)
    return text
