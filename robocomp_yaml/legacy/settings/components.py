"""The configs of each component together: their values documents, and the PDSL that they imply."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence

import msgspec

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.legacy.document import Map
from robocomp_yaml.legacy.draft import ConfigDraft
from robocomp_yaml.legacy.ledger import Entry
from robocomp_yaml.legacy.settings import declared
from robocomp_yaml.legacy.settings.grouping import Component, Components, first_half
from robocomp_yaml.legacy.settings.pdsl_document import pdsl_document
from robocomp_yaml.legacy.settings.plan import Config, Guesses, Plan
from robocomp_yaml.legacy.settings.planning import plans
from robocomp_yaml.legacy.settings.proof import proven
from robocomp_yaml.legacy.settings.sorting import sort
from robocomp_yaml.legacy.settings.values_document import Links, values_document


class Inferred(msgspec.Struct, frozen=True):
    """A PDSL to be written, with the ledger's entry of the config that names it."""

    path: str
    document: Map
    entry: Entry


def settle(
    good: Sequence[Entry],
    chosen: Mapping[str, str],
    is_ours: Callable[[Entry, str], bool],
    guesses: Guesses,
    *,
    exact: bool,
) -> tuple[dict[str, Map], list[Inferred]]:
    """The documents of configs, by the configs' paths, and the PDSLs that they imply. `is_ours`: whether an earlier run
    wrote the document at a path."""
    found = Components(good, chosen, is_ours)
    found.declare()
    documents: dict[str, Map] = {}
    inferred = [_settle(component, chosen, guesses, exact, documents) for component in found.all()]
    return documents, [made for made in inferred if made is not None]


def _settle(
    component: Component, chosen: Mapping[str, str], guesses: Guesses, exact: bool, documents: dict[str, Map]
) -> Inferred | None:
    configs, links = list[Config](), dict[str, Links]()
    entries = {entry.file.path: entry for entry in component.configs}
    for path, entry in entries.items():
        draft, rules, source = entry.file.draft, entry.file.rules, entry.file.source
        assert isinstance(draft, ConfigDraft) and rules is not None and source is not None
        first = first_half(path)
        configs.append(Config(path, source, rules, sort(draft.settings, component.ports, rules)))
        folder = os.path.dirname(chosen[path]) or "."
        links[path] = Links(
            os.path.relpath(component.document or component.parameters, folder),
            os.path.basename(path),
            os.path.relpath(chosen[first], folder) if first in entries else "",
        )
    planned = plans(configs, guesses)
    if component.declared is not None:
        planned = declared.fitted(planned, component.declared, configs)
    else:
        planned = proven(planned, configs, links)
    for plan in planned:
        _tell(plan, entries)
    for config in configs:
        entries[config.name].diagnostics += config.sorted.diagnostics
        documents[config.name] = values_document(config, planned, links[config.name], exact=exact)
    if component.declared is not None:
        return None
    document = pdsl_document(os.path.basename(component.document) or component.name, planned)
    return Inferred(component.parameters, document, component.configs[0])


def _tell(plan: Plan, entries: Mapping[str, Entry]) -> None:
    """What was guessed, at the first line that it is about."""
    if plan.guessed:
        name, given = next(iter(plan.given.items()))
        first = min(given.settings, key=lambda setting: setting.span.line)
        code = codes.UNNAMED if plan.is_unnamed else codes.GUESSED
        entries[name].diagnostics.append(code.at(first.span, what=plan.guessed, name=".".join(plan.path)))
