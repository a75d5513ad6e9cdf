"""Quick fixes that need more than one document: a parameter is added, a port is connected to a candidate."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from msgspec.structs import replace

from robocomp_yaml.api.completing import values
from robocomp_yaml.diag.codes import networks
from robocomp_yaml.diag.codes import values as value_codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Edit, Fix
from robocomp_yaml.lsp.session import KnownNames
from robocomp_yaml.source.spelled import DocumentText
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, end_of, pairs_below

MORE = frozenset((networks.AMBIGUOUS.id, value_codes.UNKNOWN_PARAMETER.id))
"""The codes for which there may be further fixes."""
_MOST = 5
_TYPES = ((bool, "bool"), (int, "int"), (float, "float"), (str, "string"))


def more_fixes(one: Diagnostic, known: KnownNames) -> tuple[Fix, ...]:
    """Further fixes of a diagnostic, all guesses."""
    text = known.texts.get(one.span.file)
    if text is None or not isinstance(text.tree, Mapping):
        return ()
    if one.code == networks.AMBIGUOUS.id:
        return tuple(_connected(one, text, text.tree))
    if one.code == value_codes.UNKNOWN_PARAMETER.id:
        return tuple(_with_parameter(one, text.tree, known))
    return ()


def added(text: DocumentText, mapping: Mapping, entry: str) -> Edit:
    """The edit that adds an entry at the end of a mapping that has some."""
    last = list(mapping.entries.values())[-1]
    end = max(end_of(last[1]), last[0].end + 1)
    if mapping.is_flow:
        end = mapping.end - 1
        return text.edit(end, end, f", {entry}")
    rest = re.compile(r"[ \t]*(?:#[^\r\n]*)?").match(text.text, end)
    end = rest.end() if rest is not None else end
    indent = " " * (next(iter(mapping.entries.values()))[0].span.column - 1)
    line_end = "\r\n" if "\r\n" in text.text else "\n"
    return text.edit(end, end, f"{line_end}{indent}{entry}")


def _connected(one: Diagnostic, text: DocumentText, root: Mapping) -> Iterator[Fix]:
    components = root.get("components")
    port, candidates = str(one.fact("port") or ""), str(one.fact("candidates") or "").partition(" and ")[0]
    for key, entry in components.items() if isinstance(components, Mapping) else ():
        is_here = key.span.line <= one.span.line <= max(entry.span.end_line, key.span.line)
        if not is_here or not isinstance(entry, Mapping) or not (key.span == one.span or entry.span.holds(one.span)):
            continue
        connect = entry.get("connect")
        for name in candidates.split(", ")[:_MOST]:
            if isinstance(connect, Mapping) and connect.entries and port not in connect.entries:
                edit = added(text, connect, f"{port}: {name}")
            elif connect is None and entry.entries and "connect" not in entry.entries:
                edit = added(text, entry, f"connect: {{{port}: {name}}}")
            else:
                return
            yield Fix(f"connect {port} to '{name}'", (edit,))
        return


def _with_parameter(one: Diagnostic, root: Mapping, known: KnownNames) -> Iterator[Fix]:
    found = next(((key, value) for key, value in pairs_below(root) if key.span == one.span), None)
    if found is None or str(one.fact("path") or "").strip("'") != found[0].lexeme:
        return  # it is inside of a group or record
    name, path = found[0].lexeme, one.span.file
    component = root.get("component")
    of = str(component.data) if component is not None else _component_around(root, one)
    linked = values.parameters_for(known.program, path, of)
    document = linked.document if linked is not None else None
    text = known.texts.get(document.path) if document is not None else None
    section = text.tree.get("parameters") if text is not None and isinstance(text.tree, Mapping) else None
    if document is None or text is None or not isinstance(section, Mapping) or not section.entries:
        return
    if re.fullmatch(r"[A-Za-z_]\w*", name):
        yield Fix(f"add the parameter '{name}' to {document.path.rpartition('/')[2]}",
                  (added(text, section, f"{name}: {_type_of(found[1])}"),))  # fmt: skip


def _component_around(root: Mapping, one: Diagnostic) -> str:
    """The component of the entry of a deployment in which a diagnostic is."""
    components = root.get("components")
    for _, entry in components.items() if isinstance(components, Mapping) else ():
        if entry.span.holds(one.span) and (component := entry.get("component")) is not None:
            return str(component.data)
    return ""


def _type_of(node: Node) -> str:
    """A type that the value has, as written in a parameter document."""
    if isinstance(node, Sequence) and node.items:
        return f"{{list: {_type_of(node.items[0])}}}"
    if isinstance(node, Scalar):
        return next((name for type_, name in _TYPES if isinstance(node.data, type_)), "string")
    return "{map: string}"


def with_more(found: Iterable[Diagnostic], known: KnownNames) -> list[Diagnostic]:
    """The diagnostics with all fixes."""
    return [replace(one, fixes=(*one.fixes, *more)) if (more := more_fixes(one, known)) else one for one in found]
