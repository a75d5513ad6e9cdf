"""Components that were compiled before their interfaces changed, and communicate by the old ones."""

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
from robocomp_yaml.link.workspace import component_argument
from robocomp_yaml.source.regular import text


def outdated(linked: LinkedDeployment) -> Iterator[Diagnostic]:
    """A warning for each component of a deployment whose Slice differs from its documents. A component without Slice
    has not been compiled, and is ignored."""
    started: dict[str, tuple[Span, str, LinkedComponent]] = {}
    for instance in linked.instances.values():
        if instance.component is not None and instance.entry.enabled:
            started.setdefault(instance.folder, (instance.entry.span, instance.name, instance.component))
    return _outdated((folder, *one) for folder, one in started.items())


def outdated_components(components: Iterable[LinkedComponent]) -> Iterator[Diagnostic]:
    """The same for components, at the locations of their documents."""
    of = ((linked, linked.component) for linked in components)
    return _outdated((os.path.dirname(one.path), one.span, one.name, linked) for linked, one in of)


def _outdated(compiled: Iterable[tuple[str, Span, str, LinkedComponent]]) -> Iterator[Diagnostic]:
    texts = functools.cache(slice_target.text)
    for folder, span, name, component in compiled:
        if component.broken or any(module.unresolved for module in component.modules()):
            continue  # it cannot be compiled
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
    return f"{compile_}, then `{typed('rcyaml', 'build', component_argument(component.name, component.path))}`"


def _changed(folder: str, component: LinkedComponent, texts: Callable[[LinkedModule], str]) -> list[LinkedModule]:
    """The modules that changed. With shared Slice, the generated code has only one fingerprint of all modules: then all
    modules of the component."""
    modules = component.modules()
    states = component.component.language.target.states
    code = text(os.path.join(folder, states)) if states else None
    if code is not None and STATED in code:
        now = fingerprint({slice_target.file_name(one): texts(one) for one in modules})
        return [] if stated(now) in code else modules
    compiled = {one: text(os.path.join(folder, SLICE, slice_target.file_name(one))) for one in modules}
    return [one for one, slice_ in compiled.items() if slice_ is not None and slice_ != texts(one)]
