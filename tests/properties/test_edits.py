"""Random changes of a deployment: no comment is lost, no line changes that was not meant, and all can be undone."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest

from conftest import write_tree
from deployments import deployed
from robocomp_yaml import api
from robocomp_yaml.api.editing import changes as made
from robocomp_yaml.api.editing.editor import DocumentEditor
from robocomp_yaml.source.comments import comments
from robocomp_yaml.source.tree import parse

DDSL = "robot.ddsl.yaml"
EDITS = 50


def _document(random: Random) -> str:
    """A deployment in mixed layouts, with a comment in every line."""
    lines = ["deployment: Robot", "hosts:", "  one: 10.0.0.2", "  two: {address: 10.0.0.3}", "", "components:"]
    for number in range(8):
        kind, host = ("speech", "mouth")[number % 2], random.choice(("one", "two"))
        keys = {"component": kind, "host": host}
        if kind == "speech":
            keys["connect"] = f"{{Mouth: c{random.choice((1, 3, 5, 7))}}}"
        if random.random() < 0.5:
            keys["set"] = "{period.compute: 50}"
        if random.random() < 0.5:
            keys["after"] = "[wait]"
        match random.randrange(3):
            case 0:
                lines.append(f"  c{number}: {{{', '.join(f'{key}: {value}' for key, value in keys.items())}}}")
            case 1:
                lines.append(f"  c{number}:")
                for key, value in keys.items():
                    if value.startswith("{") and random.random() < 0.5:
                        lines += [f"    {key}:", f"      {value[1:-1]}"]
                    elif value.startswith("[") and random.random() < 0.5:
                        lines += [f"    {key}:", f"      - {value[1:-1]}"]
                    else:
                        lines.append(f"    {key}: {value}")
            case _:
                first, *others = [f"{key}: {value}" for key, value in keys.items()]
                lines += [f"  c{number}: {{{first},", *(f"    {one}," for one in others), "  }"]
        if random.random() < 0.3:
            lines += [f"    # about c{number}", ""]
    lines += ["  wait: {program: sleep, args: [9], host: one}", "groups:", "  all: {components: [c0, c1]}"]
    return "".join(
        f"{line}{' ' * random.choice((1, 3))}# {number}\n" if line and "#" not in line else f"{line}\n"
        for number, line in enumerate(lines)
    )


def _change(random: Random) -> made.DocumentChange:
    entry, other = (f"c{random.randrange(8)}" for _ in "12")
    speech, mouth = f"c{random.choice((0, 2, 4, 6))}", f"c{random.choice((1, 3, 5, 7))}"
    return random.choice((
        made.Connect(speech, "Mouth", mouth), made.Connect(speech, "Mouth", f"{mouth}.Mouth"),
        made.Disconnect(speech, "Mouth"), made.MoveEntry(entry, random.choice(("one", "two"))),
        made.GroupEntries(random.choice(("all", "some")), (entry, other)), made.UngroupEntries("all", (entry,)),
        made.SetParameter(entry, "period.compute", random.randrange(1, 99)),
        made.SetParameter(entry, "period.compute", None), made.SetPort(entry, random.randrange(10000, 20000)),
        made.SetPort(entry, None), made.StartAfter(entry, ("wait",)), made.StartIndependently(entry, ("wait",)),
    ))  # fmt: skip


def _comments(text: str) -> Counter[str]:
    root, faults = parse(DDSL, text)
    assert root is not None
    assert not faults
    return Counter(comment for _, comment in comments(text, root))


def _without_comment(line: str) -> str:
    return line.partition(" #")[0].strip()


@pytest.mark.parametrize("seed", range(3))
def test_random_edits_lose_no_comment_and_no_line(seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    random = Random(seed)
    write_tree(Path(), deployed(""))
    first = _document(random)
    Path(DDSL).write_text(first)
    assert not api.load(DDSL).analysis.diagnostics
    editor, written = DocumentEditor(api.follow(".")), 0
    for _ in range(EDITS * 4):
        change, before = _change(random), Path(DDSL).read_text()
        try:
            revision = editor.revise(DDSL, change)
        except api.Refused:
            continue  # such as a disconnection of what is not connected
        editor.write(revision, force=True)
        after = Path(DDSL).read_text()
        assert _comments(after) == _comments(before), change
        entry = str(getattr(change, "entry", "")) or "groups"
        for owner, line in Counter(_owned(before)) - Counter(_owned(after)):
            is_meant = owner == entry or (entry == "groups" and owner in ("groups", "all", "some"))
            assert is_meant or not _without_comment(line), (change, line)
        written += not revision.is_empty
        if written == EDITS:
            break
    assert written == EDITS
    for _ in range(EDITS):
        editor.undo(DDSL)
    assert Path(DDSL).read_text() == first


def _owned(text: str) -> Iterator[tuple[str, str]]:
    """The lines, each with the entry or section to which it belongs: the last key that is indented by at most two."""
    owner = ""
    for line in text.splitlines():
        if line[:2].strip() and not line.startswith("#"):
            owner = line.partition(":")[0]
        elif line[:3].strip() and line.strip()[0] not in "#}-":
            owner = line.strip().partition(":")[0]
        yield owner, line
