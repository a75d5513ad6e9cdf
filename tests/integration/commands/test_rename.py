"""`rcyaml rename`: what is written, what is refused, and with which exit code."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

PLACE = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Arm.idsl.yaml": (
        "module: RoboCompArm\ninterfaces:\n  Arm:\n    methods:\n"
        "      reach: {in: {goal: float}, out: {rest: float}}  # mm\n      stop:\n"
        "topics: {Reached: {methods: {reach: {in: {goal: float}}}}}\n"
    ),
    "arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\nimports: [Arm]\nimplements: [Arm]\n",
    "arm/src/specificworker.py": (
        "from genericworker import GenericWorker\n\n\nclass SpecificWorker(GenericWorker):\n"
        "    def Arm_reach(self, goal):\n        return goal - 1\n\n    def Arm_stop(self):\n        goal = 2\n"
    ),
    "robot.ddsl.yaml": "deployment: Robot\ncomponents: {arm: {component: arm}, legs: {program: sh}}\n",
    "arm.mock.yaml": (
        "interfaces:\n  Arm: {methods: {reach: [{out: {rest: 1}}, {out: {rest: 2}, delay: 1 ms}]}}\n"
        "topics:\n  Reached: {messages: [{reach: {goal: 3}}]}\n"
    ),
}


@pytest.fixture
def ws(rcyaml: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = write_tree(tmp_path / "ws", PLACE)
    monkeypatch.chdir(folder)
    return folder


def test_an_argument_is_renamed_in_documents_and_scripts(ws: Path, rcyaml: Callable[..., Result]) -> None:
    ran = rcyaml("rename", "Arm.reach.rest", "left")
    assert ran.exit_code == 0, ran.output
    assert "out: {left: float}}  # mm\n" in (ws / "interfaces/Arm.idsl.yaml").read_text()
    assert "[{out: {left: 1}}, {out: {left: 2}, delay" in (ws / "arm.mock.yaml").read_text()
    assert (ws / "arm/src/specificworker.py").read_text() == PLACE["arm/src/specificworker.py"], "it is its own name"
    assert rcyaml("check").exit_code == 0


def test_the_argument_of_one_method_is_not_that_of_another(ws: Path, rcyaml: Callable[..., Result]) -> None:
    ran = rcyaml("rename", "goal", "to")
    assert ran.exit_code == 2 and "argument in interfaces/Arm.idsl.yaml:5:" in ran.output
    ran = rcyaml("rename", "Reached.reach.goal", "to")
    assert ran.exit_code == 0, ran.output
    assert "{reach: {to: 3}}" in (ws / "arm.mock.yaml").read_text()
    assert "reach: {in: {goal: float}" in (ws / "interfaces/Arm.idsl.yaml").read_text()


def test_a_renamed_interface_takes_its_arguments_along(ws: Path, rcyaml: Callable[..., Result]) -> None:
    ran = rcyaml("rename", "interface:Arm", "Limb")
    assert ran.exit_code == 0, ran.output
    assert "def Limb_reach(self, goal):" in (ws / "arm/src/specificworker.py").read_text()
    assert rcyaml("rename", "Limb.reach.rest", "left").exit_code == 0


@pytest.mark.parametrize("old", ["Arm", "arm"])
@pytest.mark.parametrize("proxy", ["arm:tcp -h {host} -p 10021", '"arm" -t:tcp -p 10021 -h {host}', "arm @ Adapter"])
def test_a_renamed_interface_takes_the_identities_in_proxies_along(
    ws: Path, rcyaml: Callable[..., Result], old: str, proxy: str
) -> None:
    local, remote = proxy.format(host="localhost"), proxy.format(host="10.0.0.7")
    interface = (ws / "interfaces/Arm.idsl.yaml").read_text().replace("  Arm:", f"  {old}:")
    user = f"language: python\nimports: [Arm]\nrequires: [{old}]\n"
    write_tree(
        ws,
        {
            "interfaces/Arm.idsl.yaml": interface,
            "arm/arm.cdsl.yaml": f"component: ArmComp\nlanguage: python\nimports: [Arm]\nimplements: [{old}]\n",
            "arm.mock.yaml": "topics:\n  Reached: {messages: [{reach: {goal: 3}}]}\n",
            "user/user.cdsl.yaml": f"component: UserComp\n{user}",
            "user/etc/config": f"# of the user\n{old}Proxy = {local}\n",
            "head/head.cdsl.yaml": f"component: HeadComp\n{user}",
            "head/etc/config.yaml": f"component: ../head.cdsl.yaml\nproxies:\n  {old}: '{local}'  # near\n",
            "robot.ddsl.yaml": "deployment: Robot\ncomponents:\n  arm: {component: arm}\n"
            f"  head: {{component: head, connect: {{{old}: arm}}}}\n"
            f"  user: {{component: user, connect: {{{old}: '{remote}'}}}}\n",
        },
    )
    (ws / "arm/src/specificworker.py").unlink()
    ran = rcyaml("rename", f"interface:{old}", "Limb")
    assert ran.exit_code == 0, ran.output
    assert (ws / "user/etc/config").read_text() == f"# of the user\nLimbProxy = {local.replace('arm', 'limb')}\n"
    assert f"  Limb: '{local.replace('arm', 'limb')}'  # near\n" in (ws / "head/etc/config.yaml").read_text()
    robot = (ws / "robot.ddsl.yaml").read_text()
    assert f"connect: {{Limb: '{remote.replace('arm', 'limb')}'}}" in robot
    assert "connect: {Limb: arm}" in robot, "an entry has a name of its own"


def test_what_values_in_scripts_name_is_renamed(ws: Path, rcyaml: Callable[..., Result]) -> None:
    """Members, also of exceptions and inside lists and maps, enumerators and exceptions."""
    write_tree(
        ws,
        {
            "interfaces/Eye.idsl.yaml": (
                "module: RoboCompEye\n"
                "types:\n  Mode: {enum: [idle, moving]}\n  P: {struct: {xx: int, mode: Mode}}\n  Ps: {sequence: P}\n"
                "  ByName: {map: {key: string, value: Mode}}\n  ByMode: {map: {key: Mode, value: P}}\n"
                "exceptions: {Lost: {struct: {where: P}}}\n"
                "interfaces:\n  Eye:\n    methods:\n      look: {out: {ps: Ps, modes: ByName, of: ByMode}, returns: Mode, throws: [Lost]}\n"
                "topics: {Seen: {methods: {saw: {in: {p: P}}}}}\n"
            ),
            "eye.mock.yaml": (
                "interfaces:\n  Eye:\n    methods:\n      look:\n"
                "        - {out: {ps: [{xx: 1, mode: moving}], modes: {left: 'moving'}, of: {moving: {xx: 2, mode: idle}}}, returns: moving}\n"
                '        - throws: {Lost: {where: {xx: 3, mode: "moving"}}}\n'
                "topics:\n  Seen: {messages: [{saw: {p: {xx: 4, mode: moving}}}]}\n"
            ),
        },
    )
    before = (ws / "eye.mock.yaml").read_text()
    assert rcyaml("check").exit_code == 0
    for old, new in (("xx", "yy"), ("moving", "running"), ("Lost", "Gone"), ("Gone.where", "there")):
        ran = rcyaml("rename", old, new)
        assert ran.exit_code == 0, ran.output
        assert rcyaml("check").exit_code == 0, old
    after = (ws / "eye.mock.yaml").read_text()
    renamed = before.replace("xx", "yy").replace("moving", "running").replace("Lost", "Gone").replace("where", "there")
    assert after == renamed


def test_a_name_in_code_stays_when_the_parameter_is_renamed(ws: Path, rcyaml: Callable[..., Result]) -> None:
    text = (
        "component: arm.cdsl.yaml\nparameters:\n  2d: {type: bool, default: true, as: view2d}\n  on: {type: bool, default: true}\n"
        "constraints: [view2d or on]\n"
    )
    (ws / "arm/arm.pdsl.yaml").write_text(text)
    assert rcyaml("rename", "2d", "3d").exit_code == 0
    assert rcyaml("rename", "on", "off").exit_code == 0
    after = text.replace("2d:", "3d:").replace(" on:", " off:").replace("or on", "or off")
    assert (ws / "arm/arm.pdsl.yaml").read_text() == after and rcyaml("check").exit_code == 0


def test_an_entry_with_instances_is_renamed_and_back(ws: Path, rcyaml: Callable[..., Result]) -> None:
    robot = (
        "deployment: Robot\ncomponents:\n  arm{i}: {component: arm, instances: 2}\n"
        "  legs{i}: {program: sh, instances: 2, after: [\"arm{i}\"], connect: {Arm: 'arm{i}'}}\n"
        "  last: {program: sh, after: [arm0, legs1]}\ngroups: {all: {components: ['arm{i}']}}\n"
    )
    (ws / "robot.ddsl.yaml").write_text(robot)
    before = rcyaml("check").output
    for old, new, after in (
        ("arm{i}", "limb{i}", robot.replace("arm{i}", "limb{i}").replace("arm0", "limb0")),
        ("limb{i}", "arm{i}", robot),
    ):
        ran = rcyaml("rename", f"entry:{old}", new)
        assert ran.exit_code == 0, ran.output
        assert (ws / "robot.ddsl.yaml").read_text() == after
    assert rcyaml("check").output == before


@pytest.mark.parametrize("entry", ["arm: {component: arm}", "arm{i}: {component: arm, instances: 2}"])
def test_the_ports_of_a_first_config_stay_those_that_nobody_chose(
    ws: Path, rcyaml: Callable[..., Result], entry: str
) -> None:
    (ws / "robot.ddsl.yaml").write_text(f"deployment: Robot\ncomponents:\n  {entry}\n")
    for unused in ("arm.mock.yaml", "arm/src/specificworker.py"):
        (ws / unused).unlink()
    for old, new in (("Arm", "Limb"), ("Limb", "Arm")):
        assert rcyaml("compile", "arm").exit_code == 0
        ran = rcyaml("rename", f"interface:{old}", new)
        assert ran.exit_code == 0, ran.output
        assert f"{new}.Endpoints=" in (ws / "arm/etc/config").read_text()
        assert "nothing wrong" in rcyaml("check").output
    first = (ws / "arm/etc/config").read_text()
    (ws / "arm/etc/config").write_text(re.sub(r"(Arm.Endpoints=tcp -p )\d+", r"\g<1>12345", first))
    assert rcyaml("check").exit_code == ("instances" in entry), "instances cannot share a port that somebody chose"


@pytest.mark.parametrize(
    ("name", "new", "code", "said"),
    [
        ("Arm.stop", "reach", 1, "Arm.stop"),
        ("arm", "legs", 1, "is not renamed"),
        ("Arm.reach.goal", "rest", 1, "is not renamed"),
        ("Arm.reach.goal", "", 1, "at least one character"),
        ("Arm.walk", "run", 2, "unknown name 'Arm.walk'"),
        ("interfaces/Arm.idsl.yaml:1:1", "x", 2, "is not a name"),
        ("interfaces/Leg.idsl.yaml:1:1", "x", 2, "is not a name"),
    ],
)
def test_what_would_be_wrong_is_refused_and_nothing_is_written(
    ws: Path, rcyaml: Callable[..., Result], name: str, new: str, code: int, said: str
) -> None:
    ran = rcyaml("rename", name, new)
    assert (ran.exit_code, said in ran.output) == (code, True), ran.output
    assert {name: (ws / name).read_text() for name in PLACE} == PLACE


def test_a_diff_writes_nothing(ws: Path, rcyaml: Callable[..., Result]) -> None:
    ran = rcyaml("rename", "Arm.stop", "halt", "--diff")
    assert ran.exit_code == 0
    assert "-    def Arm_stop(self):\n+    def Arm_halt(self):\n" in ran.stdout
    assert "method stop would be renamed to halt" not in ran.stdout, "it is a patch"
    assert {name: (ws / name).read_text() for name in PLACE} == PLACE


def test_a_location_is_relative_to_the_working_folder(
    ws: Path, rcyaml: Callable[..., Result], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ws / "arm")
    ran = rcyaml("rename", "../interfaces/Arm.idsl.yaml:6:7", "halt", "--format", "json")
    assert ran.exit_code == 0, ran.output
    told = json.loads(ran.stdout)
    assert told["name"] == "method stop" and told["written"] is True
    assert sorted(one["edits"] for one in told["files"]) == [1, 1]
    assert "      halt:\n" in (ws / "interfaces/Arm.idsl.yaml").read_text()


def test_the_same_name_changes_nothing(ws: Path, rcyaml: Callable[..., Result]) -> None:
    ran = rcyaml("rename", "Arm.stop", "stop")
    assert (ran.exit_code, ran.stdout) == (0, "method stop has this name already\n")


def test_a_member_in_a_legacy_spelling(rcyaml: Callable[..., Result], tmp_path: Path) -> None:
    text = (
        "types:\n  Row: {struct: {name: string, id: int, vel: float}}\n"
        "parameters:\n  rows: {list: Row, default: []}\n  more: {list: Row, default: []}\n  keyed: {list: Row, default: []}\n"
        'legacy:\n  rows: {key: "M{i}", columns: [name, id, vel]}\n'
        '  more: {fields: {name: "n_{i}", id: "id_{i}", vel: "v_{i}"}}\n  keyed: {key: "K:{name}-{id}", columns: [vel]}\n'
    )
    (tmp_path / "a.pdsl.yaml").write_text(text)
    assert rcyaml("rename", "a.pdsl.yaml:2:18", "title").exit_code == 0
    assert (tmp_path / "a.pdsl.yaml").read_text() == text.replace("name", "title")
