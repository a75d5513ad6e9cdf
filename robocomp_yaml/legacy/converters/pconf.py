"""Convert the values of 2011 to a values document. Its component is the PDSL that they import."""

from __future__ import annotations

from robocomp_yaml.legacy.converters.pdsl import literal, value
from robocomp_yaml.legacy.document import Map, Notes
from robocomp_yaml.legacy.draft import Reader, ValuesDraft
from robocomp_yaml.legacy.grammar import token, trees


def convert(reader: Reader) -> ValuesDraft | None:
    tree = reader.tree
    config = trees(tree, "config")[0]
    notes = reader.notes(config)
    path = f"{reader.name(config)}.pdsl"
    for node in trees(tree, "import"):
        named = token(node, "STRING")
        path = str(named).strip('"') or path
    document, parameters = Map(block=True), Map(block=True)
    document.put("component", f"{path}.yaml", Notes(notes.head, notes.tail))
    for name, node in reader.named(trees(config, "entry")):
        parameters.put(name, value(literal(node)), reader.notes(node))
    document.put_some("parameters", parameters)
    reader.placed.around.foot[:0] = notes.foot
    return ValuesDraft(document, reader.placed.around)
