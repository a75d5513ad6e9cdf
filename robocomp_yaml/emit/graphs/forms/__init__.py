"""The forms of pictures: a module for each, with `draw(picture) -> text`."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from robocomp_yaml.plugins import GRAPHS, NONE, Plugins
from robocomp_yaml.registry import Modules

if TYPE_CHECKING:
    from robocomp_yaml.emit.graphs.picture import Picture

OWN = Modules(__name__, "form")


def built_in() -> Collection[str]:
    """The names of the forms that are part of rcyaml."""
    return OWN.table().keys()


def forms(plugins: Plugins = NONE) -> list[str]:
    """The names of all forms, those of plug-ins last."""
    return [*built_in(), *sorted(plugins.of(GRAPHS))]


def draw(picture: Picture, form: str, plugins: Plugins = NONE) -> str:
    """The text of a picture in a form of `forms()`. Raises ValueError if the form is unknown."""
    if form in plugins.of(GRAPHS):
        plugin, module = plugins.of(GRAPHS)[form]
        with plugin.guarded(f"picture '{form}'"):
            drawn = module.draw(picture)
            if not isinstance(drawn, str):
                raise TypeError("it returns no text")
        return drawn
    text: str = OWN.load(form).draw(picture)
    return text
