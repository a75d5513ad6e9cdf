"""What the manager does of a deployment with one living analysis: nothing is analysed or judged twice."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml.api import addresses
from robocomp_yaml.api.editing.changes import MoveEntry
from robocomp_yaml.api.editing.editor import DocumentEditor, EditConflict
from robocomp_yaml.manager.managed import ManagedDeployment

ENTRIES = "".join(f"  c{n}: {{program: sleep, host: left}}  # the {n}th\n" for n in range(4))
NETWORK = "deployment: Net\nhosts: {left: 10.0.0.2, right: 10.0.0.3}\ncomponents:\n" + ENTRIES
MOVE = MoveEntry("c2", "right")


@pytest.fixture
def managed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ManagedDeployment:
    monkeypatch.chdir(write_tree(tmp_path / "ws", {"rcyaml.yaml": "{}\n", "net.ddsl.yaml": NETWORK}))
    return ManagedDeployment("net.ddsl.yaml")


@pytest.fixture
def judged(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The changes that were judged."""
    found: list[str] = []
    revise = DocumentEditor.revise

    def counting(self: DocumentEditor, *arguments: object) -> object:
        found.append(str(arguments[1]))
        return revise(self, *arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(DocumentEditor, "revise", counting)
    return found


def change(managed: ManagedDeployment, move: MoveEntry = MOVE, based_on: str = "", *, write: bool) -> None:
    managed.revise(move, "", based_on, write=write, force=False)


def test_a_change_that_was_shown_is_judged_once(managed: ManagedDeployment, judged: list[str]) -> None:
    change(managed, write=False)
    change(managed, write=True)
    assert len(judged) == 1
    assert Path("net.ddsl.yaml").read_text() == NETWORK.replace(
        "c2: {program: sleep, host: left", "c2: {program: sleep, host: right"
    )
    change(managed, MoveEntry("c2", "left"), write=True)
    assert len(judged) == 2
    assert Path("net.ddsl.yaml").read_text() == NETWORK


@pytest.mark.parametrize("elsewhere", ["net.ddsl.yaml", "other.ddsl.yaml"])
def test_a_change_is_judged_again_if_a_document_changed_since_it_was_shown(
    managed: ManagedDeployment, judged: list[str], elsewhere: str
) -> None:
    change(managed, write=False)
    path = Path(elsewhere)
    path.write_text(NETWORK.replace("Net", "Other").replace("4th", "last"))
    change(managed, write=True)
    assert len(judged) == 2
    if elsewhere == "net.ddsl.yaml":
        assert "deployment: Other" in path.read_text(), "what somebody else wrote stays"
    assert "c2: {program: sleep, host: right" in Path("net.ddsl.yaml").read_text()


def test_a_change_that_was_shown_does_not_overwrite_another(managed: ManagedDeployment) -> None:
    version = managed.graph()["version"]
    change(managed, based_on=version, write=False)
    Path("net.ddsl.yaml").write_text(NETWORK + "# mine\n")
    with pytest.raises(EditConflict):
        change(managed, based_on=version, write=True)
    assert Path("net.ddsl.yaml").read_text() == NETWORK + "# mine\n"


def test_calls_values_and_topics_use_the_living_analysis(
    managed: ManagedDeployment, monkeypatch: pytest.MonkeyPatch
) -> None:
    def afresh(*_: object) -> None:
        raise AssertionError("the documents are analysed afresh")

    monkeypatch.setattr(addresses, "analyse", afresh)
    assert managed.addresses().network is not None
    assert managed.topics() is not None
