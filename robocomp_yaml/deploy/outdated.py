"""Components that were compiled before their interfaces changed: what runs would not speak as the documents say."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.emit import slice as slice_target
from robocomp_yaml.emit.layout import SLICE, STATED, fingerprint, stated
from robocomp_yaml.link.deployments import LinkedDeployment
from robocomp_yaml.link.program import LinkedComponent, LinkedModule
from robocomp_yaml.link.workspace import component_argument
from robocomp_yaml.source.regular import text


def outdated(linked: LinkedDeployment) -> Iterator[Diagnostic]:
    """A warning for each component whose Slice is not that of its documents; one that has none is not compiled."""
    texts = _Texts()
    seen: set[str] = set()
    for instance in linked.instances.values():
        component = instance.component
        if component is None or component.broken or instance.folder in seen or not instance.entry.enabled:
            continue
        seen.add(instance.folder)
        if any(module.unresolved for module in component.modules()):
            continue  # it cannot be compiled as it is
        changed = _changed(instance.folder, component, texts)
        if changed:
            yield deploying.OUTDATED.at(
                instance.entry.span, name=instance.name, document=changed[0].module.path,
                hint=f"`{typed('rcyaml', 'compile', component.component.path)}`" + _then_build(component),
                related=[Related("changed since", module.module.span) for module in changed],
            )  # fmt: skip


def outdated_components(components: Iterable[LinkedComponent]) -> Iterator[Diagnostic]:
    """The same of components by themselves, at their documents."""
    texts = _Texts()
    for linked in components:
        path = linked.component.path
        if linked.broken or any(module.unresolved for module in linked.modules()):
            continue
        changed = _changed(os.path.dirname(path), linked, texts)
        if changed:
            yield deploying.OUTDATED.at(
                linked.component.span, name=linked.component.name, document=changed[0].module.path,
                hint=f"`{typed('rcyaml', 'compile', path)}`{_then_build(linked)}",
                related=[Related("changed since", module.module.span) for module in changed],
            )  # fmt: skip


def _then_build(linked: LinkedComponent) -> str:
    component = linked.component
    if not component.language.target.build:
        return ""
    return f", then `{typed('rcyaml', 'build', component_argument(component.name, component.path))}`"


class _Texts:
    """The Slice of modules, rendered once."""

    def __init__(self) -> None:
        self._known: dict[LinkedModule, str] = {}

    def of(self, linked: LinkedModule) -> str:
        if linked not in self._known:
            self._known[linked] = slice_target.text(linked)
        return self._known[linked]


def _changed(folder: str, component: LinkedComponent, texts: _Texts) -> list[LinkedModule]:
    """The modules that are not as they were. Where the component shares its Slice, and only generated code knows which
    it was made for, they are all that it has."""
    modules = component.modules()
    states = component.component.language.target.states
    said = text(os.path.join(folder, states)) if states else None
    if said is not None and STATED in said:
        now = fingerprint({slice_target.file_name(one): texts.of(one) for one in modules})
        return [] if stated(now) in said else modules
    found = {one: text(os.path.join(folder, SLICE, slice_target.file_name(one))) for one in modules}
    return [one for one, found_text in found.items() if found_text is not None and found_text != texts.of(one)]
