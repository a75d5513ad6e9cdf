"""Every `rcyaml …` that a page, a message, a schema or a template names is a command, with options that it has."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import click
import pytest

from conftest import ROOT
from robocomp_yaml.cli import group

_QUOTED = re.compile(r"`rcyaml ([^`\n]+)`")
_BLOCK = re.compile(r"^```(?:sh|text|console|yaml)\b[^\n]*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_TYPED = re.compile(r"(?:^|&& |; |run: |- |\$ )rcyaml ((?!.*┌)[^|;&>#\n]+)", re.MULTILINE)
_OPTION = re.compile(r"--?[a-zA-Z][a-z-]*")
SOURCES = [
    path
    for pattern in (
        "*.md",
        "docs/**/*.md",
        "robocomp_yaml/**/*.py",
        "schemas/*.json",
        "templates/**/*",
        "examples/*.py",
    )
    for path in sorted(ROOT.glob(pattern))
    if path.is_file() and path.name not in ("CHANGELOG.md", "commands.md")
]


def named(path: Path) -> Iterator[str]:
    text = path.read_text(encoding="utf-8", errors="replace")
    yield from _QUOTED.findall(text)
    if path.suffix == ".md":
        for block in _BLOCK.findall(text):
            yield from _TYPED.findall(block)


def wrong(line: str) -> str:
    """Why a command line is not possible, or ''."""
    words = line.replace("…", " ").split()
    command: click.Command = group
    context = click.Context(group, info_name="rcyaml", **group.context_settings)
    while words and words[0].startswith("-"):
        words = words[1:]
    while words and isinstance(command, click.Group) and re.fullmatch(r"[a-z][a-z-]*", words[0]):
        inner = command.get_command(context, words[0])
        if inner is None:
            return "" if context.info_name == "record" else f"{context.command_path} has no command '{words[0]}'"
        command, context = inner, click.Context(inner, info_name=words[0], parent=context)
        words = words[1:]
    known = {name for option in command.get_params(context) for name in option.opts}
    if isinstance(command, click.Group) and context.info_name == "record":
        known |= {name for option in command.commands["start"].params for name in option.opts}
    before = words[: words.index("--")] if "--" in words else words
    for word in before:
        option = word.partition("=")[0]
        if _OPTION.fullmatch(option) and option not in known and option[:2] not in known:
            return f"{context.command_path} has no option {option}"
    return ""


@pytest.mark.parametrize("folder", sorted({path.relative_to(ROOT).parts[0] for path in SOURCES}))
def test_named_commands_exist(folder: str) -> None:
    found = [
        (str(path.relative_to(ROOT)), line)
        for path in SOURCES
        if path.relative_to(ROOT).parts[0] == folder
        for line in named(path)
    ]
    assert [(path, line, why) for path, line in found if (why := wrong(line))] == []


def test_commands_are_named() -> None:
    assert sum(1 for path in SOURCES for _ in named(path)) > 500


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("deploy upp", "rcyaml deploy has no command 'upp'"),
        ("check --fxi", "rcyaml check has no option --fxi"),
        ("-q check --fix", ""),
        ("record Odometry --count 3", ""),
        ("run patrol -- --speed=3", ""),
    ],
)
def test_what_is_wrong(line: str, why: str) -> None:
    assert wrong(line) == why
