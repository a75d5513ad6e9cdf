"""Diagnostics are facts: what makes them gives those that their message names, and nobody reads the words again."""

from __future__ import annotations

import ast
import importlib
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest

from conftest import ROOT
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import files, idsl, table
from robocomp_yaml.diag.diagnostic import Diagnostic, in_order
from robocomp_yaml.diag.hidden import Hidden
from robocomp_yaml.diag.span import Span
from robocomp_yaml.secrets import HIDDEN

MODULES = sorted(path for path in (ROOT / "robocomp_yaml").rglob("*.py") if "templates" not in path.parts)
RENDERING = ("robocomp_yaml/diag/render", "robocomp_yaml/diag/hidden.py")
OWN = {"hint", "related", "more", "fixes"}


def named(path: Path) -> str:
    return str(path.relative_to(ROOT))


def fields(message: str) -> set[str]:
    return set(re.findall(r"(?<!\{)\{(\w+)\}(?!\})", message))


def made(tree: ast.AST) -> Iterator[tuple[ast.Call, Code]]:
    """The calls of `at` of codes that a module names by their constants."""
    modules: dict[str, object] = {}
    rows: dict[str, Code] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("robocomp_yaml.diag.codes"):
            for name in node.names:
                called = name.asname or name.name
                if node.module == "robocomp_yaml.diag.codes":
                    if name.name != "table" and name.name.islower() and "_of" not in name.name:
                        modules[called] = importlib.import_module(f"{node.module}.{name.name}")
                else:
                    rows[called] = getattr(importlib.import_module(node.module or ""), name.name)
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "at":
            match node.func.value:
                case ast.Attribute(value=ast.Name(id=module), attr=constant) if module in modules:
                    yield node, getattr(modules[module], constant)
                case ast.Name(id=constant) if isinstance(rows.get(constant), Code):
                    yield node, rows[constant]


def test_the_facts_at_hand_fill_the_message() -> None:
    seen = set()
    for path in MODULES:
        for call, row in made(ast.parse(path.read_text(encoding="utf-8"))):
            given = {keyword.arg for keyword in call.keywords}
            seen.add(row.id)
            if None not in given:  # **facts
                lacking = fields(row.message) - given
                assert not lacking, f"{named(path)}:{call.lineno}: {row.id} lacks {lacking}"
    assert len(seen) > 0.8 * len(table())


WORDS = ("message", "hint")
READING = {"startswith", "endswith", "split", "rsplit", "partition", "rpartition", "find", "index", "removeprefix",
           "removesuffix", "count", "splitlines"}  # fmt: skip
PATTERNS = {"re.match", "re.search", "re.fullmatch", "re.findall", "re.split", "re.sub"}


def is_words(node: ast.AST) -> bool:
    """A diagnostic's words, or those of an exception."""
    match node:
        case ast.Attribute(attr=attr):
            return attr in WORDS
        case ast.Name(id=name):
            return name in WORDS
        case ast.Call(func=ast.Name(id="str"), args=[ast.Name(id=name)]):
            return name in {"error", "refused", "unusable", "exception", "failed", "hint"}
    return False


@pytest.mark.parametrize("path", MODULES, ids=named)
def test_nobody_reads_words_again(path: Path) -> None:
    """What a program wants to know of a diagnostic, or of an exception, is a fact of it."""
    if named(path).startswith(RENDERING):
        return
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        told = f"{named(path)}:{getattr(node, 'lineno', 0)}: make it a fact of the diagnostic"
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in READING:
            assert not is_words(node.func.value), told
        if isinstance(node, ast.Call) and ast.unparse(node.func) in PATTERNS:
            assert not any(map(is_words, node.args)), told
        if isinstance(node, ast.Compare):
            texts = [each for each in (node.left, *node.comparators) if is_words(each)]
            is_empty = any(isinstance(each, ast.Constant) and not each.value for each in node.comparators)
            assert not texts or is_empty, told
        if isinstance(node, ast.Subscript):
            assert not is_words(node.value), told


def test_facts_are_values() -> None:
    """They are equal, hashed, sorted, kept as JSON and read again by what they are."""
    span = Span("a.idsl.yaml", 3, 1)
    one = idsl.ENUM_NUMBER.at(span, name="left", number=-1, largest=7)
    other = idsl.ENUM_NUMBER.at(span, largest=7, number=-1, name="left")
    assert one == other and len({one, other}) == 1
    assert one.message == "the enumerator 'left' has the number -1, which is not between 0 and 7"
    assert dict(one.facts) == {"name": "left", "number": -1, "largest": 7}
    assert one.fact("number") == -1 and one.fact("colour") is None
    kept = json.loads(json.dumps(msgspec.to_builtins(one)))
    assert msgspec.convert(kept, Diagnostic) == one
    later = idsl.ENUM_NUMBER.at(span, name="right", number=10**30, largest=7)
    assert in_order([later, one, other]) == [one, later]


def test_any_value_can_be_a_fact() -> None:
    said = files.SYNTAX.at(Span("a"), problem=Path("a/b"), more_of_it=[1, Path("c")], nothing=None, braces="{x}")
    assert dict(said.facts) == {"problem": "a/b", "more_of_it": (1, "c"), "nothing": None, "braces": "{x}"}
    assert files.SYNTAX.at(Span("a"), problem="{problem} {0}").message == "{problem} {0}"


@pytest.mark.parametrize(
    ("secret", "facts", "message"),
    [
        (
            "hunter2345",
            {"name": "hunter2345", "kind": "type"},
            f"no type can be called '{HIDDEN}': it is a reserved word of Slice",
        ),
        ("abc", {"name": "abc", "kind": "type"}, f"no type can be called '{HIDDEN}': it is a reserved word of Slice"),
        ("12345", {"name": 12345, "kind": "type"}, f"no type can be called '{HIDDEN}': it is a reserved word of Slice"),
        (
            "type",
            {"name": "x", "kind": ["type"]},
            f"no ('{HIDDEN}',) can be called 'x': it is a reserved word of Slice",
        ),
        ("x': it", {"name": "x", "kind": "type"}, f"no type can be called '{HIDDEN}': it is a reserved word of Slice"),
    ],
)
def test_secrets_are_no_facts(secret: str, facts: dict[str, object], message: str) -> None:
    hidden = Hidden()
    hidden.add(Span("a", 1, 1, 1, 9), secret)
    said = hidden.veiled(idsl.RESERVED_WORD.at(Span("a"), **facts))
    assert said.message.startswith(message)
    assert secret not in str(said.facts)


def test_pages_are_read_when_something_is_found(tmp_path: Path) -> None:
    """A check without findings reads none, and one with findings the pages of their families."""
    script = (
        "import sys\nfrom robocomp_yaml.cli import group\nfrom robocomp_yaml.diag import page\n"
        "read = []\nreal = page.resources.text\n"
        "page.resources.text = lambda path: (read.append(path), real(path))[1]\n"
        "try: group(['check'])\nexcept SystemExit: pass\n"
        "print(*[path for path in read if path.endswith('.md')], file=sys.stderr)"
    )
    document = tmp_path / "Speech.idsl.yaml"
    read = []
    for text in ("module: RoboCompSpeech\n", "module: RoboCompSpeech\nimports: [Mouth]\n"):
        document.write_text(text, encoding="utf-8")
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, cwd=tmp_path, check=True)
        read.append(done.stderr.split())
    assert read == [[], ["diagnostics/idsl.md"]]
