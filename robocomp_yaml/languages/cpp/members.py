"""Members of parameters in C++: their plain types, their comments, and the names of what sets them."""

from __future__ import annotations

from robocomp_yaml.emit.parameter_facts import facts
from robocomp_yaml.languages.cpp.text import comment
from robocomp_yaml.model.parameters import Member

_PLAIN = {
    "bool": "bool", "int": "int", "long": "long long", "float": "float", "double": "double", "string": "std::string",
}  # fmt: skip


def plain_type(name: str) -> str:
    return _PLAIN[name]


def documented(member: Member, indent: str) -> str:
    doc = "\n".join(part for part in (member.doc.strip(), facts(member)) if part)
    return comment(doc or f"{member.name}.", indent)


def set_name(verb: str, path: str) -> str:
    """`set` and `period.compute` make `setPeriodCompute`."""
    return verb + "".join(part[:1].upper() + part[1:] for part in path.split("."))
