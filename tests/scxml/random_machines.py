"""Random machines that tell what they do: each logs the states that it enters and leaves, driven by events that its
first state sends."""

from __future__ import annotations

import random
from dataclasses import dataclass, field
from pathlib import Path

from conftest import write_tree
from robocomp_yaml.diag.diagnostic import ERROR
from robocomp_yaml.model.statemachine import StateMachine
from robocomp_yaml.pipeline import analyse

EVENTS = ["e0", "e1", "e2", "e3"]
RAISED = ["r0", "r1", "r2"]  # a transition raises only later ones, so that every machine comes to rest

# Each event that it handles makes it raise the next one.
RUNAWAY = (
    '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" initial="a"><state id="a">'
    '<onentry><raise event="e"/></onentry><onexit><log label="out"/></onexit>'
    '<transition event="e"><raise event="e"/></transition></state></scxml>'
)


def odd_machines(folder: Path) -> dict[str, StateMachine]:
    """A few random machines, and one that never comes to rest."""
    texts = {**{f"m{seed}": Maker(seed).text() for seed in range(5)}, "runaway": RUNAWAY}
    return {name: read(text, folder / name) for name, text in texts.items()}


def read(text: str, folder: Path) -> StateMachine:
    """The machine of an SCXML document."""
    write_tree(folder, {"c.cdsl.yaml": "component: C\nlanguage: cpp\nstatemachine: c.scxml\n", "c.scxml": text})
    analysis = analyse([str(folder)])
    assert not [d for d in analysis.diagnostics if d.severity == ERROR], text
    [component] = analysis.program.components.values()
    assert component.machine is not None
    return component.machine


@dataclass(eq=False)
class Node:
    name: str
    kind: str
    parent: Node | None = None
    children: list[Node] = field(default_factory=list)

    def all(self) -> list[Node]:
        return [self, *(inner for child in self.children for inner in child.all())]

    def ancestors(self) -> list[Node]:
        return [self.parent, *self.parent.ancestors()] if self.parent else []


class Maker:
    """Makes one machine from a seed; a plain one has neither parallel states nor histories."""

    def __init__(self, seed: int, plain: bool = False) -> None:
        self.plain = plain
        self.random = random.Random(seed)
        self.count = 0

    def text(self) -> str:
        root = Node("", "state")
        root.children = [self._node(root, 3) for _ in range(self.random.randint(2, 4))]
        nodes = [node for node in root.all() if node is not root]
        sends = "".join(f'<send event="{self.random.choice(EVENTS)}"/>' for _ in range(12))
        begin = next(node for node in root.children if node.kind != "history")
        body = "".join(self._xml(node, nodes) for node in root.children)
        return (
            '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" initial="begin" datamodel="null">\n'
            f'<state id="begin"><onentry><send event="go"/>{sends}</onentry>'
            f'<transition event="go" target="{begin.name}"/></state>\n{body}</scxml>\n'
        )

    def _node(self, parent: Node, depth: int) -> Node:
        kinds = ["state", "state", "parallel"] if depth and not self.plain else ["state"]
        node = Node(f"s{self.count}", self.random.choice(kinds), parent)
        self.count += 1
        if depth and (node.kind == "parallel" or self.random.random() < 0.6):
            node.children = [self._node(node, depth - 1) for _ in range(self.random.randint(2, 3))]
            if self.random.random() < 0.3 and not self.plain:
                node.children.append(self._leaf(node, "history"))
            if node.kind == "state" and self.random.random() < 0.3:
                node.children.append(self._leaf(node, "final"))
        return node

    def _leaf(self, parent: Node, kind: str) -> Node:
        self.count += 1
        return Node(f"s{self.count - 1}", kind, parent)

    def _xml(self, node: Node, nodes: list[Node]) -> str:
        logs = f'<onentry><log label="in" expr="\'{node.name}\'"/></onentry>'
        logs += f'<onexit><log label="out" expr="\'{node.name}\'"/></onexit>'
        if node.kind == "final":
            return f'<final id="{node.name}">{logs}</final>\n'
        assert node.parent is not None
        if node.kind == "history":
            beside = [child for child in node.parent.children if child.kind in ("state", "parallel")]
            targets = beside if node.parent.kind == "parallel" else [self.random.choice(beside)]
            deep = self.random.choice(["deep", "shallow"])
            target = " ".join(target.name for target in targets)
            return f'<history id="{node.name}" type="{deep}"><transition target="{target}"/></history>\n'
        inside = [child for child in node.children if child.kind != "history"]
        initial = f' initial="{self.random.choice(inside).name}"' if inside and node.kind == "state" else ""
        transitions = self._transitions(node, nodes)
        body = "".join(self._xml(child, nodes) for child in node.children)
        return f'<{node.kind} id="{node.name}"{initial}>{logs}\n{transitions}{body}</{node.kind}>\n'

    def _transitions(self, node: Node, nodes: list[Node]) -> str:
        """None for an event that one before it always takes, which `check` refuses."""
        taken, kept = set(), ""
        for _ in range(self.random.randint(0, 3)):
            made = self._transition(node, nodes)
            event = made.split('"')[1]
            kept += made if event not in taken else ""
            if " cond=" not in made:
                taken.add(event)
        return kept

    def _transition(self, node: Node, nodes: list[Node]) -> str:
        number = self.random.randrange(-len(EVENTS), len(RAISED))
        event = RAISED[number] if number >= 0 else EVENTS[number]
        if self.random.random() < 0.1:
            event = f"done.state.{self.random.choice(nodes).name}"
        goal = self.random.choice(nodes)
        target = f' target="{goal.name}"' if self.random.random() < 0.85 else ""
        inside = node in goal.ancestors() and node.kind == "state"
        kind = ' type="internal"' if inside and target and self.random.random() < 0.5 else ""
        condition = f" cond=\"In('{self.random.choice(nodes).name}')\"" if self.random.random() < 0.2 else ""
        later = RAISED[max(number, -1) + 1 :]
        raised = f'<raise event="{self.random.choice(later)}"/>' if later and self.random.random() < 0.5 else ""
        if event.startswith("done"):
            raised = ""
        log = f'<log label="from" expr="\'{node.name}\'"/>'
        return f'<transition event="{event}"{target}{kind}{condition}>{log}{raised}</transition>\n'
