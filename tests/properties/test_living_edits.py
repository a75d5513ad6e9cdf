"""After any sequence of edits, the living analysis says the same as a fresh one: diagnostics, networks and values, and
what a compile of it does."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from conftest import write_tree
from robocomp_yaml import api
from robocomp_yaml.link.program import LinkedValues
from robocomp_yaml.source import parts
from robocomp_yaml.source.disk import DiskRecord
from verdicts import CASES

WORKSPACE = {
    "rcyaml.yaml": "interfaces: [interfaces]\nlint: {RC1103: off}\n",
    "interfaces/Pose.idsl.yaml": "module: RoboCompPose\ntypes:\n  Pose: {struct: {x: {type: float, unit: mm}, y: float}}\n",
    "interfaces/Arm.idsl.yaml": (
        "module: RoboCompArm\nimports: [Pose]\ninterfaces:\n"
        "  Arm: {methods: {moveTo: {in: {pose: Pose.Pose}, returns: bool}}}\n"
        "topics:\n  Moved: {methods: {hasMoved: {in: {pose: Pose.Pose}}}}\n"
    ),
    "interfaces/Eye.idsl.yaml": "module: RoboCompEye\ninterfaces:\n  Eye: {methods: {look: {in: {far: bool}}}}\n",
    "arm/arm.cdsl.yaml": (
        "component: ArmComp\nlanguage: python\nimports: [Arm, Eye]\nimplements: [Arm]\nrequires: [Eye]\n"
        "publishes: [Moved]\nperiod: 50\n"
    ),
    "arm/arm.pdsl.yaml": (
        "component: arm.cdsl.yaml\ntypes: {Joint: {struct: {name: string, limit: {type: int, default: 90}}}}\nparameters:\n  speed: {type: float, range: [0, 2], default: 1}\n"
        "  joints: {list: Joint, default: []}\n"
        "  camera: {group: {width: {type: int, default: 640}, token: string}}\n"
    ),
    "arm/etc/base.config.yaml": "component: ../arm.cdsl.yaml\nparameters: {speed: 0.5, camera: {token: {env: TOKEN}}}\n",
    "arm/etc/config.yaml": (
        "component: ../arm.cdsl.yaml\nextends: [base.config.yaml]\nparameters:\n  joints: [{name: elbow}]\n"
    ),
    "eye/eye.cdsl.yaml": "component: EyeComp\nlanguage: cpp\nimports: [Eye, Arm]\nimplements: [Eye]\nsubscribes: [Moved]\n",
    "eye/etc/config": "Endpoints.Eye=tcp -p 12000\nsize=3\n",
    "tool/tool.pdsl.yaml": "component: tool\nparameters:\n  device: string\n",
    "tool/tool.config.yaml": "component: tool.pdsl.yaml\nparameters: {device: /dev/null}\n",
    "robot.ddsl.yaml": (
        "deployment: Robot\nhosts: {left: 10.0.0.2, right: 10.0.0.3}\nservices: {storm: {icestorm: {host: left}}}\n"
        "components:\n  arm: {component: arm, host: left, connect: {Eye: eye0}, set: {speed: 1.5}}\n"
        "  'eye{i}': {component: eye, host: right, config: etc/config, instances: 2}\n"
        "  log: {program: sh, args: [-c, 'sleep 9'], host: right, after: [arm]}\n"
    ),
    "lab.ddsl.yaml": (
        "deployment: Lab\nservices: {storm: {icestorm: }}\ncomponents:\n  arm: {component: arm/arm.cdsl.yaml, connect: {Eye: eye1}}\n"
        "  eye1: {component: eye}\n  eye2: {component: eye}\n"
        "groups: {eyes: {components: [eye1, eye2]}}\n"
    ),
    "whole.ddsl.yaml": "deployment: Whole\ninclude: [robot.ddsl.yaml]\ncomponents:\n  more: {program: sleep, args: [9]}\n",
    "line.ddsl.yaml": (
        "deployment: Line\nhosts:\n  left: {address: 10.0.0.2, listen: any}\n  right: 10.0.0.3\n"
        "services: {storm: {icestorm: {host: left}}}\ncomponents:\n"
        + "".join(
            f"  arm{n}: {{component: arm, host: {'left' if n % 2 else 'right'}, connect: {{Eye: eye{n % 3}}}, "
            f"set: {{speed: 0.{n}}}, after: [eye0]}}\n"
            for n in range(9)
        )
        + "  eye0: {component: eye, host: left, port: 12000}\n  eye1:\n    component: eye\n    host: right\n"
        "  eye2: {component: eye, host: left, config: ../spare/spare.config.yaml}\n"
        "  'arm-{i}': {component: arm, host: left, connect: {Eye: eye0}, config: ../spare/spare.config.yaml, "
        "set: {camera.token: {env: TOKEN}}, instances: 3}\n"
        "groups: {eyes: {components: [eye1, eye2]}, right: {components: [arm0, arm2]}}\nlimits: {memory: 100 MiB}\n"
    ),
    "spare/spare.config.yaml": "parameters: {speed: 0.25}\n",
}  # fmt: skip
WORDS = (
    "Arm", "Eye", "Pose", "Moved", "ArmComp", "float", "int", "speed", "1.5", "50", "arm", "eye", "left", "token",
    "python", "moveTo", "0.5", "off", "etc/config", "[", "{", ": ", "RoboComp",
)  # fmt: skip
NEW = ("Leg", "spede", "string", "bool", "-3", "1e400", "ARM", "", "]", "'", "{}", "elbow", "warning", "# x\n", "\t")


@pytest.fixture(autouse=True, scope="module")
def short_documents_in_parts() -> Iterator[None]:
    """As if they were long."""
    before = parts.LONG, parts.FEW
    parts.LONG, parts.FEW = 0, 2
    yield
    parts.LONG, parts.FEW = before


class Edited:
    """A workspace on the disk with some unsaved documents, which are edited at random, and its living analysis."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.unsaved: dict[str, str] = {}
        self.living = api.follow()

    def step(self) -> str:
        random = self.random
        edits: list[Callable[[str], object]] = [
            self.shift, self.insert, self.insert, self.change, self.change, self.change, self.cut, self.repair, self.repair, self.save, self.remove,
            self.rename, self.close, self.copy,
        ]  # fmt: skip
        edit, name = random.choice(edits), random.choice([*WORKSPACE, *self.unsaved, *self.files()])
        edit(name)
        return f"{edit.__name__} {name}"

    def files(self) -> list[str]:
        return [os.path.join(where, name)[2:] for where, _, names in os.walk(".") for name in sorted(names)]

    def text(self, name: str) -> str:
        path = Path(name)
        return self.unsaved.get(name) or (path.read_text() if path.is_file() else WORKSPACE.get(name, ""))

    def put(self, name: str, text: str) -> None:
        if self.random.random() < 0.6:
            self.unsaved[name] = text
            self.living.edit(name, text)
        else:
            self.close(name)
            Path(name).parent.mkdir(parents=True, exist_ok=True)
            Path(name).write_text(text)

    def shift(self, name: str) -> None:
        self.put(name, f"# {self.random.random()}\n{self.text(name)}")

    def change(self, name: str) -> None:
        text, word = self.text(name), self.random.choice([word for word in WORDS if word in self.text(name)] or [""])
        self.put(name, text.replace(word, self.random.choice((*WORDS, *NEW)), 1) if word else text)

    def insert(self, name: str) -> None:
        lines = self.text(name).splitlines(keepends=True)
        at = self.random.randrange(len(lines) + 1)
        line = self.random.choice(
            ["\n", "# a word\n", "  more: {component: eye, host: left}\n", *lines[at : at + 1], ":\n"]
        )
        self.put(name, "".join([*lines[:at], line, *lines[at:]]))

    def cut(self, name: str) -> None:
        lines = self.text(name).splitlines(keepends=True)
        del lines[self.random.randrange(max(len(lines), 1)) :][:1]
        self.put(name, "".join(lines))

    def repair(self, name: str) -> None:
        self.put(name, WORKSPACE.get(name, ""))

    def save(self, name: str) -> None:
        if name in self.unsaved:
            Path(name).parent.mkdir(parents=True, exist_ok=True)
            Path(name).write_text(self.unsaved[name])
            self.close(name)

    def close(self, name: str) -> None:
        self.unsaved.pop(name, None)
        self.living.edit(name, None)

    def remove(self, name: str) -> None:
        self.close(name)
        Path(name).unlink(missing_ok=True)
        if self.random.random() < 0.1:
            shutil.rmtree(Path(name).parent if "/" in name else "arm", ignore_errors=True)

    def rename(self, name: str) -> None:
        if Path(name).is_file():
            other = self.random.choice((name.replace("arm", "leg"), name.replace("Arm", "Leg"), f"x{Path(name).name}"))
            Path(other).parent.mkdir(parents=True, exist_ok=True)
            Path(name).rename(other)

    def copy(self, name: str) -> None:
        self.put(f"{Path(name).parent}/copy-{Path(name).name}".removeprefix("./"), self.text(name))


def said(workspace: api.Workspace) -> tuple[object, ...]:
    analysis = workspace.analysis
    values = {
        real: analysis.program.effective(linked) for real, linked in analysis.program.values.items() if usable(linked)
    }
    return (
        workspace.check(),
        {path: repr(replace(network, settings={})) for path, network in workspace.networks.items()},
        {real: (effective and effective.data, faults) for real, (effective, faults) in values.items()},
        workspace.documents,
    )


def planned(workspace: api.Workspace) -> list[object]:
    """What a compile would write. `--watch` keeps the files of components whose documents are the same."""
    return [(plan.root, plan.owner, plan.files) for plan in workspace.compile()._built.plans]


def requested(workspace: api.Workspace) -> DiskRecord:
    """All that the analysis depends on: a stamp of the compile must have all of it, whether recalled or made."""
    return workspace.analysis.disk.record()


def usable(linked: LinkedValues) -> bool:
    return linked.parameters is not None and not linked.parameters.broken


@pytest.mark.parametrize("shown", ["whole", "document"])
@settings(max_examples=max(CASES // 10, 2), deadline=None, suppress_health_check=list(HealthCheck))
@given(seed=st.integers(0, 1 << 40))
def test_a_living_analysis_equals_a_fresh_one(tmp_path_factory: pytest.TempPathFactory, seed: int, shown: str) -> None:
    home, folder = os.getcwd(), tmp_path_factory.mktemp("living")
    os.chdir(folder)
    try:
        write_tree(Path(), WORKSPACE)
        edited, done = Edited(Random(seed)), list[str]()
        for _ in range(25):
            done.append(edited.step())
            if shown == "whole":
                living, fresh = edited.living.load(), api.load(overlay=edited.unsaved)
                assert requested(living) == requested(fresh), done
                assert said(living) == said(fresh), done
                assert planned(living) == planned(fresh), done
            else:
                edited.living.refresh()
                name = edited.random.choice([*WORKSPACE, *edited.unsaved])
                assert said(edited.living.look(name)) == said(api.load(name, overlay=edited.unsaved)), (done, name)
    finally:
        os.chdir(home)
        shutil.rmtree(folder)


def damaged(random: Random) -> str:
    """Somebody deletes, edits or links a file that rcyaml wrote, or that is the user's; or a whole folder goes."""
    written = sorted(os.path.join(where, name) for where, _, names in os.walk(".") for name in names)
    path = Path(random.choice([one for one in written if not one.endswith(".yaml")] or written))
    what = random.choice(["delete", "edit", "edit", "forbid", "link", "remove the folder"])
    if what == "delete":
        path.unlink()
    elif what == "edit" and not path.is_symlink():
        path.write_bytes(path.read_bytes()[random.randrange(2) :] + b"\n")
    elif what == "forbid":
        path.chmod(0o600)
    elif what == "link":
        moved = path.with_name(f"moved-{path.name}")
        path.rename(moved)
        path.symlink_to(random.choice([moved.name, "/nowhere/at/all", "../" * 9]))
    elif what == "remove the folder" and path.parent != Path() and ".yaml" not in " ".join(os.listdir(path.parent)):
        shutil.rmtree(path.parent)
    return f"{what} {path}"


@settings(max_examples=max(CASES // 20, 2), deadline=None, suppress_health_check=list(HealthCheck))
@given(seed=st.integers(0, 1 << 40))
def test_a_living_compile_does_the_same_as_a_fresh_one(tmp_path_factory: pytest.TempPathFactory, seed: int) -> None:
    """As `compile --watch`: the user changes documents and generated files alike between two runs."""
    home, folder = os.getcwd(), tmp_path_factory.mktemp("watched")
    os.chdir(folder)
    try:
        write_tree(Path(), WORKSPACE)
        random = Random(seed)
        edited, done = Edited(random), list[str]()
        for _ in range(12):
            if random.random() < 0.5:
                done.append(damaged(random))
            else:
                done.append(edited.step())
                for name in list(edited.unsaved):  # a compile reads what is saved
                    edited.save(name)
            living, fresh = edited.living.load().compile(), api.load().compile()
            assert living.look() == fresh.look(), done
            if random.random() < 0.8:
                living.apply()
    finally:
        os.chdir(home)
        shutil.rmtree(folder)
