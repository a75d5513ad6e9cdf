"""Properties that are not parameters, and are written among them: where they belong."""

from __future__ import annotations

from collections.abc import Iterator

from robocomp_yaml.semantics.connections import MANAGER
from robocomp_yaml.source.ice_properties import PREFIX
from robocomp_yaml.source.tree import Mapping, Node

_TLS = "IceSSL."


def section_of(name: str, value: Node | None = None, *, is_similar: bool = False) -> str:
    """The section in which the property of this name is written, as a hint; '' if the name is none that Ice or the run
    time reads. A mapping as the value continues the name: `{Ice: {Warn: {Connections: 1}}}`. If a parameter
    `is_similar`, that is meant, unless the property is one of Ice itself."""
    names = [whole for whole in _wholes(name, value) if not is_similar or whole.startswith((PREFIX, _TLS))]
    return next((hint for whole in names if (hint := _section(whole))), "")


def _wholes(name: str, value: Node | None) -> Iterator[str]:
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _wholes(f"{name}.{key.lexeme}", inner)
    else:
        yield name


def _section(name: str) -> str:
    if name.startswith(PREFIX):
        own = name.removeprefix(PREFIX)
        return f"it is a property of Ice: write `ice: {{{own}: …}}` in a values document"
    if name.startswith(_TLS):
        return f"it is a property of Ice: write `properties: {{{name}: …}}` in a values document"
    if name in MANAGER:
        return "it is not a parameter: write `topics: {manager: …}` in a values document"
    before, _, last = name.rpartition(".")
    if last == "Endpoints" and before:
        written = f"`endpoints: {{{before}: …}}` in a values document, or `ports: {{{before}: …}}` in a deployment"
        return f"it is not a parameter: write {written}"
    interface = name.removesuffix("Proxy") if not before else last if before == "Proxies" else ""
    if interface and interface != name and interface[0].isupper():
        written = (
            f"`proxies: {{{interface}: …}}` in a values document, or `connect: {{{interface}: …}}` in a deployment"
        )
        return f"it is not a parameter: write {written}"
    return ""
