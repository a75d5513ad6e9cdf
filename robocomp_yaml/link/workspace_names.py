"""The names of a workspace that its schemas offer to editors, by the kind of place where they are written.

They are read from the trees of the documents, so that a document with errors still has its names. They depend on the
documents of the workspace alone: neither on those that a command names, nor on other folders of the search path.
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Iterable, Iterator

from robocomp_yaml.link.documents import read_tree
from robocomp_yaml.link.workspace import SUFFIX, root_above
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source.discover import documents_below, kind_of
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.heading import text_at_top
from robocomp_yaml.source.relative import relative
from robocomp_yaml.source.schema_names import OfferedName, OfferedNames
from robocomp_yaml.source.tree import Mapping, Node, Scalar, Sequence

_NAME = pattern(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_ENTRY = pattern(r"[A-Za-z_][-A-Za-z0-9_.]*\Z")
_OWN = "x-"  # keys that rcyaml ignores


def names_below(root: str, disk: Disk | None = None) -> OfferedNames:
    """The names of the workspace of this folder."""
    disk = disk or Disk()
    return names_in(root, ((path, read_tree(path, disk)[0]) for path in documents_of(root, disk)), disk)


def names_in(root: str, trees: Iterable[tuple[str, Node | None]], disk: Disk) -> OfferedNames:
    """The names in the documents of a workspace, which are known with their trees."""
    collected = _Collected(root)
    for path, tree in trees:
        if isinstance(tree, Mapping):
            collected.add(path, kind_of(path, disk) or "", tree)
    return collected.offered()


def documents_of(root: str, disk: Disk) -> Iterator[str]:
    """The documents whose workspace is this one: those of a workspace below it are not its own."""
    own: dict[str, bool] = {}
    paths = disk.walked.get(root)
    for path in list(documents_below(root, disk=disk)) if paths is None else paths:
        folder = os.path.dirname(path)
        if folder not in own:
            above = root_above(folder, disk)
            own[folder] = _same(folder if above is None else above, root)
        if own[folder]:
            yield path


def _same(one: str, other: str) -> bool:
    return relative(one, other) == os.curdir


class _Collected:
    """Names while documents are added: by kind, and by name, with what each is."""

    def __init__(self, root: str) -> None:
        self._root = root
        self._names: dict[str, dict[str, list[str]]] = defaultdict(dict)
        self._modules: dict[str, list[tuple[str, str, str]]] = defaultdict(list)  # of interfaces and topics
        self._subscribed: set[str] = set()
        self._components: list[tuple[str, str]] = []
        self._deployments: list[tuple[str, str]] = []

    def add(self, path: str, kind: str, tree: Mapping) -> None:
        match kind:
            case "idsl":
                self._add_interfaces(path, tree)
            case "cdsl":
                self._components.append((path, text_at_top(tree, "component")))
                self._subscribed |= {name for section in ("publishes", "subscribes") for name in _ports(tree, section)}
            case "pdsl":
                self._add_keys("parameter types", tree, "types", f"type of {os.path.basename(path)}")
            case "ddsl":
                self._add_deployment(path, tree)

    def _add(self, kind: str, name: str, says: str) -> None:
        listed = self._names[kind].setdefault(name, [])
        if says not in listed:
            listed.append(says)

    def _add_keys(self, kind: str, tree: Mapping, section: str, says: str) -> None:
        for name, node in _members(tree, section):
            if _ENTRY.match(name):
                self._add(kind, name, says + _doc(node))

    def _add_interfaces(self, path: str, tree: Mapping) -> None:
        stem = os.path.basename(path).removesuffix(SUFFIX)
        module = text_at_top(tree, "module")
        if stem.endswith(".yaml") or not _NAME.match(module):
            return  # `idsl.yaml` cannot be imported by its name
        self._add("imports", stem, f"{self._from_root(path)}{_doc(tree)}")
        for kind in ("interfaces", "topics"):
            for name, node in _members(tree, kind):
                if _NAME.match(name):
                    self._modules[name].append((kind, module, f"{kind[:-1]} of {stem}{_doc(node)}"))
        for kind in ("types", "exceptions"):
            for name, node in _members(tree, kind):
                if _NAME.match(name) and _NAME.match(stem):
                    self._add(kind, f"{stem}.{name}", f"{kind[:-1]} of module {module}{_doc(node)}")

    def _add_deployment(self, path: str, tree: Mapping) -> None:
        self._deployments.append((path, text_at_top(tree, "deployment")))
        where = os.path.basename(path)
        self._add_keys("hosts", tree, "hosts", f"host of {where}")
        for section, kinds in (
            ("components", ("processes", "targets", "starts")), ("groups", ("targets", "starts")),
            ("include", ("targets", "starts")), ("services", ("starts",)),
        ):  # fmt: skip
            what = {"components": "entry", "groups": "group", "include": "group", "services": "service"}[section]
            for kind in kinds:
                self._add_keys(kind, tree, section, f"{what} of {where}")

    def offered(self) -> OfferedNames:
        for name, found in self._modules.items():
            is_unique = len({module for _, module, _ in found}) == 1
            for kind, module, says in found:
                text = name if is_unique else f"{module}.{name}"
                # RoboComp's own components publish to interfaces.
                is_topic = kind == "topics" or name in self._subscribed
                for list_, fits in (("interfaces", kind == "interfaces"), ("topics", is_topic), ("ports", True)):
                    if fits:
                        self._add(list_, text, says)
        self._add_paths()
        return tuple(
            (kind, tuple(OfferedName(name, "; ".join(sorted(says))) for name, says in sorted(names.items())))
            for kind, names in sorted(self._names.items())
        )

    def _add_paths(self) -> None:
        """Paths are relative to the folders of the deployments."""
        folders = sorted({os.path.dirname(path) for path, _ in self._deployments}) or [self._root]
        by_folder: dict[str, int] = defaultdict(int)
        for path, _ in self._components:
            by_folder[os.path.dirname(path)] += 1
        for folder in folders:
            seen = f", as seen from {self._from_root(folder)}" if len(folders) > 1 else ""
            for path, name in self._components:
                home = os.path.dirname(path)
                target = path if by_folder[home] > 1 or _same(home, folder) else home
                self._add("components", _relative(target, folder), f"component {name}{seen}")
            for path, name in self._deployments:
                self._add("deployments", _relative(path, folder), f"deployment {name}{seen}")

    def _from_root(self, path: str) -> str:
        return _relative(path, self._root)


def _relative(path: str, folder: str) -> str:
    return relative(path, folder).replace(os.sep, "/")


def _members(tree: Mapping, section: str) -> Iterator[tuple[str, Node]]:
    node = tree.get(section)
    for key, value in node.items() if isinstance(node, Mapping) else ():
        if not key.lexeme.startswith(_OWN):
            yield key.lexeme, value


def _ports(tree: Mapping, section: str) -> Iterable[str]:
    """The interfaces of a list of ports, without their modules."""
    node = tree.get(section)
    for item in node.items if isinstance(node, Sequence) else ():
        values = [value for _, value in item.items()] if isinstance(item, Mapping) else [item]
        for value in values:
            named = value.get("interface") if isinstance(value, Mapping) else value
            if isinstance(named, Scalar):
                yield named.lexeme.rpartition(".")[2]


def _doc(node: Node) -> str:
    """The first line of the documentation of a definition, after a colon."""
    doc = node.get("doc") if isinstance(node, Mapping) else None
    lines = doc.lexeme.strip().splitlines() if isinstance(doc, Scalar) else []
    return f": {lines[0]}" if lines else ""
