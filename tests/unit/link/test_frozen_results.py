"""The results of passes never change: whatever a program and its networks consist of is frozen."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import msgspec

from in_memory import analysed
from robocomp_yaml.digraph import reachable

DOCUMENTS = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Mouth.idsl.yaml": "module: RoboCompMouth\ntypes: {P: {struct: {x: {type: int, default: 1}}}, E: {enum: [a]}}\n"
    "constants: {C: {type: int, value: 1}}\ninterfaces: {Mouth: {methods: {move: {in: {p: P}, returns: E}}}}\n"
    "topics: {Said: {methods: {heard: {in: {text: string}}}}}\n",
    "mouth/mouth.cdsl.yaml": "component: Mouth\nlanguage: python\nimports: [Mouth]\nimplements: [Mouth]\npublishes: [Said]\n"
    "statemachine:\n  initial: idle\n  events: [tired]\n  states: {idle: {}, busy: {entry: [{send: tired, after: 5 s}]}}\n"
    "  transitions: {idle: {event: tired, to: busy, if: low}, busy: {event: tired, to: idle}}\n",
    "mouth/mouth.pdsl.yaml": "component: mouth.cdsl.yaml\ntypes: {M: {struct: {name: string, low: {type: int, default: 1}}}}\n"
    "parameters: {ms: {list: M, size: [1, 3]}, on: {type: bool, default: true}, t: {type: string, pattern: 'a+', default: a}}\n"
    "constraints: ['all(m.low < 3 for m in ms)']\nlegacy: {ms: {key: 'M{i}', columns: [name, low]}}\n",
    "mouth/etc/config.yaml": "component: ../mouth.cdsl.yaml\nparameters: {ms: [{name: a}]}\n",
    "speech/speech.cdsl.yaml": "component: Speech\nlanguage: cpp\nimports: [Mouth]\nrequires: [Mouth]\nsubscribes: [Said]\n",
    "head.ddsl.yaml": "deployment: Head\nservices: {storm: {icestorm: {port: 9999}}}\ncomponents:\n"
    "  mouth: {component: mouth, set: {on: false}}\n  speech: {component: speech, after: [mouth]}\n"
    "groups: {face: {components: [mouth], expose: {Mouth: mouth}}}\n",
}  # fmt: skip


def parts(whole: object) -> Iterable[object]:
    """What an object consists of. Nodes and the disk are what was read; results refer to them."""
    if isinstance(whole, msgspec.Struct):
        inner: Iterable[object] = (getattr(whole, name) for name in whole.__struct_fields__ if name[0] != "_")
    elif isinstance(whole, Mapping):
        inner = (*whole.keys(), *whole.values())
    else:
        inner = whole if isinstance(whole, tuple | list | set | frozenset) else ()
    return [Part(one) for one in inner]


class Part:
    """An object by its identity: results need not be hashable."""

    def __init__(self, it: object) -> None:
        self.it = it

    def __hash__(self) -> int:
        return id(self.it)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Part) and other.it is self.it


def test_the_results_of_passes_are_frozen() -> None:
    analysis = analysed(DOCUMENTS)
    assert [one for one in analysis.diagnostics if one.severity == "error"] == []
    results = analysis.program, analysis.networks, analysis.documents, analysis.workspaces, analysis.search
    found = reachable(map(Part, results), lambda part: parts(part.it))
    types = {type(part.it) for part in found if isinstance(part.it, msgspec.Struct)}
    names = {one.__name__ for one in types}
    assert names >= {
        "Program",
        "LinkedModule",
        "LinkedDeployment",
        "StateMachine",
        "ResolvedMember",
        "Network",
        "Process",
    }
    assert {one.__name__ for one in types if not one.__struct_config__.frozen} == set()
