"""What a deployment's document says about its entries, as its changes need it: names and where they are used."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

import msgspec

from robocomp_yaml.api.editing.text import EditedText
from robocomp_yaml.api.refusals import meant
from robocomp_yaml.diag.errors import Refused
from robocomp_yaml.diag.listing import some
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.model.deployment import INDEX
from robocomp_yaml.semantics.paths import Step
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence

COMPONENTS, GROUPS, HOSTS, SERVICES = "components", "groups", "hosts", "services"


class EntryUse(msgspec.Struct, frozen=True):
    """A place where a document names an entry or a group: the steps to it, and the text. `rest` is what follows the
    name (`.Mouth`). If `is_all`, a name with instances means all of them."""

    steps: tuple[Step, ...]
    text: str
    rest: str = ""
    is_all: bool = True


class Entries:
    """The entries of the document of an edited text. `scope` is the include in which the document is, with a dot;
    `components` are the components of entries, as far as they are known. `created` are the paths of documents that will
    be written with the change. `renamed` are entries that get another name."""

    def __init__(self, edited: EditedText, scope: str, components: dict[str, LinkedComponent]) -> None:
        self.edited, self.scope, self.components = edited, scope, components
        self.created: Collection[str] = ()
        self.renamed: list[tuple[str, str]] = []

    def names(self, section: str = COMPONENTS) -> list[str]:
        node = self.edited.at(section)
        return [key for key in node.entries if not key.startswith("x-")] if isinstance(node, Mapping) else []

    def key(self, name: str) -> str:
        """The key of an entry: its name, or that of one of its instances. Raises Refused if it is unknown."""
        name, known = self.own(name), self.names()
        if name in known:
            return name
        numbered = (one for one in known if INDEX in one and re.fullmatch(_numbered(one), name))
        return next(numbered, "") or self._unknown(name, known)

    def steps(self, name: str) -> list[Step]:
        return [COMPONENTS, self.key(name)]

    def own(self, name: str) -> str:
        """A name of the whole network as this document spells it."""
        return name.removeprefix(self.scope)

    def require_new(self, name: str) -> None:
        if name in {*self.names(), *self.names(GROUPS), *self.names(SERVICES)}:
            raise Refused(f"{self.edited.path} has a '{name}' already")

    def require(self, section: str, name: str) -> None:
        """Raises Refused if a section has no such name."""
        if name not in (known := self.names(section)):
            raise Refused(f"{self.edited.path} has no {section[:-1]} '{name}'{meant(name, known)}")

    def component(self, name: str) -> LinkedComponent | None:
        return self.components.get(self.key(name))

    def _unknown(self, name: str, known: list[str]) -> str:
        listed = f"known are {some(known, 8)}" if known else ""
        raise Refused(f"{self.edited.path} has no entry '{name}'{meant(name, known, listed)}")

    def uses(self, name: str) -> Iterator[EntryUse]:
        """Where the document uses the name of an entry or a group, or of one of its instances."""
        for entry in self.names():
            node = self.edited.at(COMPONENTS, entry)
            yield from self._in(node, (COMPONENTS, entry), name)
        for group in self.names(GROUPS):
            node = self.edited.at(GROUPS, group)
            if isinstance(node, Mapping):
                yield from _of_list(node.get("components"), (GROUPS, group, "components"), name)
                yield from _of_values(node.get("expose"), (GROUPS, group, "expose"), name)

    def _in(self, node: Node | None, steps: tuple[Step, ...], name: str) -> Iterator[EntryUse]:
        if isinstance(node, Mapping):
            yield from _of_list(node.get("after"), (*steps, "after"), name)
            yield from _of_values(node.get("connect"), (*steps, "connect"), name)
            yield from _of_scalar(node.get("process"), (*steps, "process"), name, is_all=False)


def _of_list(node: Node | None, steps: tuple[Step, ...], name: str) -> Iterator[EntryUse]:
    for index, item in enumerate(node.items if isinstance(node, Sequence) else ()):
        yield from _of_scalar(item, (*steps, index), name)


def _of_values(node: Node | None, steps: tuple[Step, ...], name: str) -> Iterator[EntryUse]:
    for key, value in node.items() if isinstance(node, Mapping) else ():
        inner = value.get("member")
        if inner is not None:
            yield from _of_scalar(inner, (*steps, key.lexeme, "member"), name, is_all=False)
        yield from _of_scalar(value, (*steps, key.lexeme), name, is_all=False)


def _of_scalar(node: Node | None, steps: tuple[Step, ...], name: str, *, is_all: bool = True) -> Iterator[EntryUse]:
    if not isinstance(node, Scalar):
        return
    found = re.fullmatch(rf"({_numbered(name)}|{re.escape(name)})(\.[\w.]+)?", node.lexeme)
    if found is not None:
        yield EntryUse(steps, found[1], found[2] or "", is_all)


def _numbered(name: str) -> str:
    """The pattern of the names of an entry's instances."""
    return re.escape(name).replace(re.escape(INDEX), r"\d+")
