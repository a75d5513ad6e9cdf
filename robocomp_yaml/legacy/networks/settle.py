"""The networks of a run as documents, once it is known what its components are called and where they will stand."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence

from robocomp_yaml.legacy.document import Map
from robocomp_yaml.legacy.draft import DeploymentDraft
from robocomp_yaml.legacy.ledger import Entry
from robocomp_yaml.legacy.networks.components import Known, of_folder, of_run
from robocomp_yaml.legacy.networks.deployment import build
from robocomp_yaml.legacy.networks.entries import Site
from robocomp_yaml.legacy.networks.node import safe_name
from robocomp_yaml.legacy.workspaces import Workspaces


def settle(good: Sequence[Entry], chosen: Mapping[str, str], workspaces: Workspaces) -> dict[str, Map]:
    """The document of each network among these files, all of which become documents, by the file's path."""
    made: dict[str, Map] = {}
    networks = [(entry, entry.file.draft) for entry in good if isinstance(entry.file.draft, DeploymentDraft)]
    if not networks:
        return made
    migrated = of_run((entry.file for entry in good), chosen)
    documents = {os.path.realpath(path): document for path, document in chosen.items()}
    there: dict[str, list[Known]] = {}
    for entry, draft in networks:
        rules = entry.file.rules
        assert rules is not None
        document = chosen[entry.file.path]
        home = workspaces.of(document).root
        if home not in there:
            there[home] = of_folder(home, [known.path for known in migrated])
        name = safe_name(os.path.basename(document).removesuffix(rules.document))
        known = [*migrated, *there[home]]
        content, said = build(name, draft.network, known, Site(document, documents), f"x-{rules.name}")
        made[entry.file.path] = content
        entry.diagnostics += said
    return made
