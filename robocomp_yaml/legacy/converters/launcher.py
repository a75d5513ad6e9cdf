"""Convert a launcher's list of components to a network, which becomes a deployment when the run's components are
known."""

from __future__ import annotations

from lark import Token, Tree

from robocomp_yaml.legacy.converters import toml
from robocomp_yaml.legacy.document import Notes
from robocomp_yaml.legacy.draft import DeploymentDraft, Reader, named_node
from robocomp_yaml.legacy.grammar import trees
from robocomp_yaml.legacy.networks import endpoint
from robocomp_yaml.legacy.networks.node import NetworkDraft
from robocomp_yaml.source import rcremote

_KEYS = {"name": "", "cwd": "cwd", "cmd": "program", "ice_name": "endpoints"}
"""The keys of a component, and the keys of the document that get their comments."""

_Pairs = dict[str, tuple[str, Tree[Token]]]


def convert(reader: Reader) -> DeploymentDraft | None:
    tree = toml.toml_tree(reader)
    return None if tree is None else _LauncherConverter(reader).draft(tree)


class _LauncherConverter:
    def __init__(self, reader: Reader) -> None:
        self.reader = reader
        self.network = NetworkDraft()

    def draft(self, tree: Tree[Token]) -> DeploymentDraft:
        head: Tree[Token] | None = None
        pairs: _Pairs = {}
        is_foreign = False
        for node in trees(tree):
            if node.data != "pair":
                self.component(head, pairs)
                is_foreign = node.data == "table" or _key(node) not in ("component", "components")
                head, pairs = None if is_foreign else node, {}
                if is_foreign:
                    self.reader.refused("foreign", node, f"[{_key(node)}]")
            elif is_foreign:
                continue  # its table is reported
            elif head is None or _key(node) not in _KEYS:
                self.reader.refused("foreign", node, _key(node))
            else:
                pairs[_key(node)] = (self.text(node), node)
        self.component(head, pairs)
        return DeploymentDraft(self.network, self.reader.placed.around)

    def component(self, head: Tree[Token] | None, pairs: _Pairs) -> None:
        if head is None:
            return
        texts = {key: text for key, (text, _) in pairs.items()}
        name = texts.get("name", "")
        at = pairs["name"][1] if "name" in pairs else head
        node = named_node(self.reader, self.network, name, at, self.reader.notes(head), at)
        node.by_key = {_KEYS[key]: self.reader.notes(pair) for key, (_, pair) in pairs.items()}
        node.notes.add(node.by_key.pop("", Notes()))
        node.command = rcremote.parse(texts.get("cmd", ""), texts.get("cwd", ""))
        node.endpoint = endpoint.parse(texts.get("ice_name", ""))
        if "ice_name" in pairs:
            node.endpoint_span = self.reader.span(pairs["ice_name"][1])
            if node.endpoint is None:
                node.extra.put("endpoint", texts["ice_name"])
        if node.endpoint is not None:
            node.interface = node.endpoint.identity

    def text(self, pair: Tree[Token]) -> str:
        value = trees(pair)[1]
        if value.data != "text":
            self.reader.refused("no_text", pair, _key(pair))
            return ""
        return toml.text(str(value.children[0]))


def _key(node: Tree[Token]) -> str:
    """Return the key of a pair or a table, as it is spelled."""
    return ".".join(str(part) for part in trees(node, "key")[0].children)
