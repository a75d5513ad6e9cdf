"""Components that were compiled before their interfaces changed: what runs would not speak as the documents say."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Iterable, Iterator

from robocomp_yaml.diag.codes import deploying
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.emit import slice as slice_target
from robocomp_yaml.emit.layout import SLICE, STATED, fingerprint, stated
from robocomp_yaml.link.deployments import LinkedDeployment
from robocomp_yaml.link.program import LinkedComponent, LinkedModule
from robocomp_yaml.link.workspace import named_from_here
from robocomp_yaml.source.regular import text


def outdated(linked: LinkedDeployment) -> Iterator[Diagnostic]:
    """A warning for each component whose Slice is not that of its documents; one that has none is not compiled."""
    started: dict[str, tuple[Span, str, LinkedComponent]] = {}
    for instance in linked.instances.values():
        if instance.component is not None and instance.entry.enabled:
            started.setdefault(instance.folder, (instance.entry.span, instance.name, instance.component))
    return _outdated((folder, *one) for folder, one in started.items())


def outdated_components(components: Iterable[LinkedComponent]) -> Iterator[Diagnostic]:
    """The same of components by themselves, at their documents."""
    of = ((linked, linked.component) for linked in components)
    return _outdated((os.path.dirname(one.path), one.span, one.name, linked) for linked, one in of)


def _outdated(compiled: Iterable[tuple[str, Span, str, LinkedComponent]]) -> Iterator[Diagnostic]:
    texts = functools.cache(slice_target.text)
    for folder, span, name, component in compiled:
        if component.broken or any(module.unresolved for module in component.modules()):
            continue  # it cannot be compiled as it is
        if changed := _changed(folder, component, texts):
            yield deploying.OUTDATED.at(
                span, name=name, document=changed[0].module.path, hint=_compile(component),
                related=[Related("changed since", module.module.span) for module in changed],
            )  # fmt: skip


def _compile(linked: LinkedComponent) -> str:
    component = linked.component
    compile_ = f"`{typed('rcyaml', 'compile', component.path)}`"
    if not component.language.target.build:
        return compile_
    return f"{compile_}, then `{typed('rcyaml', 'build', named_from_here(component.name, component.path))}`"


def _changed(folder: str, component: LinkedComponent, texts: Callable[[LinkedModule], str]) -> list[LinkedModule]:
    """The modules that are not as they were. Where the component shares its Slice, and only generated code knows which
    it was made for, they are all that it has."""
    modules = component.modules()
    states = component.component.language.target.states
    said = text(os.path.join(folder, states)) if states else None
    if said is not None and STATED in said:
        now = fingerprint({slice_target.file_name(one): texts(one) for one in modules})
        return [] if stated(now) in said else modules
    found = {one: text(os.path.join(folder, SLICE, slice_target.file_name(one))) for one in modules}
    return [one for one, found_text in found.items() if found_text is not None and found_text != texts(one)]
