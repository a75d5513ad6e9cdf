"""Check the documents of a component's configs before they are written. A setting that is not valid as a parameter,
or in its section, becomes a property; one that is not valid as a property either is reported as lost."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

import msgspec
from msgspec.structs import replace

from robocomp_yaml.check import checks_of
from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic, has_errors
from robocomp_yaml.diag.span import Span
from robocomp_yaml.legacy.document import Map, Notes
from robocomp_yaml.legacy.document import text as document_text
from robocomp_yaml.legacy.settings.grouping import generic_config
from robocomp_yaml.legacy.settings.pdsl_document import pdsl_document
from robocomp_yaml.legacy.settings.plan import Config, ParameterPlan
from robocomp_yaml.legacy.settings.planning import keep_as_properties
from robocomp_yaml.legacy.settings.sorting import SortedSettings
from robocomp_yaml.legacy.settings.values_document import DocumentLinks, values_document
from robocomp_yaml.link.program import LinkedParameters, LinkedValues, Program
from robocomp_yaml.parameters.resolution.resolve import resolve
from robocomp_yaml.parameters.specification import build as build_parameters
from robocomp_yaml.parameters.specification.document import ValuesDocument
from robocomp_yaml.semantics.paths import in_words
from robocomp_yaml.source import schema, tree
from robocomp_yaml.source.text import decode
from robocomp_yaml.source.tree import Mapping as Mapping_
from robocomp_yaml.source.tree import Node, Scalar
from robocomp_yaml.source.tree import Sequence as Sequence_


def accepted_plans(
    plans: Sequence[ParameterPlan], configs: Sequence[Config], links: Mapping[str, DocumentLinks]
) -> list[ParameterPlan]:
    """Return the plans whose documents are valid. Each round moves what is not valid to `properties`, or out of
    them."""
    remaining = list(plans)
    while True:
        trial = _TrialDocuments(remaining, configs, links)
        moved = [_move(fault, trial, remaining, configs) for fault in trial.faults()]
        remaining = [plan for plan in remaining if plan.shape is not None]
        if not any(moved):
            return remaining


class _DocumentFault(msgspec.Struct, frozen=True):
    """An error, and the keys that lead to its location. `config` is '' in the PDSL. `path` is the parameter that the
    error is about, '' where it names none."""

    config: str
    keys: tuple[str, ...]
    message: str
    path: str


class _TrialDocuments:
    """The documents as they would be written, and their diagnostics."""

    def __init__(
        self, plans: Sequence[ParameterPlan], configs: Sequence[Config], links: Mapping[str, DocumentLinks]
    ) -> None:
        self.trees: dict[str, Node | None] = {}
        self.diagnostics: list[Diagnostic] = []
        root = self._tree("", "pdsl", pdsl_document("component", plans))
        if root is None:
            return
        document = build_parameters.build(root, "")
        parameters, found = resolve(document)
        self.diagnostics += found
        linked = LinkedParameters(parameters, document, broken=has_errors(found))
        documents: dict[str, ValuesDocument] = {}
        for config in configs:
            node = self._tree(config.name, "config", values_document(config, plans, links[config.name], exact=False))
            if node is not None:
                documents[config.name] = build_parameters.build_values(node, config.name)
        bases = {name: generic_config(name) for name in documents if generic_config(name) in documents}
        linked_values = {
            name: LinkedValues(document, parameters=linked, is_extended=name in bases.values())
            for name, document in documents.items()
        }
        values = {name: replace(one, extends=(linked_values[bases[name]],)) if name in bases else one
                  for name, one in linked_values.items()}  # fmt: skip
        program = Program(parameters={"": linked}, values=values)
        for check in checks_of("pdsl"):
            self.diagnostics += check(program)

    def _tree(self, name: str, kind: str, document: Map) -> Mapping_ | None:
        """Return the tree of a document; None where its schema rejects it."""
        content, diagnostics = decode(name, document_text(document, Notes()).encode())
        root = None
        if content is not None:
            root, diagnostics = tree.parse(name, content)
        self.trees[name] = root
        if root is not None:
            diagnostics = [*diagnostics, *schema.validate(kind, root)]
        self.diagnostics += diagnostics
        return root if isinstance(root, Mapping_) and not has_errors(diagnostics) else None

    def faults(self) -> list[_DocumentFault]:
        """Return the errors of the documents."""
        errors = [(error, error.span) for error in self.diagnostics if error.severity == ERROR]
        return [
            _DocumentFault(
                span.file, tuple(_keys(self.trees.get(span.file), span)), error.message, str(error.fact("path") or "")
            )
            for error, span in errors
        ]

    def types_of(self, plan: ParameterPlan) -> set[str]:
        """Return the names in the PDSL's entry of a plan, types among them."""
        node: Node | None = self.trees.get("")
        steps = ["parameters", *(step for part in plan.path for step in (part, "group"))][:-1]
        for step in steps:
            node = node.get(step) if isinstance(node, Mapping_) else None
        return {inner.lexeme for inner in tree.below(node) if isinstance(inner, Scalar)} if node is not None else set()


def _move(
    fault: _DocumentFault, trial: _TrialDocuments, plans: Sequence[ParameterPlan], configs: Sequence[Config]
) -> bool:
    """Move the setting that causes an error, and return whether there was one to move."""
    if fault.config:
        settings = next(config.sorted for config in configs if config.name == fault.config)
        if fault.keys[:1] == ("properties",) and len(fault.keys) > 1:
            return _lose(fault, settings)
        if len(fault.keys) > 1 and fault.keys[0] in _SECTIONS:
            return _keep(fault, settings)
    moved = [plan for plan in _blamed(fault, trial, plans) if plan.shape is not None]
    for plan in moved:
        keep_as_properties(plan, configs)
    return bool(moved)


def _blamed(fault: _DocumentFault, trial: _TrialDocuments, plans: Sequence[ParameterPlan]) -> list[ParameterPlan]:
    """Return the plans that may cause an error."""
    section, *steps = (*fault.keys, "")
    path = tuple(steps[:-1])
    if section == "types" and path:
        return [plan for plan in plans if path[0] in trial.types_of(plan)]
    if section == "legacy" and path:
        return [plan for plan in plans if ".".join(plan.path) == path[0]]
    if not fault.config:
        path = tuple(step for at, step in enumerate(path) if at % 2 == 0 or step != "group")
    if section == "parameters" and path:
        inside = [plan for plan in plans if plan.path[: len(path)] == path]
        return inside or [plan for plan in plans if path[: len(plan.path)] == plan.path]
    # The error is about the document as a whole.
    named = [plan for plan in plans if fault.path.startswith(in_words(plan.path))]
    return sorted(named, key=lambda plan: len(in_words(plan.path)))[-1:]


_SECTIONS = ("endpoints", "proxies", "topics", "ice")


def _keep(fault: _DocumentFault, settings: SortedSettings) -> bool:
    """Move a setting from its section to the properties."""
    for section in settings.sections:
        for named in section:
            if named.name == fault.keys[-1] or (section is settings.proxies and named.name in fault.keys[1:2]):
                section.remove(named)
                settings.keep(named.setting)
                return True
    return False


def _lose(fault: _DocumentFault, settings: SortedSettings) -> bool:
    """Remove a property that is not valid, and report it as lost."""
    for named in settings.properties:
        if named.name == fault.keys[1]:
            settings.properties.remove(named)
            settings.diagnostics.append(codes.LOST.at(named.setting.span, what=f"{fault.message}; it is omitted"))
            return True
    return False


def _keys(node: Node | None, span: Span) -> Iterator[str]:
    """Yield the keys that lead to a location."""
    start = (span.line, span.column)
    items: Iterable[tuple[str, Node, Node]] = ()
    if isinstance(node, Mapping_):
        items = [(key.lexeme, key, value) for key, value in node.items()]
    elif isinstance(node, Sequence_):
        items = [(str(at), item, item) for at, item in enumerate(node.items)]
    for name, key, value in items:
        end = max((value.span.end_line, value.span.end_column), (key.span.end_line, key.span.end_column))
        if (key.span.line, key.span.column) <= start < end:
            yield name
            yield from _keys(value, span)
            return
