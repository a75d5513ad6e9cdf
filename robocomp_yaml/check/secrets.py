"""Finds secrets in documents, so that no output shows them, and reports those that other users can read.

In a values document, the types of the parameters decide; in a deployment, the meaning of the keys. In a document with
errors, the names decide; in one that is no YAML, the lines are searched.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Iterator
from typing import TYPE_CHECKING

import msgspec

from robocomp_yaml import secrets
from robocomp_yaml.diag.codes import networks as network_codes
from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.hidden import Hidden
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.terminal import typed
from robocomp_yaml.link.documents import Document, read_tree
from robocomp_yaml.link.program import LinkedParameters, Program
from robocomp_yaml.semantics.references import is_sound
from robocomp_yaml.source import properties
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.secret_nodes import is_named, named_nodes, plain_below
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence, found_in, pairs_below

if TYPE_CHECKING:
    from robocomp_yaml.parameters.types import RecordType

_PROPERTIES = ("properties", "ice", "endpoints", "proxies", "topics")


class Secret(msgspec.Struct, frozen=True):
    """A secret that a document contains in plain text. `part` is the secret part of a longer text; `is_sure` is False
    if the use of the value is unknown."""

    node: Scalar
    part: str = ""
    is_sure: bool = True


Held = tuple[Document, tuple[Secret, ...]]
"""A document with the secrets that it surely contains."""


def held(program: Program, documents: Iterable[Document]) -> Iterator[Held]:
    """The documents with secrets."""
    finder = _SecretFinder(program)
    for document in documents:
        if document.kind in secrets.KINDS and document.model is not None and finder.may_hold(document):
            found = tuple(secret for secret in finder.secrets(document) if secret.is_sure)
            if found:
                yield document, found


def check(program: Program, found: Iterable[Held]) -> Iterator[Diagnostic]:
    """Warns about secrets in files that other users can read."""
    for document, secrets_ in found:
        if _others_can_read(document.path):
            yield from (_warning(document, secret) for secret in secrets_)
    yield from _of_configurations(program)


def _of_configurations(program: Program) -> Iterator[Diagnostic]:
    """Warns about secrets in flat configs, at the deployment that names them."""
    reported: set[tuple[str, str]] = set()
    for deployment in program.deployments.values():
        for instance in deployment.instances.values():
            path, config, component = instance.flat, instance.entry.config, instance.component
            location = (instance.document.path, os.path.realpath(path)) if path else ("", "")
            if config is None or location in reported:
                continue
            if path not in program.disk.contents or not _others_can_read(path):
                continue
            reported.add(location)
            names = _names([component.parameters] if component is not None else [])
            line = _line_of_secret(program.disk.contents[path].decode("utf-8", "replace"), names)
            if line:
                file, hint = os.path.relpath(path), f"`{typed('chmod', '600', os.path.relpath(path))}`"
                yield network_codes.OPEN_CONFIG.at(config.span, file=file, line=line, hint=hint)


def _line_of_secret(text: str, names: Collection[str]) -> int:
    """The number of the first line with a secret, as Ice reads it or as any other text; 0 if there is none."""
    if not secrets.may_hold(text) and not any(name in text for name in names):
        return 0
    for entry in properties.read(text).entries:
        is_set = entry.value and not entry.key.startswith(_COMMENT)
        if is_set and secrets.value(entry.key, entry.value, names) != entry.value:
            return entry.line
    lines = ["" if line.lstrip().startswith(_COMMENT) else line for line in text.splitlines()]
    return min(secrets.parts_of_lines(lines, names), default=-1) + 1


def hidden(program: Program, documents: Iterable[Document], files: set[str]) -> Hidden:
    """The parts of these files that must not be shown."""
    hidden_parts, finder = Hidden(), _SecretFinder(program)
    for document in documents:
        if document.path not in files:
            continue
        hidden_parts.files.add(document.path)
        if document.kind not in secrets.KINDS:
            for node in _in_extensions(document.tree):
                hidden_parts.add(node.span, node.lexeme)
        elif document.tree is None:
            _add_lines(hidden_parts, document, program.disk, finder.names)
        elif finder.names or finder.may_hold(document):  # a name may be misspelled
            for secret in finder.secrets(document):
                hidden_parts.add(secret.node.span, secret.part or secret.node.lexeme)
    return hidden_parts


_MORE = {"ddsl": ("set",), "pdsl": ("default",)}
"""Keys that may contain a secret under any name, for documents that cannot be parsed."""
_ALLOWED = {"values", "enum", "one-of"}
_COMMENT = ("#", ";", "//", "<!--")


def _others_can_read(path: str) -> bool:
    try:
        return bool(os.stat(path).st_mode & 0o044)
    except OSError:
        return False


def _warning(document: Document, secret: Secret) -> Diagnostic:
    mode = f"`{typed('chmod', '600', document.path)}`"
    code = network_codes.OPEN_SECRET if document.kind == "ddsl" else codes.OPEN_SECRET
    hint = {
        "config": f"{mode}, or write {{env: NAME}} or {{file: PATH}}",
        "ddsl": f"{mode}, or write {{env: NAME}} or {{file: PATH}}, under `env:` or `set:`",
        "pdsl": "remove the default, and set the value as {env: NAME} or {file: PATH}",
    }[document.kind]
    return code.at(secret.node.span, file=os.path.basename(document.path), hint=hint)


class _SecretFinder:
    def __init__(self, program: Program) -> None:
        self.program = program
        linked = [*program.parameters.values(), *(one.parameters for one in program.components.values())]
        self.names = _names(linked)

    def may_hold(self, document: Document) -> bool:
        """Whether a document may contain a secret; a quick test, which is False for most documents."""
        text = self.program.disk.contents.get(document.path, b"").decode("utf-8", "replace")
        is_alone = (
            document.kind != "pdsl" and document.real not in self.program.values
        )  # the types of its values are unknown
        return is_alone or secrets.may_hold(text) or any(name in text for name in self.names)

    def secrets(self, document: Document) -> tuple[Secret, ...]:
        """The secrets in a document, which are searched once in a run."""
        return self.program.disk.once(("secrets", document.real), lambda: tuple(self._secrets(document)))

    def _secrets(self, document: Document) -> Iterator[Secret]:
        tree = document.tree
        if not isinstance(tree, Mapping):
            return
        seen: set[Node] = set()
        for secret in self._of_kind(document, tree):
            if secret.node not in seen:
                seen.add(secret.node)
                yield secret
        for node in _in_extensions(tree):
            if node not in seen:
                seen.add(node)
                yield Secret(node, is_sure=False)
        for node in _texts(tree):
            text = node.lexeme
            if node not in seen and (masked := secrets.url(text)) != text:
                yield Secret(node, _between(text, masked))
            elif node not in seen and (masked := secrets.masked(text)) != text and (part := _between(text, masked)):
                yield Secret(node, part, is_sure=False)

    def _of_kind(self, document: Document, tree: Mapping) -> Iterator[Secret]:
        if document.model is None:  # it does not fit its schema: a secret may be anywhere
            yield from _of_defaults(tree) if document.kind == "pdsl" else _anywhere(tree, self.names)
        if document.kind == "config":
            yield from map(Secret, self._of_values(document, tree))
        elif document.kind == "ddsl":
            yield from self._of_deployment(document, tree)
        else:
            yield from map(Secret, self._of_parameters(document))
            yield from _of_allowed(tree)

    def _of_values(self, document: Document, tree: Mapping) -> Iterator[Scalar]:
        values = self.program.values.get(document.real)
        linked = values.parameters if values is not None else None
        parameters = tree.get("parameters")
        if linked is None:
            yield from named_nodes(tree, {*self.names, *_names_nearby(document.path, self.program.disk)})
            return
        if parameters is not None:
            yield from _of_type(linked.parameters.root, parameters)
        for section in _PROPERTIES:
            if (node := tree.get(section)) is not None:
                yield from named_nodes(node)

    def _of_parameters(self, document: Document) -> Iterator[Scalar]:
        """The defaults of secret parameters."""
        for linked in self.program.parameter_documents():
            if linked.document is not None and linked.document.path == document.path:
                from robocomp_yaml.parameters.hidden import of_defaults

                for type_ in (linked.parameters.root, *linked.parameters.types):
                    yield from of_defaults(type_)

    def _of_deployment(self, document: Document, tree: Mapping) -> Iterator[Secret]:
        linked = self.program.deployments.get(document.real)
        owners: dict[tuple[int, int], LinkedParameters] = {}
        for instance in linked.instances.values() if linked is not None else ():
            if instance.component is not None and instance.entry.settings is not None:
                span = instance.entry.settings.span
                if span.file == document.path:
                    owners[span.line, span.column] = instance.component.parameters
        components = tree.get("components")
        for entry in components.children() if components is not None else ():
            yield from found_in(_of_entry, components, entry, self.names) if components is not None else ()
            settings = entry.get("set")
            owner = owners.get((settings.span.line, settings.span.column)) if settings is not None else None
            if settings is not None and owner is not None and components is not None:
                yield from found_in(_of_settings, components, entry, owner.parameters.root)
            elif settings is not None and components is not None:
                yield from found_in(_of_unknown_settings, components, entry, self.names)


def _names(linked: Collection[LinkedParameters]) -> set[str]:
    """The names of the secret members of parameters."""
    if not linked:
        return set()
    from robocomp_yaml.parameters.hidden import secrets_of  # programs have no parameters

    return {name for one in linked for name in secrets_of(one)}


def _of_type(type_: RecordType, node: Node) -> Iterator[Scalar]:
    """Every secret value of this type below a node."""
    from robocomp_yaml.parameters.hidden import nodes

    return nodes(type_, node)


def _of_settings(entry: Node, root: RecordType) -> Iterator[Secret]:
    """The secrets in the settings of an entry, for a component with these parameters."""
    settings = entry.get("set")
    return map(Secret, _of_type(root, settings) if settings is not None else ())


def _of_unknown_settings(entry: Node, names: Collection[str]) -> Iterator[Secret]:
    """The secrets in the settings of an entry, if the parameters of its component are unknown."""
    if (settings := entry.get("set")) is not None:
        yield from map(Secret, named_nodes(settings, names))
        yield from _doubtful(settings) if entry.get("component") is not None else ()


def _of_entry(entry: Node, names: Collection[str]) -> Iterator[Secret]:
    """The secrets in an entry of a deployment, except those in its settings."""
    if (env := entry.get("env")) is not None:
        yield from map(Secret, named_nodes(env))
    for key in ("args", "ready"):
        yield from _words(entry.get(key), names)


def _anywhere(node: Node, names: Collection[str]) -> Iterator[Secret]:
    if isinstance(node, Sequence):
        yield from _words(node, names)
        for item in node.items:
            yield from _anywhere(item, names)
    elif isinstance(node, Mapping) and not is_sound(node.data):
        for key, value in node.items():
            if is_named(key, names):
                yield from map(Secret, plain_below(value))
            yield from found_in(_anywhere, node, value, names)


def _of_defaults(tree: Node) -> Iterator[Secret]:
    """The secret defaults in a parameter document that does not fit the schema."""
    for value in _secret_specifications(tree):
        yield from map(Secret, plain_below(default)) if (default := value.get("default")) is not None else ()


def _of_allowed(tree: Node) -> Iterator[Secret]:
    """The allowed values of a secret parameter: one of them is the secret."""
    for value in _secret_specifications(tree):
        for word in _ALLOWED & value.entries.keys():
            yield from _doubtful(value.entries[word][1])


def _secret_specifications(tree: Node) -> Iterator[Mapping]:
    """The specifications of parameters with a secret name or the key `secret`."""
    for key, value in pairs_below(tree):
        if isinstance(value, Mapping) and (secrets.is_secret(key.lexeme) or "secret" in value.entries):
            yield value


def _words(node: Node | None, names: Collection[str]) -> Iterator[Secret]:
    """Arguments that are secrets or contain one."""
    if isinstance(node, Mapping):
        node = node.get("command")
    if not isinstance(node, Sequence):
        return
    is_value = False  # of a secret option before it
    for item in node.items:
        yield from map(Secret, plain_below(item) if is_value else named_nodes(item))
        is_value = isinstance(item, Scalar) and item.lexeme.startswith("-") and secrets.is_one_of(item.lexeme, names)
    words = [item for item in node.items if isinstance(item, Scalar)]
    for item, shown in zip(words, secrets.words((item.lexeme for item in words), names), strict=True):
        if shown != item.lexeme:
            head, _, tail = shown.partition(secrets.HIDDEN)
            yield Secret(item, item.lexeme[len(head) : len(item.lexeme) - len(tail) or None])


def _doubtful(node: Node) -> Iterator[Secret]:
    return (Secret(value, is_sure=False) for value in plain_below(node))


def _in_extensions(node: Node | None) -> Iterator[Scalar]:
    """Secrets below the user's own keys (`x-…`), by name or by text."""
    if isinstance(node, Mapping):
        for key, value in node.items():
            if key.lexeme.startswith("x-"):
                yield from named_nodes(value)
                yield from plain_below(value) if secrets.is_secret(key.lexeme) else ()
                yield from (one for one in plain_below(value) if secrets.masked(one.lexeme) != one.lexeme)
            else:
                yield from found_in(_in_extensions, node, value)
    for item in node.items if isinstance(node, Sequence) else ():
        yield from _in_extensions(item)


def _texts(node: Node) -> Iterator[Scalar]:
    """Every text that may contain a secret such as a URL with a password."""
    if isinstance(node, Scalar):
        yield from (node,) if secrets.may_hold(node.lexeme) else ()
    children = (value for key, value in node.items() if key.lexeme != "doc") if isinstance(node, Mapping) else None
    for child in children or node.children():
        yield from found_in(_texts, node, child)


def _between(text: str, masked: str) -> str:
    head, _, tail = masked.partition(secrets.HIDDEN)
    return text[len(head) : len(text) - len(tail)] if secrets.HIDDEN not in tail else text


def _add_lines(hidden_parts: Hidden, document: Document, disk: Disk, names: Collection[str]) -> None:
    """Adds the secret parts of the lines of a document that is no YAML."""
    text = disk.contents.get(document.path, b"").decode("utf-8-sig", "replace")
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    nearby = _names_nearby(document.path, disk) if document.kind == "config" else ()
    known = {*names, *nearby, *_MORE.get(document.kind, ())}
    for number, parts in secrets.parts_of_lines(lines, known).items():
        for start, end in parts:
            span = Span(document.path, number + 1, start + 1, number + 1, end + 1)
            part = lines[number][start:end]
            for text in (part.strip("\"' "), *re.findall(r"[^\s\"'!&*@{}\[\],]{4,}", part)):
                hidden_parts.add(span, text)


def _names_nearby(path: str, disk: Disk) -> Iterator[str]:
    """The names of secret parameters in the parameter documents of a document's folder and of the folder above."""
    folder = os.path.dirname(path) or "."
    for where in (folder, os.path.join(folder, os.pardir)):
        names = [name for name in disk.documents(where) if name.endswith("pdsl.yaml")]
        for name in names[:20]:
            tree, _ = read_tree(os.path.join(where, name), disk)
            for key, value in pairs_below(tree) if tree is not None else ():
                if isinstance(value, Mapping) and value.data.get("secret") is True:  # type: ignore[attr-defined]
                    yield key.lexeme
