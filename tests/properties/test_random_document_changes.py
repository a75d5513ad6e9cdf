"""Fifty random changes of a deployment and its components, as a person makes them: no comment and no line is lost, every
change can be undone and made again, and the result is what one gets from the documents without a past."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from random import Random

import pytest

from conftest import write_tree
from deployments import deployed
from robocomp_yaml import api
from robocomp_yaml.api.editing import changes
from robocomp_yaml.api.editing.editor import DocumentEditor

EDITS = 50
DDSL = "robot.ddsl.yaml"
DEPLOYMENT = """\
# c-head
hosts: # c-hosts
  one: 10.0.0.2 # c-one

  # c-above two
  two: {address: 10.0.0.3, user: robo} # c-two
components: # c-components

  # c-above speech
  speech: {component: speech, host: one} # c-speech
  mouth: # c-mouth
    component: mouth # c-mouth component
    # c-in mouth
    host: one # c-mouth host
    set: # c-set
      period: {compute: 20} # c-period
  "lips": {component: mouth, host: two, # c-lips
         connect: {}, after: [mouth]} # c-lips too
  wait:
    program: sleep # c-wait
    args: # c-args
      - "9" # c-nine
    host: two # c-host
    after: # c-after
      - mouth # c-after mouth
  ear: {component: ear, host: one} # c-ear

# c-above groups
groups: # c-groups
  face: {components: [speech, mouth]} # c-face
  body: # c-body
    components: # c-members
      # c-above wait
      - wait # c-member
# c-foot
"""
PORTS = "implements: # c-implements\n  - Speech # c-speech\n# c-above\nrequires: [Mouth] # c-requires\n# c-end\n"
Make = Callable[[Random], changes.DocumentChange]
NAMES = ("speech", "mouth", "lips", "wait", "ear", "face", "body", "one", "two", "e1", "e2", "e3", "mouth{i}", "lips0")


def entry(random: Random) -> str:
    return random.choice(NAMES[:5] + NAMES[9:])


MADE: tuple[Make, ...] = (
    lambda random: changes.Connect(entry(random), "Mouth", entry(random)),
    lambda random: changes.Disconnect(entry(random), "Mouth"),
    lambda random: changes.NameTopic(entry(random), "Heard", random.choice(("", "left/Heard", "# odd: [name"))),
    lambda random: changes.MoveEntry(entry(random), random.choice(("one", "two", "three"))),
    lambda random: changes.AddHost(f"h{random.randrange(9)}", "10.0.0.9", random.choice(("", "robo"))),
    lambda random: changes.GroupEntries(random.choice(("face", "body", "g1", "g2")), (entry(random), entry(random))),
    lambda random: changes.UngroupEntries(random.choice(("face", "body", "g1")), (entry(random),)),
    lambda random: changes.AddEntry(random.choice(("e1", "e2", "e3")), component="mouth"),
    lambda random: changes.AddEntry(random.choice(("e1", "e2")), program="sleep", args=("# 9", "'")),
    lambda random: changes.AddNew(f"n{random.randrange(99)}", f"N{random.randrange(99)}", implements=("Speech",)),
    lambda random: changes.RenameEntry(entry(random), random.choice((*NAMES, "e{i}", "new name"))),
    lambda random: changes.SetParameter(
        entry(random), random.choice(("period.compute", "volume", "a.b")), random.choice((None, 5, "x # y", [1, 2]))
    ),
    lambda random: changes.SetPort(
        entry(random), random.choice((None, random.randrange(1, 65536))), random.choice(("", "Mouth", "CommonBehavior"))
    ),
    lambda random: changes.SetInstances(entry(random), random.randrange(1, 4)),
    lambda random: changes.StartAfter(entry(random), (entry(random), entry(random))),
    lambda random: changes.StartIndependently(entry(random), (entry(random),)),
    lambda random: changes.Require(random.choice(("Speech", "Mouth")), random.choice(("SpeechComp", "mouth"))),
    lambda random: changes.Unrequire(random.choice(("Speech", "Mouth")), random.choice(("SpeechComp", "mouth"))),
    lambda random: changes.Implement(("Speech", "Mouth"), random.choice(("speech", "EarComp"))),
    lambda random: changes.Unimplement("Speech", random.choice(("speech", "ear"))),
    lambda random: changes.Publish("Heard", random.choice(("speech", "mouth"))),
    lambda random: changes.Unpublish("Heard", random.choice(("speech", "mouth"))),
    lambda random: changes.Subscribe("Heard", random.choice(("speech", "ear"))),
    lambda random: changes.Unsubscribe("Heard", random.choice(("speech", "ear"))),
)  # fmt: skip


def comments(text: str) -> Counter[str]:
    return Counter(found[found.index("# c-") :].rstrip() for found in text.splitlines() if "# c-" in found)


def keys(text: str) -> int:
    """The lines with something in them."""
    return sum(1 for line in text.splitlines() if line.strip())


def documents() -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in sorted(Path().rglob("*.yaml")) if ".rcyaml" not in path.parts}


def workspace(line_end: str) -> None:
    write_tree(Path(), deployed(DEPLOYMENT, speech=PORTS, mouth="implements: [Mouth] # c-mouth\n", ear="# c-ear\n"))
    for path in documents():
        path.write_bytes(path.read_bytes().replace(b"\n", line_end.encode()))


@pytest.mark.parametrize("seed", range(8))
def test_random_changes_lose_no_comment_and_no_line(seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    workspace("\r\n" if seed % 4 == 3 else "\n")
    random, editor = Random(seed), DocumentEditor(api.follow("."))
    at_first, done, refused = documents(), list[tuple[str, changes.DocumentChange]](), 0
    while len(done) < EDITS:
        change = random.choice(MADE)(random)
        try:
            revision = editor.revise(DDSL, change)
        except api.Refused as error:
            refused += 1
            assert "\n" not in str(error)
            assert refused < 40 * EDITS
            continue
        before, after = revision.before.decode(), revision.after.decode()
        assert not comments(before) - comments(after), change
        assert keys(after) >= keys(before) - _removed(change, before), change
        assert ("\r\n" in before) == ("\r\n" in after)
        assert "\n" not in after.replace("\r\n", "") or "\r\n" not in after, change
        if revision.is_empty:
            continue
        editor.write(revision, force=True)
        done.append((revision.path, change))
    at_last = documents()
    fresh = api.load(".").analysis.diagnostics
    assert [str(one) for one in fresh] == [str(one) for one in revision.diagnostics] or revision.is_empty
    other = DocumentEditor(api.follow("."))  # as another process
    for path, _ in reversed(done):
        other.undo(path)
    assert documents() == at_first
    for path, _ in done:
        other.redo(path)
    assert documents() == at_last


def _removed(change: changes.DocumentChange, before: str) -> int:
    """The lines that a change may remove: those of the value that is removed, and of collections that get empty."""
    if isinstance(change, (changes.Disconnect, changes.NameTopic, changes.SetParameter, changes.SetPort)):
        return 3
    if isinstance(change, (changes.UngroupEntries, changes.StartIndependently)):
        return 4
    return 2 if not getattr(change, "adds", True) else 0
