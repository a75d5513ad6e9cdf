"""Source code as far as a merge looks into it: the methods of the specific class, imports, and faults of syntax."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml.diag.span import Span

if TYPE_CHECKING:
    from tree_sitter import Node

CLASS = "SpecificWorker"


class Signature(msgspec.Struct, frozen=True):
    """`parameters` and `returns` with blanks made alike; `names` are those of the parameters. A call with `least` to
    `most` arguments fits; `most` is None where there is no limit."""

    parameters: tuple[str, ...]
    names: tuple[str, ...]
    returns: str
    least: int
    most: int | None


class SourceMethod(msgspec.Struct, frozen=True):
    """A method of the class: declared in its body, or (C++) defined outside of it.

    `first` and `end` are the lines from its first to behind its last, from 0, decorators with it. `signature` is None
    where the class only gives something else this name. `nested` when it stands under a condition.
    """

    name: str
    place: Span
    first: int
    end: int
    signature: Signature | None
    has_body: bool = True
    nested: bool = False


class ImportLine(msgspec.Struct, frozen=True):
    """What a line brings in, and the line that would bring just this."""

    key: str
    line: str


class SourceCode(msgspec.Struct, frozen=True):
    """A file. `members` stand in the class, `definitions` outside. `place` is that of the class's name, None where the
    file does not have the class; `body_end` the line before which its body ends, and `unit` one step of indentation.
    `bases` are the classes that it inherits from. `import_end` is the line behind the last import, or where one may
    be put."""

    path: str
    lines: list[str]
    faults: int
    members: tuple[SourceMethod, ...] = ()
    definitions: tuple[SourceMethod, ...] = ()
    imports: tuple[ImportLine, ...] = ()
    import_end: int = 0
    place: Span | None = None
    body_end: int = 0
    unit: str = "    "
    bases: tuple[str, ...] = ()

    def text_of(self, method: SourceMethod) -> str:
        return "".join(self.lines[method.first : method.end])


def lines_of(text: str) -> list[str]:
    """The lines with their ends; only a line feed ends one, as for compilers."""
    lines = [f"{line}\n" for line in text.split("\n")]
    last = lines.pop()[:-1]
    return [*lines, last] if last else lines


def place(node: Node, lines: list[str]) -> Span:
    """Where a node of one line stands; the path is left empty."""
    row, start = node.start_point
    column = len(lines[row].encode()[:start].decode(errors="replace")) + 1
    return Span("", row + 1, column, row + 1, column + len(text(node)))


def text(node: Node) -> str:
    return (node.text or b"").decode(errors="replace")


def plain(node: Node | None) -> str:
    """A node's text without comments and needless blanks."""
    return " ".join(words(node)) if node else ""


def field(node: Node, name: str) -> Node:
    """A part of a node by its name; the node itself where it has none."""
    found = node.child_by_field_name(name)
    return found if found is not None else node


def words(node: Node, without: Collection[Node | None] = ()) -> Iterator[str]:
    """The tokens below a node."""
    todo = [node]
    while todo:
        current = todo.pop()
        if current.type == "comment" or current in without:
            continue
        if current.child_count == 0:
            yield text(current)
        todo += reversed(current.children)


def below(root: Node, enters: Callable[[Node], bool]) -> Iterator[tuple[Node, bool]]:
    """The nodes below one, in order; of those to be entered, what is in them instead, which is nested then."""
    todo = [(child, False) for child in reversed(root.children)]
    while todo:
        node, nested = todo.pop()
        if enters(node):
            todo += [(child, True) for child in reversed(node.children)]
        else:
            yield node, nested


def faults(root: Node) -> int:
    """How many places of a tree are no proper syntax."""
    count, todo = 0, [root] if root.has_error else []
    while todo:
        node = todo.pop()
        count += node.is_error or node.is_missing
        todo += [child for child in node.children if child.has_error or child.is_missing]
    return count
