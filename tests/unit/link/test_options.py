"""Options of legacy components add imports and interfaces."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.pipeline import Analysis, analyse


def idsl(name: str, kind: str = "interfaces") -> str:
    return f"module: RoboComp{name}\n{kind}:\n  {name}:\n    methods:\n      tell: {{in: {{text: string}}}}\n"


NAMES = ("AGMExecutive", "AGMCommonBehavior", "AGMWorldModel", "Arm")
INTERFACES = {
    **{f"interfaces/{name}.idsl.yaml": idsl(name) for name in NAMES},
    "interfaces/AGMExecutiveTopic.idsl.yaml": idsl("AGMExecutiveTopic", "topics"),
}


@pytest.fixture
def linked(tmp_path: Path) -> Callable[[str], tuple[Analysis, LinkedComponent]]:
    def link(text: str, interfaces: bool = True) -> tuple[Analysis, LinkedComponent]:
        files = {"rcyaml.yaml": "interfaces: [interfaces]\n", "interfaces": None, "agent/agent.cdsl.yaml": text}
        write_tree(tmp_path, {**files, **(INTERFACES if interfaces else {})})
        analysis = analyse([str(tmp_path / "agent")])
        (component,) = analysis.program.components.values()
        return analysis, component

    return link


def ports(component: LinkedComponent) -> dict[str, list[str]]:
    return {
        list_: [port.name for port in getattr(component, list_)]
        for list_ in ("implements", "requires", "publishes", "subscribes")
    }


@pytest.mark.parametrize("spelling", ["agmagent", "AGMAgent"])
def test_an_agm_agent(linked: Callable[..., tuple[Analysis, LinkedComponent]], spelling: str) -> None:
    text = f"component: Agent\nlanguage: cpp\nimports: [Arm]\nrequires: [Arm]\noptions: [{spelling}]\n"
    analysis, component = linked(text)
    assert not analysis.diagnostics
    assert ports(component) == {
        "implements": ["AGMCommonBehavior"],
        "requires": ["Arm", "AGMExecutive"],
        "publishes": [],
        "subscribes": ["AGMExecutiveTopic"],
    }
    assert [scope.module.stem for scope in component.imports] == [
        "Arm",
        "AGMExecutive",
        "AGMCommonBehavior",
        "AGMWorldModel",
        "AGMExecutiveTopic",
    ]


def test_an_option_adds_no_duplicates(linked: Callable[..., tuple[Analysis, LinkedComponent]]) -> None:
    text = (
        "component: Agent\nlanguage: python\nimports: [../interfaces/AGMExecutive.idsl.yaml, AGMExecutiveTopic]\n"
        "requires: [AGMExecutive.AGMExecutive]\nsubscribes: [{Plans: AGMExecutiveTopic}]\noptions: [agmagent]\n"
    )
    analysis, component = linked(text)
    assert not analysis.diagnostics
    assert ports(component)["requires"] == ["AGMExecutive"] and ports(component)["subscribes"] == ["Plans"]


def test_unknown_imports_are_reported_at_the_option(linked: Callable[..., tuple[Analysis, LinkedComponent]]) -> None:
    analysis, component = linked("component: Agent\nlanguage: cpp\noptions: [agmagent]\n", interfaces=False)
    assert {d.code for d in analysis.diagnostics} == {"RC2101"}
    assert {(d.span.line, d.span.column) for d in analysis.diagnostics} == {(3, 11)}
    assert component.broken


@pytest.mark.parametrize("option", ["dsr", "DSR", "InnerModelViewer"])
def test_options_without_interfaces(linked: Callable[..., tuple[Analysis, LinkedComponent]], option: str) -> None:
    analysis, component = linked(f"component: Agent\nlanguage: cpp\noptions: [{option}]\n")
    assert [(d.code, d.severity) for d in analysis.diagnostics] == [("RC2352", "note")]
    assert not any(ports(component).values())
