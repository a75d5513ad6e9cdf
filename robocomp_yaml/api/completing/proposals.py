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

from robocomp_yaml.api.completing import machines, others, schema_keys, values
from robocomp_yaml.api.completing.paths import paths
from robocomp_yaml.api.completing.places import MARK, TypedPlace
from robocomp_yaml.api.completing.proposal import CODE, PATH, VALUE, Proposal
from robocomp_yaml.api.schemas import names_offered
from robocomp_yaml.check.pdsl.values import port_names
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import IMPORT, Edit
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedParameters, Program
from robocomp_yaml.naming import names
from robocomp_yaml.naming.names import DefinedName, Names
from robocomp_yaml.parameters.specification.expression import FUNCTIONS
from robocomp_yaml.parameters.types import RecordType
from robocomp_yaml.parameters.words import label
from robocomp_yaml.source.discover import KINDS, WORKSPACE_FILE, kind_of
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.spelled import DocumentText
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence
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
    present = _siblings(place)
    modules = dict.fromkeys(importable)  # in their order, and looked up for each name
    match kind:
        case "idsl":
            found = _in_interfaces(path, place, known, modules)
        case "cdsl":
            found = chain(_in_component(path, place, known, modules), machines.proposals(place))
        case "pdsl":
            found = chain(
                _in_parameters(place, known),
                _in_constraint(path, place, known),
                _component_paths(path, place, known, "component"),
            )
        case "ddsl":
            found = chain(_in_deployment(path, place, known), _set_values(path, place, program))
            found = chain(found, _ports_of_entry(path, place, program), _of_groups(place, program, path))
        case "config":
            found = chain(_in_values(path, place, program, with_schema=with_schema),
                          _component_paths(path, place, known, "component"))  # fmt: skip
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
    if place.has_colon and (one.snippet or one.text).endswith(": "):
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
    yield from schema_keys.keys_at(kind, place.keys, _siblings(place))


def _siblings(place: TypedPlace) -> list[str]:
    """The keys of the mapping, or the plain elements of the list, in which something is typed."""
    if isinstance(place.around, Sequence):
        return [one.lexeme for one in place.around.items if isinstance(one, Scalar) and MARK not in one.lexeme]
    return [key for key in place.around.entries if key != MARK] if place.around is not None else []


def _in_values(path: str, place: TypedPlace, program: Program | None, *, with_schema: bool) -> Iterator[Proposal]:
    """Values and, without a server of schemas, keys in a values document."""
    component = place.root.get("component")
    if program is None or not with_schema:
        return
    linked = values.parameters_for(program, path, str(component.data) if component is not None else "")
    if linked is None:
        return
    if place.keys[:1] == ("parameters",):
        yield from _at_parameter(linked, place, place.keys[1:])
    elif place.is_key and linked.component is not None and place.keys in (known := port_names(linked.component)):
        what, ports = known[place.keys]
        yield from (Proposal(one, names.INTERFACE, what, snippet=f"{one}: ") for one in ports)


def _at_parameter(linked: LinkedParameters, place: TypedPlace, steps: tuple[str, ...]) -> Iterator[Proposal]:
    """The values of the parameter at a path, or the names of the parameters or members there. Behind a dot, those of
    groups with their path."""
    root = linked.parameters.root
    head = place.word.rpartition(".")[0] if place.is_key else ""
    inner = values.member_at(root, (*steps, head) if head else steps) if steps or head else None
    if not place.is_key:
        yield from values.values_of(inner) if inner is not None else ()
        if steps[-1:] != ("",):  # else a record may be begun
            return
    record = inner.type if inner is not None else root if not (steps or head) else None
    for one in record.members if isinstance(record, RecordType) else ():
        name = f"{head}.{one.name}" if head else one.name
        yield Proposal(name, names.PARAMETER, label(one.type), one.doc, snippet=f"{name}: ")


def _set_values(path: str, place: TypedPlace, program: Program | None) -> Iterator[Proposal]:
    """Parameters under `set:` of an entry and their values, which no schema knows."""
    match place.keys:
        case ("components", entry, "set", *steps) if (steps or place.is_key) and program is not None:
            linked = _parameters_of(path, place, entry, program)
            yield from _at_parameter(linked, place, tuple(steps)) if linked is not None else ()


def _parameters_of(path: str, place: TypedPlace, entry: str, program: Program) -> LinkedParameters | None:
    components = place.root.get("components")
    of_entry = components.get(entry) if components is not None else None
    component = of_entry.get("component") if of_entry is not None else None
    return values.parameters_for(program, path, str(component.data)) if component is not None else None


def _ports_of_entry(path: str, place: TypedPlace, program: Program | None) -> Iterator[Proposal]:
    """The ports of an entry's component, as keys; and the topics of a deployment."""
    match place.keys:
        case ("components", entry, "connect" | "topics" | "ports" | "endpoints" as section) if (
            place.is_key and program is not None
        ):
            linked = _parameters_of(path, place, entry, program)
            component = linked.component if linked is not None else None
            if component is None:
                return
            lists = {
                "connect": (("requires", component.requires),),
                "topics": (("publishes", component.publishes), ("subscribes", component.subscribes)),
            }.get(section, (("implements", component.implements), ("subscribes", component.subscribes)))  # fmt: skip
            present = _siblings(place)
            for what, ports in lists:
                for port in ports:
                    if port.name not in present:
                        yield Proposal(port.name, names.INTERFACE, f"{what} {port.interface.name}", port.interface.doc)
        case ("components", _, "topics", name) if not place.is_key:
            yield from (Proposal(topic, names.TOPIC, "topic of this deployment") for topic in _topics(place.root, name))


def _topics(root: Mapping, own: str) -> list[str]:
    """The names of topics that a deployment writes; that of the port itself comes first."""
    found = {own: None}
    components = root.get("components")
    for _, entry in components.items() if isinstance(components, Mapping) else ():
        topics = entry.get("topics")
        for _, value in topics.items() if isinstance(topics, Mapping) else ():
            if isinstance(value, Scalar) and value.lexeme and MARK not in value.lexeme:
                found[value.lexeme] = None
    return list(found)


def _of_groups(place: TypedPlace, program: Program | None, path: str) -> Iterator[Proposal]:
    """Members and methods of what a group exposes."""
    match place.keys:
        case ("groups", group, "expose", _) | ("groups", group, "expose", _, "member") if not place.is_key:
            groups = place.root.get("groups")
            listed = groups.get(group) if groups is not None else None
            yield from (Proposal(name, names.ENTRY) for name in _items_of(listed, "components"))
        case ("groups", _, "expose", interface, "allow", *_) if not place.is_key and program is not None:
            for scope in program.modules.values():
                for one in scope.module.interfaces:
                    if one.name == interface:
                        yield from (Proposal(each.name, names.METHOD, "", each.doc) for each in one.methods)


def _component_paths(path: str, place: TypedPlace, known: Names, key: str) -> Iterator[Proposal]:
    """The documents of components, as `component:` of parameters and values names them."""
    if place.keys == (key,) and not place.is_key:
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
    own = {os.path.basename(path).removesuffix(_SUFFIX), *_items(place.root, "imports")}
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
    yield from (Proposal(name, kind, f"{kind} of this module") for name in _keys(place.root, section))
    for stem, one in _of_imported(place, known, kind):
        yield Proposal(f"{stem}.{one.name}", kind, one.says, one.doc)


def _enumerators(place: TypedPlace, known: Names) -> Iterator[Proposal]:
    """The enumerators of the type beside a default or a constant, and the values to which it is limited."""
    node: Node | None = place.root
    for key in place.keys[:-1]:
        node = node.get(key) if node is not None else None
    of = node.get("type") if node is not None else None
    stem, _, name = of.lexeme.rpartition(".") if isinstance(of, Scalar) else ("", "", "")
    limited = node.get("values") if node is not None else None
    for each in limited.items if isinstance(limited, Sequence) else ():
        yield Proposal(flow(each.data), VALUE, "one of values")
    if name == "bool" and limited is None:
        yield from (Proposal(one, VALUE, "bool") for one in ("true", "false"))
    types = place.root.get("types")
    own = types.get(name) if types is not None and not stem else None
    listed = own.get("enum") if own is not None else None
    found = [key.lexeme for key, _ in listed.items()] if isinstance(listed, Mapping) else _items_of(own, "enum")
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
        yield from (Proposal(name, names.TYPE, "type of this document") for name in _keys(place.root, "types"))


def _in_constraint(path: str, place: TypedPlace, known: Names) -> Iterator[Proposal]:
    """Parameters by their paths, functions, and, behind a dot, members of records (`m.min` of `for m in motors`)."""
    if not place.is_in_expression:
        return
    defined = {one.key: one for one in known.in_document(path)}

    def dotted(one: DefinedName) -> str:
        outer = defined.get(one.inside)
        return f"{dotted(outer)}.{one.name}" if outer and outer.kind == names.PARAMETER else one.name

    head, dot, _ = place.word.rpartition(".")
    for one in defined.values():
        if one.kind == names.PARAMETER:
            yield Proposal(dotted(one), one.kind, one.says, one.doc)
        elif one.kind == names.PARAMETER_MEMBER and dot:
            yield Proposal(f"{head}.{one.name}", one.kind, one.says, one.doc)
    if not dot:
        yield from (Proposal(name, VALUE, "function", snippet=f"{name}(") for name in FUNCTIONS)


def _in_deployment(path: str, place: TypedPlace, known: Names) -> Iterator[Proposal]:
    keys, root = place.keys, place.root
    entries = [name for name in _keys(root, "components") if keys[:2] != ("components", name)]
    others = [*_keys(root, "groups"), *_keys(root, "services")]
    match keys:
        case ("components" | "groups" | "services", _, *_, "host") if not place.is_key:
            yield from (Proposal(name, names.HOST) for name in _keys(root, "hosts"))
        case ("components", _, "component") | ("groups", _, "as") if not place.is_key:
            for one in known.of_kinds(names.COMPONENT):
                folder = os.path.relpath(os.path.dirname(one.span.file), os.path.dirname(path))
                yield Proposal(folder, names.COMPONENT, one.says, one.doc)
        case ("components", _, "connect" | "process", *_) if not place.is_key:
            yield from (Proposal(name, names.ENTRY) for name in (*entries, *_keys(root, "groups")))
        case ("components", _, "after", *_) if not place.is_key:
            yield from (Proposal(name, names.ENTRY) for name in (*entries, *others))
        case ("groups", _, "components", *_) if not place.is_key:
            yield from (Proposal(name, names.ENTRY) for name in entries)


def _of_imported(place: TypedPlace, known: Names, kind: str) -> Iterator[tuple[str, DefinedName]]:
    """The names of a kind in the modules that the document imports, each with the stem of its module."""
    stems = {name.rpartition("/")[2].removesuffix(_SUFFIX) for name in _items(place.root, "imports")}
    return ((_stem(one), one) for one in known.of_kinds(kind) if _stem(one) in stems)


def _stem(one: DefinedName) -> str:
    return os.path.basename(one.key[1]).removesuffix(_SUFFIX)


def _keys(root: Mapping, section: str) -> list[str]:
    found = root.get(section)
    return [key.lexeme for key, _ in found.items()] if isinstance(found, Mapping) else []


def _items(root: Mapping, section: str) -> list[str]:
    return _items_of(root, section)


def _items_of(root: Node | None, section: str) -> list[str]:
    found = root.get(section) if root is not None else None
    return [str(item.data) for item in found.items] if isinstance(found, Sequence) else []


def of_schema_server(path: str, place: TypedPlace) -> frozenset[str]:
    """The names that a server of schemas offers at a place, from the schema that a compile has written."""
    kind = kind_at(path)
    is_offered = kind in KINDS and not place.is_key and schema_keys.has_names(str(kind), place.keys)
    return names_offered(path) if is_offered else frozenset()
