"""`config set` in the document that `config new` wrote: its commented lines stay lines that can be used."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

Run = Callable[..., Result]
PDSL = """\
component: c.cdsl.yaml
parameters:
  device: {type: string, default: /dev/tty, doc: "Where.\\n\\ndevice: none"}
  offsets: {map: float, default: {}}
  gains: {list: float, default: [1, 2]}
  speed: float
  Arm: {group: {device: {type: string, optional: true}, Hand: {group: {force: {type: float, default: 1}}}}}
  Last: {group: {low: {type: int, default: 0}, high: {type: int, default: 9}}}
"""


@pytest.fixture
def document(rcyaml: Run, tmp_path: Path) -> Path:
    write_tree(tmp_path, {"c.cdsl.yaml": "component: C\nlanguage: python\n", "c.pdsl.yaml": PDSL})
    assert rcyaml("config", "new", "c.cdsl.yaml").exit_code == 0
    return tmp_path / "etc/config.yaml"


@pytest.mark.parametrize(("path", "value", "before", "after"), [
    ("device", "/dev/x", "  # device: /dev/tty\n", "  device: /dev/x\n"),
    ("offsets.left", "2", "  # offsets: {}\n", "  offsets:\n    left: 2\n"),
    ("Arm.device", "left", "    # device: text\n", "    device: left\n"),
    ("Arm.Hand.force", "7", "      # force: 1\n", "      force: 7\n"),
    ("Last.high", "8", "    # high: 9\n", "    high: 8\n"),
    ("period.emergency", "70", "    # emergency: 500\n", "    emergency: 70\n"),
])  # fmt: skip
def test_the_line_that_is_left_out_becomes_the_value(
    rcyaml: Run, document: Path, path: str, value: str, before: str, after: str
) -> None:
    was = document.read_text()
    assert was.count(before) == 1
    assert rcyaml("config", "set", "etc/config.yaml", path, value).exit_code == 0
    assert document.read_text() == was.replace(before, after)


def test_a_comment_of_the_user_is_left_alone(rcyaml: Run, document: Path) -> None:
    mine = "component: ../c.cdsl.yaml\nparameters:\n  speed: 1\n  # the old one:\n  # device: /dev/tty\n"
    document.write_text(mine)
    assert rcyaml("config", "set", "etc/config.yaml", "device", "x").exit_code == 0
    assert document.read_text() == mine.replace("speed: 1\n", "speed: 1\n  device: x\n")


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_comments_stay_below_the_key_that_they_belong_to(rcyaml: Run, document: Path, end: str) -> None:
    """Nothing comes between a key and what is indented below it, by whatever width."""
    head = "component: ../c.cdsl.yaml\nparameters:\n    speed: 1\n    Last:\n"
    inner = "\n        # rarely changed\n        # low: 3\n\n        # high: 8\n"
    document.write_bytes(f"{head}{inner}endpoints: {{}}\n".replace("\n", end).encode())
    assert rcyaml("config", "set", "etc/config.yaml", "device", "x").exit_code == 0
    assert document.read_bytes().decode().replace("\r\n", "\n") == f"{head}{inner}    device: x\nendpoints: {{}}\n"
    assert rcyaml("config", "set", "etc/config.yaml", "Arm.Hand.force", "3").exit_code == 0
    text = document.read_text().replace("# low", "low").replace("# high", "high")
    document.write_text(text)
    shown = rcyaml("config", "show", "etc/config.yaml").stdout
    assert all(line in shown for line in ("Last.low = 3", "Last.high = 8", "Arm.Hand.force = 3", "device = x"))


def test_a_first_child_goes_where_the_comments_stand(rcyaml: Run, document: Path) -> None:
    document.write_text("component: ../c.cdsl.yaml\nparameters:\n  speed: 1\n  Last:\n      # low: 3\n")
    assert rcyaml("config", "set", "etc/config.yaml", "Last.high", "5").exit_code == 0
    document.write_text(document.read_text().replace("# low", "low"))
    assert "Last.low = 3" in rcyaml("config", "show", "etc/config.yaml").stdout


@pytest.mark.parametrize("path", ["gains[0]", "gains[2]"])
def test_an_entry_of_a_list_that_is_left_out(rcyaml: Run, document: Path, path: str) -> None:
    was = document.read_text()
    told = rcyaml("config", "set", "etc/config.yaml", path, "3")
    assert told.exit_code == 2
    assert "set the whole list" in told.stderr
    assert document.read_text() == was
    assert rcyaml("config", "set", "etc/config.yaml", "gains", "[3, 2]").exit_code == 0
    assert document.read_text() == was.replace("  # gains: [1, 2]\n", "  gains: [3, 2]\n")
