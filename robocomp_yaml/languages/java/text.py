"""Java source text: comments and literals."""

from __future__ import annotations

from collections.abc import Sequence

_LONGEST = 20_000  # characters of a literal: a class file allows 65,535 bytes
_CHARS = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r"}
_IN_COMMENTS = {"&": "&amp;", "<": "&lt;", ">": "&gt;", "\\": "&#92;", "@": "&#64;"}


def comment(text: str, indent: str = "") -> str:
    """A documentation comment, in which no text can end the comment or be a tag. The first line has no indent."""
    lines = [_harmless(line) for line in text.strip().splitlines()] or [""]
    if len(lines) == 1:
        return f"/** {lines[0]} */"
    return "\n".join(["/**", *(f"{indent} * {line}".rstrip() for line in lines), f"{indent} */"])


def one_line(text: str) -> str:
    """A text of a document as the rest of a comment line."""
    return _harmless(" ".join(text.split()))


def _harmless(line: str) -> str:
    kept = "".join(_IN_COMMENTS.get(c, c) for c in line if c.isprintable() or c == "\t")
    return kept.replace("*/", "*&#47;").rstrip()


def literal(data: str) -> str:
    """A string literal; a long one is joined from pieces."""
    if len(data) <= _LONGEST:
        return f'"{_escaped(data)}"'
    pieces = [data[start : start + _LONGEST] for start in range(0, len(data), _LONGEST)]
    return f'String.join("", {", ".join(map(literal, pieces))})'


def _escaped(data: str) -> str:
    return "".join(_CHARS.get(char) or (char if char.isprintable() else _units(char)) for char in data)


def _units(char: str) -> str:
    """Octal where possible: Java translates `\\u000a` to a line end before it parses anything."""
    if ord(char) < 0x100:
        return f"\\{ord(char):03o}"
    raw = char.encode("utf-16-be", "surrogatepass")
    return "".join(f"\\u{raw[at]:02x}{raw[at + 1]:02x}" for at in range(0, len(raw), 2))


def value(data: object) -> str:
    """An expression for plain data: Boolean, Long, Double, String, lists and maps."""
    match data:
        case bool():
            return "true" if data else "false"
        case str():
            return literal(data)
        case int() if -(2**63) <= data < 2**63:
            return f"{data}L"
        case int() | float():
            return repr(float(data))
        case list():
            return listed([value(item) for item in data])
        case dict():
            if not data:
                return "java.util.Map.of()"
            pairs = (f"java.util.Map.entry({literal(key)}, {value(item)})" for key, item in data.items())
            return f"java.util.Map.ofEntries({', '.join(pairs)})"
        case _:
            raise TypeError(f"no plain data: {data!r}")


def listed(items: Sequence[str]) -> str:
    return f"java.util.List.of({', '.join(items)})"
