"""`rcyaml explain CODE`: explains a diagnostic, with a wrong and a right example."""

from __future__ import annotations

import re
import shutil
import sys
from collections.abc import Iterable

import click

from robocomp_yaml.commands import _options, _plugin_choices
from robocomp_yaml.commands._command import LibraryCommand
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.page import Files, Repeated

_OF_A_PLUGIN = re.compile(r"(?!RC\d)[A-Z]{2,}\d{3,4}")


@click.command(cls=LibraryCommand, short_help="Explain a diagnostic, with examples.")
@click.argument("code", required=False)
@_options.text_or_json
@click.pass_context
def command(ctx: click.Context, code: str | None, format_: str) -> None:
    """Explain the diagnostic CODE, such as RC2003; without a code, list all diagnostics."""
    rows = _codes()
    if code is None:
        chosen = list(rows.values())
    elif (row := rows.get(code.upper()) or rows.get(f"RC{code}")) is None:
        _plugin_choices.plugins_at()  # raises Faulty if it may be that of a missing plug-in
        raise click.UsageError(f"unknown diagnostic {code}{_hint(code.upper(), rows)}")
    else:
        chosen = [row]
    if format_ == "json":
        terminal.data(_as_json(chosen), json=True)
    else:
        terminal.say_text(_listed(chosen) if code is None else _explained(chosen[0]))


def _hint(code: str, known: Iterable[str]) -> str:
    from robocomp_yaml.diag.suggest import suggest

    alike = [one for one in known if one[:2] == code[:2]]
    if not alike and _OF_A_PLUGIN.fullmatch(code):
        return ": a diagnostic of a plug-in is explained in a workspace that names the plug-in under `plugins:`"
    if len(code) < 5:  # is like too many
        return ": a code consists of RC and four digits; `rcyaml explain` lists all"
    meant = suggest(code, alike or known)
    return f"; did you mean {meant}?" if meant else ": `rcyaml explain` lists all"


def _codes() -> dict[str, Code]:
    """All codes, with those of the plug-ins of this folder's workspace."""
    from robocomp_yaml.diag.codes import table

    return {**table(), **_plugin_choices.codes()}


def _listed(rows: list[Code]) -> str:
    lines = [f"{row.id}  {row.severity:<7}  {row.messages[0]}{' …' if len(row.messages) > 1 else ''}" for row in rows]
    if sys.stdout.isatty():
        lines = [terminal.cut(line, _width()) for line in lines]
    return "".join(f"{line}\n" for line in lines)


def _explained(row: Code) -> str:
    parts = [
        "\n".join([f"{row.id} ({row.severity}): {row.messages[0]}", *(f"or: {other}" for other in row.messages[1:])]),
        _wrapped(row.why),
        f"Wrong:\n\n{_tree(row.wrong)}",
        f"Right:\n\n{_tree(row.right)}",
    ]
    if row.command != "check .":
        parts.append(f"It is reported by `rcyaml {row.command}`.")
    return "\n\n".join(part.rstrip("\n") for part in parts) + "\n"


def _width() -> int:
    """Columns of a line: as many as the terminal has, at most 100."""
    return min(100, shutil.get_terminal_size().columns)


def _wrapped(text: str) -> str:
    import textwrap

    return "\n\n".join(textwrap.fill(paragraph, _width()) for paragraph in text.split("\n\n"))


def _tree(files: Files) -> str:
    """The files of an example as text. Long lines are cut."""
    out = []
    for path, content in files.items():
        text = _text(content)
        if text is None:
            out.append(f"  {path}/  (an empty folder)")
        elif isinstance(content, str) and text.startswith("-> "):
            out.append(f"  {path} {text}  (a link)")
        else:
            room = _width() - 2
            lines = [line if len(line) <= room else f"{line[: room - 1]}…" for line in text.splitlines()]
            out.append("\n".join([f"  # {path}", *(f"  {line}".rstrip() for line in lines)]))
    return "\n\n".join(out)


def _text(content: str | bytes | Repeated | None) -> str | None:
    """The content of a file in an example; None for a folder."""
    if isinstance(content, bytes):
        return content.decode("utf-8", "backslashreplace")
    return None if content is None else str(content)


def _as_json(rows: list[Code]) -> str:
    from robocomp_yaml.diag.render.json import dumps

    return dumps([
        {
            "code": row.id, "severity": row.severity, "message": row.messages[0], "messages": row.messages,
            "why": row.why, "wrong": {path: _text(content) for path, content in row.wrong.items()},
            "right": {path: _text(content) for path, content in row.right.items()}, "command": row.command,
        }
        for row in rows
    ])  # fmt: skip
