"""The structure of each artefact: what a program that reads it would see, with texts taken out of where texts belong.

`structure(path, text)` is equal for two artefacts that differ in nothing but the texts of their documents. Artefacts of
data keep their texts as leaves; of code and pictures, where texts stand in comments or are cut into lines, only the
rest is compared.
"""

from __future__ import annotations

import ast
import functools
import itertools
import json
import re
import tomllib
from collections.abc import Callable, Iterator
from typing import Any
from xml.etree import ElementTree

from robocomp_yaml.source import properties
from robocomp_yaml.source.tree import parse

TEXT = "<text>"


def of_python(text: str) -> Any:
    """The syntax tree. A text may stand where another one stood."""
    root = ast.parse(text)
    for node in ast.walk(root):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            node.value = TEXT
    return ast.dump(root)


@functools.cache
def _cpp_parser() -> Any:
    import tree_sitter_cpp
    from tree_sitter import Language, Parser

    return Parser(Language(tree_sitter_cpp.language()))


def of_cpp(text: str) -> Any:
    """The tokens, without comments; adjacent literals are one."""
    found: list[str] = []

    def visit(node: Any) -> None:
        assert not node.is_error and not node.is_missing, (node.start_point, node.text)
        if node.type == "comment":
            return
        if node.type in ("string_literal", "raw_string_literal", "char_literal", "concatenated_string"):
            if found[-1:] != [TEXT]:
                found.append(TEXT)
        elif not node.children:
            found.append(node.text.decode())
        for child in node.children if found[-1:] != [TEXT] or node.type not in _LITERALS else ():
            visit(child)

    visit(_cpp_parser().parse(text.encode()).root_node)
    return found


_LITERALS = ("string_literal", "raw_string_literal", "char_literal", "concatenated_string")
_SLICE = re.compile(r'\s+|//[^\n]*|/\*.*?\*/|(?P<text>"(?:\\.|[^"\\\n])*")|(?P<token>[A-Za-z_0-9.:]+|\S)', re.DOTALL)


def of_slice(text: str) -> Any:
    return list(_tokens(_SLICE, text))


_CMAKE = re.compile(
    r"\s+|#\[(?P<c>=*)\[.*?\](?P=c)\]|#[^\n]*|\[(?P<b>=*)\[.*?\](?P=b)\]|(?P<text>\"(?:\\.|[^\"\\])*\")|(?P<token>[()]|[^\s()#\"]+)",
    re.DOTALL,
)


def of_cmake(text: str) -> Any:
    return list(_tokens(_CMAKE, text))


_DOT = re.compile(r'\s+|//[^\n]*|/\*.*?\*/|(?P<text>"(?:\\.|[^"\\])*")|(?P<token>[A-Za-z_0-9.]+|->|\S)', re.DOTALL)


def of_dot(text: str) -> Any:
    return list(_tokens(_DOT, text))


def _tokens(pattern: re.Pattern[str], text: str) -> Iterator[str]:
    at = 0
    while at < len(text):
        match = pattern.match(text, at)
        assert match is not None and match.end() > at, text[at : at + 40]
        at = match.end()
        if match["text"] is not None:
            yield TEXT
        elif match["token"] is not None:
            yield match["token"]


_MERMAID_TEXT = re.compile(r'"[^"\n]*"|\|[^|\n]*\||%%.*')


def of_mermaid(text: str) -> Any:
    lines = [_MERMAID_TEXT.sub(TEXT, line).rstrip() for line in text.split("\n")]
    assert not any('"' in line for line in lines), lines
    return lines


def of_xml(text: str) -> Any:
    def visit(node: ElementTree.Element) -> Any:
        return node.tag, sorted(node.attrib), [visit(child) for child in node]

    return visit(ElementTree.fromstring(text))


def of_svg(text: str) -> Any:
    """Which elements there are: how large they are, and in how many lines, depends on the texts."""
    return sorted({node.tag for node in ElementTree.fromstring(text).iter()})


def of_icegrid(text: str) -> Any:
    """Servers with what they really run: words that a node would drop are passed on by a line of shell."""

    def visit(node: ElementTree.Element) -> Any:
        attributes = {name: value.replace("$${", "${") for name, value in node.attrib.items()}
        words = [(option.text or "").replace("$${", "${") for option in node.findall("option")]
        if words[:1] == ["-c"]:
            attributes["exe"], *words = (word.removeprefix("=") for word in words[3:])
        if attributes.get("exe") == "/usr/bin/env":
            attributes["exe"], *words = itertools.dropwhile(lambda word: "=" in word, words)
        if node.tag == "properties":
            return {one.get("name", ""): one.get("value", "").replace("$${", "${") for one in node}
        others = [visit(child) for child in node if child.tag not in ("option", "env")]
        return node.tag, attributes, words, others

    return visit(ElementTree.fromstring(text))


_PROSE = ("title", "description", "markdownDescription", "errorMessage", "defaultSnippets")


def of_json(text: str) -> Any:
    def visit(data: Any) -> Any:
        if isinstance(data, dict):
            return {name: TEXT if name in _PROSE else visit(value) for name, value in data.items()}
        return [visit(item) for item in data] if isinstance(data, list) else data

    return visit(json.loads(text))


def of_yaml(text: str) -> Any:
    root, faults = parse("compose.yaml", text)
    assert root is not None, faults
    return json.loads(json.dumps(root.data).replace("$$", "$"))


def of_toml(text: str) -> Any:
    return tomllib.loads(text)


def of_properties(text: str) -> Any:
    read = properties.read(text)
    assert not read.invalid, text
    return read.values


def of_unit(text: str) -> Any:
    """Sections with their directives; what is run as words."""
    found: list[Any] = []
    for line in text.replace("\\\n", " ").split("\n"):
        if not line.strip() or line.lstrip()[0] in "#;":
            continue
        if line.startswith("["):
            found.append(line)
            continue
        name, separator, value = line.partition("=")
        assert separator and re.fullmatch(r"[A-Za-z]+", name), line
        plain = name in ("Description", "Documentation")
        dollar = "$$" if name.startswith("Exec") else "$"
        words = [_unescaped(word).replace(dollar, "$") for word in _unit_words(value)]
        found.append((name, TEXT if plain else words))
    return found


_WORD = re.compile(r"""\s*(?:"((?:\\.|[^"\\])*)"|((?:\\.|[^\s"\\])+))(?=\s|\Z)""", re.DOTALL)
_ESCAPE = re.compile(r"\\(x[0-9a-fA-F]{2}|u[0-9a-fA-F]{4}|U[0-9a-fA-F]{8}|[0-7]{3}|.)", re.DOTALL)
_SIMPLE = {"n": "\n", "t": "\t", "r": "\r", "s": " ", "a": "\a", "b": "\b", "f": "\f", "v": "\v"}


def _unit_words(value: str) -> list[str]:
    """The words of a directive: in double quotes, or without any."""
    found, at = [], 0
    while value[at:].strip():
        match = _WORD.match(value, at)
        assert match is not None, value[at:]
        found.append(match[1] if match[1] is not None else match[2])
        at = match.end()
    return found


def _unescaped(word: str) -> str:
    def one(match: re.Match[str]) -> str:
        code = match[1]
        if code[0] in "xuU" and len(code) > 1:
            return chr(int(code[1:], 16))
        return chr(int(code, 8)) if len(code) == 3 else _SIMPLE.get(code, code)

    return _ESCAPE.sub(one, word).replace("%%", "%")


def of_markdown(text: str) -> Any:
    """How many cells each row of a table has; texts are Markdown themselves."""
    found: list[int] = []
    before = ""
    in_table = False
    for line in text.split("\n"):
        in_table = line.startswith("|---") or (in_table and line.startswith("|"))
        for row in [before, line] if line.startswith("|---") else [line] if in_table else []:
            bare = re.sub(r"`[^`]*`", lambda code: code[0].replace("|", ""), row.replace("\\|", ""))
            found.append(len(bare.split("|")))
        before = line
    return found


def _as_it_is(text: str) -> Any:
    return text


_BY_NAME: tuple[tuple[str, Callable[[str], Any]], ...] = (
    (r".*\.pyi?", of_python), (r"bin/\w+", of_python), (r".*\.(?:cpp|h)", of_cpp), (r".*\.ice", of_slice),
    (r".*(?:CMakeLists\.txt|\.cmake)", of_cmake), (r".*\.dot", of_dot), (r".*\.mermaid", of_mermaid), (r".*\.svg", of_svg),
    (r"icegrid/.*\.xml", of_icegrid), (r".*\.(?:xml|ui)", of_xml), (r".*\.json", of_json), (r".*\.yaml", of_yaml),
    (r".*\.toml", of_toml), (r".*(?:\.ice-config|etc/config|config/[\w.-]+)", of_properties), (r".*\.(?:service|target)", of_unit),
    (r".*\.md", of_markdown),
)  # fmt: skip


def structure(path: str, text: str) -> Any:
    for pattern, reader in _BY_NAME:
        if re.fullmatch(pattern, path) or re.search(rf"(?:^|/){pattern}\Z", path):
            return reader(text)
    return _as_it_is(text)
