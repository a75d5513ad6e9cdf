"""The values of `set:` on a flat config, which keeps its own lines for all other values.

A parameter that `set:` changes is written as a whole: its defaults, and what the flat config has of it. A list is
numbered, a map has the property of its keys, and `legacy:` spells records as rows, so that a part of one cannot be
written by itself. What the flat config has of the parameter does not count beside that.
"""

from __future__ import annotations

import msgspec
from msgspec.structs import replace

from robocomp_yaml.addresses.flat_values import FlatValues
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.link.program import LinkedParameters, LinkedValues
from robocomp_yaml.parameters.defaults import with_defaults
from robocomp_yaml.parameters.layers.effective import document_faults
from robocomp_yaml.parameters.layers.merge import data_of, merged
from robocomp_yaml.parameters.specification.document import ValuesDocument
from robocomp_yaml.parameters.types import RecordType
from robocomp_yaml.parameters.writing.sections import Property
from robocomp_yaml.parameters.writing.write import Writer
from robocomp_yaml.source.tree import Mapping, Node


class SetValues(msgspec.Struct, frozen=True):
    """The properties of the parameters that `set:` changes. `replaced` are the properties of the flat config that have
    no effect beside them."""

    properties: list[Property] = []
    replaced: frozenset[str] = frozenset()
    faults: list[Diagnostic] = []


def set_values(linked: LinkedParameters, below: FlatValues, layer: ValuesDocument, *, quote: bool) -> SetValues:
    """The values of `layer` on those of the flat config `below`."""
    own = LinkedValues(layer, parameters=linked)
    faults = list(document_faults(own, linked))
    if has_errors(faults):
        return SetValues(faults=faults)
    changed = changed_parameters(linked.parameters.root, layer.root.get("parameters"))
    place = merged(replace(own, extends=(below.layer,)))
    data = with_defaults(changed, data_of(place, changed))
    writer = Writer(replace(linked.parameters, root=changed), layer.root.span, True, quote)
    properties = writer.write(data, place)
    read = below.keys_of(changed)
    return SetValues(properties, frozenset(read), [*faults, *writer.faults])


def changed_parameters(record: RecordType, node: Node | None) -> RecordType:
    """The group with only the parameters that a mapping sets or resets. Groups are changed by their members."""
    entries = node.entries if isinstance(node, Mapping) else {}  # with those that are null
    found = []
    for member in (member for member in record.members if member.name in entries):
        inner = entries[member.name][1]
        if isinstance(member.type, RecordType) and member.is_group and isinstance(inner, Mapping):
            found.append(replace(member, type=changed_parameters(member.type, inner)))
        else:
            found.append(member)
    return replace(record, members=tuple(found))
