"""Changes of deployments and components, and what becomes of the document."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from deployments import deployed
from robocomp_yaml import api
from robocomp_yaml.api.editing import changes, layout
from robocomp_yaml.api.editing.changes import (
    AddEntry,
    AddHost,
    AddNew,
    Connect,
    Disconnect,
    GroupEntries,
    MoveEntry,
    NameTopic,
    Publish,
    RemoveEntry,
    RemoveHost,
    RenameEntry,
    Require,
    SetInstances,
    SetParameter,
    SetPort,
    StartAfter,
    StartIndependently,
    UngroupEntries,
    Unrequire,
)  # fmt: skip
from robocomp_yaml.api.editing.editor import DocumentEditor, EditConflict

DDSL = "robot.ddsl.yaml"


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def editor(text: str, **others: str) -> DocumentEditor:
    write_tree(Path(), deployed(text, **others))
    return DocumentEditor(api.follow("."))


def after(text: str, *made: changes.DocumentChange, force: bool = False, **others: str) -> str:
    """The deployment's document after these changes, without its first line."""
    one = editor(text, **others)
    for change in made:
        one.write(one.revise(DDSL, change), force=force)
    return Path(DDSL).read_text().removeprefix("deployment: Robot\n")


TWO = """\
components:
  speech: {component: speech, connect: {Mouth: mouth}} # talks
  mouth: {component: mouth}
  lips: # the other
    component: mouth # too
"""
HOSTS = """\
hosts:
  one: 10.0.0.2
components:
  speech: {component: speech} # talks
  mouth:
    component: mouth
"""


@pytest.mark.parametrize(
    ("text", "change", "expected"),
    [
        (TWO, Connect("speech", "Mouth", "lips"), TWO.replace("Mouth: mouth", "Mouth: lips")),
        (TWO, Connect("speech", "Mouth", "lips.Mouth"), TWO.replace("Mouth: mouth", "Mouth: lips.Mouth")),
        (TWO, Connect("speech", "Mouth", "m:tcp -p 1"), TWO.replace("Mouth: mouth", 'Mouth: "m:tcp -p 1"')),
        (TWO, RenameEntry("mouth", "jaw"), TWO.replace("mouth:", "jaw:").replace("Mouth: mouth", "Mouth: jaw")),
        (TWO, RemoveEntry("lips"), TWO[: TWO.index("  lips")]),
        (TWO, SetParameter("lips", "period.compute", 50), TWO + "    set:\n      period.compute: 50\n"),
        (TWO, SetPort("mouth", 10001), TWO.replace("component: mouth}", "component: mouth, port: 10001}")),
        (TWO, SetPort("mouth", 10001, "CommonBehavior"),
         TWO.replace("component: mouth}", "component: mouth, ports: {CommonBehavior: 10001}}")),
        (TWO, StartAfter("lips", ("speech", "mouth")), TWO + "    after: [speech, mouth]\n"),
        (TWO, GroupEntries("face", ("mouth", "lips")), TWO + "groups:\n  face:\n    components: [mouth, lips]\n"),
        (TWO, AddEntry("eye", program="sleep", args=("9",)), TWO + '  eye: {program: sleep, args: ["9"]}\n'),
        (TWO, AddEntry("jaw", component="mouth/mouth.cdsl.yaml"), TWO + "  jaw: {component: mouth/mouth.cdsl.yaml}\n"),
        (TWO, SetInstances("lips", 3), TWO.replace("lips:", "lips{i}:") + "    instances: 3\n"),
        (HOSTS, AddHost("two", "10.0.0.3", "robo"), (
            HOSTS.replace("10.0.0.2\n", "10.0.0.2\n  two: {address: \"10.0.0.3\", user: robo}\n")
            .replace("speech}", "speech, host: one}") + "    host: one\n")),
        (HOSTS.replace("  one: 10.0.0.2\n", "  one: 10.0.0.2\n  more: 10.0.0.4\n"),
         AddHost("two", "arm", path="/opt/robot", port=2222, known_hosts="keys", jump="gate"), (
            HOSTS.replace("10.0.0.2\n", "10.0.0.2\n  more: 10.0.0.4\n  two: {address: arm, path: /opt/robot, "
                          "ssh: {port: 2222, known-hosts: keys, jump: gate}}\n"))),
    ],
)  # fmt: skip
def test_a_change_is_made_in_place(text: str, change: changes.DocumentChange, expected: str) -> None:
    assert after(text, change) == expected


def test_a_change_and_its_opposite_restore_the_text() -> None:
    mouth = "components:\n  speech: {component: speech} # a\n  mouth: {component: mouth}\n"
    pairs = [
        (Connect("speech", "Mouth", "mouth"), Disconnect("speech", "Mouth")),
        (SetPort("mouth", 10009), SetPort("mouth", None)),
        (SetParameter("mouth", "period.compute", 5), SetParameter("mouth", "period.compute", None)),
        (StartAfter("speech", ("mouth",)), StartIndependently("speech", ("mouth",))),
        (GroupEntries("face", ("speech",)), UngroupEntries("face", ("speech",))),
        (GroupEntries("face", ("speech",)), UngroupEntries("face")),
        (AddEntry("wait", program="sleep"), RemoveEntry("wait")),
        (RenameEntry("mouth", "lips"), RenameEntry("lips", "mouth")),
        (AddHost("one", "10.0.0.2"), RemoveHost("one")),
    ]
    for change, opposite in pairs:
        assert after(mouth, change) != mouth
        assert after(mouth, change, opposite) == mouth, change


def test_what_names_an_entry_is_renamed_and_removed_with_it() -> None:
    text = """\
components:
  speech: {component: speech, connect: {Mouth: mouth.Mouth}, after: [mouth, wait]}
  mouth: {component: mouth}
  wait: {program: sleep}
groups: {face: {components: [speech, mouth], expose: {Mouth: mouth}}}
"""
    renamed = after(text, RenameEntry("mouth", "m2"))
    assert "connect: {Mouth: m2.Mouth}, after: [m2, wait]" in renamed
    assert "components: [speech, m2], expose: {Mouth: m2}" in renamed
    removed = after(text, RemoveEntry("mouth"), force=True)
    assert "  speech: {component: speech, after: [wait]}\n" in removed
    assert "groups: {face: {components: [speech]}}\n" in removed


def test_instances_get_numbers_wherever_they_are_named() -> None:
    text = """\
components:
  speech: {component: speech, connect: {Mouth: mouth}, after: [mouth]}
  mouth: {component: mouth}
"""
    made = after(text, SetInstances("mouth", 2))
    assert 'speech: {component: speech, connect: {Mouth: mouth0}, after: ["mouth{i}"]}' in made
    assert "mouth{i}: {component: mouth, instances: 2}" in made
    again = after(text, SetInstances("mouth", 2), SetInstances("mouth1", 4), RenameEntry("mouth0", "lips{i}"))
    assert 'connect: {Mouth: lips0}, after: ["lips{i}"]' in again
    assert "lips{i}: {component: mouth, instances: 4}" in again


def test_topics_get_names() -> None:
    text = "services: {storm: {icestorm: }}\ncomponents:\n  ear: {component: ear}\n"
    named = after(text, NameTopic("ear", "Heard", "left/Heard"), ear="publishes: [Heard]\n")
    assert "ear: {component: ear, topics: {Heard: left/Heard}}" in named
    assert after(text, NameTopic("ear", "Heard", "x"), NameTopic("ear", "Heard"), ear="publishes: [Heard]\n") == text


def test_a_parameter_is_set_where_it_is_set() -> None:
    nested = "components:\n  mouth:\n    component: mouth\n    set:\n      period: {compute: 5} # fast\n"
    assert after(nested, SetParameter("mouth", "period.compute", 7)) == nested.replace("5", "7")
    by_path = "components:\n  mouth: {component: mouth, set: {period.compute: 5}}\n"
    assert after(by_path, SetParameter("mouth", "period.compute", 7)) == by_path.replace("5", "7")


def test_both_kinds_of_ports_exclude_each_other() -> None:
    text = "components:\n  mouth: {component: mouth, port: 10001}\n"
    made = after(text, SetPort("mouth", 10002, "CommonBehavior"))
    assert "ports: {Mouth: 10001, CommonBehavior: 10002}" in made
    assert " port:" not in made


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (Connect("speach", "Mouth", "mouth"), "has no entry 'speach'; did you mean 'speech'?"),
        (Disconnect("lips", "Mouth"), "the connection follows from the components"),
        (MoveEntry("speech", "ome"), "has no host 'ome'; did you mean 'one'?"),
        (AddHost("one", "10.0.0.9"), "has a host 'one' already"),
        (AddEntry("mouth", program="sleep"), "has a 'mouth' already"),
        (AddEntry("x", component="no/such"), "'no/such' does not exist"),
        (RenameEntry("mouth", "speech"), "has a 'speech' already"),
        (RenameEntry("mouth", "m{i}"), "an entry with instances has {i} in its name"),
        (SetInstances("mouth", 0), "at least one instance"),
        (SetParameter("mouth", "period.compute", None), "does not set period.compute of mouth"),
        (StartIndependently("mouth", ("speech",)), "does not say that mouth starts after 'speech'"),
        (UngroupEntries("face", ("lips",)), "has no group 'face'"),
        (Require("Mouth"), "is not the document of a component"),
    ],
)  # fmt: skip
def test_what_is_not_possible_is_refused(change: changes.DocumentChange, message: str) -> None:
    text = "hosts: {one: 10.0.0.2}\n" + TWO
    one = editor(text)
    with pytest.raises(api.Refused) as refused:
        one.revise(DDSL, change)
    assert message in str(refused.value)


def test_a_change_that_causes_errors_is_not_written() -> None:
    one = editor(TWO)
    for change, code in (
        (Connect("speech", "Mouth", "speech"), "RC4204"), (RemoveEntry("mouth"), None),
        (SetParameter("mouth", "period.compute", "often"), "RC3302"), (SetPort("mouth", 70000), "RC0204"),
    ):  # fmt: skip
        before = Path(DDSL).read_text()
        revision = one.revise(DDSL, change)
        if code is None:
            assert not revision.new_errors  # the other one serves it
            continue
        with pytest.raises(api.Faulty) as faulty:
            one.write(revision)
        assert code in [error.code for error in faulty.value.diagnostics]
        assert Path(DDSL).read_text() == before
        one.write(revision, force=True)
        assert Path(DDSL).read_text() != before
        one.undo(DDSL)


def test_errors_that_were_there_do_not_prevent_a_change() -> None:
    text = "components:\n  speech: {component: speech}\n  mouth: {component: mouth}\n  lips: {component: mouth}\n"
    assert "jaw" in after(text, RenameEntry("lips", "jaw"))


def test_errors_in_other_documents_count() -> None:
    one = editor("components: {mouth: {component: mouth}}\n", **{
        "all.ddsl.yaml": "deployment: All\ninclude: {left: robot.ddsl.yaml}\n"
                         "components: {wait: {program: sleep, after: [left.mouth]}}\n",
    })  # fmt: skip
    revision = one.revise(DDSL, RenameEntry("mouth", "lips"))
    assert [(error.code, error.span.file) for error in revision.new_errors] == [("RC4005", "all.ddsl.yaml")]


def test_entries_of_included_documents_are_changed_there() -> None:
    one = editor("components: {mouth: {component: mouth}, speech: {component: speech}}\n", **{
        "all.ddsl.yaml": "deployment: All\ninclude: {left: robot.ddsl.yaml}\n",
    })  # fmt: skip
    revision = one.revise("all.ddsl.yaml", Connect("left.speech", "Mouth", "left.mouth"))
    assert revision.path == DDSL
    assert b"connect: {Mouth: mouth}" in revision.after


def test_undo_and_redo_until_somebody_else_changes_the_file() -> None:
    one = editor(TWO)
    first = Path(DDSL).read_bytes()
    for change in (SetPort("mouth", 10001), StartAfter("lips", ("mouth",))):
        one.write(one.revise(DDSL, change))
    last = Path(DDSL).read_bytes()
    other = DocumentEditor(api.follow("."))  # as another process would
    assert other.undo(DDSL).what == "undo: after lips mouth"
    other.undo(DDSL)
    assert Path(DDSL).read_bytes() == first
    with pytest.raises(api.Refused, match="nothing to undo: there is no such change"):
        one.undo(DDSL)
    assert one.redo(DDSL).what == "redo: port mouth 10001"
    one.redo(DDSL)
    assert Path(DDSL).read_bytes() == last
    Path(DDSL).write_bytes(last + b"# mine\n")
    with pytest.raises(api.Refused, match="changed by somebody else"):
        one.undo(DDSL)
    one.write(one.revise(DDSL, SetPort("mouth", 10002)))
    one.undo(DDSL)
    assert Path(DDSL).read_bytes() == last + b"# mine\n"


def test_a_file_that_was_changed_meanwhile_is_kept() -> None:
    one = editor(TWO)
    version, seen = one.version(DDSL), Path(DDSL).read_text()
    revision = one.revise(DDSL, SetPort("mouth", 10001), version)
    theirs = seen + "# mine\n"
    Path(DDSL).write_text(theirs)
    with pytest.raises(EditConflict) as late:
        one.write(revision)
    with pytest.raises(EditConflict) as early:
        one.revise(DDSL, SetPort("mouth", 10001), version)
    assert Path(DDSL).read_text() == theirs
    for conflict in (late.value, early.value):
        assert (conflict.theirs, conflict.ours) == (theirs, revision.after.decode())
    one.write(one.revise(DDSL, SetPort("mouth", 10001), one.version(DDSL)))
    assert "# mine" in Path(DDSL).read_text()
    assert "port: 10001" in Path(DDSL).read_text()


def test_the_order_of_marks_and_line_ends_stay() -> None:
    one = editor("")
    Path(DDSL).write_bytes(b"\xef\xbb\xbfdeployment: Robot\r\ncomponents:\r\n  mouth: {component: mouth}\r\n")
    one.write(one.revise(DDSL, SetPort("mouth", 10001)))
    assert Path(DDSL).read_bytes() == (
        b"\xef\xbb\xbfdeployment: Robot\r\ncomponents:\r\n  mouth: {component: mouth, port: 10001}\r\n"
    )


def test_a_broken_document_is_not_changed() -> None:
    one = editor("components: {mouth: [}\n")
    with pytest.raises(api.Faulty):
        one.revise(DDSL, SetPort("mouth", 1))


def test_interfaces_are_added_with_their_imports() -> None:
    one = editor("", **{"Ear.idsl.yaml": "module: RoboCompEar\ninterfaces: {Ear: {methods: {hear: }}}\n"})
    path = "speech/speech.cdsl.yaml"
    for change in (Require("Ear", "SpeechComp"), Publish("Heard", "speech")):
        one.write(one.revise(path, change))
    assert Path(path).read_text() == (
        "component: SpeechComp\nlanguage: python\nimports: [../Face, ../Ear]\nimplements: [Speech]\n"
        "requires: [Mouth, Ear]\npublishes: [Heard]\n"
    )
    with pytest.raises(api.Refused, match="requires 'Ear' already"):
        one.revise(path, Require("Ear"))
    one.write(one.revise(path, Unrequire(("Mouth", "Ear"))))
    assert "requires" not in Path(path).read_text()
    with pytest.raises(api.Refused, match="defines an interface 'Eer'; did you mean 'Ear'"):
        one.revise(path, Require("Eer"))


def test_ports_with_names_of_their_own_are_removed_by_them() -> None:
    lists = "requires:\n  - Mouth # the first\n  - {Mouth1: Mouth} # the second\n"
    one = editor("", speech=lists)
    revision = one.revise("speech/speech.cdsl.yaml", Unrequire("Mouth1"))
    assert b"requires:\n  - Mouth # the first\n  # the second\n" in revision.after


def test_the_port_of_a_program_is_in_its_endpoint() -> None:
    laser = "components:\n  laser: {program: sleep, endpoints: {Laser: tcp -h any  -p 10003 -t 5}} # eyes\n"
    assert after(laser, SetPort("laser", 12)) == laser.replace("10003", "12")
    assert after(laser, SetPort("laser", 12, "Laser")) == laser.replace("10003", "12")
    for change, message in (
        (SetPort("laser", None), "the endpoint of Laser is 'tcp -h any  -p 10003 -t 5'"),
        (SetPort("laser", 12, "Lasre"), "did you mean 'Laser'"),
    ):
        with pytest.raises(api.Refused, match=message):
            after(laser, change)


def test_changes_are_read_from_json() -> None:
    data = {"change": "connect", "entry": "speech", "port": "Mouth", "to": "mouth"}
    assert changes.from_json(data) == Connect("speech", "Mouth", "mouth")
    for wrong in ({"change": "conect"}, {"change": "connect", "entry": 1}, {**data, "more": 1}, [], None):
        with pytest.raises(ValueError):  # noqa: PT011 (the message is msgspec's)
            changes.from_json(wrong)


def test_a_component_is_named_by_its_name_folder_or_document() -> None:
    one = editor(TWO)
    for name in ("MouthComp", "mouth", "./mouth/", "mouth/mouth.cdsl.yaml"):
        assert one.revise(DDSL, Require("Speech", name)).path == "mouth/mouth.cdsl.yaml"
    for name, message in (("MuthComp", "did you mean 'MouthComp'"), ("/etc", "unknown component"), ("..", "unknown")):
        with pytest.raises(api.Refused, match=message):
            one.revise(DDSL, Require("Speech", name))


def test_a_new_component_is_written_with_its_entry_and_removed_by_undo() -> None:
    one, path = editor(TWO), Path("components/earcomp/earcomp.cdsl.yaml")
    change = AddNew("ear", "EarComp", implements=("Speech",), requires=("Mouth",))
    with pytest.raises(api.Faulty) as faulty:
        one.write(one.revise(DDSL, change))  # who serves Mouth?
    assert ("RC4202" in {error.code for error in faulty.value.diagnostics}, path.exists()) == (True, False)
    change = AddNew("ear", "EarComp", implements=("Speech",))
    revision = one.revise(DDSL, change)
    assert (path.exists(), "+++ b/components/earcomp/earcomp.cdsl.yaml" in revision.diff) == (False, True)
    one.write(revision)
    assert "  ear: {component: components/earcomp/earcomp.cdsl.yaml}\n" in Path(DDSL).read_text()
    written = path.read_text()
    assert "implements: [Speech]" in written
    one.undo(DDSL)
    assert (path.exists(), path.parent.exists(), Path(DDSL).read_text()) == (False, False, f"deployment: Robot\n{TWO}")
    one.redo(DDSL)
    assert path.read_text() == written
    path.write_text(written + "# mine\n")
    one.undo(DDSL)
    assert path.read_text().endswith("# mine\n")  # it is the user's now
    with pytest.raises(api.Refused, match="exists already"):
        one.redo(DDSL)
    assert "ear:" not in Path(DDSL).read_text()
    with pytest.raises(api.Refused, match="exists already"):
        one.revise(DDSL, change)
    with pytest.raises(api.Refused, match="'9x' is not a name"):
        one.revise(DDSL, AddNew("ear", "9x"))
    with pytest.raises(api.Refused, match="no language 'pyton'; did you mean 'python'"):
        one.revise(DDSL, AddNew("ear", "Ear", "pyton"))


def test_positions_follow_names() -> None:
    one = editor(TWO, **{"all.ddsl.yaml": "deployment: All\ninclude: {left: robot.ddsl.yaml}\n"})
    layout.move(DDSL, {"mouth": (10, 20), "lips": (30, 40.04), "speech": (1, 1)})
    layout.move("all.ddsl.yaml", {"left.mouth": (5, 5)})
    one.write(one.revise("all.ddsl.yaml", RenameEntry("left.mouth", "jaw")))
    assert (layout.read(DDSL)["jaw"], layout.read("all.ddsl.yaml")) == ((10, 20), {"left.jaw": (5, 5)})
    one.undo(DDSL)
    assert (layout.read(DDSL)["mouth"], layout.read("all.ddsl.yaml")) == ((10, 20), {"left.mouth": (5, 5)})
    one.write(one.revise(DDSL, SetInstances("lips", 2)))
    layout.move(DDSL, {"lips1": (7, 7), "speech": None})
    one.write(one.revise(DDSL, RenameEntry("lips1", "l{i}"), ""))
    assert layout.read(DDSL) == {"mouth": (10, 20), "l0": (30, 40), "l1": (7, 7)}
    for wrong in ({"x": (-1, 0)}, {"x": (float("nan"), 0)}, {"x" * 2000: (1, 1)}):
        with pytest.raises(api.Refused):
            layout.move(DDSL, wrong)
    Path(".rcyaml/layout/robot.json").write_text("[broken")
    assert layout.read(DDSL) == {}


def test_positions_do_not_leave_the_workspace(tmp_path: Path) -> None:
    editor(TWO)
    elsewhere = tmp_path.parent / f"{tmp_path.name}-elsewhere"
    elsewhere.mkdir()
    Path(".rcyaml").mkdir(exist_ok=True)
    Path(".rcyaml/layout").symlink_to(elsewhere)
    with pytest.raises(api.Refused, match="a link leads out of the workspace"):
        layout.move(DDSL, {"mouth": (1, 1)})
    assert not list(elsewhere.iterdir())


def test_a_text_replaces_a_document_as_a_change_does() -> None:
    one = editor("")
    Path(DDSL).write_bytes(b"\xef\xbb\xbfdeployment: Robot\r\ncomponents:\r\n  mouth: {component: mouth}\r\n")
    version = one.version(DDSL)
    text = "deployment: Robot\ncomponents:\n  mouth: {component: mouth, port: 10001} # mine\n"
    one.write(one.rewrite(DDSL, text, version))
    assert Path(DDSL).read_bytes() == b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode()
    with pytest.raises(EditConflict) as conflict:
        one.rewrite(DDSL, "deployment: Other\n", version)
    assert conflict.value.ours.endswith("deployment: Other\r\n")
    with pytest.raises(api.Faulty):
        one.write(one.rewrite(DDSL, "deployment: [\n"))
    one.write(one.rewrite(DDSL, "deployment: [\n"), force=True)
    one.undo(DDSL)
    assert b"# mine" in Path(DDSL).read_bytes()
    Path(DDSL).write_bytes(b"deployment: Caf\xe9\n")
    with pytest.raises(api.Refused, match="is not UTF-8 text"):
        one.rewrite(DDSL, text)
