"""Convert the configs of each component together: to values documents, and the PDSL that they imply."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence

import msgspec

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.legacy.document import Map
from robocomp_yaml.legacy.draft import ConfigDraft
from robocomp_yaml.legacy.ledger import LedgerEntry
from robocomp_yaml.legacy.settings import declared
from robocomp_yaml.legacy.settings.grouping import ConfiguredComponent, ConfiguredComponents, generic_config
from robocomp_yaml.legacy.settings.pdsl_document import pdsl_document
from robocomp_yaml.legacy.settings.plan import Config, Corrections, ParameterPlan
from robocomp_yaml.legacy.settings.planning import plans
from robocomp_yaml.legacy.settings.sorting import sort
from robocomp_yaml.legacy.settings.trial import accepted_plans
from robocomp_yaml.legacy.settings.values_document import DocumentLinks, values_document


class InferredParameters(msgspec.Struct, frozen=True):
    """A PDSL to write. `entry` is the ledger's entry of the component's first config, which reports it."""

    path: str
    document: Map
    entry: LedgerEntry


def build_config_documents(
    accepted: Sequence[LedgerEntry], targets: Mapping[str, str], owners: Mapping[str, str],
    was_written: Callable[[LedgerEntry, str], bool], corrections: Corrections, *, exact: bool,
) -> tuple[dict[str, Map], list[InferredParameters]]:  # fmt: skip
    """Return the values documents by the paths of the configs, and the PDSLs that these imply. `owners` are the
    documents of components by the real paths of configs that a network assigns to them. `was_written`: whether an
    earlier run wrote the document at a path."""
    components = ConfiguredComponents(accepted, targets, owners, was_written)
    components.declare()
    documents: dict[str, Map] = {}
    inferred = [_build(component, targets, corrections, exact, documents) for component in components.all()]
    return documents, [each for each in inferred if each is not None]


def _build(
    component: ConfiguredComponent, targets: Mapping[str, str], corrections: Corrections, exact: bool,
    documents: dict[str, Map],
) -> InferredParameters | None:  # fmt: skip
    configs, links = list[Config](), dict[str, DocumentLinks]()
    entries = {entry.file.path: entry for entry in component.configs}
    for path, entry in entries.items():
        draft, rules, source = entry.file.draft, entry.file.rules, entry.file.source
        assert isinstance(draft, ConfigDraft) and rules is not None and source is not None
        first = generic_config(path)
        configs.append(Config(path, source, rules, sort(draft.settings, component.ports, rules)))
        folder = os.path.dirname(targets[path]) or "."
        home = os.path.relpath(component.document or component.parameters, folder)
        after = os.path.relpath(targets[first], folder) if first in entries else ""
        links[path] = DocumentLinks(home, os.path.basename(path), after)
    planned = plans(configs, corrections)
    if component.declared is not None:
        planned = declared.fitted(planned, component.declared, configs)
    else:
        planned = accepted_plans(planned, configs, links)
    for plan in planned:
        _report_guess(plan, entries)
    for config in configs:
        entries[config.name].diagnostics += config.sorted.diagnostics
        documents[config.name] = values_document(config, planned, links[config.name], exact=exact)
    if component.declared is not None:
        return None
    document = pdsl_document(os.path.basename(component.document) or component.name, planned)
    return InferredParameters(component.parameters, document, component.configs[0])


def _report_guess(plan: ParameterPlan, entries: Mapping[str, LedgerEntry]) -> None:
    """Report what was guessed, at the first line that it concerns."""
    if plan.guessed:
        name, value = next(iter(plan.values.items()))
        first = min(value.settings, key=lambda setting: setting.span.line)
        code = codes.UNNAMED if plan.is_unnamed else codes.GUESSED
        entries[name].diagnostics.append(code.at(first.span, what=plan.guessed, name=".".join(plan.path)))
