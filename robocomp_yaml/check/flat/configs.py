"""The values of a flat `etc/config` that rcyaml wrote, which are judged like those of a values document; and what Ice
ignores in every one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from msgspec.structs import replace

from robocomp_yaml.addresses.flat_values import FlatValues, flat_values
from robocomp_yaml.addresses.own import adapters, of_flat
from robocomp_yaml.addresses.own_configuration import own_configuration
from robocomp_yaml.addresses.table import LOCALHOST
from robocomp_yaml.check.pdsl import ice_properties, proxies
from robocomp_yaml.check.pdsl.values import texts_of_ice
from robocomp_yaml.diag.codes import specific
from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import WARNING, Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean, likeness, suggest
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.link.flat_configs import FlatConfig
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.parameters.types import BasicType, EnumType, RecordType, Type, below, leaves
from robocomp_yaml.semantics.connections import endpoints, proxy
from robocomp_yaml.source import properties
from robocomp_yaml.source.ice_proxy import proxy_at
from robocomp_yaml.source.properties import IceProperty, entry_line

_NEAR = 0.8  # similarity of a name that is surely misspelled
_OWN = "a property of your own belongs under `properties:` of an etc/config.yaml, which `{}` writes"


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in sorted(program.components.values(), key=lambda linked: linked.component.path):
        if linked.broken or linked.parameters.broken:
            continue
        flat = own_configuration(linked, program).flat
        if flat is not None:
            found = flat_values(flat, linked.parameters, linked)
            for fault in (
                *_lines(flat),
                *ice_properties.of_document(found.layer),
                *proxies.of_document(found.layer, program),
            ):
                # A fix edits documents, and this is none.
                fault = replace(fault, fixes=())
                yield fault if flat.is_written else fault.as_severity(WARNING)
            if flat.is_written:
                yield from _values(found, linked, program)
                yield from _removed(flat, linked)
                yield from _moved(flat, linked, program)


def replaced(program: Program, components: Iterable[LinkedComponent]) -> Iterator[Diagnostic]:
    """A warning for each of these components that has the values of its flat config instead of those of its values
    document. A compile, which ends this, reports it in its own way."""
    for linked in components:
        own = own_configuration(linked, program)
        if own.replaced is not None and own.flat is not None:
            path, document = own.flat.path, own.replaced.document.path
            if "\ufffd" in own.flat.text:
                adopt = typed("rcyaml", "compile", "--adopt", linked.component.path)
                hint = f"it is not UTF-8, which programs need: save it as UTF-8, or `{adopt}` does so"
            else:
                hint = f"move your changes to {document}, then `{typed('rcyaml', 'compile', linked.component.path)}`"
            yield codes.CHANGED_FLAT.at(Span(path), path=path, document=document, hint=hint)


def missing(program: Program) -> Iterator[Diagnostic]:
    """A warning for each value that a flat config which rcyaml wrote lacks. It is no error, because the value may be
    given on the command line. Components that a deployment starts are judged there, with what it sets."""
    instances = [one for linked in program.deployments.values() for one in linked.instances.values()]
    deployed = {one.component.component.path for one in instances if one.component is not None}
    for linked in sorted(program.components.values(), key=lambda linked: linked.component.path):
        flat = None if linked.broken or linked.parameters.broken else own_configuration(linked, program).flat
        if flat is not None and flat.is_written and linked.component.path not in deployed:
            for fault in missing_values(flat_values(flat, linked.parameters, linked), program):
                yield fault.as_severity(WARNING)


def missing_values(found: FlatValues, program: Program) -> Iterator[Diagnostic]:
    """The values without which a component does not start, unless other values are wrong, or misspelled."""
    from robocomp_yaml.parameters.layers.effective import document_faults

    parameters = found.layer.parameters
    if parameters is not None and not parameters.broken and not document_faults(found.layer, parameters):
        for fault in program.effective(found.layer)[1]:
            is_misspelled = any(likeness(key, str(fault.fact("path"))) >= _NEAR for key in found.unread)
            if fault.code == codes.MISSING.id and not is_misspelled:
                yield replace(fault, fixes=())


def _lines(flat: FlatConfig) -> Iterator[Diagnostic]:
    """The lines that Ice ignores, because they are no properties, or because a later line replaces them."""
    seen: dict[str, IceProperty] = {}
    for line in properties.read(flat.text).lines:
        text = flat.text[line.start : line.stop]
        column = len(text) - len(text.lstrip()) + 1
        span = Span(flat.path, line.number, column, line.number, len(text.rstrip()) + 1)
        if line.is_invalid:
            key, colon, value = text.strip().partition(":")
            meant = f"{key.rstrip()}={value.lstrip()}" if colon and " " not in key.rstrip() else "KEY=VALUE"
            yield codes.NOT_A_PROPERTY.at(span, hint=f"write {meant}, or # before a comment")
        if line.entry is not None:
            earlier = seen.get(line.entry.key)
            if earlier is not None and earlier.value != line.entry.value:
                yield codes.REPEATED_PROPERTY.at(
                    span, name=line.entry.key, line=earlier.line, hint="remove one of the two lines"
                )
            seen[line.entry.key] = line.entry


def _removed(flat: FlatConfig, linked: LinkedComponent) -> Iterator[Diagnostic]:
    """The endpoints and proxies that rcyaml wrote, and that the file does not set any more."""
    own, before = of_flat(flat, linked), [*flat.base]
    needed = [(endpoints(name)[0], name in own.endpoints) for name in adapters(linked)]
    needed += [(proxy(port.name)[0], port.name in own.proxies) for port in linked.requires]
    for key, is_set in needed:
        if key in before and not is_set:
            span = next((Span(flat.path, line.number) for line in properties.read(flat.text).lines
                         if line.entry is not None and line.entry.key == key), Span(flat.path))  # fmt: skip
            hint = f"write {entry_line(key, flat.base[key])}, as rcyaml wrote it"
            yield specific.REMOVED_PROPERTY.at(span, name=key, component=linked.component.name, hint=hint)


def _moved(flat: FlatConfig, linked: LinkedComponent, program: Program) -> Iterator[Diagnostic]:
    """The proxies that rcyaml wrote, and that lead nowhere now, because a component's port was changed."""
    own = of_flat(flat, linked)
    for port in linked.requires:
        text, interface = own.proxies.get(port.name), port.interface.name
        is_ours = text is not None and (text.is_as_written or proxy(port.name)[0] not in flat.base)
        found = proxy_at(text.text) if text is not None and is_ours else None
        if text is None or found is None or [one.host for one in found.endpoints] != [LOCALHOST]:
            continue
        served = {at.port: (at, one) for at, name, one in proxies.served(program) if name == interface}
        if served and found.endpoints[0].port not in served and linked not in [one for _, one in served.values()]:
            endpoint, other = next(iter(served.values()))
            meant = f"{found.identity}:{endpoint.reached_at(LOCALHOST)}"
            hint = f"write {entry_line(proxy(port.name)[0], meant)}"
            yield codes.MOVED.at(text.span, port=port.name, component=other.component.name, hint=hint)


def _values(found: FlatValues, linked: LinkedComponent, program: Program) -> Iterator[Diagnostic]:
    from robocomp_yaml.parameters.layers.effective import document_faults

    root = linked.parameters.parameters.root
    faults = list(document_faults(found.layer, linked.parameters))
    if not faults:  # `missing` reports missing values, which may come from elsewhere
        faults = [one for one in program.effective(found.layer)[1] if one.code == codes.CONSTRAINT.id]
    # A fix edits documents, and this is none.
    yield from (replace(fault, fixes=()) for fault in faults)
    yield from (replace(fault, fixes=()) for fault in texts_of_ice(found.layer))
    for what, name, span in found.unknown_ports.values():
        ports = linked.requires if what == "proxy" else linked.implements
        meant = suggest(name, [port.name for port in ports])
        if meant and likeness(name, meant) >= _NEAR:  # another may be one of the component's own code
            own, similar = linked.component.name, f"did you mean '{meant}'?"
            yield codes.UNKNOWN_PORT.at(span, component=own, what=what, name=name, hint=similar)
    known = [*(path for path, _ in leaves(root)), *found.connections]
    new = _OWN.format(typed("rcyaml", "config", "new", linked.component.path))
    for key, span in found.unread.items():
        inside = _inside(key, root)
        hint = did_you_mean(key, known if inside is None else inside, otherwise=new if inside is None else "")
        fault = replace(codes.UNKNOWN_PARAMETER.at(span, path=key, hint=hint), fixes=())
        is_misspelled = inside is not None or (hint.meant and likeness(key, hint.meant) >= _NEAR)
        yield fault if is_misspelled else fault.as_severity(WARNING)


def _inside(key: str, root: RecordType) -> list[str] | None:
    """The names that a property in a group, record, list or map can have; None if it is not in one."""
    *outer, _ = key.split(".")
    type_: Type | None = root
    for depth, step in enumerate(outer):
        inner = below(type_, step)
        if inner is None:
            return None if depth == 0 else []
        type_ = inner
    if not outer or isinstance(type_, (BasicType, EnumType)):
        return None
    return [".".join((*outer, member.name)) for member in type_.members] if isinstance(type_, RecordType) else []
