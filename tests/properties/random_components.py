"""Random components with interfaces, and random changes of these: for the test that merges them."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace
from pathlib import Path
from random import Random
from typing import Any

from robocomp_yaml import pipeline
from robocomp_yaml.diag.diagnostic import ERROR
from robocomp_yaml.emit.component import of_language
from robocomp_yaml.transactions.plan import ONCE, RootPlan

TYPES = ("int", "string", "bool", "float", "Pose", "Names", "Side")
WORDS = ("say", "stop", "move", "look", "reset", "grip", "turn", "wait", "home", "learn", "sing", "jump")

Methods = dict[str, dict[str, Any]]


@dataclass(frozen=True)
class Model:
    """Methods by interface, and a component: the interfaces that it implements, requires and subscribes to."""

    interfaces: dict[str, Methods]
    implements: tuple[str, ...] = ("Arm",)
    subscribes: tuple[str, ...] = ()
    requires: tuple[str, ...] = ()
    period: int = 100
    doc: str = ""
    extra: dict[str, str] = field(default_factory=dict)


def random_model(random: Random) -> Model:
    interfaces = {
        name: {word: _method(random) for word in random.sample(WORDS, random.randint(1, 4))}
        for name in ("Arm", "Leg", "Eye")
    }
    implements = random.choice([("Arm",), ("Arm", "Leg"), ("Arm", "Eye", "Leg")])
    return Model(interfaces, implements, random.choice([(), ("Eye",)]), random.choice([(), ("Leg",), ("Leg", "Eye")]))


def changed(model: Model, random: Random) -> Model:
    """The model after one to four changes, as a user makes them in the documents."""
    for _ in range(random.randint(1, 4)):
        model = random.choice(CHANGES)(model, random)
    return model


def plan(model: Model, language: str, folder: Path, root: Path) -> RootPlan:
    """The plan of the files that become the user's, for `root`; documents are written to `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    pose = {"struct": {"x": "float", "y": "float"}}
    types = {"Pose": pose, "Names": {"sequence": "string"}, "Side": {"enum": ["left", "right"]}}
    for name, methods in model.interfaces.items():
        document = {"module": f"RoboComp{name}", "types": types, "interfaces": {name: {"methods": methods}}}
        (folder / f"{name}.idsl.yaml").write_text(json.dumps(document))
    component = {
        "component": "Robot", "language": language, "imports": list(model.interfaces), "period": model.period,
        "implements": model.implements, "subscribes": model.subscribes, "requires": model.requires,
        **({"doc": model.doc} if model.doc else {}),
    }  # fmt: skip
    (folder / "robot.cdsl.yaml").write_text(json.dumps(component))
    analysis = pipeline.analyse([str(folder)])
    assert not [d for d in analysis.diagnostics if d.severity == ERROR], analysis.diagnostics
    (linked,) = analysis.program.components.values()
    files = tuple(file for file in of_language(linked) if file.policy == ONCE)
    return RootPlan(str(root), "robot.cdsl.yaml", files)


def _method(random: Random) -> dict[str, Any]:
    method: dict[str, Any] = {}
    if count := random.randint(0, 3):
        names = random.sample(("where", "fast", "name", "seconds"), count)
        method["in"] = {name: random.choice(TYPES) for name in names}
    if random.random() < 0.4:
        method["returns"] = random.choice(TYPES)
    if random.random() < 0.2:
        method["out"] = {name: random.choice(TYPES) for name in random.sample(("left", "done"), random.randint(1, 2))}
    if random.random() < 0.3:
        method["doc"] = random.choice(["Does it.", "Does it at once,\nand well.", "Ends what was begun."])
    return method


def _with_methods(model: Model, name: str, methods: Methods) -> Model:
    return replace(model, interfaces={**model.interfaces, name: methods})


def _some(model: Model, random: Random) -> tuple[str, Methods]:
    name = random.choice([*model.implements, *model.subscribes])
    return name, dict(model.interfaces[name])


def _add_method(model: Model, random: Random) -> Model:
    name, methods = _some(model, random)
    entries = list(methods.items())
    word = random.choice([word for word in WORDS if word not in methods])
    entries.insert(random.randint(0, len(entries)), (word, _method(random)))
    return _with_methods(model, name, dict(entries))


def _remove_method(model: Model, random: Random) -> Model:
    name, methods = _some(model, random)
    if len(methods) > 1:
        del methods[random.choice(list(methods))]
    return _with_methods(model, name, methods)


def _rename_method(model: Model, random: Random) -> Model:
    name, methods = _some(model, random)
    old = random.choice(list(methods))
    new = random.choice([word for word in WORDS if word not in methods])
    renamed = {new if word == old else word: method for word, method in methods.items()}
    return _with_methods(model, name, renamed)


def _change_method(model: Model, random: Random) -> Model:
    name, methods = _some(model, random)
    methods[random.choice(list(methods))] = _method(random)
    return _with_methods(model, name, methods)


def _implements(model: Model, random: Random) -> Model:
    return replace(model, implements=tuple(random.sample(("Arm", "Leg", "Eye"), random.randint(1, 3))))


def _subscribes(model: Model, random: Random) -> Model:
    return replace(model, subscribes=random.choice([(), ("Eye",), ("Leg",)]))


def _requires(model: Model, random: Random) -> Model:
    return replace(model, requires=random.choice([(), ("Leg",), ("Eye",), ("Leg", "Eye")]))


def _about(model: Model, random: Random) -> Model:
    about = ["", "A robot.", "A robot\nwith arms."]
    return replace(model, period=random.choice([20, 50, 100]), doc=random.choice(about))


CHANGES = (
    _add_method, _add_method, _remove_method, _rename_method, _change_method, _implements, _subscribes, _requires,
    _about,
)  # fmt: skip
