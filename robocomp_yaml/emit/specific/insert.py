"""Inserts methods and imports into code, without a change to any existing line."""

from __future__ import annotations

from collections.abc import Collection

from robocomp_yaml.emit.specific.code import SourceCode, SourceMethod


def insert(code: SourceCode, skeleton: SourceCode, names: Collection[str]) -> str:
    """The text of `code` with the methods of these `names` of the skeleton, each after the method that precedes it in
    the skeleton, and with the imports of the skeleton that the code lacks."""
    known = {one.key for one in code.imports}
    imports = "".join(one.line for one in skeleton.imports if one.key not in known)
    pieces: list[tuple[int, str]] = [(code.import_end, imports)] if imports else []
    for part in ("members", "definitions"):
        order: tuple[SourceMethod, ...] = getattr(skeleton, part)
        mine: tuple[SourceMethod, ...] = getattr(code, part)
        ends = {method.name: method.end for method in mine if not method.nested}
        for n, method in enumerate(order):
            if method.name in names and method.name not in ends:
                before = next((ends[other.name] for other in reversed(order[:n]) if other.name in ends), None)
                at = before if before is not None else code.body_end if code.location else len(code.lines)
                ends[method.name] = at
                pieces.append((at, _piece(code, skeleton, method, alone=before is None)))
    return _joined(code.lines, pieces)


def lead(skeleton: SourceCode, method: SourceMethod) -> str:
    """The comment above a method that is the title of a section, with the blank line after it."""
    row = method.first
    if row and not skeleton.lines[row - 1].strip():
        row -= 1
    start = row
    while start and skeleton.lines[start - 1].lstrip().startswith(("# ", "// ")):
        start -= 1
    return "" if start == row else "".join(skeleton.lines[start : method.first])


def _piece(code: SourceCode, skeleton: SourceCode, method: SourceMethod, alone: bool) -> str:
    """The lines to insert, below the title of their section if the file lacks the title. `alone`: they are inserted at
    the end of the class, where members may be private in C++."""
    title = lead(skeleton, method)
    if title and title.splitlines()[0].strip() in {line.strip() for line in code.lines}:
        title = ""
    text = f"{title}{skeleton.text_of(method)}"
    if not method.has_body:
        return f"{chr(10) if title or alone else ''}{'public:' + chr(10) if alone else ''}{text}"
    if code.unit != skeleton.unit:
        text = "".join(_indented(line, skeleton.unit, code.unit) for line in text.splitlines(keepends=True))
    return f"\n{text}"


def _indented(line: str, old: str, new: str) -> str:
    steps = 0
    while line.startswith(old, steps * len(old)):
        steps += 1
    return new * steps + line[steps * len(old) :]


def _joined(before: list[str], pieces: list[tuple[int, str]]) -> str:
    lines = list(before)
    if pieces and lines and not lines[-1].endswith("\n"):
        lines[-1] += "\n"
    by_line: dict[int, str] = {}
    for at, piece in pieces:
        by_line[at] = by_line.get(at, "") + piece
    for at in sorted(by_line, reverse=True):
        piece = by_line[at]
        follows = lines[at] if at < len(lines) else ""
        is_spaced = piece.startswith("\n") and follows.strip() and not follows.lstrip().startswith("}")
        lines.insert(at, f"{piece}\n" if is_spaced else piece)
    return "".join(lines)
