"""Convert the PDSL of 2011 to a PDSL document."""

from __future__ import annotations

from lark import Token, Tree

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.legacy import literals
from robocomp_yaml.legacy.document import TRUE, List, Map, Notes, Raw, Value
from robocomp_yaml.legacy.draft import ParametersDraft, Reader
from robocomp_yaml.legacy.grammar import token, trees

LITERALS = ("STRING", "NUMBER", "BOOLEAN")


def convert(reader: Reader) -> ParametersDraft | None:
    tree = reader.tree
    component = trees(tree, "component")[0]
    notes = reader.notes(component)
    document, parameters = Map(block=True), Map(block=True)
    document.put("component", reader.name(component), Notes(notes.head, notes.tail))
    has_flag = False
    for name, node in reader.named(trees(component, "parameter")):
        body = _parameter(reader, node)
        flag = next((token(each, "FLAG") for each in trees(node, "flag")), None)
        if flag == "T":
            body.put("editable", TRUE)
            if not has_flag:
                reader.report(codes.GUESSED, flag, name=reader.name(component), what=reader.rules.repairs["flag"])
            has_flag = True
        parameters.put(name, body, reader.notes(node))
    document.put("parameters", parameters)
    reader.placed.around.foot[:0] = notes.foot
    return ParametersDraft(document, reader.placed.around)


def _parameter(reader: Reader, node: Tree[Token]) -> Map:
    kind = str(token(node, "TYPE"))
    body = Map()
    body.put("type", kind)
    ends = [end for limit in trees(node, "range") for end in limit.children if isinstance(end, Token)]
    limits = [literals.value(end) for end in ends if kind in ("int", "float", "double")]
    body.put_some("range", List.of(limits))
    default = literal(node)
    if _fits(kind, default) and _inside(default, limits):
        body.put("default", value(default))
    else:
        reader.repaired("default", default, str(default))
    return body


def literal(node: Tree[Token]) -> Token:
    return next(child for child in node.children if isinstance(child, Token) and child.type in LITERALS)


def _fits(kind: str, default: Token) -> bool:
    if kind == "string":
        return default.type == "STRING"
    if kind == "bool":
        return default.type == "BOOLEAN"
    return default.type == "NUMBER" and (kind != "int" or float(default).is_integer())


def value(default: Token) -> Value:
    return Raw(default.lower()) if default.type == "BOOLEAN" else literals.value(default)


def _inside(default: Token, limits: list[Value]) -> bool:
    if not limits or default.type != "NUMBER":
        return True
    low, high = (float(limit.lexeme) for limit in limits if isinstance(limit, Raw))
    return low <= float(default) <= high
