"""Generated Java: every text of a document stays a text."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from conftest import write_tree
from fuzz.hostile import STRINGS
from robocomp_yaml.emit.component import of_language
from robocomp_yaml.languages import language
from robocomp_yaml.languages.java.text import literal
from robocomp_yaml.pipeline import analyse
from robocomp_yaml.source.yaml_text import flow
from robocomp_yaml.transactions.plan import FilePlan

SHARE = 1 if "RCYAML_CASES" in os.environ else 8
"""Every n-th text is tested."""
TOKEN = re.compile(
    r'\s+|//[^\n\r]*|/\*.*?\*/|(?P<text>"(?:\\[btnfr"\'\\]|\\[0-7]{1,3}|[^"\\\n\r])*")|(?P<token>\w+|[^\w\s"])',
    re.DOTALL,
)


MADE = (
    "generated/Parameters.java",
    "generated/GenericWorker.java",
    "generated/Services.java",
    "src/SpecificWorker.java",
)


def read(source: str) -> str:
    """The source after the first step of Java: unicode escapes behind an even number of backslashes are replaced."""
    return re.sub(r"(\\\\)|\\u+([0-9a-fA-F]{4})", lambda found: found[1] or chr(int(found[2], 16)), source)


def tokens(source: str) -> list[str]:
    text, found, at = read(source), [], 0
    assert not re.search(r"(?<!\\)(?:\\\\)*\\u(?![0-9a-fA-F]{4})", source), "an unfinished escape is an error"
    while at < len(text):
        match = TOKEN.match(text, at)
        assert match is not None, text[at : at + 40]
        at = match.end()
        if match["text"] or match["token"]:
            found.append("<text>" if match["text"] else match["token"])
    return found


def files(folder: Path, text: str) -> dict[str, FilePlan]:
    write_tree(folder, {
        "Talk.idsl.yaml": flow({
            "module": "RoboCompTalk", "doc": text,
            "interfaces": {"Ear": {"doc": text, "methods": {"hear": {"doc": text, "in": {"words": {"type": "string", "doc": text, "unit": "m"}}}}}},
        }) + "\n",
        "ear.pdsl.yaml": flow({
            "doc": text,
            "types": {"Mode": {"doc": text, "enum": {"slow": {"doc": text}, "fast": None}}},
            "parameters": {"said": {"type": "string", "default": text, "doc": text, "editable": True},
                           "mode": {"type": "Mode", "default": "slow", "doc": text}},
        }) + "\n",
        "ear.cdsl.yaml": flow({
            "component": "EarComp", "language": "java", "doc": text, "imports": ["Talk"], "implements": ["Ear"],
            "requires": [{"Other": {"interface": "Ear", "doc": text}}], "parameters": "ear.pdsl.yaml",
        }) + "\n",
    })  # fmt: skip
    analysis = analyse([str(folder)])
    component = next(iter(analysis.program.components.values()), None)
    if component is None or component.broken or any(one.severity == "error" for one in analysis.diagnostics):
        return {}
    return {file.path: file for file in of_language(component)}


def test_hostile_texts_change_no_structure(tmp_path: Path) -> None:
    usual = files(tmp_path, "harmless")
    harmless = {path: tokens(usual[path].text) for path in MADE}
    compiled = 0
    for text in [*STRINGS[::SHARE], "\\u0022+x+\\u0022", "\\\\u000a", "*/ x /*", "\\", "@param x", "\\u"]:
        found = files(tmp_path, text)
        compiled += bool(found)
        for path in MADE if found else ():
            assert tokens(found[path].text) == harmless[path], (text, path)
    assert compiled > 50 / SHARE


def test_a_long_text_is_split() -> None:
    """A literal in a class file has at most 65,535 bytes."""
    made = literal("é" * 50_000)
    assert max(len(part.encode()) for part in re.findall(r'"[^"]*"', made)) < 65_000
    assert made.startswith('String.join("", "') and made.count("é") == 50_000


@pytest.mark.parametrize(
    ("text", "made"),
    [
        ('a"b\\', '"a\\"b\\\\"'),
        ("\0\x1b\x85", '"\\000\\033\\205"'),
        ("\u2028", '"\\u2028"'),
        ("\\u000a", '"\\\\u000a"'),
    ],
)
def test_a_literal(text: str, made: str) -> None:
    assert literal(text) == made


def test_the_plan() -> None:
    target = language("java")
    assert target.build == (("{folder}/generated/build",),)
    assert not target.has & {"statemachine", "gui", "compatibility"}
