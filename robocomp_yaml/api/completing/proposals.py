"""Completion of names, which the schemas do not hold: imports, interfaces, topics, types, parameters and their values,
components, hosts and entries of deployments, states, codes of diagnostics. Keys and basic types are completed by the
server of the schemas; if there is none, from the schemas too."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Collection, Iterable, Iterator
from itertools import chain

from msgspec.structs import replace

from robocomp_yaml.api.completing import constraints, deployments, machines, others, schema_keys, values
from robocomp_yaml.api.completing.paths import paths
from robocomp_yaml.api.completing.places import TypedPlace, items_of, keys_of, siblings
from robocomp_yaml.api.completing.proposal import CODE, PATH, VALUE, Proposal
from robocomp_yaml.api.schemas import names_offered
from robocomp_yaml.check.pdsl.values import port_names
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import IMPORT, Edit
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import Program
from robocomp_yaml.naming import names
from robocomp_yaml.naming.names import DefinedName, Names
from robocomp_yaml.source.discover import KINDS, WORKSPACE_FILE, kind_of
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.spelled import DocumentText
from robocomp_yaml.source.tree import Mapping, Scalar, Sequence, value_at
from robocomp_yaml.source.yaml_text import flow

_SUFFIX = ".idsl.yaml"
_PORTS = {
    "implements": names.INTERFACE, "requires": names.INTERFACE, "publishes": names.TOPIC, "subscribes": names.TOPIC,
}  # fmt: skip
_ONCE = frozenset((
    names.MODULE, names.INTERFACE, names.TOPIC, names.METHOD, names.EXCEPTION, names.STATE, names.PARAMETER, names.HOST,
    names.ENTRY, PATH,
))  # fmt: skip
"""Kinds of names of which a list or mapping has each only once."""
_OF_TYPES = ("struct", "sequence", "map", "in", "out", "returns", "type")


def proposals(
    path: str, place: TypedPlace, known: Names, importable: Iterable[str], program: Program | None = None, *,
    with_schema: bool = False,
) -> list[Proposal]:  # fmt: skip
    """What can stand at a place of a document, each once. `with_schema`: also what its schema says."""
    found: Iterator[Proposal] = iter(())
    kind = kind_at(path)
    present = siblings(place)
    modules = dict.fromkeys(importable)  # in their order, and looked up for each name
    match kind:
        case "idsl":
            found = _in_interfaces(path, place, known, modules)
        case "cdsl":
            found = chain(_in_component(path, place, known, modules), machines.proposals(place))
        case "pdsl":
            found = chain(
                _in_parameters(place, known),
                constraints.proposals(path, place, known, program),
                _component_paths(path, place, known),
            )
        case "ddsl":
            found = deployments.proposals(path, place, known, program)
        case "config":
            found = chain(_in_values(path, place, program, with_schema=with_schema),
                          _component_paths(path, place, known))  # fmt: skip
        case "mock":
            found = others.in_script(place, known, program, present)
        case "workspace":
            found = others.in_settings(place, present) if with_schema else found
    if program is not None:
        found = chain(found, paths(kind, path, place, program))
    if with_schema and kind in (*KINDS, "mock", "workspace"):
        found = chain(found, _of_schema(kind, place))
    made = {one.text: one for one in reversed(list(found)) if not (one.kind in _ONCE and one.text in present)}
    return [_as_typed(one, kind, place) for one in reversed(made.values())]


def _as_typed(one: Proposal, kind: str, place: TypedPlace) -> Proposal:
    """A proposal beside what is typed already: the colon of a key or quotes; or in the brackets of a list, which are
    missing."""
    is_closed = place.has_colon or (place.is_key and place.quote)
    if is_closed and (one.snippet or one.text).endswith(": "):
        return replace(one, text=one.text.removesuffix(": "), snippet=one.snippet.removesuffix(": "))
    if place.quote and not one.snippet and one.text[:1] == one.text[-1:] == '"':
        single = json.loads(one.text).replace("'", "''")
        return replace(one, text=one.text[1:-1] if place.quote == '"' else single)
    is_name = one.kind in _ONCE or one.kind == PATH
    if is_name and not place.is_key and not place.quote and schema_keys.is_list(kind, place.keys):
        return replace(one, snippet=f"[{one.text}]")
    return one


def importing(path: str, place: TypedPlace, name: str) -> list[Edit]:
    """The edits that import a module, if they are in another line than the cursor."""
    edits = DocumentText(path, place.text).spelled(Edit(Span(path), name, IMPORT)) if name else []
    return [one for one in edits if one.span.line != place.line]


def _of_schema(kind: str, place: TypedPlace) -> Iterator[Proposal]:
    if not place.is_key:
        yield from schema_keys.values_at(kind, place.keys)
        return
    yield from schema_keys.keys_at(kind, place.keys, siblings(place))


def _in_values(path: str, place: TypedPlace, program: Program | None, *, with_schema: bool) -> Iterator[Proposal]:
    """Values and, without a server of schemas, keys in a values document."""
    if program is None or not with_schema:
        return
    linked = values.parameters_for(program, path, values.named_by(place))
    if linked is None:
        return
    if place.keys[:1] == ("parameters",):
        yield from values.at_parameter(linked, place, place.keys[1:])
    elif place.is_key and linked.component is not None and place.keys in (known := port_names(linked.component)):
        what, ports = known[place.keys]
        yield from (Proposal(one, names.INTERFACE, what, snippet=f"{one}: ") for one in ports)


def _component_paths(path: str, place: TypedPlace, known: Names) -> Iterator[Proposal]:
    """The documents of components, as `component:` of parameters and values names them."""
    if place.keys == ("component",) and not place.is_key:
        for one in known.of_kinds(names.COMPONENT):
            where = os.path.relpath(one.span.file, os.path.dirname(path))
            yield Proposal(where, names.COMPONENT, one.says, one.doc)


_ALLOW = re.compile(r"#[ \t]*rcyaml[ \t]*:?[ \t]*allow\b[ \t]*(?:[\w,]+[ \t,]+)*(?P<code>\w*)\Z", re.IGNORECASE)
_VERB = re.compile(r"#[ \t]*rcyaml[ \t]*:[ \t]*(?P<verb>\w*)\Z")


def codes_at(line: str, column: int, found: Iterable[Diagnostic], number: int) -> tuple[int, list[Proposal]] | None:
    """The codes behind `# rcyaml: allow`, and the column at which the word begins: those that are reported here first,
    or in the next line. Behind `# rcyaml:`, the word `allow`. None anywhere else."""
    if verb := _VERB.search(line[: column - 1]):
        return verb.start("verb") + 1, [Proposal("allow", CODE, "suppresses diagnostics of this line or the next one")]
    typed = _ALLOW.search(line[: column - 1])
    if typed is None:
        return None
    here = {one.code: one.message for one in found if one.span.line in (number, number + 1)}
    known = {**here, **{id_: code.message for id_, code in table().items() if id_ not in here}}
    made = [Proposal(id_, CODE, text, "reported here" if id_ in here else "") for id_, text in known.items()]
    return typed.start("code") + 1, made


def kind_at(path: str, disk: Disk | None = None) -> str:
    """The kind of a file with a schema: of documents, mock scripts and the settings of a workspace."""
    if kind := kind_of(path, disk or Disk()):
        return kind
    name = os.path.basename(path)
    return "workspace" if name == WORKSPACE_FILE else name.removesuffix(".yaml").rpartition(".")[2]


def _imports(path: str, place: TypedPlace, known: Names, importable: Collection[str]) -> Iterator[Proposal]:
    """Modules by their names, and by relative paths those that no folder of the search path has."""
    far = (_as_import(one, path, importable) for one in known.of_kinds(names.MODULE) if one.span.file != path)
    own = {os.path.basename(path).removesuffix(_SUFFIX), *items_of(place.root, "imports")}
    return (Proposal(name, names.MODULE) for name in dict.fromkeys((*importable, *far)) if name not in own)


def _as_import(one: DefinedName, path: str, importable: Collection[str]) -> str:
    """How a document imports the module that defines a name."""
    stem = _stem(one)
    if stem in importable:
        return stem
    return os.path.relpath(one.span.file, os.path.dirname(path)).removesuffix(_SUFFIX)


def _in_interfaces(path: str, place: TypedPlace, known: Names, importable: Collection[str]) -> Iterator[Proposal]:
    keys = place.keys
    if keys[:1] == ("imports",) and not place.is_key:
        yield from _imports(path, place, known, importable)
    elif not place.is_key and len(keys) > 2 and keys[0] in ("interfaces", "topics", "types", "exceptions", "constants"):
        is_exception = "throws" in keys[3:]
        if keys[-1] == "default" or (keys[0], keys[-1]) == ("constants", "value"):
            yield from _enumerators(place, known)
        elif is_exception or any(key in _OF_TYPES for key in keys[2:]):
            yield from _types(place, known, "exceptions" if is_exception else "types")


def _types(place: TypedPlace, known: Names, section: str) -> Iterator[Proposal]:
    kind = names.EXCEPTION if section == "exceptions" else names.TYPE
    yield from (Proposal(name, kind, f"{kind} of this module") for name in keys_of(place.root, section))
    for stem, one in _of_imported(place, known, kind):
        yield Proposal(f"{stem}.{one.name}", kind, one.says, one.doc)


def _enumerators(place: TypedPlace, known: Names) -> Iterator[Proposal]:
    """The enumerators of the type beside a default or a constant, and the values to which it is limited."""
    node = value_at(place.root, *place.keys[:-1])
    of, limited = value_at(node, "type"), value_at(node, "values")
    stem, _, name = of.lexeme.rpartition(".") if isinstance(of, Scalar) else ("", "", "")
    for each in limited.items if isinstance(limited, Sequence) else ():
        yield Proposal(flow(each.data), VALUE, "one of values")
    if name == "bool" and limited is None:
        yield from (Proposal(one, VALUE, "bool") for one in ("true", "false"))
    own = value_at(place.root, "types", name) if not stem else None
    listed = value_at(own, "enum")
    found = [key.lexeme for key, _ in listed.items()] if isinstance(listed, Mapping) else items_of(own, "enum")
    yield from (Proposal(one, VALUE, f"enumerator of {name}") for one in found)
    for imported, one in _of_imported(place, known, names.ENUMERATOR):
        if stem == imported and one.key[2] == name:
            yield Proposal(one.name, VALUE, one.says, one.doc)


def _in_component(path: str, place: TypedPlace, known: Names, importable: Collection[str]) -> Iterator[Proposal]:
    keys = place.keys
    if keys[:1] == ("imports",) and not place.is_key:
        yield from _imports(path, place, known, importable)
    elif keys and keys[0] in _PORTS and not place.is_key and (len(keys) < 4 or keys[3] == "interface"):
        kind = _PORTS[keys[0]]
        for _, one in _of_imported(place, known, kind):
            yield Proposal(one.name, kind, one.says, one.doc)
        stems = {stem for stem, _ in _of_imported(place, known, names.MODULE)}
        for one in known.of_kinds(kind):
            if _stem(one) not in stems:
                module = _as_import(one, path, importable)
                yield Proposal(one.name, kind, f"{one.says}, imports {module}", one.doc, module)


def _in_parameters(place: TypedPlace, known: Names) -> Iterator[Proposal]:
    if not place.is_key and place.keys[-1:] == ("default",):
        yield from _enumerators(place, known)
    if not place.is_key and place.keys[-1:] in (("type",), ("list",), ("map",)):
        yield from (Proposal(name, names.TYPE, "type of this document") for name in keys_of(place.root, "types"))


def _of_imported(place: TypedPlace, known: Names, kind: str) -> Iterator[tuple[str, DefinedName]]:
    """The names of a kind in the modules that the document imports, each with the stem of its module."""
    stems = {name.rpartition("/")[2].removesuffix(_SUFFIX) for name in items_of(place.root, "imports")}
    return ((_stem(one), one) for one in known.of_kinds(kind) if _stem(one) in stems)


def _stem(one: DefinedName) -> str:
    return os.path.basename(one.key[1]).removesuffix(_SUFFIX)


def of_schema_server(path: str, place: TypedPlace) -> frozenset[str]:
    """The names that a server of schemas offers at a place, from the schema that a compile has written."""
    kind = kind_at(path)
    is_offered = kind in KINDS and not place.is_key and schema_keys.has_names(str(kind), place.keys)
    return names_offered(path) if is_offered else frozenset()
