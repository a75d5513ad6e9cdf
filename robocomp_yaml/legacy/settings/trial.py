"""The documents of a component's configs, read as `check` reads them before they are written. What they cannot say as a
parameter, or in a section of its own, is kept as a property; what can be no property either is told of as lost."""

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
    planned: Sequence[ParameterPlan], configs: Sequence[Config], links: Mapping[str, DocumentLinks]
) -> list[ParameterPlan]:
    """The plans that hold. Each round moves what does not hold one step: to `properties`, or out of these."""
    kept = list(planned)
    while True:
        draft = _TrialDocuments(kept, configs, links)
        moved = [_move(fault, draft, kept, configs) for fault in draft.faults()]
        kept = [plan for plan in kept if plan.shape is not None]
        if not any(moved):
            return kept


class _Fault(msgspec.Struct, frozen=True):
    """What is wrong, and the keys that lead there; `config` is '' in the parameters' own document. `path` is the
    parameter that it is about, where it says so."""

    config: str
    keys: tuple[str, ...]
    message: str
    path: str


class _TrialDocuments:
    """The documents as they would be written."""

    def __init__(
        self, plans: Sequence[ParameterPlan], configs: Sequence[Config], links: Mapping[str, DocumentLinks]
    ) -> None:
        self.trees: dict[str, Node | None] = {}
        self.said: list[Diagnostic] = []
        root = self._tree("", "pdsl", pdsl_document("component", plans))
        if root is None:
            return
        made = build_parameters.build(root, "")
        parameters, found = resolve(made)
        self.said += found
        linked = LinkedParameters(parameters, made, broken=has_errors(found))
        documents: dict[str, ValuesDocument] = {}
        for config in configs:
            node = self._tree(config.name, "config", values_document(config, plans, links[config.name], exact=False))
            if node is not None:
                documents[config.name] = build_parameters.build_values(node, config.name)
        bases = {
            name: generic_config(name) for name in documents if links[name].after and generic_config(name) in documents
        }
        first = {
            name: LinkedValues(document, parameters=linked, is_extended=name in bases.values())
            for name, document in documents.items()
        }
        values = {name: replace(one, extends=(first[bases[name]],)) if name in bases else one
                  for name, one in first.items()}  # fmt: skip
        program = Program(parameters={"": linked}, values=values)
        for check in checks_of("pdsl"):
            self.said += check(program)

    def _tree(self, name: str, kind: str, document: Map) -> Mapping_ | None:
        """Only a document of the right shape."""
        content, said = decode(name, document_text(document, Notes()).encode())
        root = None
        if content is not None:
            root, said = tree.parse(name, content)
        self.trees[name] = root
        if root is not None:
            said = [*said, *schema.validate(kind, root)]
        self.said += said
        return root if isinstance(root, Mapping_) and not has_errors(said) else None

    def faults(self) -> list[_Fault]:
        return [
            _Fault(
                said.span.file, tuple(_keys(self.trees.get(said.span.file), said.span)), said.message,
                str(said.fact("path") or ""),
            )
            for said in self.said if said.severity == ERROR
        ]  # fmt: skip

    def types_of(self, plan: ParameterPlan) -> set[str]:
        """The names of types that stand at a plan's place."""
        node: Node | None = self.trees.get("")
        steps = ["parameters", *(step for part in plan.path for step in (part, "group"))][:-1]
        for step in steps:
            node = node.get(step) if isinstance(node, Mapping_) else None
        return {inner.lexeme for inner in tree.below(node) if isinstance(inner, Scalar)} if node is not None else set()


def _move(fault: _Fault, draft: _TrialDocuments, plans: Sequence[ParameterPlan], configs: Sequence[Config]) -> bool:
    """Whether something went another way that could be at fault."""
    if fault.config:
        found = next(config.sorted for config in configs if config.name == fault.config)
        if fault.keys[:1] == ("properties",) and len(fault.keys) > 1:
            return _lose(fault, found)
        if len(fault.keys) > 1 and fault.keys[0] in _SECTIONS:
            return _keep(fault, found)
    moved = [plan for plan in _blamed(fault, draft, plans) if plan.shape is not None]
    for plan in moved:
        keep_as_properties(plan, configs)
    return bool(moved)


def _blamed(fault: _Fault, draft: _TrialDocuments, plans: Sequence[ParameterPlan]) -> list[ParameterPlan]:
    section, *steps = (*fault.keys, "")
    path = tuple(steps[:-1])
    if section == "types" and path:
        return [plan for plan in plans if path[0] in draft.types_of(plan)]
    if section == "legacy" and path:
        return [plan for plan in plans if ".".join(plan.path) == path[0]]
    if not fault.config:
        path = tuple(step for at, step in enumerate(path) if at % 2 == 0 or step != "group")
    if section == "parameters" and path:
        inside = [plan for plan in plans if plan.path[: len(path)] == path]
        return inside or [plan for plan in plans if path[: len(plan.path)] == plan.path]
    # It has no place of its own.
    named = [plan for plan in plans if fault.path.startswith(in_words(plan.path))]
    return sorted(named, key=lambda plan: len(in_words(plan.path)))[-1:]


_SECTIONS = ("endpoints", "proxies", "topics", "ice")


def _keep(fault: _Fault, found: SortedSettings) -> bool:
    """What stands in a section becomes a property."""
    for section in (found.endpoints, found.proxies, found.manager, found.prefixes, found.names, found.ice):
        for named in section:
            if named.name == fault.keys[-1] or (section is found.proxies and named.name in fault.keys[1:2]):
                section.remove(named)
                found.keep(named.setting)
                return True
    return False


def _lose(fault: _Fault, found: SortedSettings) -> bool:
    for named in found.properties:
        if named.name == fault.keys[1]:
            found.properties.remove(named)
            found.diagnostics.append(codes.LOST.at(named.setting.span, what=f"{fault.message}; it is left out"))
            return True
    return False


def _keys(node: Node | None, span: Span) -> Iterator[str]:
    """The keys that lead to a place."""
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
