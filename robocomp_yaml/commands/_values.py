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
from robocomp_yaml.commands import _options
from robocomp_yaml.diag.codes import files as file_codes
from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors, in_order
from robocomp_yaml.diag.render.json import dumps
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedParameters, LinkedValues
from robocomp_yaml.model.parameters import BasicType, EnumType, RecordType, Type
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.source import text as source_text
from robocomp_yaml.source import whole_file
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, parse
from robocomp_yaml.values import paths
from robocomp_yaml.values import show as values_show
from robocomp_yaml.values.edit import NotEditable
from robocomp_yaml.values.edit import set_value as edit
from robocomp_yaml.values.effective import Effective, effective
from robocomp_yaml.values.judge import judge
from robocomp_yaml.values.paths import Step
from robocomp_yaml.values.spell_yaml import flow

_REFERENCE = re.compile(r"\{ *env *: *[A-Za-z_][A-Za-z0-9_]* *\}", re.ASCII)  # as `get` prints it


class Loaded(msgspec.Struct):
    """A values document with what it is about; `values` is None where it could not be read."""

    values: LinkedValues | None
    diagnostics: list[Diagnostic] = []
    documents: int = 0

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
    return Loaded(values, in_order(told), program.documents)


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
    from robocomp_yaml.diag.render import render

    if ctx.params.get("format_") == "json":
        click.echo(render("json", diagnostics, documents, False), nl=False)
        ctx.exit(1)
    color = _options.colored(ctx, sys.stderr)
    click.echo(render("text", diagnostics, documents, color), nl=False, err=True, color=ctx.color)
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


def show(ctx: click.Context, file: str, include: tuple[str, ...], format_: str) -> None:
    _, values = _effective(ctx, file, include)
    rows = list(values_show.shown(values))
    if format_ == "json":
        click.echo(dumps({"values": [_as_json(row) for row in rows]}), nl=False)
        return
    width = max((min(len(_assignment(row)), 50) for row in rows), default=0)
    for row in rows:
        click.echo(f"{_assignment(row):<{width}}  # {_origin(row)}")


def _assignment(row: values_show.Shown) -> str:
    return f"{row.path} = {row.text}" + (f" {row.unit}" if row.unit else "")


def _origin(row: values_show.Shown) -> str:
    if row.node is None:
        where = f", {_place(row.default)}" if row.default is not None else ""
        return f"default{where}"
    overrode = "".join(f", overrides {_said(node)} ({_place(node)})" for node in row.overrode)
    return f"{_place(row.node)}{overrode}"


def _said(node: Node) -> str:
    text = node.lexeme if isinstance(node, Scalar) else flow(node.data)
    return text if len(text) <= 40 else text[:39] + "…"


def _place(node: Node) -> str:
    return f"{node.span.file}:{node.span.line}"


def _as_json(row: values_show.Shown) -> dict[str, Any]:
    return {
        "path": row.path, "value": row.data, "unit": row.unit, "editable": row.editable,
        "default": row.node is None, **_json_place(row.node or row.default),
        "overrode": [{"value": node.data, **_json_place(node)} for node in row.overrode],
    }


def _json_place(node: Node | None) -> dict[str, Any]:
    return {"file": node.span.file if node else None, "line": node.span.line if node else None}


def get(ctx: click.Context, file: str, path: str, include: tuple[str, ...], format_: str) -> None:
    _, values = _effective(ctx, file, include)
    steps, _ = _steps(path, values.parameters.root)
    found = values_show.find(values, steps)
    if found is None:
        click.echo(f"{path} has no value", err=True)
        ctx.exit(1)
    data = found[0]
    if format_ == "json":
        click.echo(dumps({"path": path, "value": data}), nl=False)
        return
    click.echo(data if isinstance(data, str) else flow(data))


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
    _refuse_bad(ctx, file, type_, steps, value, _place_of(root, ["parameters", *steps]), is_text)
    try:
        change = edit(file, text, root, ["parameters", *steps], value, is_text=is_text and value != "null")
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
    if format_ == "json":
        click.echo(dumps({"path": path, "value": value, "was": change.was or None}), nl=False)
    elif ctx.obj.verbosity >= 0:
        was = f" (was {change.was})" if change.was else ""
        click.echo(f"{path} = {value}{was}")


def _refuse_bad(
    ctx: click.Context, file: str, type_: Type, steps: list[Step], value: str, span: Span, is_text: bool
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
        _fail(ctx, [file_codes.WRONG_SHAPE.at(span, problem=f"'{value}' is no value: {reason}")], 1)
    found = [replace(fault, span=span) for fault in judge(type_, node, tuple(steps), complete=False)]
    if found:
        _fail(ctx, found, 1)


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


def export(ctx: click.Context, file: str, form: str, include: tuple[str, ...]) -> None:
    loaded, values = _effective(ctx, file, include)
    assert loaded.values is not None
    if form == "toml":
        from robocomp_yaml.emit.toml_text import toml_text

        click.echo(toml_text(loaded.values, values), nl=False)
        return
    from robocomp_yaml.values.properties import properties
    from robocomp_yaml.values.property_text import property_text

    sections, _ = properties(loaded.values, values)
    component = loaded.parameters.component
    name = component.component.name if component else "the component"
    click.echo(property_text(sections, name, os.path.basename(file)), nl=False)


def write_new(ctx: click.Context, file: str, include: tuple[str, ...]) -> None:
    component = file if file.endswith((".cdsl.yaml", ".pdsl.yaml")) else _component_near(file)
    if not os.path.isfile(component):
        raise click.UsageError(f"there is no document {component}")
    target = Path(component).parent / "etc" / "config.yaml" if component == file else Path(file)
    if os.path.lexists(target):
        raise click.UsageError(f"{target} is there already, and stays as it is")
    analysis = analyse((component,), include)
    real = os.path.realpath(component)
    program = analysis.program
    linked = program.components[real].parameters if real in program.components else program.parameters.get(real)
    if linked is None or linked.broken or has_errors(analysis.diagnostics):
        _fail(ctx, analysis.diagnostics, program.documents)
    from robocomp_yaml.emit.first_values import first_values

    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        whole_file.create(target, first_values(linked, component, str(target)))
    except OSError as error:
        raise click.UsageError(f"{target} cannot be written: {(error.strerror or str(error)).lower()}") from None
    if ctx.obj.verbosity >= 0:
        click.echo(f"wrote {target}\nnext: rcyaml config check {target}")


def _component_near(file: str) -> str:
    """The only component beside a values document, or one folder up."""
    if not file.endswith((".config.yaml", "/config.yaml")) and file != "config.yaml":
        raise click.UsageError("FILE is a component's document, or a values document: NAME.config.yaml")
    folder = os.path.dirname(file)
    for where in (folder or ".", os.path.join(folder or ".", os.pardir)):
        for suffix in (".cdsl.yaml", ".pdsl.yaml"):
            listed = sorted(os.listdir(where)) if os.path.isdir(where) else []
            names = [name for name in listed if name.endswith(suffix)]
            if len(names) == 1:
                return os.path.normpath(os.path.join(where, names[0]))
            if names:
                raise click.UsageError(f"there are several components here: {', '.join(names)}; name one of them")
    raise click.UsageError(f"there is no component beside {file}, nor one folder up")
