"""docs/reference/commands.md is made of the command line, and docs/reference/schemas.md of the schemas; --update-golden
writes both."""

from __future__ import annotations

import re
import tomllib
from collections import deque
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import click
import pytest

from conftest import ROOT
from robocomp_yaml.cli import COMMANDS, EPILOG, group
from robocomp_yaml.commands._command import examples
from robocomp_yaml.source.schema import schema as schema_of

REFERENCE = ROOT / "docs" / "reference"

COMMANDS_HEAD = """\
# All commands

Every command with all its arguments and options, as the command line itself describes them: this page is generated from
it. [The command line](../cli.md) explains what commands have in common: paths, exit codes, output. The examples are
about the robot of the [tutorial](../tutorial/README.md), with its topic and its parameters.

`rcyaml` itself has these options, which are written before the command: `rcyaml -q check`.

"""

SCHEMAS_HEAD = """\
# All keys

Every key of each kind of document, as the JSON Schemas describe it: this page is generated from them. Editors show the
same texts. `rcyaml schema KIND` prints a schema; `rcyaml compile` writes all of them, with the names of the workspace,
to `.rcyaml/schemas/`.

In a path, `NAME` is a name of yours, and `[]` an element of a list. What may be in several places is explained at the
first one. Every construct may have `doc:`, and keys that start with `x-` are yours.
"""

KINDS = {
    "idsl": "idsl.md", "cdsl": "cdsl.md", "pdsl": "pdsl.md", "config": "config.md", "ddsl": "ddsl.md",
    "workspace": "cli.md#init-and-new", "mock": "mock.md",
}  # fmt: skip


def commands() -> str:
    context = click.Context(group, info_name="rcyaml", **group.context_settings)
    page = COMMANDS_HEAD + options(group, context)
    for name in group.list_commands(context):
        page += command(group.get_command(context, name), name, context, "##")
    return page


def command(one: click.Command | None, name: str, parent: click.Context, marks: str) -> str:
    assert one is not None
    context = click.Context(one, info_name=name, parent=parent)
    usage = " ".join([context.command_path, *one.collect_usage_pieces(context)])
    text = "\n\n".join(" ".join(part.split()) for part in (one.help or "").replace("\b", "").split("\n\n"))
    page = f"\n{marks} {context.command_path}\n\n```text\n{usage}\n```\n\n{escaped(text)}\n\n{options(one, context)}"
    if lines := examples().get(context.command_path):
        page += "\n```text\n{}\n```\n".format("\n".join(lines))
    if isinstance(one, click.Group):
        for inner in one.list_commands(context):
            page += command(one.get_command(context, inner), inner, context, "###")
    return page


def options(one: click.Command, context: click.Context) -> str:
    rows = [row(option, context) for option in one.get_params(context) if isinstance(option, click.Option)]
    return "".join(["| option | meaning |\n|---|---|\n", *rows])


def row(option: click.Option, context: click.Context) -> str:
    names, _ = option.get_help_record(context) or ("", "")
    text = option.help or ""
    if found := re.search(r" \[([^]]*\|[^]]*)\]$", names):
        names = names.removesuffix(found[0])
        text += f" One of {', '.join(f'`{one}`' for one in found[1].split('|'))}."
    if option.show_default and option.default is not None:
        text += f" Default: {option.default}."
    return f"| `{names}` | {escaped(text)} |\n"


def escaped(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;")


class Keys:
    """The keys of a schema, by their paths, with what is said about each. A definition is entered once, where it is
    nearest to the top."""

    def __init__(self, schema: Mapping[str, Any]) -> None:
        self.schema = schema
        self.rows: dict[str, str] = {}
        self._entered: set[str] = set()
        self._pending: deque[tuple[str, Any]] = deque([("", schema)])
        while self._pending:
            self._enter_all(*self._pending.popleft())

    def _enter_all(self, path: str, node: Any) -> None:
        for one in self._parts(node):
            if "$ref" in one:
                if one["$ref"] not in self._entered:
                    self._entered.add(one["$ref"])
                    self._enter_all(path, self._definition(one["$ref"]))
                continue
            inner = [(f"{path}.{key}", value) for key, value in one.get("properties", {}).items()]
            others = {"": one.get("additionalProperties"), **one.get("patternProperties", {})}
            inner += [(f"{path}.NAME", value) for key, value in others.items() if not key.startswith("^x-")]
            inner.append((f"{path}[]", one.get("items")))
            for where, value in inner:
                if isinstance(value, dict):
                    self._enter(where.lstrip("."), value)

    def _enter(self, path: str, node: Any) -> None:
        text = self._text(node)
        if text and not path.endswith(("NAME", "[]")) and (not path.endswith(".doc") or path == "doc"):
            if text not in self.rows.setdefault(path, text):
                self.rows[path] += f" Or: {text}"
        self._pending.append((path, node))

    def _definition(self, ref: str) -> Any:
        node: Any = self.schema
        for word in ref.removeprefix("#/").split("/"):
            node = node[word]
        return node

    def _parts(self, node: Any) -> Iterator[Mapping[str, Any]]:
        """A schema, and those that it combines."""
        if isinstance(node, dict):
            yield node
            for one in (*node.get("allOf", ()), *node.get("anyOf", ()), *node.get("oneOf", ())):
                yield from self._parts(one)
            for key in ("if", "then", "else"):
                yield from self._parts(node.get(key))

    def _text(self, node: Any) -> str:
        for one in self._parts(node):
            said = one.get("markdownDescription") or one.get("description")
            if not said and "$ref" in one:
                said = self._text(self._definition(one["$ref"]))
            if said:
                return " ".join(str(said).partition("\n\n```")[0].split())
        return ""

    def ordered(self) -> Iterator[tuple[str, str]]:
        """The rows, each key followed by those in it."""

        def under(path: str) -> Iterator[tuple[str, str]]:
            for one, text in self.rows.items():
                if parent(one) == path:
                    yield one, text
                    yield from under(one)

        def parent(path: str) -> str:
            above = path.replace("[]", ".[]")
            while above := above.rpartition(".")[0]:
                if (found := above.replace(".[]", "[]")) in self.rows:
                    return found
            return ""

        yield from under("")


def schemas() -> str:
    page = SCHEMAS_HEAD
    for kind, about in KINDS.items():
        schema = schema_of(kind)
        page += f"\n## {kind}\n\n{schema['markdownDescription']} See [its page](../{about}).\n\n| key | meaning |\n|---|---|\n"
        page += "".join(f"| `{path}` | {escaped(text)} |\n" for path, text in Keys(schema).ordered())
    return page


MADE = {"commands.md": commands, "schemas.md": schemas}


@pytest.mark.parametrize("name", MADE)
def test_a_page_is_what_it_is_generated_from(name: str, request: pytest.FixtureRequest) -> None:
    page = Path(REFERENCE / name)
    if request.config.getoption("--update-golden"):
        page.write_text(MADE[name](), encoding="utf-8")
    assert page.read_text(encoding="utf-8") == MADE[name]()


def test_all_commands_are_there() -> None:
    titles = re.findall(r"^##+ rcyaml (.*)$", commands(), re.MULTILINE)
    assert {title.split()[0] for title in titles} == set(COMMANDS)
    assert {"deploy up", "edit connect", "param watch", "new component"} <= set(titles)


def test_each_option_says_what_it_does() -> None:
    silent = re.findall(r"^\| (`[^`]*`) \| (?:One of [^|]*)? *\|$", commands(), re.MULTILINE)
    assert silent == []


@pytest.mark.parametrize("kind", KINDS)
def test_all_keys_at_the_top_are_there_and_explained(kind: str) -> None:
    keys = Keys(schema_of(kind))
    assert set(schema_of(kind)["properties"]) <= set(keys.rows) and len([*keys.ordered()]) == len(keys.rows)


def test_the_command_line_names_the_documentation() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["urls"]["Documentation"] in EPILOG
