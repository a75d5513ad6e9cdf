"""One value of a document is set in its text: all else stays as it is, comments and layout too, or it is refused."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from in_memory import COMPONENT, ROOT, plain
from robocomp_yaml.api.values import Values
from robocomp_yaml.diag.errors import Faulty, Refused
from robocomp_yaml.source.yaml_text import flow

PDSL = """\
component: c.cdsl.yaml
types: {Motor: {struct: {name: string, most: {type: float, default: 1}}}}
parameters:
  n: {type: int, default: 1}
  t: {type: string, default: a}
  g: {group: {x: {type: int, default: 1}, h: {group: {y: {type: int, default: 2}}}}}
  ls: {list: int, default: [1]}
  motors: {list: Motor, default: []}
  m: {map: float, default: {}}
"""

CASES: dict[str, tuple[str, str, str]] = {
    "a plain value": ("parameters:\n  n: 5  # five\n  t: a\n", "n", "6"),
    "a value in quotes": ("parameters:\n  t: 'it''s'  # quoted\n", "t", "b c"),
    "a text that looks like a number": ("parameters: {t: a}\n", "t", "5"),
    "a value that has a default": ("parameters:\n  n: 5\n\n# the end\n", "t", "b"),
    "a value of a group": ("parameters:\n  g:\n    x: 3   # three\n", "g.x", "4"),
    "a group that is not there yet": ("parameters:\n  n: 5\n", "g.h.y", "4"),
    "a member of a group that is there": ("parameters:\n  g:\n      x: 3\n", "g.h.y", "4"),
    "in a flow mapping": ("parameters: {n: 5, t: a}  # all\n", "n", "6"),
    "more in a flow mapping": ("parameters: {n: 5}\n", "g.h.y", "6"),
    "more in an empty flow mapping": ("parameters: {}\n", "n", "6"),
    "no parameters yet": ("legacy: {file: config}\n", "n", "6"),
    "parameters without a value": ("parameters:\nlegacy: {file: config}\n", "n", "6"),
    "a key without a value": ("parameters:\n  n:\n  t: a\n", "n", "6"),
    "a group without a value": ("parameters:\n  g:   # to come\n  t: a\n", "g.x", "6"),
    "what is commented out": ("parameters:\n  # n: 5  # five\n  t: a\n", "n", "6"),
    "an element of a list": ("parameters:\n  ls: [1, 2, 3]  # three\n", "ls[1]", "7"),
    "an element of a block list": ("parameters:\n  ls:\n    - 1\n    - 2  # two\n", "ls[1]", "7"),
    "one more entry": ("parameters:\n  ls: [1, 2]\n", "ls[2]", "7"),
    "one more entry of a block list": ("parameters:\n  ls:\n    - 1\n    - 2  # two\n  n: 5\n", "ls[2]", "7"),
    "an element far behind the last": ("parameters: {ls: [1, 2]}\n", "ls[5]", "7"),
    "a whole list": ("parameters:\n  ls: [1, 2]\n", "ls", "[4, 5]"),
    "a list with comments": ("parameters:\n  ls: [  # why\n    1,  # the left one\n    2]\n", "ls", "[4, 5]"),
    "a list with what looks like a comment": ("parameters:\n  ls: [1, 2]  # '#' is\n", "ls", "[4, 5]"),
    "a whole block list": ("parameters:\n  ls:\n    - 1\n", "ls", "[4, 5]"),
    "a member of an element": (
        "parameters:\n  motors:\n    - {name: a}\n    - name: b\n      most: 2\n",
        "motors[1].most",
        "3",
    ),
    "a new member of an element": ("parameters:\n  motors:\n    - {name: a}\n    - name: b\n", "motors[0].most", "3"),
    "a new member of a block entry": ("parameters:\n  motors:\n    - name: b\n", "motors[0].most", "3"),
    "a new entry of records": ("parameters:\n  motors:\n    - name: b\n", "motors[1]", "{name: c, most: 1}"),
    "a map's entry": ("parameters:\n  m: {left: 1}\n", "m.right", "2"),
    "a map's first entry": ("parameters:\n  n: 5\n", "m.right", "2"),
    "a name with a dot": ("parameters:\n  m: {a.b: 1}\n", 'm["a.b"]', "2"),
    "an alias": ("parameters:\n  ls: &it [1]\n  n: 5\n", "ls[0]", "2"),
    "a value with an anchor": ("parameters:\n  n: &it 5\n  g: {x: *it}\n", "n", "2"),
    "a value that is an alias": ("parameters:\n  n: &it 5\n  g: {x: *it}\n", "g.x", "2"),
    "a text of several lines": ("parameters:\n  t: |\n    a\n    b\n", "t", "c"),
    "what does not fit": ("parameters:\n  n: 5\n", "n", "x"),
    "what is no parameter": ("parameters:\n  n: 5\n", "nn", "6"),
    "an element of what is no list": ("parameters:\n  n: 5\n", "n[0]", "6"),
    "line ends of Windows": ("parameters:\r\n  n: 5\r\n", "t", "b"),
    "no line end at the end": ("parameters:\n  n: 5", "t", "b"),
    "a document with an end": ("parameters:\n  n: 5\n...\n", "t", "b"),
    "comments below": ("parameters:\n  n: 5\n  # about n\n\n# about all\n", "t", "b"),
    "behind a text of several lines": ("parameters:\n  t: >-\n    a\n    b\n", "n", "6"),
    "behind a text of several lines, and more": ("parameters:\n  t: >-\n    a\nlegacy: {file: config}\n", "n", "6"),
    "behind a nested block": ("parameters:\n  g:\n    h:\n      y: 1\n  # about t\n", "g.x", "6"),
    "a key in quotes": ('parameters:\n  "n": 5\n', "n", "6"),
    "below comments only": ("parameters:\n  # nothing yet\n  # nor here\n", "n", "6"),
}


def test_each_is_set_in_its_place(golden: Callable[[str, Mapping[str, str]], None]) -> None:
    told = []
    for name, (text, path, value) in CASES.items():
        told.append(f"== {name}: {path} = {value}\n{edited(text, path, value)}".replace("\r", "\\r").rstrip("\n"))
    golden("edited", {"edited.txt": "\n".join(told) + "\n"})


def edited(text: str, path: str, value: str) -> str:
    """The document with the value at the path, or why the path cannot have it."""
    head = "component: c.cdsl.yaml\n"
    documents = {"c.cdsl.yaml": COMPONENT, "c.pdsl.yaml": PDSL, "x.config.yaml": head + text}
    overlay = {f"{ROOT}/{name}": content.encode() for name, content in documents.items()}
    file = f"{ROOT}/x.config.yaml"
    try:
        change = Values(file, overlay=overlay).set(path, value)
    except Refused as error:
        return plain(f"refused: {error}")
    except Faulty as error:
        return "".join(
            f"{one.severity}[{one.code}] at {one.span.line}:{one.span.column}: {one.message}\n"
            for one in error.diagnostics
        )
    held = Values(file, overlay={**overlay, file: change.after}).get(path)
    assert (held if isinstance(held, str) else flow(held)) == value
    return change.after.decode().removeprefix(head)
