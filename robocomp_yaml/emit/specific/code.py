"""Source code as a merge sees it: methods of the specific class, imports, and syntax errors."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from functools import cache
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.digraph import preorder

if TYPE_CHECKING:
    from tree_sitter import Node, Parser

CLASS = "SpecificWorker"


class Signature(msgspec.Struct, frozen=True):
    """`parameters` and `returns` have normalized blanks; `names` are those of the parameters. A call has at least
    `least` and at most `most` arguments; `most` is None if there is no limit."""

    parameters: tuple[str, ...]
    names: tuple[str, ...]
    returns: str
    least: int
    most: int | None


class SourceMethod(msgspec.Struct, frozen=True):
    """A method of the class: declared in its body, or (C++) defined outside.

    `first` is its first line, with decorators, and `end` the line after its last; both count from 0. `signature` is
    None if the name is only assigned. `nested`: the method is inside a condition.
    """

    name: str
    location: Span
    first: int
    end: int
    signature: Signature | None
    has_body: bool = True
    nested: bool = False


class ImportLine(msgspec.Struct, frozen=True):
    """One imported name, and the line that imports only this name."""

    key: str
    line: str


class SourceCode(msgspec.Struct, frozen=True):
    """A file. `faults` is the number of syntax errors. `members` are in the class, `definitions` outside. `location` is
    the location of the class's name, None if the file does not contain the class. `body_end` is the line before which
    the class's body ends, and `unit` one step of indentation. `bases` are the base classes. `import_end` is the line
    after the last import, or the line before which an import can be inserted. `older` is the location of syntax that
    only an older version of the language has."""

    path: str
    lines: list[str]
    faults: int
    members: tuple[SourceMethod, ...] = ()
    definitions: tuple[SourceMethod, ...] = ()
    imports: tuple[ImportLine, ...] = ()
    import_end: int = 0
    location: Span | None = None
    body_end: int = 0
    unit: str = "    "
    bases: tuple[str, ...] = ()
    older: Span | None = None

    @property
    def methods(self) -> tuple[SourceMethod, ...]:
        """The declarations and definitions of methods."""
        return (*self.members, *self.definitions)

    def text_of(self, method: SourceMethod) -> str:
        """The lines of a method."""
        return "".join(self.lines[method.first : method.end])


@cache
def parser(language: Callable[[], object]) -> Parser:
    """The parser of a language, by the function of its grammar's package."""
    from tree_sitter import Language, Parser  # of what a component without code does not need

    return Parser(Language(language()))


def lines_of(text: str) -> list[str]:
    """The lines with their ends. Only a line feed ends a line, as for compilers."""
    lines = [f"{line}\n" for line in text.split("\n")]
    last = lines.pop()[:-1]
    return [*lines, last] if last else lines


def location(node: Node, lines: list[str]) -> Span:
    """The location of a node of one line, without the path."""
    row, start = node.start_point
    column = len(lines[row].encode()[:start].decode(errors="replace")) + 1
    return Span("", row + 1, column, row + 1, column + len(text(node)))


def text(node: Node) -> str:
    """The text of a node."""
    return (node.text or b"").decode(errors="replace")


def plain(node: Node | None) -> str:
    """The text of a node without comments, with single blanks; '' for None."""
    return " ".join(words(node)) if node else ""


def field(node: Node, name: str) -> Node:
    """The field of a node with this name; the node itself if it has no such field."""
    child = node.child_by_field_name(name)
    return child if child is not None else node


def around(node: Node, types: Collection[str]) -> Node | None:
    """The innermost node of these types that contains a node, or is it."""
    now: Node | None = node
    while now is not None and now.type not in types:
        now = now.parent
    return now


def words(node: Node, without: Collection[Node | None] = ()) -> Iterator[str]:
    """The tokens below a node, except those of the nodes in `without`."""

    def inner(outer: Node) -> Iterable[Node]:
        return (child for child in outer.children if child.type != "comment" and child not in without)

    yield from (text(each) for each in preorder([node], inner) if each.child_count == 0)


def below(root: Node, enters: Callable[[Node], bool]) -> Iterator[tuple[Node, bool]]:
    """The nodes below a node, in order, each with whether it is nested. A node that `enters` accepts is replaced by its
    children, which are nested."""
    todo = [(child, False) for child in reversed(root.children)]
    while todo:
        node, nested = todo.pop()
        if enters(node):
            todo += [(child, True) for child in reversed(node.children)]
        else:
            yield node, nested


def faults(root: Node) -> int:
    """The number of syntax errors in a tree."""
    wrong = preorder([root], lambda node: (child for child in node.children if child.has_error or child.is_missing))
    return sum(node.is_error or node.is_missing for node in wrong)
