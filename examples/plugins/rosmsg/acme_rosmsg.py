"""Converts ROS messages (`Pose2D.msg`) of plain values, each to a struct in a module of its own."""

from pathlib import Path

from robocomp_yaml.api import plugins

RULES = r"""
title: ROS message
kind: idsl
suffixes: [.msg]
rank: 60
signature: '(?m)^\s*(bool|byte|char|u?int\d+|float(32|64)|string)(\[\d*\])?\s+[a-z]\w*'
names: '[A-Za-z_][A-Za-z0-9_]*'
doc: {strip: '(?!)', drop: '(?!)'}
words: {TYPE: a type, NAME: a name, ARRAY: '', $END: the end of the file}
places: {member: comment}
repairs: {repeated: "the second '{text}' is dropped"}
refusals:
  refused_array: an array has no name in a ROS message, and needs one in IDSL; write the document by hand
  refused_uint64: Slice has no type for uint64
"""

GRAMMAR = r"""
start: member*
member: (TYPE | refused_uint64) refused_array? NAME
refused_array: ARRAY
refused_uint64: "uint64"

TYPE.2: /(bool|byte|char|u?int(8|16|32)|int64|float32|float64|string)\b/
ARRAY: /\[\d*\]/
NAME: /[A-Za-z]\w*/
LINE_COMMENT: /#[^\n]*/
BLANK: /\s+/
%ignore LINE_COMMENT
%ignore BLANK
"""

TYPES = {
    "bool": "bool", "byte": "byte", "char": "byte", "uint8": "byte", "int8": "short", "int16": "short",
    "uint16": "int", "int32": "int", "uint32": "long", "int64": "long", "float32": "float", "float64": "double",
    "string": "string",
}  # fmt: skip


def convert(reader):
    name = Path(reader.source.path).stem
    members = plugins.Map(block=True)
    seen = set()
    for node in plugins.trees(reader.parsed.tree, "member"):
        member, type_ = reader.name(node), plugins.token(node, "TYPE")
        if member in seen:
            reader.repaired("repeated", node, member)
        elif type_ is not None:
            seen.add(member)
            members.put(member, plugins.Raw(TYPES[type_]), reader.notes(node))
    struct, types, document = plugins.Map(block=True), plugins.Map(block=True), plugins.Map(block=True)
    struct.put("struct", members)
    types.put(name, struct)
    document.put("module", f"RoboComp{name}")
    document.put("types", types)
    return plugins.ModuleDraft(document, reader.placed.around, (), plugins.ModuleNames(f"RoboComp{name}", {name}))
