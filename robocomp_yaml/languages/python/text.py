"""Python source text: docstrings, signatures and literals."""

from __future__ import annotations

import json
from collections.abc import Sequence

from robocomp_yaml.model.interface import Member

WIDTH = 110


def docstring(text: str, indent: str) -> str:
    """The text between triple quotes, with all lines after the first indented."""
    lines = [_plain(line) for line in text.strip().splitlines()]
    if len(lines) < 2:
        return f'"""{_closable("".join(lines))}"""'
    rest = [f"{indent}{line}" if line else "" for line in lines[1:]]
    return "\n".join([f'"""{lines[0]}', *rest, f'{indent}"""'])


def signature(name: str, parameters: Sequence[str], returns: str, indent: str) -> str:
    """`def name(self, …) -> …:`; a long one has a line per parameter."""
    return folded(f"def {name}(", ["self", *parameters], f") -> {returns}:", indent)


def folded(head: str, items: Sequence[str], tail: str, indent: str, width: int = WIDTH) -> str:
    """HEAD, the items with commas between them, and TAIL: on one line, or with one item on each line where that is
    longer than `width` or an item has lines. The first line has no indent."""
    line = f"{head}{', '.join(items)}{tail}"
    if len(indent) + len(line) <= width and "\n" not in line:
        return line
    return "".join([f"{head}\n", *(f"{indent}    {item},\n" for item in items), f"{indent}{tail.removeprefix(',')}"])


def literal(data: object) -> str:
    """Plain data as an expression; strings are in double quotes."""
    if isinstance(data, str):
        return json.dumps(data, ensure_ascii=False) if data.isprintable() else repr(data)
    if isinstance(data, tuple):
        return f"({', '.join(map(literal, data))}{',' if len(data) == 1 else ''})"
    if isinstance(data, list):
        return f"[{', '.join(map(literal, data))}]"
    if isinstance(data, dict):
        return f"{{{', '.join(f'{literal(key)}: {literal(value)}' for key, value in data.items())}}}"
    return repr(data)


def one_line(text: str) -> str:
    """A text of a document as the rest of a comment line, or of a list."""
    return " ".join(_plain(text).split())


def about(member: Member) -> str:
    """The documentation and unit of a member or parameter, on one line."""
    unit = f"[{one_line(member.unit)}]" if member.unit else ""
    return f"{one_line(member.doc)} {unit}".strip()


def _plain(line: str) -> str:
    """The line without unprintable characters, and without what would end the docstring."""
    printable = "".join(c for c in line.rstrip() if c.isprintable() or c == "\t")
    return printable.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')


def _closable(line: str) -> str:
    """Escapes a quote at the end, which would join the closing quotes."""
    before = line[:-1]
    is_escaped = (len(before) - len(before.rstrip("\\"))) % 2 == 1
    return f'{before}\\"' if line.endswith('"') and not is_escaped else line
