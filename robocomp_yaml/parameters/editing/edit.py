"""An edit of one value in the text of its document; every other byte is unchanged.

An existing value is replaced at its location. A new value is inserted after the last element of its mapping or list,
and after the comments that are indented like that element. A commented line of a first document (`examples.new`) is
replaced. An edit that affects more than the value, such as a list on several lines or an alias, is rejected.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection
from typing import Any

import msgspec
from msgspec.structs import replace

from robocomp_yaml.semantics.limits import elements
from robocomp_yaml.semantics.paths import Step
from robocomp_yaml.source.comments import comments
from robocomp_yaml.source.parts import PartsParser
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, child, end_of, last_end, parse
from robocomp_yaml.source.yaml_text import quoted, scalar, single_quoted

_COLON = re.compile(r"[ \t]*:")
_LINE = re.compile(r"(?<=\n)(?P<indent>[ ]*)(?P<body>[^\r\n]*?)[ \t]*(?=\r?\n|\Z)")
_REST_OF_LINE = re.compile(r"[ \t]*(?:#[^\r\n]*)?(?=\r?\n|\Z)")


class NotEditable(Exception):
    """A value cannot be edited in place. `node` is the reason."""

    def __init__(self, reason: str, node: Node) -> None:
        super().__init__(reason)
        self.node = node


class DocumentEdit(msgspec.Struct, frozen=True):
    """`text` is the whole document after the edit, `was` the previous text of the value, or ''. `tree` is that of the
    text, once it is checked."""

    text: str
    was: str
    tree: Node | None = None


def set_value(
    path: str, text: str, root: Mapping, steps: list[Step], new: str, *, is_text: bool,
    lines_above: Callable[[list[Step]], Collection[str]] = lambda steps: (), parser: PartsParser | None = None,
) -> DocumentEdit:  # fmt: skip
    """The document with a new value at `steps`, from its root. An index equal to the length of a list appends an
    element. `new` is YAML on one line, or the text itself if `is_text`. `lines_above` returns the possible comments
    above the commented line of a value. `parser` parsed the tree; it may not be used any more then, but for its data.
    Raises NotEditable."""
    node: Node = root
    key: Scalar | None = None
    for depth, step in enumerate(steps):
        found = _child(node, step)
        if found is None:
            if any(isinstance(each, int) for each in steps[depth + 1 :]):
                raise NotEditable("there is no list to append to; set the whole list", node)
            spelled = scalar(new) if is_text else new
            commented = _commented(text, node, key, steps[depth], lines_above(steps[: depth + 1]))
            if commented is not None:
                change = _uncommented(text, commented, steps[depth:], spelled)
            else:
                change = _insert(text, node, key, steps[depth:], spelled)
            break
        key, node = found[0] or key, found[1]
    else:
        change = _replace(text, node, key, new, is_text)
    after, faults = (parser.parse if parser is not None else parse)(path, change.text)
    meant, _ = (None, []) if is_text else parse(path, new)
    expected = new if is_text else meant.data if meant is not None else None
    if after is None or faults or not _same_but(root.data, after.data, steps) or _at(after.data, steps) != expected:
        raise NotEditable("an edit would affect more than this value", node)
    return replace(change, tree=after)


def _at(data: Any, steps: list[Step]) -> Any:
    for step in steps:
        data = data[step]
    return data


def _child(node: Node, step: Step) -> tuple[Scalar | None, Node] | None:
    if isinstance(node, Sequence) and isinstance(step, int) and step > len(node.items):
        raise NotEditable(f"the list has {elements(len(node.items))}", node)
    return child(node, step)


def _same_but(before: object, after: object, steps: list[Step]) -> bool:
    """Whether the data of two documents differ at most at `steps`."""
    if not steps:
        return True
    if isinstance(before, (dict, None.__class__)) and isinstance(after, dict):
        old = before or {}
        others = {key for key in (*old, *after) if key != steps[0]}
        return all(key in old and key in after and old[key] == after[key] for key in others) and _same_but(
            old.get(steps[0]), after.get(steps[0]), steps[1:]
        )
    at = steps[0]
    if isinstance(before, list) and isinstance(after, list) and isinstance(at, int):
        if at == len(before):
            return after[:-1] == before
        others_alike = [*before[:at], *before[at + 1 :]] == [*after[:at], *after[at + 1 :]]
        return len(before) == len(after) and others_alike and _same_but(before[at], after[at], steps[1:])
    return False


def _replace(text: str, node: Node, key: Scalar | None, new: str, is_text: bool) -> DocumentEdit:
    start, end = node.start, node.end
    if key is not None and start < key.end:
        raise NotEditable("the value is an alias of another one", key)
    if text[start : start + 1] in ("&", "!", "*"):
        raise NotEditable("the value has an anchor, to which aliases may refer", node)
    old = text[start:end]
    if isinstance(node, Scalar):
        if not old:  # an empty value, or an empty element of a list
            return _fill(text, node, key, scalar(new) if is_text else new)
        if old[0] in "|>":
            raise NotEditable("the value is a text of several lines", node)
        spelled = new
        if is_text:
            spelled = quoted(new) if old[0] == '"' else single_quoted(new) if old[0] == "'" else scalar(new)
        return DocumentEdit(text[:start] + spelled + text[end:], old)
    if old[0] not in "[{":
        raise NotEditable("the value spans several lines; set its elements, or edit the document", node)
    if inside := next((comment for at, comment in comments(text, node) if start <= at < end), ""):
        raise NotEditable(f"there is a comment in the value ({inside}): set its elements, or edit the document", node)
    return DocumentEdit(text[:start] + (scalar(new) if is_text else new) + text[end:], old)


def _fill(text: str, node: Node, key: Scalar | None, new: str) -> DocumentEdit:
    if key is None:
        raise NotEditable("the element is empty", node)
    colon = _COLON.match(text, key.end)
    if colon is None:
        raise NotEditable("the key has no value", key)
    return DocumentEdit(f"{text[: colon.end()]} {new}{text[colon.end() :]}", "")


def _insert(text: str, node: Node, key: Scalar | None, steps: list[Step], new: str) -> DocumentEdit:
    """Inserts an element in a mapping or list, or the first one below a key without a value."""
    if isinstance(node, Sequence) and isinstance(steps[0], int):
        return _append(text, node, key, steps[1:], new)
    if isinstance(node, Scalar) and node.data is None and key is not None and isinstance(steps[0], str):
        colon = _COLON.match(text, key.end)
        if colon is None or node.end > node.start:
            raise NotEditable("there is no mapping to add to", node)
        at = _end_of_line(text, colon.end())
        indent = " " * _inside(text, key)
        return DocumentEdit(text[:at] + _line_end(text) + _block(steps, new, indent, _line_end(text)) + text[at:], "")
    if not isinstance(node, Mapping) or not isinstance(steps[0], str):
        what = "list" if isinstance(steps[0], int) else "mapping"
        raise NotEditable(f"there is no {what} to add to", node)
    if key is not None and node.start < key.end:
        raise NotEditable("the mapping is an alias of another one", key)
    last = last_end(node)
    if text[node.start : node.start + 1] == "{":
        element = _flow(steps, new)
        at = node.start + 1 if last is None else last
        return DocumentEdit(text[:at] + (f", {element}" if last is not None else element) + text[at:], "")
    first_key = next(iter(node.entries.values()))[0]
    indent = " " * (first_key.span.column - 1)
    assert last is not None
    line_end = _line_end(text)
    if text[:last].endswith("\n"):  # after a text of several lines
        return DocumentEdit(text[:last] + _block(steps, new, indent, line_end) + line_end + text[last:], "")
    at = _behind_comments(text, _end_of_line(text, last), len(indent))
    return DocumentEdit(text[:at] + line_end + _block(steps, new, indent, line_end) + text[at:], "")


def _behind_comments(text: str, at: int, indent: int) -> int:
    """The index after the following comments that are indented deeper: they belong to the element above them."""
    for line in _LINE.finditer(text, at):
        if line["body"] and (not line["body"].startswith("#") or len(line["indent"]) <= indent):
            break
        if line["body"]:
            at = line.end("body")
    return at


def _commented(text: str, node: Node, key: Scalar | None, step: Step, above: Collection[str]) -> re.Match[str] | None:
    """The commented line of an element in a first document, below the key of its mapping; None if there is none."""
    is_block = (isinstance(node, Mapping) and not node.is_flow) or (isinstance(node, Scalar) and node.data is None)
    if key is None or not above or not is_block:
        return None
    outer = key.span.column - 1
    keys = (first for first, _ in node.entries.values()) if isinstance(node, Mapping) else iter(())
    indent = next((first.span.column - 1 for first in keys), _inside(text, key))
    found, before = None, ""
    for line in _LINE.finditer(text, _end_of_line(text, key.end)):
        body = line["body"]
        if body and not body.startswith("#") and len(line["indent"]) <= outer:
            break
        if before in above and len(line["indent"]) == indent and body.startswith(f"# {scalar(step)}:"):
            found = line
        before = body
    return found


def _inside(text: str, key: Scalar) -> int:
    """The indentation of the elements below a key without elements: that of the comments there."""
    outer = key.span.column - 1
    line = _LINE.search(text, key.end)
    is_inside = line is not None and line["body"].startswith("#") and len(line["indent"]) > outer
    return len(line["indent"]) if line is not None and is_inside else outer + 2


def _uncommented(text: str, line: re.Match[str], steps: list[Step], new: str) -> DocumentEdit:
    block = _block(steps, new, line["indent"], _line_end(text))
    return DocumentEdit(text[: line.start("indent")] + block + text[line.end("body") :], "")


def _append(text: str, node: Sequence, key: Scalar | None, steps: list[Step], new: str) -> DocumentEdit:
    """Appends an element to a list."""
    if key is not None and node.start < key.end:
        raise NotEditable("the list is an alias of another one", key)
    element = f"{{{_flow(steps, new)}}}" if steps else new
    if text[node.start : node.start + 1] == "[":
        at = node.items[-1].end if node.items else node.start + 1
        return DocumentEdit(text[:at] + (f", {element}" if node.items else element) + text[at:], "")
    last = end_of(node)
    if node.items[-1].data is None or text[:last].endswith("\n"):
        raise NotEditable("the last element is empty, or a text of several lines", node)
    at, indent = _end_of_line(text, last), " " * (node.span.column - 1)
    return DocumentEdit(f"{text[:at]}{_line_end(text)}{indent}- {element}{text[at:]}", "")


def _end_of_line(text: str, at: int) -> int:
    rest = _REST_OF_LINE.match(text, at)
    return rest.end() if rest else at


def _line_end(text: str) -> str:
    return "\r\n" if "\r\n" in text else "\n"


def _block(steps: list[Step], new: str, indent: str, line_end: str) -> str:
    lines = [f"{indent}{'  ' * depth}{scalar(step)}:" for depth, step in enumerate(steps)]
    return line_end.join(lines) + f" {new}"


def _flow(steps: list[Step], new: str) -> str:
    inner = new
    for step in reversed(steps[1:]):
        inner = f"{{{scalar(step)}: {inner}}}"
    return f"{scalar(steps[0])}: {inner}"
