"""What the manager serves about documents: texts while they are typed, components, and where boxes are."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from deployments import deployed
from test_manager import Manager, manager, read_events

DDSL = "robot.ddsl.yaml"
TEXT = """\
deployment: Robot
components:
  speech: {component: speech} # talks
  mouth: {component: mouth}
"""
PDSL = "component: speech.cdsl.yaml\nparameters: {loudness: {type: float, default: 0.5}}\n"


@pytest.fixture
def served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Manager]:
    monkeypatch.setenv("XDG_STATE_HOME", f"{tmp_path}/own")
    documents = deployed(TEXT.partition("\n")[2], ear="publishes: [Heard]\n")
    write_tree(tmp_path / "robot", {**documents, "rcyaml.yaml": "interfaces: [.]\n", "speech/speech.pdsl.yaml": PDSL})
    monkeypatch.chdir(tmp_path / "robot")
    with manager(tmp_path / "robot") as one:
        yield one


def labels(one: Manager, text: str, path: str = DDSL) -> dict[str, Any]:
    """What completion offers at the `|` of a text, by label."""
    before, _, after = text.partition("|")
    line, column = before.count("\n") + 1, len(before.rpartition("\n")[2]) + 1
    status, found = one.robot("completion", {"path": path, "text": before + after, "line": line, "column": column})
    assert status == 200, found
    return {item["label"]: item for item in found["items"]}


def test_names_and_keys_are_completed_in_unsaved_texts(served: Manager) -> None:
    found = labels(served, TEXT.replace("speech} #", "speech, connect: {Mouth: mo|}} #"))
    assert set(found) == {"mouth"}
    column = len("  speech: {component: speech, connect: {Mouth: ") + 1
    assert (found["mouth"]["insert"], found["mouth"]["start"], found["mouth"]["end"]) == ("mouth", column, column + 2)
    assert {"ear", "mouth", "speech"} <= set(labels(served, TEXT + "  ear: {component: |}\n"))
    assert {"connect", "after", "set"} <= set(labels(served, TEXT.replace("speech} #", "speech, |} #")))
    ports = labels(served, "component: MouthComp\nlanguage: python\nrequires: [|]\n", "mouth/mouth.cdsl.yaml")
    assert ports["Speech"]["edits"][0]["insert"].strip() == "imports: [Face]"
    assert "loudness" in labels(served, TEXT.replace("speech} #", "speech, set: {lo|}} #"))
    assert labels(served, TEXT + "# speech: |\n") == {}
    (row,) = [one for one in labels(served, TEXT + "# rcyaml: allow RC42|").values() if one["label"] == "RC4202"]
    assert row["start"] == len("# rcyaml: allow ") + 1


@pytest.mark.parametrize("place", [(0, 0), (-3, 5), (99, 1), (1, 10**6), (2**62, 2**62)])
def test_positions_behind_the_text_offer_nothing_or_something(served: Manager, place: tuple[int, int]) -> None:
    status, found = served.robot("completion", {"path": DDSL, "text": TEXT, "line": place[0], "column": place[1]})
    assert (status, isinstance(found["items"], list)) == (200, True)


def test_unsaved_texts_are_diagnosed_with_what_they_cause_elsewhere(served: Manager) -> None:
    assert served.robot("diagnose", {"path": DDSL, "text": TEXT}) == (200, {"diagnostics": [], "elsewhere": []})
    status, found = served.robot("diagnose", {"path": DDSL, "text": TEXT.replace("mouth}", "muth}")})
    assert (status, [one["line"] for one in found["diagnostics"]]) == (200, [4])
    assert found["diagnostics"][0]["severity"] == "error"
    mouth = Path("mouth/mouth.cdsl.yaml").read_text().replace("implements: [Mouth]", "")
    found = served.robot("diagnose", {"path": "mouth/mouth.cdsl.yaml", "text": mouth})[1]
    assert found["diagnostics"] == []
    assert [(one["code"], one["file"]) for one in found["elsewhere"]] == [("RC4201", DDSL)]
    assert served.robot("diagnose", {"path": DDSL, "text": TEXT})[1]["diagnostics"] == []  # nothing was kept
    assert served.robot("diagnose", {"path": DDSL, "text": "a: [\t{]\0"})[1]["diagnostics"]


def test_a_text_is_written_as_a_change_is(served: Manager) -> None:
    version = served.robot("document")[1]["version"]
    wrong = TEXT.replace("mouth}", "muth}")
    status, answer = served.robot("write", {"path": DDSL, "text": wrong, "based_on": version})
    assert (status, bool(answer["diagnostics"]), Path(DDSL).read_text()) == (422, True, TEXT)
    mine = TEXT + "  # mine\n"
    status, answer = served.robot("write", {"path": DDSL, "text": mine, "based_on": version, "write": False})
    assert (status, answer["written"], "+  # mine" in answer["diff"], Path(DDSL).read_text()) == (
        200,
        False,
        True,
        TEXT,
    )
    status, answer = served.robot("write", {"path": DDSL, "text": mine, "based_on": version})
    assert (status, answer["written"], Path(DDSL).read_text()) == (200, True, mine)
    status, conflict = served.robot("write", {"path": DDSL, "text": TEXT, "based_on": version})
    assert (status, conflict["theirs"], conflict["ours"]) == (409, mine, TEXT)
    assert conflict["version"] == answer["version"]  # of what is shown, which may be meant then
    assert served.robot("write", {"path": DDSL, "text": wrong, "based_on": answer["version"], "force": True})[0] == 200
    assert served.robot("undo", {})[0] == 200
    assert served.robot("undo", {})[0] == 200
    assert Path(DDSL).read_text() == TEXT
    assert "wrote robot.ddsl.yaml" in [one["text"] for one in served.robot("history")[1]["happened"]]


def test_components_are_read_and_changed(served: Manager) -> None:
    for name in ("SpeechComp", "speech", "speech/speech.cdsl.yaml"):
        status, found = served.robot(f"component?name={name}")
        assert (status, found["path"], found["requires"]) == (200, "speech/speech.cdsl.yaml", ["Mouth"])
    found = served.robot("component?name=EarComp")[1]
    change = {"change": "require", "component": "EarComp", "interface": "Mouth"}
    status, answer = served.robot("edit", {"change": change, "based_on": found["version"]})
    assert (status, answer["document"], answer["change"]) == (200, "ear/ear.cdsl.yaml", "require Mouth")
    assert served.robot("component?name=EarComp")[1]["requires"] == ["Mouth"]
    change = {"change": "unrequire", "component": "EarComp", "interface": ["Mouth"]}
    assert served.robot("edit", {"change": change, "based_on": found["version"]})[0] == 409
    assert served.robot("edit", {"change": change})[0] == 200
    assert served.robot("undo", {"document": "ear/ear.cdsl.yaml"})[0] == 200
    for name, message in (("SpechComp", "did you mean 'SpeechComp'"), ("/etc", "unknown"), ("", "unknown")):
        status, answer = served.robot(f"component?name={name}")
        assert (status, message in answer["error"]) == (400, True)
    assert "names the component" in served.robot("edit", {"change": {**change, "component": ""}})[1]["error"]


def test_components_have_a_picture_of_their_own(served: Manager) -> None:
    status, found = served.robot("graph?of=components")
    assert (status, found["of"], {one["name"] for one in found["nodes"]} >= {"SpeechComp", "MouthComp", "EarComp"}) == (
        200, "components", True,
    )  # fmt: skip
    lines = [(one["from"], one["to"]) for one in found["edges"] if one["kind"] == "uses"]
    assert ("SpeechComp", "MouthComp") in lines
    mouth = "component: MouthComp\nlanguage: pyton\nimports: [Face]\nimplements: [Mouth]\n"
    asked = {"path": "mouth/mouth.cdsl.yaml", "text": mouth, "graph": True, "of": "components"}
    drawn = served.robot("diagnose", asked)[1]["graph"]
    assert [one["faults"] != [] for one in drawn["nodes"] if one["name"] == "MouthComp"] in ([True], [])
    assert served.robot("graph?of=everything")[0] == 400


def test_a_new_component_is_added(served: Manager) -> None:
    change = {"change": "add-new", "entry": "nose", "component": "NoseComp", "implements": ["Speech"]}
    status, answer = served.robot("edit", {"change": change, "write": False})
    assert (status, Path("components").exists(), "b/components/nosecomp" in answer["diff"]) == (200, False, True)
    assert served.robot("edit", {"change": change})[0] == 200
    assert served.robot("component?name=NoseComp")[1]["implements"] == ["Speech"]
    assert served.robot("undo", {})[0] == 200
    assert not Path("components/nosecomp").exists()


def test_boxes_are_where_a_person_put_them(served: Manager) -> None:
    def box(name: str) -> list[float]:
        (found,) = [one for one in served.robot("graph")[1]["nodes"] if one["name"] == name]
        return [found["x"], found["y"]]

    speech, events = box("speech"), read_events(served.open("/api/deployments/Robot/events"), "documents")
    assert served.robot("positions")[1] == {"positions": {}}
    status, now = served.robot("positions", {"positions": {"mouth": [700, 333.33]}})
    assert (status, now) == (200, {"positions": {"mouth": [700, 333.3]}})
    assert next(events) == {"problem": ""}
    assert (box("mouth"), box("speech")) == ([700, 333.3], speech)
    kept = Path(".rcyaml/layout/robot.json")
    assert json.loads(kept.read_text()) == {"positions": {"mouth": [700, 333.3]}}
    assert served.robot("edit", {"change": {"change": "rename", "entry": "mouth", "name": "jaw"}})[0] == 200
    assert (box("jaw"), served.robot("positions")[1]["positions"]) == ([700, 333.3], {"jaw": [700, 333.3]})
    assert served.robot("positions", {"positions": {"jaw": None, "never": None}})[1] == {"positions": {}}
    assert box("jaw") != [700, 333.3]
    for wrong in ({"jaw": [1]}, {"jaw": [-5, 0]}, {"jaw": ["1", 0]}, {"jaw": [1e300, 0]}, {"j" * 5000: [1, 1]}, 7):
        assert served.robot("positions", {"positions": wrong})[0] == 400, wrong
    kept.write_text('{"positions": {"jaw": [800, 400]}}')  # as another manager does it
    assert next(one for one in events if box("jaw") == [800, 400]) == {"problem": ""}


def test_what_is_renamed_stays_where_it_is(served: Manager) -> None:
    def places() -> dict[str, list[float]]:
        return {one["name"]: [one["x"], one["y"]] for one in served.robot("graph")[1]["nodes"]}

    before = places()
    assert served.robot("edit", {"change": {"change": "rename", "entry": "speech", "name": "voice"}})[0] == 200
    assert places() == {"voice" if name == "speech" else name: place for name, place in before.items()}
    assert served.robot("undo", {})[0] == 200
    assert places() == before


def test_entries_of_included_documents_are_edited_there(served: Manager) -> None:
    Path("both.ddsl.yaml").write_text("deployment: Both\ninclude: {left: robot.ddsl.yaml, right: robot.ddsl.yaml}\n")
    with manager(Path.cwd(), "both.ddsl.yaml") as one:

        def edit(**change: object) -> tuple[int, Any]:
            return one.ask("/api/deployments/Both/edit", {"change": change, **asked})

        asked: dict[str, object] = {"write": False}
        found = one.ask("/api/deployments/Both/entries")[1]["entries"]
        assert {each["process"]: (each["entry"], each["scope"]) for each in found}["left.mouth"] == (
            "left.mouth", "left.",
        )  # fmt: skip
        status, shown = edit(change="rename", entry="left.mouth", name="left.jaw")
        assert (status, shown["document"], "+  jaw: {" in shown["diff"]) == (200, DDSL, True)
        asked = {"based_on": shown["based_on"]}
        assert edit(change="rename", entry="left.mouth", name="left.jaw")[0] == 200
        status, conflict = edit(change="rename", entry="left.jaw", name="mouth")
        assert (status, conflict["theirs"]) == (409, Path(DDSL).read_text())
        asked = {"based_on": conflict["version"]}
        assert edit(change="rename", entry="right.jaw", name="mouth")[0] == 200
        assert Path(DDSL).read_text() == TEXT


def test_the_command_line_draws_them_there_too(served: Manager) -> None:
    import subprocess

    served.robot("positions", {"positions": {"mouth": [700, 300]}})
    drawn = subprocess.run(
        [sys.executable, "-m", "robocomp_yaml", "graph", "--as", "json"], capture_output=True, text=True, check=True
    )
    (mouth,) = [one for one in json.loads(drawn.stdout)["nodes"] if one["name"] == "mouth"]
    assert (mouth["x"], mouth["y"]) == (700, 300)


def test_only_documents_of_the_workspace_are_typed_and_written(served: Manager, tmp_path: Path) -> None:
    outside = tmp_path / "other.ddsl.yaml"
    outside.write_text("deployment: Other\n")
    Path("link.ddsl.yaml").symlink_to(outside)
    for path in ("../other.ddsl.yaml", str(outside), "link.ddsl.yaml", "/etc/passwd", "new.ddsl.yaml", "", "x\0"):
        for command, more in (("write", {}), ("diagnose", {}), ("completion", {"line": 1, "column": 1})):
            status, answer = served.robot(command, {"path": path, "text": "deployment: X\n", **more})
            assert (status, "not a document of this workspace" in answer["error"]) == (400, True), (command, path)
    assert outside.read_text() == "deployment: Other\n"
    assert not Path("new.ddsl.yaml").exists()


def test_the_command_line_moves_boxes_too(served: Manager) -> None:
    import subprocess

    def place(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "robocomp_yaml", "edit", "place", *words]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    done = place("mouth", "640", "80.5")
    assert (done.returncode, done.stdout) == (0, "wrote .rcyaml/layout/robot.json: place mouth\n")
    assert served.robot("positions")[1] == {"positions": {"mouth": [640, 80.5]}}
    assert place("mouth").returncode == 0
    assert served.robot("positions")[1] == {"positions": {}}
    for words, text in ((("muth", "1", "1"), "did you mean 'mouth'"), (("mouth", "1"), "two numbers")):
        assert (place(*words).returncode, text in place(*words).stderr) == (2, True)
