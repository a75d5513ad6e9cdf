"""Plain data as C++ source: literals of the run time's values, and of C++'s own types."""

from __future__ import annotations

_LEAST = -(2**63)


def text(data: str) -> str:
    """A string literal; what does not print becomes an octal escape, which has an end."""
    escaped = "".join(_CHARS.get(char) or (char if char.isprintable() else _octal(char)) for char in data)
    return f'"{escaped}"'


_CHARS = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r", "?": "\\?"}


def _octal(char: str) -> str:
    return "".join(f"\\{byte:03o}" for byte in char.encode("utf-8", "surrogatepass"))


def string(data: str) -> str:
    """An expression for a std::string, or what becomes one: a literal ends at a NUL."""
    return f"std::string({text(data)}, {len(data.encode('utf-8', 'surrogatepass'))})" if "\0" in data else text(data)


def number(data: int | float) -> str:
    if isinstance(data, float):
        return repr(data)
    if -(2**31) < data < 2**31:
        return str(data)
    return f"({data + 1}LL - 1)" if data == _LEAST else f"{data}LL" if _LEAST < data < 2**63 else repr(float(data))


def value(data: object) -> str:
    """An expression for a runtime::Value, or for what becomes one."""
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
