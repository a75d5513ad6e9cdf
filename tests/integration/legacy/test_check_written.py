"""`migrate` checks the documents that it wrote: settings that are not valid as parameters are properties, and remaining
errors are reported."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from robocomp_yaml.source.tree import parse

Run = Callable[..., Result]
FLAT = "Endpoints0=true,true\n"  # with this key, components remove quotes
CONFIGS = {
    "a quoted text": ('Laser = "true"\n' + FLAT, {"Laser": '"true"'}),
    "above rows that are called as a section of TOML": ('names = "left"\nAgent0=a,1\n', {"names": '"left"'}),
    "several": ('a.b = "x y"\nPeriod3=a,b\nc = "true"\nd = 1\n', {"a.b": '"x y"', "c": '"true"'}),
}


@pytest.mark.parametrize("name", CONFIGS)
def test_what_cannot_be_a_parameter_is_a_property(name: str, rcyaml: Run, tmp_path: Path) -> None:
    text, properties = CONFIGS[name]
    write_tree(tmp_path, {"etc/config": text})
    result = rcyaml("migrate", ".", "--format", "json")
    assert "RC5039" not in result.stdout
    assert rcyaml("check", "etc/config.yaml").exit_code == 0
    root, _ = parse("x.yaml", (tmp_path / "etc/config.yaml").read_text())
    assert root is not None and isinstance(root.data, dict)
    assert root.data["properties"] == properties
    exported = rcyaml("config", "export", "etc/config.yaml").stdout
    assert all(f"{key}={value}" in exported for key, value in properties.items())


def test_errors_of_check_are_reported_once_for_a_document(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(
        tmp_path,
        {
            "speech.cdsl": "Component C { Communications { implements A, B; }; language python; };\n",
            "fine.cdsl": "Component D { language python; };\n",
        },
    )
    result = rcyaml("migrate", ".", "--format", "json")
    assert result.exit_code == 0
    (told,) = [each for each in json.loads(result.stdout)["diagnostics"] if each["code"] == "RC5039"]
    assert told["file"] == "speech.cdsl" and "(and 1 more)" in told["message"]
    assert rcyaml("check", ".").exit_code == 1


COMPONENT = "Component C {{ Communications {{ implements {0}; }}; language cpp; {1} }};\n"
NOT_THERE = {
    "an interface": ({"c.cdsl": 'import "Nada.idsl";\n' + COMPONENT.format("Nada", "")}, ["RC5009"]),
    "an interface of an interface": (
        {"A.idsl": 'import "Nada.idsl";\nmodule RoboCompA { interface A { RoboCompNada::X f(); }; };\n'},
        ["RC5009"],
    ),
    "a machine": ({"c.cdsl": 'Component C { language cpp; statemachine "sm/door.smdsl"; };\n'}, ["RC5019"]),
    "parameters": ({"left.pconf": 'import "left.pdsl";\nConfigFile Left{\n  volume = 3\n}\n'}, ["RC5030"]),
    "a type": ({"A.idsl": "module RoboCompA { interface A { Eye f(); void g(out Eye x); }; };\n"}, ["RC5010"] * 2),
    "a type and a module": (
        {"A.idsl": "module RoboCompA { interface A { void h(RoboCompZ::Q x); Eye g(); }; };\n"},
        ["RC5010"] * 2,
    ),
    "a folder that is not searched": (
        {"a/A.idsl": "module RoboCompA {};\n", "c/c.cdsl": 'import "A.idsl";\nComponent C { language cpp; };\n'},
        ["RC5026"],
    ),
}


@pytest.mark.parametrize("name", NOT_THERE)
def test_what_is_missing_is_reported_once(name: str, rcyaml: Run, tmp_path: Path) -> None:
    files, codes = NOT_THERE[name]
    write_tree(tmp_path, {"rcyaml.yaml": "interfaces: []\n", **files})  # a workspace in which each is an error
    result = rcyaml("migrate", ".", "--format", "json")
    assert [each["code"] for each in json.loads(result.stdout)["diagnostics"]] == codes
    assert rcyaml("check", ".").exit_code == 1


def test_another_fault_of_the_same_kind_is_reported(rcyaml: Run, tmp_path: Path) -> None:
    interface = "module RoboCompA { interface A { Eye f(); void g(RoboCompZ::Ear x); }; };\n"
    write_tree(tmp_path, {"rcyaml.yaml": "interfaces: []\n", "A.idsl": 'import "Nada.idsl";\n' + interface})
    found = json.loads(rcyaml("migrate", ".", "--format", "json").stdout)["diagnostics"]
    assert [each["code"] for each in found] == ["RC5039", "RC5009", "RC5010"]
    assert "'RoboCompZ.Ear'" in found[0]["message"] and "more)" not in found[0]["message"]


def test_a_dry_run_checks_no_documents(rcyaml: Run, tmp_path: Path) -> None:
    write_tree(tmp_path, {"speech.cdsl": "Component C { Communications { implements A; }; language python; };\n"})
    assert "RC5039" not in rcyaml("migrate", ".", "--dry-run").output
