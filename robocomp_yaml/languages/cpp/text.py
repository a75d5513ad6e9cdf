"""C++ source text: comments, literals, and layout of long expressions."""

from __future__ import annotations

import re
from collections.abc import Iterator

from robocomp_yaml.languages._shared.text import IN, WIDTH

_LEAST = -(2**63)
_LITERAL_OR_MARK = re.compile(r""""(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'|[][(){},]""", re.DOTALL)


def comment(text: str, indent: str = "") -> str:
    """A documentation comment. The first line has no indent."""
    lines = [_plain(line) for line in text.strip().splitlines()] or [""]
    return f"\n{indent}".join(f"/// {line}".rstrip() for line in lines)


def one_line(text: str) -> str:
    """A text of a document as the rest of a comment line."""
    return _plain(" ".join(text.split()))


def _plain(line: str) -> str:
    """The line without unprintable characters, and without a backslash that would continue the comment."""
    kept = line if line.isprintable() else "".join(c for c in line if c.isprintable() or c == "\t")
    return kept.rstrip(" \t\\")


def literal(data: str) -> str:
    """A string literal. Characters that do not print become octal escapes, which have at most three digits."""
    escaped = data.translate(_CHARS)
    if not escaped.isprintable():
        escaped = "".join(char if char.isprintable() else _octal(char) for char in escaped)
    return f'"{escaped}"'


_CHARS = str.maketrans({"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r", "?": "\\?"})


def _octal(char: str) -> str:
    return "".join(f"\\{byte:03o}" for byte in char.encode("utf-8", "surrogatepass"))


def string(data: str) -> str:
    """An expression for a std::string, or a value that converts to one: a plain literal ends at a NUL."""
    return (
        f"std::string({literal(data)}, {len(data.encode('utf-8', 'surrogatepass'))})" if "\0" in data else literal(data)
    )


def number(data: int | float) -> str:
    if isinstance(data, float):
        return repr(data)
    if -(2**31) < data < 2**31:
        return str(data)
    return f"({data + 1}LL - 1)" if data == _LEAST else f"{data}LL" if _LEAST < data < 2**63 else repr(float(data))


def value(data: object) -> str:
    """An expression for a runtime::Value, or a value that converts to one."""
    match data:
        case bool():
            return "true" if data else "false"
        case str():
            return string(data)
        case int() | float():
            return number(data)
        case list():
            return f"runtime::Value(runtime::Value::List{{{', '.join(map(value, data))}}})"
        case dict():
            pairs = ", ".join(f"{{{string(key)}, {value(item)}}}" for key, item in data.items())
            return f"runtime::Value(runtime::Value::Map{{{pairs}}})"
        case _:
            raise TypeError(f"no plain data: {data!r}")


def folded(code: str, indent: str) -> str:
    """A long expression with the content of its largest brackets on lines of its own, recursively. The first line has
    no indent."""
    if len(indent) + len(code) <= WIDTH or "\n" in code:
        return code
    start, end = max(_brackets(code), key=lambda found: found[1] - found[0], default=(0, 0))
    if end - start < 2:
        return code
    inner = indent + IN
    lines = [f"{inner}{folded(part, inner)}" for part in _parts(code[start + 1 : end])]
    return "\n".join([code[: start + 1], *lines, f"{indent}{code[end:]}"])


def _brackets(code: str) -> Iterator[tuple[int, int]]:
    """The positions of the outermost brackets."""
    start = 0
    for at, depth, char in _outside_texts(code):
        if char in "([{" and depth == 1:
            start = at
        elif char in ")]}" and depth == 0:
            yield start, at


def _parts(inner: str) -> list[str]:
    """The parts between the outermost commas, each with its comma."""
    cuts = [at + 1 for at, depth, char in _outside_texts(inner) if char == "," and depth == 0]
    return [inner[start:end].strip() for start, end in zip([0, *cuts], [*cuts, len(inner)], strict=True)]


def _outside_texts(code: str) -> Iterator[tuple[int, int, str]]:
    """Each bracket and comma outside of literals: its position, the depth of brackets after it, and the character."""
    depth = 0
    for found in _LITERAL_OR_MARK.finditer(code):
        mark = found[0]
        if len(mark) == 1:
            depth += (mark in "([{") - (mark in ")]}")
            yield found.start(), depth, mark
