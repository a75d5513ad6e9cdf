"""Components that were compiled before their interfaces changed: what runs would not speak as the documents say."""

from __future__ import annotations

import os
from collections.abc import Iterator

from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.emit import slice as slice_target
from robocomp_yaml.link.deployments import LinkedDeployment
from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.source.regular import text


def outdated(linked: LinkedDeployment) -> Iterator[Diagnostic]:
    """A warning for each component whose Slice is not that of its documents; one that has none is not compiled."""
    texts: dict[LinkedModule, str] = {}
    seen: set[str] = set()
    for instance in linked.instances.values():
        component = instance.component
        if component is None or component.broken or instance.folder in seen or not instance.entry.enabled:
            continue
        seen.add(instance.folder)
        modules = component.modules()
        if any(module.unresolved for module in modules):
            continue  # it cannot be compiled as it is
        changed = [module for module in modules if _differs(instance.folder, module, texts)]
        if changed:
            yield deploying.OUTDATED.at(
                instance.entry.span, name=instance.name, document=changed[0].module.path,
                hint=f"`{typed('rcyaml', 'compile', component.component.path)}`" + (
                    ", and build it again" if component.component.language.target.build else ""
                ),
                related=[Related("changed since", module.module.span) for module in changed],
            )  # fmt: skip


def _differs(folder: str, linked: LinkedModule, texts: dict[LinkedModule, str]) -> bool:
    """`texts` remembers what was rendered for other components."""
    path = os.path.join(folder, "slice", slice_target.file_name(linked))
    found = text(path)
    if found is None:
        return False
    if linked not in texts:
        texts[linked] = slice_target.text(linked)
    return found != texts[linked]
