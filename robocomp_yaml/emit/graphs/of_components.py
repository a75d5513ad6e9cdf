"""The picture of a workspace without a deployment: its components, and those that implement what others require."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from robocomp_yaml.addresses.interface_comparison import Implementers
from robocomp_yaml.diag.diagnostic import ERROR, Diagnostic
from robocomp_yaml.emit.graphs import picture as parts
from robocomp_yaml.emit.graphs.picture import Picture, PictureFault, PictureLine, PictureNode
from robocomp_yaml.grouping import grouped
from robocomp_yaml.link.program import LinkedComponent, Port


def picture_of(
    name: str, components: Iterable[LinkedComponent], diagnostics: Sequence[Diagnostic] = ()
) -> Picture:  # fmt: skip
    """The picture of these components, with the diagnostics of their documents. Topics are outside, and so are
    interfaces that no component implements."""
    made = Picture(name)
    faults = grouped((one.span.file, PictureFault(one.code, one.severity == ERROR, one.message)) for one in diagnostics)
    listed = list(components)
    implementers = Implementers()
    names: dict[LinkedComponent, str] = {}
    for component in listed:
        title = component.component.name
        names[component] = title if title not in made.nodes else component.component.path
        node = PictureNode(
            names[component], title, parts.COMPONENT, about=(component.component.language.name,),
            serves=tuple((port.interface.name, 0) for port in component.implements),
            faults=tuple(faults.get(component.component.path, ())),
        )  # fmt: skip
        made.nodes[node.name] = node
        implementers.add(component)
    for component in listed:
        source = names[component]
        for port in component.requires:
            label = port.interface.name if port.name == port.interface.name else f"{port.name}: {port.interface.name}"
            targets = [names[other] for other, _ in implementers.of(port)]
            if not targets:
                about = "no component here implements it"
                made.nodes.setdefault(
                    _key(port), PictureNode(_key(port), port.interface.name, parts.OUTSIDE, about=(about,))
                )
                targets = [_key(port)]
            made.lines += [PictureLine(source, target, label) for target in targets if target != source]
        for ports, kind in ((component.publishes, parts.PUBLISHES), (component.subscribes, parts.SUBSCRIBES)):
            for port in ports:
                topic = f"topic {_key(port)}"
                made.nodes.setdefault(topic, PictureNode(topic, port.interface.name, parts.TOPIC, about=("topic",)))
                made.lines.append(PictureLine(source, topic, kind=kind))
    return made


def _key(port: Port) -> str:
    """The full name of an interface."""
    return f"{port.scope.module.name}.{port.interface.name}"
