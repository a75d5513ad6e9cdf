"""A document's text, changed in small steps: set a value, remove an element, rename a key.

Each step proves itself. The new text is parsed, and must be the old data with this one change; it must contain every
comment that it had. A step that fails is not made (NotEditable).
"""

from __future__ import annotations

import copy
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from robocomp_yaml.parameters.editing.edit import NotEditable, set_value
from robocomp_yaml.semantics.paths import Step
from robocomp_yaml.source.comments import comments
from robocomp_yaml.source.parts import PartsParser
from robocomp_yaml.source.tree import Mapping, Node, Scalar, end_of, node_at
from robocomp_yaml.source.tree import Sequence as SequenceNode
from robocomp_yaml.source.yaml_text import flow, quoted, single_quoted, text_of

_REST_OF_LINE = re.compile(r"[ \t]*(?:#[^\r\n]*)?(?:\r\n|\r|\n|\Z)")
_COMMA = re.compile(r"[ \t]*,[ \t]*")
_DASH = re.compile(r"[ ]*-[ \t]+")
_LINE = re.compile(r"(?P<indent>[ \t]*)(?P<body>[^\r\n]*)(?P<end>\r\n|\r|\n|\Z)")


class EditedText:
    """The text of the document at `path`, while it is edited; `text` is the current one. The steps raise NotEditable,
    and then leave it as it was. `parser` is the one of earlier versions of this document."""

    def __init__(self, path: str, text: str, parser: PartsParser | None = None) -> None:
        self._parser = parser or PartsParser()
        root, _ = self._parser.parse(path, text)
        if not isinstance(root, Mapping):
            raise ValueError("only a document that can be parsed is edited")
        self.path, self.text, self.root = path, text, root

    def at(self, *steps: Step) -> Node | None:
        """The node at these steps from the root; None if there is none."""
        return node_at(self.root, steps)

    def data(self, *steps: Step) -> Any:
        node = self.at(*steps)
        return node.data if node is not None else None

    def set(self, steps: Sequence[Step], data: Any) -> None:
        """Sets the value at these steps. Keys that are missing are added."""
        if self.at(*steps) is not None and self.data(*steps) == data and type(self.data(*steps)) is type(data):
            return
        node = self.at(*steps)
        keeps_quotes = isinstance(data, str) and isinstance(node, Scalar) and node.quoted
        new = data if keeps_quotes else text_of(data, in_flow=True) if isinstance(data, str) else flow(data)
        were = self._comments()
        with self._as_it_was():
            made = set_value(
                self.path, self.text, self.root, list(steps), new, is_text=keeps_quotes, parser=self._parser
            )
            self._accept(made.text, _with(self.root.data, steps, data), were, tree=made.tree)

    def append(self, steps: Sequence[Step], data: Any) -> None:
        """Appends an element to the list at these steps, which may be missing."""
        node = self.at(*steps)
        if node is None or node.data is None:
            self.set(steps, [data])
        elif isinstance(node, SequenceNode):
            self.set([*steps, len(node.items)], data)
        else:
            raise NotEditable("it is not a list", node)

    def insert(self, index: int, text: str, steps: Sequence[Step], item: Any) -> None:
        """Inserts a text, by which the list at these steps gets one more item."""
        listed = self.data(*steps) or []
        self._change(self.text[:index] + text + self.text[index:], _with(self.root.data, steps, [*listed, item]))

    def remove(self, steps: Sequence[Step], *, with_comments: bool = False) -> None:
        """Removes an element of a mapping or list; a collection that would be empty is removed as well. The comments
        in the lines of the element stay, on lines of their own, unless it is removed `with_comments`."""
        steps = list(steps)
        while len(steps) > 1 and len(self.data(*steps[:-1])) == 1:
            steps.pop()
        outer, step = self.at(*steps[:-1]), steps[-1]
        elements, index = _elements(outer, step)
        assert isinstance(outer, (Mapping, SequenceNode))
        first, last = elements[index]
        if outer.is_flow:
            after = self._without_in_flow(elements, index)
        else:
            after = self._without_lines(first, last, with_comments=with_comments)
        self._change(after, _without(self.root.data, steps), may_lose=with_comments)

    def rename(self, steps: Sequence[str], name: str) -> None:
        """Gives the key at these steps another name."""
        outer = self.at(*steps[:-1])
        assert isinstance(outer, Mapping)
        key, _ = outer.entries[steps[-1]]
        if name in outer.entries:
            raise NotEditable(f"there is a '{name}' already", outer.entries[name][0])
        spelled = self._spelled(key, name, in_flow=outer.is_flow)
        after = self.text[: key.start] + spelled + self.text[key.end :]
        self._change(after, _renamed(self.root.data, steps, name))

    def _spelled(self, node: Scalar, new: str, *, in_flow: bool) -> str:
        quote = self.text[node.start : node.start + 1]
        if quote in ("&", "!", "*"):
            raise NotEditable("it has an anchor or a tag", node)
        if quote in ("'", '"'):
            return quoted(new) if quote == '"' else single_quoted(new)
        return text_of(new, in_flow=in_flow)

    def _without_in_flow(self, elements: list[tuple[int, int]], index: int) -> str:
        start, end = elements[index]
        text = self.text
        if index and (gap := text[elements[index - 1][1] : start]) and "\n" not in gap and "#" not in gap:
            return text[: elements[index - 1][1]] + text[end:]
        comma = _COMMA.match(text, end)
        end = comma.end() if comma else end
        line = max(text.rfind("\n", 0, start), text.rfind("\r", 0, start)) + 1
        rest = _REST_OF_LINE.match(text, end)
        if not text[line:start].strip() and rest is not None and "#" not in rest[0]:
            return text[:line] + text[rest.end() :]  # it had a line of its own
        return text[:start] + text[end:]

    def _without_lines(self, start: int, end: int, *, with_comments: bool) -> str:
        text = self.text
        line = max(text.rfind("\n", 0, start), text.rfind("\r", 0, start)) + 1
        before = text[line:start]
        if before.strip() and not _DASH.fullmatch(before):
            raise NotEditable("it shares its line with something else", self.root)
        while end > start and text[end - 1] in "\r\n \t":
            end -= 1
        rest = _REST_OF_LINE.match(text, end)
        if rest is None:
            raise NotEditable("something else follows in its last line", self.root)
        end = _behind_own_comments(text, rest.end(), len(before) - len(before.lstrip(" ")))
        if with_comments:
            return text[:line] + text[end:]
        indent = before[: len(before) - len(before.lstrip())]
        line_end = "\r\n" if "\r\n" in text else "\n"
        kept = "".join(f"{indent}{comment}{line_end}" for at, comment in comments(text, self.root) if line <= at < end)
        return text[:line] + kept + text[end:]

    def _change(self, text: str, expected: Any, *, may_lose: bool = False) -> None:
        """Makes a step whose text has this data."""
        were = self._comments()
        with self._as_it_was():
            tree, faults = self._parser.parse(self.path, text)
            self._accept(text, expected, Counter() if may_lose else were, tree=None if faults else tree)

    def _accept(self, text: str, expected: Any, were: Counter[str], *, tree: Node | None) -> None:
        """`were` are the comments that must be in the text, `tree` is its tree."""
        if not isinstance(tree, Mapping) or not _same(tree.data, expected):
            raise NotEditable("an edit would affect more than this value", self.root)
        lost = were - Counter(one for _, one in comments(text, tree))
        if lost:
            raise NotEditable(f"the comment '{next(iter(lost))}' would be lost", self.root)
        self.text, self.root = text, tree

    def _comments(self) -> Counter[str]:
        return Counter(one for _, one in comments(self.text, self.root))

    @contextmanager
    def _as_it_was(self) -> Iterator[None]:
        """If a step fails, the tree is that of the text again: the next version moved its parts."""
        try:
            yield
        except NotEditable:
            root, _ = self._parser.parse(self.path, self.text)
            assert isinstance(root, Mapping)
            self.root = root
            raise


def _behind_own_comments(text: str, at: int, indent: int) -> int:
    """The index after the following comments that are indented deeper: they belong to what is above them."""
    found = at
    while at < len(text):
        line = _LINE.match(text, at)
        assert line is not None
        if line["body"] and (not line["body"].startswith("#") or len(line["indent"]) <= indent):
            break
        at = line.end()
        found = at if line["body"] else found
    return found


def _elements(outer: Node | None, step: Step) -> tuple[list[tuple[int, int]], int]:
    """The start and end of each element, and the index of one of them."""
    if isinstance(outer, Mapping):
        found = [(key.start, max(key.end, end_of(value), _colon(key, value))) for key, value in outer.items()]
        if any(value.start < key.start for key, value in outer.items()):
            raise NotEditable("it has a value that is an alias", outer)
        return found, list(outer.entries).index(str(step))
    assert isinstance(outer, SequenceNode) and isinstance(step, int)
    return [(item.start, end_of(item)) for item in outer.items], step


def _colon(key: Scalar, value: Node) -> int:
    return key.end + 1 if isinstance(value, Scalar) and value.start == value.end else 0


def _same(one: Any, other: Any) -> bool:
    """Whether data is equal, in value and type."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    return type(one) is type(other) and (one == other or one != one)  # not a number


def _with(data: Any, steps: Sequence[Step], new: Any) -> Any:
    if not steps:
        return new
    made, step = copy.copy(data), steps[0]
    if isinstance(made, list) and isinstance(step, int):
        made[step : step + 1] = [_with(made[step] if step < len(made) else None, steps[1:], new)]
        return made
    made = made or {}
    made[step] = _with(made.get(step), steps[1:], new)
    return made


def _without(data: Any, steps: Sequence[Step]) -> Any:
    made = copy.copy(data)
    if len(steps) > 1:
        made[steps[0]] = _without(made[steps[0]], steps[1:])  # no other alias of it changes
    else:
        del made[steps[0]]
    return made


def _renamed(data: Any, steps: Sequence[str], name: str) -> Any:
    if len(steps) > 1:
        return {key: _renamed(value, steps[1:], name) if key == steps[0] else value for key, value in data.items()}
    return {name if key == steps[0] else key: value for key, value in data.items()}
