"""`config show` and `deploy plan` name the source of each value, and what it overrides, as text and as JSON."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from deployments import FACE

Run = Callable[..., Result]
ARM = "component: ArmComp\nlanguage: python\nimports: [Face]\nimplements: [Speech]\nrequires: [Mouth]\n"
TREE = {
    "rcyaml.yaml": "",
    "Face.idsl.yaml": FACE,
    "arm/arm.cdsl.yaml": ARM.replace("[Face]", "[../Face]"),
    "arm/arm.pdsl.yaml": (
        "component: arm.cdsl.yaml\nparameters:\n  speed: {type: int, range: [0, 9], default: 5}\n"
        "  token: {type: string, optional: true}\n"
    ),
}
VALUES = {
    "arm/etc/config.yaml": "component: ../arm.cdsl.yaml\nparameters: {speed: 6}\nproxies: {Mouth: 'mouth:tcp -p 7'}\n"
}
FLAT = {
    "arm/etc/config": "speed=8\nSpeech.Endpoints=tcp -p 12345\nMouthProxy=mouth:tcp -h 10.0.0.9 -p 4\ntoken=hunter2\n"
}


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(write_tree(tmp_path, TREE))
    return tmp_path


def lines(result: Result) -> dict[str, str]:
    assert result.exit_code == 0, result.output
    return {
        line.split(" = ")[0].strip(): line.partition("# ")[2] for line in result.stdout.splitlines() if " = " in line
    }


@pytest.mark.parametrize("argument", ["arm", "ArmComp", "arm/etc/config", "arm/arm.cdsl.yaml"])
def test_a_flat_config_is_shown(tree: Path, rcyaml: Run, argument: str) -> None:
    write_tree(tree, FLAT)
    shown = lines(rcyaml("config", "show", argument))
    assert shown["speed"] == "arm/etc/config:1" and shown["Speech.Endpoints"] == "arm/etc/config:2"
    assert "hunter2" not in rcyaml("config", "show", argument).output
    assert rcyaml("config", "get", argument, "speed").stdout == "8\n"


def test_what_nobody_sets_is_shown_on_request(tree: Path, rcyaml: Run) -> None:
    write_tree(tree, VALUES)
    assert "Speech.Endpoints" not in lines(rcyaml("config", "show", "arm"))
    shown = lines(rcyaml("-v", "config", "show", "arm"))
    assert shown["Speech.Endpoints"] == shown["Ice.MessageSizeMax"] == "default"
    assert shown["MouthProxy"] == "arm/etc/config.yaml:3"
    every = json.loads(rcyaml("config", "show", "arm", "--format", "json").stdout)["properties"]
    assert {"MouthProxy": "set", "Speech.Endpoints": "default", "Ice.MessageSizeMax": "default"}.items() <= {
        one["property"]: one["source"] for one in every
    }.items()


def test_a_flat_config_that_the_user_changed_overrides_the_document(tree: Path, rcyaml: Run) -> None:
    write_tree(tree, {**VALUES, **FLAT})
    shown = lines(rcyaml("config", "show", "arm"))
    assert shown["speed"] == "arm/etc/config:1, overrides 6 (arm/etc/config.yaml:2)"
    assert shown["MouthProxy"] == "arm/etc/config:3, overrides mouth:tcp -p 7 (arm/etc/config.yaml:3)"
    assert rcyaml("config", "get", "arm", "speed").stdout == "8\n"
    checked = rcyaml("check")
    assert checked.exit_code == 0 and "warning[RC3330]" in checked.stdout


def test_a_compile_ends_that(tree: Path, rcyaml: Run) -> None:
    assert rcyaml("compile").exit_code == 0
    with (tree / "arm/etc/config").open("a") as flat:
        flat.write("speed=8\n")
    assert rcyaml("config", "new", "arm").exit_code == 0
    assert "RC3330" not in rcyaml("check").output, "the document contains the change"
    compiled = rcyaml("compile")
    assert compiled.exit_code == 0 and "RC3330" not in compiled.output
    assert rcyaml("config", "set", "arm", "speed", "7").exit_code == 0
    assert "RC3330" not in rcyaml("check").output and rcyaml("config", "get", "arm", "speed").stdout == "7\n"


def test_a_flat_config_cannot_be_set(tree: Path, rcyaml: Run) -> None:
    write_tree(tree, FLAT)
    assert "rcyaml config new" in rcyaml("config", "set", "arm", "speed", "7").output
    assert (tree / "arm/etc/config").read_text(encoding="utf-8") == FLAT["arm/etc/config"]


def test_a_plan_names_what_replaces_a_choice(tree: Path, rcyaml: Run) -> None:
    serves = "component: MouthComp\nlanguage: python\nimports: [../Face]\nimplements: [Mouth]\n"
    head = "deployment: Sourced\ncomponents:\n  arm: {component: arm, set: {speed: 9}}\n"
    write_tree(tree, {**FLAT, "head.ddsl.yaml": head, "mouth/mouth.cdsl.yaml": serves})
    assert rcyaml("compile", "mouth").exit_code == 0
    alone = rcyaml("deploy", "plan", "head.ddsl.yaml").stdout
    assert "    MouthProxy = mouth:tcp -h 10.0.0.9 -p 4  # arm/etc/config:3; outside of the deployment\n" in alone
    assert "Speech.Endpoints" not in alone and "hunter2" not in alone and "speed" not in alone
    every = rcyaml("-v", "deploy", "plan", "head.ddsl.yaml").stdout
    assert "    speed = 9  # head.ddsl.yaml:3, overrides 8 (arm/etc/config:1)\n" in every
    assert "    Speech.Endpoints = tcp -h 127.0.0.1 -p 12345  # arm/etc/config:2\n" in every
    assert (
        "    token = ***  # arm/etc/config:4\n" in every and "    Ice.MessageSizeMax = 20004800  # default\n" in every
    )
    write_tree(tree, {"head.ddsl.yaml": head + "  lips: {component: mouth, port: 12001}\n"})
    both = rcyaml("deploy", "plan", "head.ddsl.yaml").stdout
    assert "# derived, overrides mouth:tcp -h 10.0.0.9 -p 4 (arm/etc/config:3)\n" in both
    steps = json.loads(rcyaml("deploy", "plan", "head.ddsl.yaml", "--format", "json").stdout)["plan"]
    of_arm = next(step for step in steps if step["name"] == "arm")["config"]
    (proxy,) = (one for one in of_arm if one["property"] == "MouthProxy")
    assert (proxy["source"], proxy["outside"]) == ("derived", False)
    assert proxy["overrode"] == [{"value": "mouth:tcp -h 10.0.0.9 -p 4", "file": "arm/etc/config", "line": 3}]
    (port,) = (
        one for one in next(s for s in steps if s["name"] == "lips")["config"] if one["property"] == "Mouth.Endpoints"
    )
    assert (port["source"], port["file"], port["line"]) == ("set", "head.ddsl.yaml", 4)


MOUTH = {
    "mouth/mouth.cdsl.yaml": "component: MouthComp\nlanguage: python\nimports: [../Face]\nimplements: [Mouth]\n",
    "head.ddsl.yaml": "deployment: Sourced\ncomponents:\n  arm: {component: arm}\n  lips: {component: mouth}\n",
}


def test_one_judge_says_whose_a_flat_config_is(tree: Path, rcyaml: Run) -> None:
    """A change that the document contains later gives the file back, also if the document states no connections."""
    write_tree(tree, {**MOUTH, "arm/etc/config.yaml": "component: ../arm.cdsl.yaml\n"})
    assert rcyaml("compile").exit_code == 0
    flat = tree / "arm/etc/config"
    written = flat.read_text(encoding="utf-8")
    flat.write_text("# mine\n" + written, encoding="utf-8")
    assert "RC3330" not in rcyaml("check").output, "nothing of the user's is in it"
    flat.write_text(written.replace("speed=5", "speed=6"), encoding="utf-8")
    assert "RC3330" in rcyaml("check").output and rcyaml("config", "get", "arm", "speed").stdout == "6\n"
    assert "etc/config (speed)" in rcyaml("compile").output
    assert rcyaml("config", "set", "arm", "speed", "6").exit_code == 0
    assert "RC3330" not in rcyaml("check").output and "RC6010" not in rcyaml("compile").output
    assert "speed=6\n" in flat.read_text(encoding="utf-8") and "# Configuration" in flat.read_text(encoding="utf-8")


def test_an_endpoint_in_a_changed_flat_config_counts_everywhere(tree: Path, rcyaml: Run) -> None:
    values = "component: ../mouth.cdsl.yaml\nendpoints: {Mouth: tcp -p 12001}\n"
    write_tree(tree, {**MOUTH, "mouth/etc/config.yaml": values})
    assert rcyaml("compile").exit_code == 0
    flat = tree / "mouth/etc/config"
    flat.write_text(flat.read_text(encoding="utf-8").replace("12001", "12002"), encoding="utf-8")
    plan = json.loads(rcyaml("deploy", "plan", "head.ddsl.yaml", "--format", "json").stdout)["plan"]
    texts = {one["name"]: str(one["config"]) for one in plan}
    assert (
        "-p 12002" in texts["lips"] and "-p 12002" in texts["arm"] and "'tcp -h 127.0.0.1 -p 12001" not in texts["lips"]
    )
    shown = lines(rcyaml("config", "show", "mouth"))["Mouth.Endpoints"]
    assert shown.endswith("overrides tcp -p 12001 (mouth/etc/config.yaml:2)")
    assert "Mouth.Endpoints" in rcyaml("compile").output and "-p 12002" in flat.read_text(encoding="utf-8")
