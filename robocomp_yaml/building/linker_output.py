"""The output of the linker as diagnostics, at the user's source if the linker names one.

    ld: DIR/PATH.cpp.o: in function `FUNCTION':
    FILE:(.text+0x5): undefined reference to `SYMBOL'
    FILE:LINE: multiple definition of `SYMBOL'; OBJECT:FILE:LINE: first defined here

A line may begin with the name of the linker. Without debug information the linker names no line of code, but the
object, whose path CMake makes of that of the source, and the function.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator

from robocomp_yaml.diag.codes import building as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.source.regular import text as text_of

_LINKER = re.compile(r"(?:\S*/)?(?:\S+-)?ld(?:\.\w+)?: (?=\S)")
_IN = re.compile(r"(?P<object>\S+\.o)(?:: in function [`‘'](?P<function>.*)['’]:?|:.*)")
_FAULT = re.compile(
    r"(?P<file>[^\s:(][^:\n]*?):(?:(?P<line>\d+)|\([^)]*\)): "
    r"(?P<text>(?P<kind>undefined reference to|multiple definition of) [`‘'](?P<symbol>.*?)['’](?=;|$))"
)
_SOURCE = re.compile(r"(?:.*/)?CMakeFiles/[^/]+\.dir/(?P<path>.+)\.o")
_UNDEFINED = "undefined reference to"
_HINTS = {
    _UNDEFINED: "define it, or list the library or the source that defines it under `uses:`",
    "multiple definition of": "define it once; in a header, write `inline` before it",
}


def diagnostics(lines: Iterable[str], source_of: Callable[[str], str | None]) -> Iterator[Diagnostic]:
    """The faults that are in the user's sources, each symbol once. `source_of` has the path of the user's source, by
    its path in CMake's tree; None if it is not the user's."""
    seen: set[str] = set()
    source: str | None = None
    function = ""
    for line in lines:
        line = _LINKER.sub("", line, count=1) if _LINKER.match(line) else line
        if fault := _FAULT.match(line):
            symbol = fault["symbol"]
            if (
                source is not None
                and os.path.basename(source) == os.path.basename(fault["file"])
                and symbol not in seen
            ):
                seen.add(symbol)
                number = int(fault["line"]) if fault["line"] else None
                span = _span(source, number, symbol, function)
                hint = _HINTS[fault["kind"]]
                yield codes.ERROR_OF_COMPILER.at(span, tool="the linker", text=_plain(fault["text"]), hint=hint)
        elif named := _IN.match(line):
            built = _SOURCE.fullmatch(named["object"])
            source, function = source_of(built["path"]) if built else None, named["function"] or ""


def _plain(text: str) -> str:
    return re.sub(r"[`‘](.*)['’]$", r"'\1'", text)


def _span(path: str, number: int | None, symbol: str, function: str) -> Span:
    """The location of the name: in the line that the linker names, or else in the function, or else in the file."""
    lines = (text_of(path) or "").splitlines()
    name, scope = _last_name(symbol), _last_name(function)
    if number is None:
        begins = [at for at, line in enumerate(lines) if _column(line, scope)]
        begins = [at for at in begins if lines[at].lstrip() == lines[at]] or begins  # a definition, rather than a call
        begin = begins[0] if begins else 0
        order = [*range(begin, len(lines)), *range(begin)]
        number = next((at for at in order if _column(lines[at], name)), begin) + 1
    line = lines[number - 1] if number <= len(lines) else ""
    if column := _column(line, name):
        return Span(path, number, column, number, column + len(name))
    column = len(line) - len(line.lstrip()) + 1
    return Span(path, number, column, number, max(len(line.rstrip()), column) + 1)


def _column(line: str, name: str) -> int:
    """The column of a name in a line of code, from 1; 0 if it is not there."""
    if not name or line.lstrip().startswith(("//", "*", "/*")):
        return 0
    found = re.search(rf"(?<!\w){re.escape(name)}(?!\w)", line)
    return found.start() + 1 if found else 0


def _last_name(symbol: str) -> str:
    """The name of a function or variable without its scope, arguments and template: `vtable for Arm` has `Arm`."""
    depth, end = 0, len(symbol)
    for at, letter in enumerate(symbol):
        if letter in "<(":
            if depth == 0 and letter == "(":
                end = at
                break
            depth += 1
        elif letter in ">)":
            depth -= 1
    bare = re.sub(r"<[^<>]*>", "", symbol[:end])
    return bare.replace("[", " ").rpartition("::")[2].rpartition(" ")[2] if bare.strip() else ""
