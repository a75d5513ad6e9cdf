"""What users do to a skeleton: random edits of `src/specificworker.*`, in each language."""

from __future__ import annotations

import re
from collections.abc import Callable
from random import Random

Files = dict[str, str]
Edit = Callable[[list[str], "Writer"], None]


class Writer:
    """A user, who never writes the same line twice."""

    def __init__(self, random: Random, python: bool) -> None:
        self.random = random
        self.python = python
        self.count = 0

    def name(self) -> str:
        self.count += 1
        return f"mine{self.count}_{self.random.randrange(10**6)}"

    def comment(self, indent: str) -> str:
        return f"{indent}{'#' if self.python else '//'} {self.name()}\n"

    def statement(self, indent: str) -> str:
        name = self.name()
        return f"{indent}self.{name} = [1, 2]\n" if self.python else f"{indent}int {name} = 1; (void){name};\n"


def edited(files: Files, random: Random, python: bool) -> Files:
    """The files after one to six edits; what they are about stays code, but for a rare slip."""
    user = Writer(random, python)
    files = dict(files)
    for _ in range(random.randint(1, 6)):
        path = random.choice(sorted(files))
        lines = files[path].splitlines(keepends=True)
        random.choice(PYTHON if python else JAVA if path.endswith(".java") else CPP)(lines, user)
        files[path] = "".join(lines)
    if not python and random.random() < 0.2:
        _moved_out(files, random)
    if python and random.random() < 0.1:
        path = "src/specificworker.py"
        halved = re.compile(r"^(?: {4})+", re.MULTILINE)
        files[path] = halved.sub(lambda found: "  " * (len(found[0]) // 4), files[path])
    for path in files:
        if random.random() < 0.05:
            files[path] = files[path].replace("\n", "\r\n")
        if random.random() < 0.1:
            files[path] = files[path].rstrip("\r\n")
    return files


def _bodies(lines: list[str], user: Writer) -> list[int]:
    """Lines of a method's body, before which a statement may stand."""
    if user.python:
        return [n for n, line in enumerate(lines) if re.match(r" {8}(self\.|return)", line)]
    statement = re.compile(r" {4}\w[^()]*(\.|=| )\S*.*;$")
    return [n for n, line in enumerate(lines) if statement.match(line) and "(const" not in line]


def _statement(lines: list[str], user: Writer) -> None:
    if places := _bodies(lines, user):
        at = user.random.choice(places)
        if user.python or "{\n" in lines[:at]:
            lines.insert(at, user.statement("        " if user.python else "    "))


def _body(lines: list[str], user: Writer) -> None:
    """Its own code instead of the stub's."""
    marks = [n for n, line in enumerate(lines) if "is still to be written" in line]
    if marks:
        at = user.random.choice(marks)
        indent = lines[at][: len(lines[at]) - len(lines[at].lstrip())]
        lines[at : at + 1] = [user.statement(indent) for _ in range(user.random.randint(1, 4))]


def _comment(lines: list[str], user: Writer) -> None:
    places = [n for n, line in enumerate(lines) if not line.strip()]
    if places:
        lines.insert(user.random.choice(places), user.comment("    " if user.python else ""))


def _blank(lines: list[str], user: Writer) -> None:
    places = [n for n, line in enumerate(lines) if not line.strip()]
    if places:
        del lines[user.random.choice(places)]


def _head(lines: list[str], user: Writer) -> None:
    """Says something of its own in the comment at the top, or has it no more."""
    marks = [n for n, line in enumerate(lines) if re.match(r"#(?!include|pragma)|//", line)]
    if marks:
        at = user.random.choice(marks)
        lines[at : at + 1] = user.random.choice([[], [user.comment("")], [lines[at], user.comment("")]])


def _title(lines: list[str], user: Writer) -> None:
    marks = [n for n, line in enumerate(lines) if re.match(r"    (#|//) \w+: ", line)]
    if marks:
        lines[user.random.choice(marks)] = user.comment("    ")


def _top(lines: list[str], user: Writer) -> None:
    place = next((n for n, line in enumerate(lines) if line.startswith(("from generated", "#include"))), None)
    if place is not None:
        name = user.name()
        lines.insert(place, f"import math as {name}\n" if user.python else f"#include <cmath> // {name}\n")


def _below(lines: list[str], user: Writer) -> None:
    if lines and not lines[-1].endswith("\n"):
        lines[-1] += "\n"
    name = user.name()
    if user.python:
        lines += ["\n", "\n", f"def {name}():\n", f"    return '{name}'\n"]
    else:
        lines += ["\n", f"inline int {name}() {{ return 1; }}\n"]


def _helper(lines: list[str], user: Writer) -> None:
    """A method of its own, before some other one."""
    name = user.name()
    if user.python:
        places = [n for n, line in enumerate(lines) if line.startswith("    def ")]
        text = [f"    def {name}(self, a, b=2):\n", user.statement("        "), "\n"]
    else:
        class_ = next((n for n, line in enumerate(lines) if line.startswith("class ")), len(lines))
        places = [n for n, line in enumerate(lines) if n > class_ and re.match(r"    \w.*\) ?(override)?;$", line)]
        text = [f"    int {name}(int a, int b) {{ return a + b; }}\n"]
    if places:
        at = user.random.choice(places)
        lines[at:at] = text


def _delete(lines: list[str], user: Writer) -> None:
    """Removes a method that it does not want."""
    spans = _methods(lines, user)
    if spans:
        first, end = user.random.choice(spans)
        del lines[first:end]


def _swap(lines: list[str], user: Writer) -> None:
    spans = _methods(lines, user)
    if len(spans) > 1:
        one, other = sorted(user.random.sample(spans, 2))
        texts = lines[one[0] : one[1]], lines[other[0] : other[1]]
        lines[other[0] : other[1]] = texts[0]
        lines[one[0] : one[1]] = texts[1]


def _methods(lines: list[str], user: Writer) -> list[tuple[int, int]]:
    """Methods that servants call: their first line and that behind the last one."""
    pattern = r"    def \w+_\w+\(self" if user.python else r"\w.* SpecificWorker::\w+_\w+\("
    spans = []
    for first, line in enumerate(lines):
        if re.match(pattern, line):
            end = first + 1
            if user.python:
                while end < len(lines) and (lines[end].startswith(("        ", "    )")) or not lines[end].strip()):
                    end += 1
                while not lines[end - 1].strip():
                    end -= 1
            else:
                while end < len(lines) and lines[end - 1] != "}\n":
                    end += 1
            spans.append((first, end))
    return spans


def _java_helper(lines: list[str], user: Writer) -> None:
    places = [n for n, line in enumerate(lines) if line == "    @Override\n"]
    if places:
        at = user.random.choice(places)
        lines[at:at] = [
            f"    int {user.name()}(int a) {{\n",
            user.statement("        "),
            "        return a;\n    }\n",
            "\n",
        ]


def _java_delete(lines: list[str], user: Writer) -> None:
    starts = [n for n, line in enumerate(lines) if re.match(r"    public \S+ \w+_\w+\(.*\{$", line)]
    if starts:
        first = user.random.choice(starts)
        del lines[first - 1 : lines.index("    }\n", first) + 1]


def _signature(lines: list[str], user: Writer) -> None:
    """Another name for a parameter, or one uncommented."""
    if user.python:
        marks = [n for n, line in enumerate(lines) if re.match(r"    def \w+_\w+\(self, \w+:", line)]
        if marks:
            at = user.random.choice(marks)
            lines[at] = re.sub(r"self, \w+:", f"self, {user.name()}:", lines[at])
    else:
        marks = [n for n, line in enumerate(lines) if re.search(r"/\*\w+\*/", line)]
        if marks:
            at = user.random.choice(marks)
            lines[at] = re.sub(r"/\*\w+\*/", user.name(), lines[at], count=1)


def _slip(lines: list[str], user: Writer) -> None:
    """Saves in the middle of a word."""
    if user.random.random() < 0.15:
        lines.insert(user.random.randrange(len(lines) + 1), f"    {user.name()} (\n")


def _moved_out(files: Files, random: Random) -> None:
    """A definition goes to a file of its own."""
    path = "src/specificworker.cpp"
    if path not in files:
        return
    lines = files[path].splitlines(keepends=True)
    spans = _methods(lines, Writer(random, python=False))
    if spans:
        first, end = random.choice(spans)
        files["src/more.cpp"] = '#include "specificworker.h"\n\n' + "".join(lines[first:end])
        del lines[first:end]
        files[path] = "".join(lines)


_BOTH: tuple[Edit, ...] = (
    _statement, _statement, _body, _body, _body, _comment, _blank, _head, _title, _top, _below, _helper, _helper, _slip
)  # fmt: skip
PYTHON: tuple[Edit, ...] = (*_BOTH, _delete, _swap, _signature)
CPP: tuple[Edit, ...] = (*_BOTH, _delete, _swap, _signature)
JAVA: tuple[Edit, ...] = (_body, _body, _comment, _blank, _head, _title, _slip, _java_helper, _java_delete)
