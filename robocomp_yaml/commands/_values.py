"""What the commands of `rcyaml config` do."""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

import click
import msgspec
from msgspec.structs import replace

from robocomp_yaml.check.pdsl import values as check
from robocomp_yaml.commands import _options, _which
from robocomp_yaml.diag import terminal
from robocomp_yaml.diag.codes import files as file_codes
from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors, in_order
from robocomp_yaml.diag.render import tell
from robocomp_yaml.diag.render.json import dumps
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.component_references import beside
from robocomp_yaml.link.program import LinkedParameters, LinkedValues
from robocomp_yaml.model.parameters import BasicType, EnumType, RecordType, Type, is_secret
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.secrets import HIDDEN, hidden_lines
from robocomp_yaml.source import text as source_text
from robocomp_yaml.source import whole_file
from robocomp_yaml.source.discover import kind_of
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, parse
from robocomp_yaml.values import paths
from robocomp_yaml.values import show as values_show
from robocomp_yaml.values.edit import NotEditable
from robocomp_yaml.values.edit import set_value as edit
from robocomp_yaml.values.effective import Effective, effective
from robocomp_yaml.values.hidden import hidden
from robocomp_yaml.values.judge import judge
from robocomp_yaml.values.new import lines_above
from robocomp_yaml.values.paths import Step
from robocomp_yaml.values.spell_yaml import flow

# As `get` prints them; one that cannot be followed is refused, and no text that happens to look so.
_REFERENCE = re.compile(r"\{ *(?:env|file) *:.*\}", re.DOTALL)


class Loaded(msgspec.Struct):
    """A values document with what it is about; `values` is None where it could not be read."""

    values: LinkedValues | None
    diagnostics: list[Diagnostic] = []
    documents: int = 0
    analysis: Analysis | None = None

    @property
    def parameters(self) -> LinkedParameters:
        assert self.values is not None and self.values.parameters is not None
        return self.values.parameters


def load(ctx: click.Context, file: str, include: tuple[str, ...], overlay: dict[str, bytes] | None = None) -> Loaded:
    """A document with its layers, its parameters and all that is wrong with them."""
    analysis: Analysis = analyse((file,), include, overlay=overlay)
    program = analysis.program
    values = program.values.get(os.path.realpath(file))
    told = list(analysis.diagnostics)
    if values is None and not has_errors(told):
        raise click.UsageError(f"{file} is no values document: it is called config.yaml (in etc/, beside a component) "
                               "or NAME.config.yaml")
    if values is not None:
        # The component's own values document is read with it; what is wrong there is none of this one's business.
        ours = {id(layer) for layer in values.layers()}
        others = {other.document.path for other in program.values.values() if id(other) not in ours}
        told = [diagnostic for diagnostic in told if diagnostic.span.file not in others]
    if values is not None and values.parameters is not None and check.is_only_layer(values):
        told += check.of_document(values, complete=True)
    return Loaded(values, in_order(analysis.veiled(told)), program.documents, analysis)


def _effective(ctx: click.Context, file: str, include: tuple[str, ...]) -> tuple[Loaded, Effective]:
    """The effective values; ends the command where there are none."""
    loaded = load(ctx, file, include)
    if has_errors(loaded.diagnostics):
        _fail(ctx, loaded.diagnostics, loaded.documents)
    if loaded.values is None or loaded.values.parameters is None:
        _fail(ctx, [codes.NO_COMPONENT.at(Span(file)).as_severity("error")], loaded.documents)
    values, found = effective(loaded.values)
    if values is None:  # what is wrong is no error in this workspace, and leaves nothing to show all the same
        problem = "the values cannot be completed: `rcyaml check` says what is wrong with their parameters"
        _fail(ctx, [*found, file_codes.WRONG_SHAPE.at(Span(file), problem=problem)], loaded.documents)
    return loaded, values


def _fail(ctx: click.Context, diagnostics: list[Diagnostic], documents: int) -> NoReturn:
    """What is wrong: on standard error, where standard output is for values; as JSON in their stead."""
    is_json = ctx.params.get("format_") == "json"
    tell("json" if is_json else "text", diagnostics, documents, _options.colored(ctx, sys.stderr), err=not is_json)
    ctx.exit(1)


def _steps(path: str, root: RecordType) -> tuple[list[str], Type]:
    steps = paths.parse(path)
    type_ = values_show.type_at(root, steps) if steps else None
    if steps is None or type_ is None:
        known = [name for name, _ in _all_paths(root)]
        from robocomp_yaml.diag.suggest import suggest

        meant = suggest(path, known)
        raise click.UsageError(f"there is no parameter '{path}'" + (f"; did you mean '{meant}'?" if meant else ""))
    return steps, type_


def _all_paths(root: RecordType) -> Iterator[tuple[str, Type]]:
    from robocomp_yaml.model.parameters import leaves

    return ((path, member.type) for path, member in leaves(root))


def show(ctx: click.Context, file: str, include: tuple[str, ...], format_: str, *, reveal: bool) -> None:
    _, values = _effective(ctx, file, include)
    rows = list(values_show.shown(values, reveal=reveal))
    if format_ == "json":
        terminal.data(dumps({"values": [_as_json(row) for row in rows]}), json=True)
        return
    width = max((min(len(_assignment(row)), 50) for row in rows), default=0)
    terminal.data("".join(f"{_assignment(row):<{width}}  # {_origin(row)}\n" for row in rows))


def _assignment(row: values_show.Shown) -> str:
    return f"{row.path} = {row.text}" + (f" {row.unit}" if row.unit else "")


def _origin(row: values_show.Shown) -> str:
    if row.node is None:
        where = f", {_place(row.default)}" if row.default is not None else ""
        return f"default{where}"
    overrode = "".join(f", overrides {_said(row, node)} ({_place(node)})" for node in row.overrode)
    return f"{_place(row.node)}{overrode}"


def _said(row: values_show.Shown, node: Node) -> str:
    data = row.hide(node.data)
    text = node.lexeme if isinstance(node, Scalar) and data == node.data else flow(data)
    return text if len(text) <= 40 else text[:39] + "…"


def _place(node: Node) -> str:
    return f"{node.span.file}:{node.span.line}"


def _as_json(row: values_show.Shown) -> dict[str, Any]:
    return {
        "path": row.path, "value": row.data, "unit": row.unit, "editable": row.editable,
        "default": row.node is None, **_json_place(row.node or row.default),
        "overrode": [{"value": row.hide(node.data), **_json_place(node)} for node in row.overrode],
    }


def _json_place(node: Node | None) -> dict[str, Any]:
    return {"file": node.span.file if node else None, "line": node.span.line if node else None}


def get(
    ctx: click.Context, file: str, path: str, include: tuple[str, ...], format_: str, *, reveal: bool
) -> None:  # fmt: skip
    _, values = _effective(ctx, file, include)
    steps, _ = _steps(path, values.parameters.root)
    found = values_show.find(values, steps)
    if found is None:
        terminal.say(f"{path} has no value", err=True)
        ctx.exit(1)
    data = found[0] if reveal else values_show.hidden_at(values.parameters.root, steps, found[0])
    if format_ == "json":
        terminal.data(dumps({"path": path, "value": data}), json=True)
        return
    terminal.data(f"{data if isinstance(data, str) else flow(data)}\n")


def set_value(ctx: click.Context, file: str, path: str, value: str, include: tuple[str, ...], format_: str) -> None:
    loaded = load(ctx, file, include)
    values = loaded.values
    if values is None or values.parameters is None or loaded.parameters.broken:
        _fail(ctx, loaded.diagnostics or [codes.NO_COMPONENT.at(Span(file)).as_severity("error")], loaded.documents)
    of = loaded.parameters.parameters.root
    named, type_ = _steps(path, of)
    steps = values_show.typed(of, named)
    is_text = isinstance(type_, EnumType) or (isinstance(type_, BasicType) and type_.name == "string")
    is_text = is_text and not _REFERENCE.fullmatch(value)
    raw, _ = source_text.read_bytes(file)
    assert raw is not None
    text, _ = source_text.decode(file, raw)
    assert text is not None
    root = values.document.root
    _refuse_bad(ctx, loaded, file, type_, steps, value, _place_of(root, ["parameters", *steps]), is_text)
    try:
        change = edit(
            file, text, root, ["parameters", *steps], value, is_text=is_text and value != "null",
            lines_above=lambda way: lines_above(of, way[1:]),
        )
    except NotEditable as refused:
        raise click.UsageError(
            f"{path} cannot be set in {file}:{refused.node.span.line}: {refused}"
        ) from None
    bom = raw[:3] if raw.startswith(b"\xef\xbb\xbf") else b""
    changed = bom + change.text.encode()
    after = load(ctx, file, include, {os.path.realpath(file): changed})
    before = {(d.code, d.message) for d in loaded.diagnostics}
    worse = [d for d in after.diagnostics if d.severity == "error" and (d.code, d.message) not in before]
    if worse:
        _fail(ctx, worse, after.documents)
    try:
        whole_file.replace(file, changed)
    except OSError as error:
        raise click.UsageError(f"{file} cannot be written: {(error.strerror or str(error)).lower()}") from None
    said, was = (values_show.hidden_text(of, named, text) for text in (value, change.was))
    if format_ == "json":
        terminal.data(dumps({"path": path, "value": said, "was": was or None}), json=True)
    elif ctx.obj.verbosity >= 0:
        terminal.say(f"{path} = {said}" + (f" (was {was})" if was else ""))


def _refuse_bad(
    ctx: click.Context, loaded: Loaded, file: str, type_: Type, steps: list[Step], value: str, span: Span, is_text: bool
) -> None:
    """A value that its type or limits refuse, shown at the place where it was to go."""
    if value == "null":
        return
    node: Node | None
    if is_text:
        node, faults = parse(file, json.dumps(value))
    else:
        node, faults = parse(file, value)
    if node is None:
        reason = faults[0].message if faults else "it is empty"
        said = f"'{value}'" if not is_secret(type_) else HIDDEN
        _fail(ctx, _veiled(loaded, [file_codes.WRONG_SHAPE.at(span, problem=f"{said} is no value: {reason}")]), 1)
    found = [replace(fault, span=span) for fault in judge(type_, node, tuple(steps), complete=False)]
    if found:
        _fail(ctx, _veiled(loaded, found), 1)


def _veiled(loaded: Loaded, found: list[Diagnostic]) -> list[Diagnostic]:
    return loaded.analysis.veiled(found) if loaded.analysis is not None else found


def _place_of(root: Mapping, steps: list[Step]) -> Span:
    """The place of a value, or of the nearest thing around it."""
    node: Node = root
    span = root.span
    for step in steps:
        if isinstance(node, Mapping) and isinstance(step, str) and step in node.entries:
            key, node = node.entries[step]
            span = node.span if isinstance(node, Scalar) and node.lexeme else key.span
        elif isinstance(node, Sequence) and isinstance(step, int) and step < len(node.items):
            node = node.items[step]
            span = node.span
        else:
            break
    return span


def export(ctx: click.Context, file: str, form: str, include: tuple[str, ...], *, reveal: bool) -> None:
    """Programs get the values as they are; on a terminal secrets are hidden."""
    loaded, values = _effective(ctx, file, include)
    assert loaded.values is not None
    is_hidden = sys.stdout.isatty() and not reveal
    if form == "toml":
        from robocomp_yaml.emit.toml_text import toml_text

        shown = replace(values, data=hidden(values.parameters.root, values.data)) if is_hidden else values
        text = toml_text(loaded.values, shown)
        terminal.data("".join(hidden_lines(text)) if is_hidden else text)
        return
    from robocomp_yaml.values.properties import properties
    from robocomp_yaml.values.property_text import property_text

    sections, _ = properties(loaded.values, values)
    component = loaded.parameters.component
    name = component.component.name if component else "the component"
    for section in sections if is_hidden else ():
        section.properties = [made.hidden() for made in section.properties]
    terminal.data(property_text(sections, name, os.path.basename(file)))


def write_new(ctx: click.Context, file: str, include: tuple[str, ...]) -> None:
    is_values = kind_of(file) == "config" or file.endswith(".config.yaml") or os.path.basename(file) == "config.yaml"
    target = Path(file) if is_values else None
    if target is not None and os.path.lexists(target):
        raise click.UsageError(f"{target} is there already, and stays as it is")
    component = _which.component(file) if target is None else _component_near(file)
    target = target or Path(component).parent / _which.VALUES
    if os.path.lexists(target):
        raise click.UsageError(f"{target} is there already, and stays as it is")
    analysis = analyse((component,), include)
    real = os.path.realpath(component)
    program = analysis.program
    linked = program.components[real].parameters if real in program.components else program.parameters.get(real)
    if linked is None or linked.broken or has_errors(analysis.diagnostics):
        _fail(ctx, analysis.diagnostics, program.documents)
    from robocomp_yaml.commands._neighbours import ports
    from robocomp_yaml.emit.first_values import first_values

    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        whole_file.create(target, first_values(linked, component, str(target), ports(analysis)))
    except OSError as error:
        raise click.UsageError(f"{target} cannot be written: {(error.strerror or str(error)).lower()}") from None
    if ctx.obj.verbosity >= 0:
        terminal.say(f"wrote {target}", f"next: {terminal.typed('rcyaml', 'config', 'check', str(target))}")


def _component_near(file: str) -> str:
    """The only component beside a values document, or one folder up."""
    folder = os.path.dirname(file)
    for where in (folder, os.path.normpath(os.path.join(folder, os.pardir))):
        for kind in ("cdsl", "pdsl"):
            found = beside(where, kind)
            if len(found) == 1:
                return found[0]
            if found:
                raise click.UsageError(f"there are several components here: {', '.join(found)}; name one of them")
    raise click.UsageError(f"there is no component beside {file}, nor one folder up")
