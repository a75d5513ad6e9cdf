"""The paths in documents, and what becomes of them if files or folders are renamed."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping

import msgspec

from robocomp_yaml.diag.fix import WORD, Edit
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.component_references import stem
from robocomp_yaml.link.documents import read_tree
from robocomp_yaml.naming import names as kinds
from robocomp_yaml.naming.names import Names
from robocomp_yaml.naming.renaming import NameEdit
from robocomp_yaml.pipeline import Analysis
from robocomp_yaml.source.discover import WORKSPACE_FILE
from robocomp_yaml.source.disk import FOLDER, NOTHING, Disk
from robocomp_yaml.source.spelled import DocumentText
from robocomp_yaml.source.text import decode
from robocomp_yaml.source.tree import Mapping as MappingNode
from robocomp_yaml.source.tree import Node, Scalar
from robocomp_yaml.source.tree import Sequence as SequenceNode

_ANY = "*"
_IMPORTS = ("imports", _ANY)
_COMPONENT, _CONFIG = ("components", _ANY, "component"), ("components", _ANY, "config")
_GROUP = ("groups", _ANY, "as")
_PATHS = {
    "idsl": (_IMPORTS,),
    "cdsl": (_IMPORTS, ("parameters",), ("statemachine",), ("uses", "sources", _ANY), ("uses", "classes", _ANY)),
    "pdsl": (("component",),),
    "config": (("component",), ("extends", _ANY), ("legacy", "after")),
    "ddsl": (
        _COMPONENT, _CONFIG, _GROUP, ("components", _ANY, "cwd"), ("include", _ANY), ("groups", _ANY, "include"),
    ),
    "workspace": (("interfaces", _ANY), ("output", _ANY)),
}  # fmt: skip
"""Where documents have paths, by their kinds."""
_SUFFIX = ".idsl.yaml"


def edits_of_moves(analysis: Analysis, names: Names, moves: Mapping[str, str]) -> list[NameEdit]:
    """The edits after which all paths in documents refer to the same files, if these files and folders get other
    paths. `moves` maps real paths to real paths. The edits are those of the documents before they move."""
    return list(_Moved(analysis, names, _Moves(moves, analysis.disk)).edits())


def named_files(analysis: Analysis, names: Names, path: str) -> Iterator[tuple[Span, str]]:
    """The paths in a document that lead to a file, each with that file; imports are names."""
    unmoved = _Moved(analysis, names, _Moves({}, analysis.disk))
    for shown, real, kind, tree in unmoved.documents():
        for use in _paths(tree, kind) if shown == path else ():
            if use.key != _IMPORTS and (file := unmoved.file(use, real)):
                yield use.node.span, file


class _Moves(msgspec.Struct, frozen=True):
    moves: Mapping[str, str]
    disk: Disk

    def after(self, path: str) -> str:
        return _moved(path, self.moves)

    def before(self, path: str) -> str:
        return _moved(path, {new: old for old, new in self.moves.items()})

    def exists_after(self, path: str) -> bool:
        before = self.before(path)
        return self.disk.state(before) != NOTHING and self.after(before) == path


def _moved(path: str, moves: Mapping[str, str]) -> str:
    for old in sorted(moves, key=len, reverse=True):
        if path == old or path.startswith(os.path.join(old, "")):
            return moves[old] + path[len(old) :]
    return path


class _PathUse(msgspec.Struct, frozen=True):
    """A path in a document. `key` says where it is, as in `_PATHS`; `around` is the entry that contains it."""

    node: Scalar
    key: tuple[str, ...]
    around: Node | None


class _Moved:
    def __init__(self, analysis: Analysis, names: Names, moves: _Moves) -> None:
        self.analysis, self.names, self.moves, self.disk = analysis, names, moves, analysis.disk

    def edits(self) -> Iterator[NameEdit]:
        imports: set[Span] = set()
        for path, real, kind, tree in self.documents():
            for use in _paths(tree, kind):
                if use.key == _IMPORTS:
                    imports.add(use.node.span)
                    new = self._import(use.node.lexeme, path, real)
                else:
                    new = self._path(use, real)
                if new is not None and new != use.node.lexeme:
                    yield from self._spelled(path, use.node.span, use.node.lexeme, new)
        yield from self._qualifiers(imports)

    def documents(self) -> Iterator[tuple[str, str, str, Node]]:
        for real, document in self.analysis.documents.items():
            if document.tree is not None:
                yield document.path, real, document.kind, document.tree
        for settings in self.analysis.workspaces.declared:
            path = os.path.normpath(os.path.join(settings.root, WORKSPACE_FILE))
            tree, _ = read_tree(path, self.disk)
            if tree is not None:
                yield path, self.disk.real(path), "workspace", tree

    def file(self, use: _PathUse, document: str) -> str:
        """The real path of the file that a path means; '' if there is none."""
        found = (self._real(os.path.join(base, use.node.lexeme)) for base, _ in self._bases(use, document))
        return next((real for real in found if self.disk.state(real) not in (NOTHING, FOLDER)), "")

    def _path(self, use: _PathUse, document: str) -> str | None:
        text = use.node.lexeme
        if text.startswith("~"):
            return None
        for base, folder in self._bases(use, document):
            real = self._real(os.path.join(base, text))
            if self.disk.state(real) == NOTHING:
                continue
            wanted = self._wanted(use.key, real)
            if self._real_after(os.path.join(folder, text)) == wanted:
                return text
            if os.path.isabs(text):
                return wanted
            return _like(text, os.path.relpath(wanted, folder))
        return None

    def _bases(self, use: _PathUse, document: str) -> Iterator[tuple[str, str]]:
        """The folders to which a path may be relative, before and after."""
        folder = os.path.dirname(document)
        if use.key == _CONFIG and use.around is not None and (component := use.around.get("component")) is not None:
            home = self._real(os.path.join(folder, str(component.data)))
            if self.disk.has_folder(home):
                yield home, self._home_after(home)
            else:
                yield os.path.dirname(home), os.path.dirname(self.moves.after(home))
        yield folder, os.path.dirname(self.moves.after(document))

    def _home_after(self, folder: str) -> str:
        """The folder of a component afterwards, if a path means it by its folder."""
        moved = self._wanted(_COMPONENT, folder)
        return os.path.dirname(moved) if moved.endswith(".yaml") else moved

    def _wanted(self, key: tuple[str, ...], real: str) -> str:
        """What a path has to refer to afterwards. A folder that means its component means it where it moves to."""
        if key in (_COMPONENT, _GROUP) and self.disk.state(real) == FOLDER:
            found = [name for name in self.disk.documents(real) if name == "cdsl.yaml" or name.endswith(".cdsl.yaml")]
            if len(found) == 1:
                moved = self.moves.after(os.path.join(real, found[0]))
                if os.path.dirname(moved) != self.moves.after(real):
                    return moved
        return self.moves.after(real)

    def _import(self, text: str, document: str, real: str) -> str | None:
        workspace = self.analysis.workspaces.of(document)
        found, _ = self.analysis.search.find(text, document, workspace)
        if found is None:
            return None
        wanted, tail = self.moves.after(self.disk.real(found)), text if text.endswith(_SUFFIX) else f"{text}{_SUFFIX}"
        if not wanted.endswith(_SUFFIX):
            return None  # it is not a document of interfaces any more
        beside = os.path.dirname(self.moves.after(real))
        shared = [self.moves.after(self._real(one)) for one in (*workspace.interfaces, *self.analysis.search.extra)]

        def meant(tail: str) -> str:
            folders = [beside] if tail.startswith((".", "/")) else [beside, *shared]
            paths = (os.path.normpath(os.path.join(folder, tail)) for folder in folders)
            return next((path for path in paths if self.moves.exists_after(path)), "")

        if meant(tail) == wanted:
            return text
        folders = () if text.startswith(".") else (beside, *shared)
        inside = [os.path.relpath(wanted, folder) for folder in folders if _is_inside(wanted, folder)]
        new = next((one for one in inside if meant(one) == wanted), os.path.relpath(wanted, beside))
        return _like(text, new if text.endswith(_SUFFIX) else new.removesuffix(_SUFFIX))

    def _qualifiers(self, imports: set[Span]) -> Iterator[NameEdit]:
        """The names of files before the names of types: `Speech.Voice`."""
        for module in self.analysis.program.modules.values():
            path = module.module.path
            old, new = stem(path), stem(self.moves.after(self.disk.real(path)))
            if old == new:
                continue
            for span in set(self.names.uses.get((kinds.MODULE, path), ())) & self.names.paths - imports:
                text = new if new.isidentifier() else module.module.name
                yield from self._spelled(span.file, span, old, text)

    def _spelled(self, path: str, span: Span, old: str, new: str) -> Iterator[NameEdit]:
        raw, _ = self.disk.read(path)
        text = decode(path, raw)[0] if raw is not None else None
        if text is not None:
            document = self.disk.once(("text", path), lambda: DocumentText(path, text))
            yield from (NameEdit(one.span, one.text) for one in document.spelled(Edit(span, new, WORD, old)))

    def _real(self, path: str) -> str:
        return self.disk.real(os.path.normpath(path))

    def _real_after(self, path: str) -> str:
        """The real path of a path after the moves, if something is there then."""
        normal = os.path.normpath(path)
        return normal if self.moves.exists_after(normal) else ""


def _paths(tree: Node, kind: str) -> Iterator[_PathUse]:
    for key in _PATHS.get(kind, ()):
        for node, around in _at(tree, key, None):
            if isinstance(node, Scalar) and node.lexeme and "\n" not in node.lexeme and len(node.lexeme) < 1000:
                yield _PathUse(node, key, around)


def _at(node: Node, steps: tuple[str, ...], around: Node | None) -> Iterator[tuple[Node, Node | None]]:
    """The nodes at the end of these steps, each with the mapping that contains it."""
    if not steps:
        yield node, around
    elif steps[0] == _ANY:
        items: Iterable[Node] = node.children() if isinstance(node, (MappingNode, SequenceNode)) else ()
        for item in items:
            yield from _at(item, steps[1:], node if isinstance(node, MappingNode) else around)
    elif (inner := node.get(steps[0])) is not None:
        yield from _at(inner, steps[1:], node)


def _is_inside(path: str, folder: str) -> bool:
    return path.startswith(os.path.join(folder, ""))


def _like(text: str, new: str) -> str:
    """A relative path, written as another one: with `./` before it, or `/` at its end."""
    if text.startswith("./") and not new.startswith("."):
        new = f"./{new}"
    return f"{new}/" if text.endswith("/") and not new.endswith("/") else new


_SUFFIXES: dict[str, Callable[[str], str]] = {
    kinds.COMPONENT: lambda name: name.removesuffix("Comp") or name,
    kinds.MODULE: lambda name: name.removeprefix("RoboComp") or name,
}
_FILES = (kinds.COMPONENT, kinds.INTERFACE, kinds.TOPIC, kinds.MODULE, kinds.DEPLOYMENT)


def file_after(path: str, kind: str, old: str, new: str) -> str | None:
    """The path of a document that has the name of what it defines, after a renaming; None if it has another one."""
    own, short = stem(path), _SUFFIXES.get(kind, str)
    ways: tuple[Callable[[str], str], ...] = (
        str, str.lower, short, lambda name: short(name).lower(), lambda name: name[:1].lower() + name[1:],
        lambda name: short(name)[:1].lower() + short(name)[1:],
    )  # fmt: skip
    for way in ways if kind in _FILES and own else ():
        if way(old) == own and way(new) != own:
            return os.path.join(os.path.dirname(path), way(new) + os.path.basename(path)[len(own) :])
    return None
