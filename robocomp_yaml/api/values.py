"""The values of a component's parameters: checked, shown, changed and exported without a build and without a robot."""

from __future__ import annotations

import copy
import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import msgspec
from msgspec.structs import replace

from robocomp_yaml.api import effective_values, which
from robocomp_yaml.api.refusals import cannot_write, meant
from robocomp_yaml.check.flat.configs import missing_values
from robocomp_yaml.check.pdsl import values as check
from robocomp_yaml.diag.codes import files as file_codes
from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors, in_order
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.diag.listing import some
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import suggest
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.link.program import LinkedParameters, LinkedValues
from robocomp_yaml.parameters.editing import show
from robocomp_yaml.parameters.editing.edit import NotEditable
from robocomp_yaml.parameters.editing.edit import set_value as edit
from robocomp_yaml.parameters.editing.settings import ShownSetting
from robocomp_yaml.parameters.editing.show import Value
from robocomp_yaml.parameters.examples.new import lines_above
from robocomp_yaml.parameters.hidden import hidden
from robocomp_yaml.parameters.layers.effective import Effective
from robocomp_yaml.parameters.types import (
    BasicType,
    EnumType,
    ListType,
    MapType,
    RecordType,
    Type,
    below,
    is_secret,
    leaves,
)
from robocomp_yaml.parameters.verdict.judge import judge
from robocomp_yaml.parameters.verdict.other_properties import section_of
from robocomp_yaml.pipeline import Analysis, analyse
from robocomp_yaml.secrets import HIDDEN, hidden_lines
from robocomp_yaml.semantics import paths
from robocomp_yaml.semantics.paths import Step
from robocomp_yaml.semantics.references import is_reference
from robocomp_yaml.source import text as source_text
from robocomp_yaml.source.discover import kind_of
from robocomp_yaml.source.regular import whole
from robocomp_yaml.source.tree import Node, node_at, parse
from robocomp_yaml.source.yaml_text import flow
from robocomp_yaml.transactions import whole_file
from robocomp_yaml.transactions.changes import unified

VALUE = "value"
"""Of locations in a value that was typed on a command line."""
# A reference as `rcyaml config get` prints it. One that cannot be resolved is rejected, not read as a text.
_REFERENCE = re.compile(r"\{ *(?:env|file) *:.*\}", re.DOTALL)


class Change(msgspec.Struct, frozen=True):
    """A change of one value; nothing is written before `apply`. `value` and `was` are as documents spell them, without
    secrets; `was` is '' if the value was not set."""

    file: str
    path: str
    value: str
    was: str
    before: bytes
    after: bytes

    def diff(self) -> str:
        """A unified diff of the document, without secrets."""
        old, new = (text.decode("utf-8", "surrogateescape") for text in (self.before, self.after))
        return unified("".join(hidden_lines(old)), "".join(hidden_lines(new)), f"a/{self.file}", f"b/{self.file}")

    def apply(self) -> None:
        """Writes the document, completely or not at all. Raises Refused if it cannot be written, or has changed
        meanwhile."""
        try:
            if whole(self.file)[0] != self.before:
                raise Refused(f"{self.file} has changed meanwhile, and is kept as it is: try again")
            whole_file.replace(self.file, self.after)
        except OSError as error:
            raise cannot_write(self.file, error) from None


class Values:
    """A values document with its layers, its parameters and its diagnostics.

    `file` is its path, `diagnostics` are sorted by location. What needs the effective values raises Faulty if errors
    leave none. Raises Refused if the file is not a values document.

    The file may also be the flat `etc/config` of a component, which can be read, but not changed. If the user changed
    that file beside a values document, the component has its values: `rows`, `settings` and `get` return these.
    """

    def __init__(self, file: str, include: Sequence[str] = (), overlay: Mapping[str, bytes] | None = None) -> None:
        self.file = file
        self._include, self._overlay = tuple(include), dict(overlay or {})
        self._is_flat = _is_flat(file)
        analysed = which.component_near(file) if self._is_flat else file
        self._analysis: Analysis = analyse((analysed,), self._include, overlay=self._overlay)
        self.documents_read: int = self._analysis.program.documents
        program = self._analysis.program
        self._linked: LinkedValues | None = program.values.get(os.path.realpath(file))
        self._replacing: LinkedValues | None = None
        self._flat = effective_values.flat_file(file, program) if self._is_flat else None
        if self._flat is not None:
            self._linked = self._flat.layer
        elif self._linked is not None:
            self._replacing = effective_values.replacing(self._linked, program)
        if self._linked is None and kind_of(file) == "ddsl":
            shown = typed("rcyaml", "-v", "deploy", "plan", file)
            raise Refused(f"{file} is a deployment: `{shown}` shows the values of its processes")
        if self._linked is None and not has_errors(self._analysis.diagnostics):
            raise Refused(f"{file} is not a values document: its name is config.yaml (in etc/, beside a component) "
                          "or NAME.config.yaml")  # fmt: skip
        self.diagnostics: tuple[Diagnostic, ...] = tuple(self._all_diagnostics())

    def _all_diagnostics(self) -> list[Diagnostic]:
        diagnostics, linked = list(self._analysis.diagnostics), self._linked
        if linked is not None:
            # The component's own values document is read too. Its diagnostics do not belong to this document.
            own = {layer.document.path for layer in linked.layers()}
            others = {one.document.path for one in self._analysis.program.values.values()} - own
            diagnostics = [one for one in diagnostics if one.span.file not in others]
            if linked.parameters is not None and self._flat is None and check.is_only_a_layer(linked):
                diagnostics += check.check_document(linked, self._analysis.program, complete=True)
            if self._flat is not None:
                diagnostics += missing_values(self._flat, self._analysis.program)
        return in_order(self._analysis.redacted(diagnostics))

    @property
    def _parameters(self) -> LinkedParameters:
        """The parameters of these values. Raises Faulty if the component is unknown."""
        if self._linked is None or self._linked.parameters is None:
            raise self._unknown(self.diagnostics)
        return self._linked.parameters

    def _unknown(self, diagnostics: Sequence[Diagnostic] = ()) -> Faulty:
        """The error to raise: the diagnostics, or at least that the component is unknown."""
        return Faulty(diagnostics or [codes.NO_COMPONENT.at(Span(self.file)).as_severity("error")], self.documents_read)

    @property
    def _effective(self) -> Effective:
        """The effective values of all layers and defaults. Raises Faulty."""
        return self._effective_of(self._linked)

    @property
    def _in_effect(self) -> Effective:
        """The effective values with which the component runs: of the flat config, if that replaces the document. Raises
        Faulty."""
        return self._effective_of(self._replacing or self._linked)

    def _effective_of(self, linked: LinkedValues | None) -> Effective:
        if has_errors(self.diagnostics):
            raise Faulty(self.diagnostics, self.documents_read)
        if linked is None or linked.parameters is None:
            raise self._unknown()
        values, found = self._analysis.program.effective(linked)
        if values is None:  # of a flat config, or because the workspace lowers severities
            problem = "the values cannot be completed: `rcyaml check` reports what is wrong with the parameters"
            more = [] if has_errors(found) else [file_codes.WRONG_SHAPE.at(Span(self.file), problem=problem)]
            raise Faulty([*found, *more], self.documents_read)
        return values

    def rows(self, *, reveal: bool = False) -> list[Value]:
        """All effective values, each with the location that sets it. Secrets are hidden unless `reveal` is set. Raises
        Faulty."""
        rows = show.shown(self._in_effect, reveal=reveal)
        if self._replacing is None:
            return list(rows)
        return effective_values.overriding(rows, show.shown(self._effective, reveal=reveal))

    def settings(self, *, reveal: bool = False) -> list[ShownSetting]:
        """The properties that are no parameters, each with the location that sets it: endpoints, proxies, topics, Ice's
        and others, and what rcyaml and the run time set if nobody does. Secrets are hidden unless `reveal` is set.
        Raises Faulty."""
        linked = self._replacing or self._linked
        if linked is None:
            raise self._unknown(self.diagnostics)
        return effective_values.settings_of(linked, self._linked, self._analysis.addresses, reveal=reveal)

    def get(self, path: str, *, reveal: bool = False) -> Any:
        """The effective value at a path such as `motors[0].vel`, as plain data; None if it has no value. A secret is
        hidden unless `reveal` is set. Raises Faulty, and Refused if the parameter is unknown."""
        values = self._in_effect
        steps, _ = parameter_at(path, values.parameters.root)
        found = show.find(values, steps)
        if found is None:
            return None
        return copy.deepcopy(found) if reveal else show.hidden_at(values.parameters.root, steps, found)

    def export(self, form: str = "ice", *, reveal: bool = True) -> str:
        """All effective values as Ice properties (`ice`) or TOML (`toml`), for programs. Secrets are hidden only if
        `reveal` is off. Raises Refused for another form, and Faulty."""
        if form not in ("ice", "toml"):
            raise Refused(f"unknown form '{form}'; choose ice or toml")
        values = self._effective
        assert self._linked is not None
        if form == "toml":
            from robocomp_yaml.parameters.writing.toml_text import toml_text

            if reveal:
                return toml_text(self._linked, values)
            shown = replace(values, data=hidden(values.parameters.root, values.data))
            return "".join(hidden_lines(toml_text(self._linked, shown)))
        from robocomp_yaml.parameters.writing.properties import properties, property_text

        sections, _ = properties(self._linked, values)
        component = self._parameters.component
        name = component.component.name if component else "the component"
        if not reveal:
            sections = [replace(one, properties=[made.hidden() for made in one.properties]) for one in sections]
        return property_text(sections, name, os.path.basename(self.file))

    def kept_reference(self, path: str, value: str) -> str:
        """Why a change of the value at a path would lose a reference, such as {env: NAME}: `FILE:LINE reads PATH from
        {env: NAME}`; '' if the document has none there, or the new value has it, too. `null` and another reference
        replace it on purpose."""
        steps, type_ = parameter_at(path, self._parameters.parameters.root)
        if self._linked is None or value == "null" or _REFERENCE.fullmatch(value):
            return ""
        node = node_at(self._linked.document.root, ["parameters", *show.typed(self._parameters.parameters.root, steps)])
        if node is None:
            return ""
        new, _ = parse(path, json.dumps(value) if spells_text(type_, value) else value)
        kept = dict(references(type_, new.data, path)) if new is not None else {}
        for where, reference in references(type_, node.data, path):
            if kept.get(where) != reference:
                return f"{self.file}:{node.span.line} reads {where} from {flow(reference)}"
        return ""

    def set(self, path: str, value: str, *, replaces_references: bool = False) -> Change:
        """The change of the value at a path. Everything else in the document stays, byte for byte. Text needs no
        quotes; `null` returns to the default. Raises Refused if the parameter is unknown or cannot be set in this
        document, or a reference would be replaced by a plain value, and Faulty if its type or limits reject the value,
        or the document would have new errors."""
        if self._is_flat:
            folder = os.path.dirname(which.component_near(self.file))
            new = typed("rcyaml", "config", "new", folder or os.curdir)
            raise Refused(f"{self.file} is not a values document: change it yourself, or write one with `{new}`")
        parameters = self._parameters
        if parameters.broken or self._linked is None:
            raise self._unknown(self.diagnostics)
        of = parameters.parameters.root
        named, type_ = parameter_at(path, of)
        steps = show.typed(of, named)
        is_text = spells_text(type_, value)
        raw = self._analysis.disk.contents[self._linked.document.path]  # the text that the locations refer to
        text = source_text.decode(self.file, raw)[0]
        assert text is not None  # the analysis has read it
        root = self._linked.document.root
        if value != "null":
            accepted(type_, steps, value, is_text=is_text)
        if not replaces_references and (kept := self.kept_reference(path, value)):
            raise Refused(f"{kept}: change it there, or set another reference")
        try:
            change = edit(
                self.file, text, root, ["parameters", *steps], value, is_text=is_text and value != "null",
                lines_above=lambda steps_: lines_above(of, steps_[1:]),
            )  # fmt: skip
        except NotEditable as error:
            raise Refused(f"{path} cannot be set in {self.file}:{error.node.span.line}: {error}") from None
        bom = raw[:3] if raw.startswith(b"\xef\xbb\xbf") else b""
        changed = bom + change.text.encode()
        self._reject_new_errors(changed, {self._linked.document.path: change.text})
        shown, was = (show.hidden_text(of, named, text) for text in (value, change.was))
        return Change(self.file, path, shown, was, raw, changed)

    def _reject_new_errors(self, changed: bytes, text: Mapping[str, str]) -> None:
        """Raises Faulty. The locations are in the changed text, which is not written."""
        after = Values(self.file, self._include, {**self._overlay, os.path.realpath(self.file): changed})
        before = {(d.code, d.facts) for d in self.diagnostics}
        new = [d for d in after.diagnostics if d.severity == "error" and (d.code, d.facts) not in before]
        if new:
            raise Faulty(new, after.documents_read, text)


def _is_flat(file: str) -> bool:
    return os.path.basename(file) == "config" and os.path.basename(os.path.dirname(os.path.abspath(file))) == "etc"


def spells_text(type_: Type, value: str) -> bool:
    """Whether a value from a command line is a text, and not YAML: it needs no quotes. A reference is YAML."""
    is_text = isinstance(type_, EnumType) or (isinstance(type_, BasicType) and type_.name == "string")
    return is_text and not _REFERENCE.fullmatch(value)


def accepted(type_: Type, steps: Sequence[Step], value: str, *, is_text: bool, complete: bool = False) -> Node:
    """The node of a value from a command line. Raises Faulty if its type or its limits reject it; the locations are in
    the value as it was typed, which is not shown if it is secret. `complete` as for the judge."""
    node, faults = _judged(
        type_, steps, value, Span(VALUE, 1, 1, 1, len(value) + 1), is_text=is_text, complete=complete
    )
    if faults or node is None:
        raise Faulty(faults, None, {} if is_secret(type_) else {VALUE: value})
    return node


def references(type_: Type, data: object, path: str) -> Iterator[tuple[str, dict[str, str]]]:
    """The references in the value of a parameter, with their paths."""
    if isinstance(type_, ListType):
        for number, one in enumerate(data if isinstance(data, list) else ()):
            yield from references(type_.element, one, f"{path}[{number}]")
    elif isinstance(type_, MapType | RecordType):
        for key, one in (data if isinstance(data, dict) else {}).items():
            if (inner := below(type_, key)) is not None:
                yield from references(inner, one, f"{path}.{key}")
    elif isinstance(data, dict) and is_reference(data):
        yield path, data


def _judged(
    type_: Type, steps: Sequence[Step], value: str, span: Span, *, is_text: bool, complete: bool
) -> tuple[Node | None, list[Diagnostic]]:
    shown = f"'{value}'" if not is_secret(type_) else HIDDEN
    if any("\ud800" <= char <= "\udfff" for char in value):  # bytes of the command line
        return None, [file_codes.WRONG_SHAPE.at(span, problem=f"{shown} is not UTF-8")]
    node, faults = parse(span.file, json.dumps(value) if is_text else value)
    if node is None:
        reason = faults[0].message if faults else "it is empty"
        return None, [file_codes.WRONG_SHAPE.at(span, problem=f"{shown} is not a value: {reason}")]
    return node, [replace(fault, span=span, fixes=()) for fault in judge(type_, node, tuple(steps), complete=complete)]


def write_new(file: str, include: Sequence[str] = ()) -> str:
    """Writes a first values document, and returns its path: `file` is that document, or names a component as
    `which.component` accepts it. Values and connections of the component's `etc/config` are copied. Raises Refused and
    Faulty."""
    is_values = kind_of(file) == "config" or file.endswith(".config.yaml") or os.path.basename(file) == "config.yaml"
    if is_values and os.path.lexists(file):
        raise Refused(f"{os.path.normpath(file)} exists already, and is kept as it is")
    component = which.component_near(file) if is_values else which.component(file)
    target = os.path.normpath(file if is_values else os.path.join(os.path.dirname(component), which.VALUES))
    if os.path.lexists(target):
        raise Refused(f"{target} exists already, and is kept as it is")
    analysis = analyse((component,), include)
    real = os.path.realpath(component)
    program = analysis.program
    linked = program.components[real].parameters if real in program.components else program.parameters.get(real)
    if linked is None or linked.broken or has_errors(analysis.diagnostics):
        raise Faulty(analysis.diagnostics, program.documents)
    from robocomp_yaml.emit.first_values import first_values

    try:
        os.makedirs(os.path.dirname(target) or ".", exist_ok=True)
        whole_file.create(target, first_values(linked, component, target, analysis.addresses.table))
    except OSError as error:
        raise cannot_write(target, error) from None
    return target


def parameter_at(path: str, root: RecordType) -> tuple[list[str], Type]:
    """The steps and the type of a parameter. Raises Refused if it is unknown."""
    steps = paths.parse(path)
    type_ = show.type_at(root, steps) if steps else None
    if steps is None or type_ is None:
        known = [name for name, _ in leaves(root)]
        elsewhere = section_of(path, is_similar=suggest(path, known) is not None)
        listed = f"known are {some(known, 8)}" if known else ""
        raise Refused(f"unknown parameter '{path}'{f'; {elsewhere}' if elsewhere else meant(path, known, listed)}")
    return steps, type_
