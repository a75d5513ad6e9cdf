"""The reference of parameters in Markdown: what a reader sees is what the document says."""

from __future__ import annotations

from pathlib import Path

from conftest import write_tree
from robocomp_yaml import pipeline
from robocomp_yaml.parameters.writing.reference import reference

PDSL = r"""
component: c.cdsl.yaml
doc: Give <host> and `<port>`, see <https://robocomp.org>.
types:
  Mode: {enum: {slow: {doc: Less than <1> | 2.}, fast: }}
  Point: {struct: {x: {type: double, doc: "two\nlines"}}}
parameters:
  device: {type: string, pattern: "/dev/(a|b)[0-9]*", default: /dev/a0}
  text: {type: string, default: "a  `b` | \n"}
  modes: {map: Mode, default: {left arm: slow}}
  one: {type: Mode, values: [slow], default: slow}
  points: {list: {list: Point}, size: 2}
  ids: {list: int, unique: true, default: [1]}
  many: {list: int, default: [11111, 22222, 33333, 44444, 55555, 66666, 77777, 88888, 9]}
constraints:
  - {that: len(ids) < 3, else: give fewer than <3>}
"""


def test_what_a_reader_sees(tmp_path: Path) -> None:
    documents = {"c.cdsl.yaml": "component: C\nlanguage: python\n", "c.pdsl.yaml": PDSL}
    (component,) = pipeline.analyse([str(write_tree(tmp_path, documents))]).program.components.values()
    lines = reference(component.parameters.parameters, "C").splitlines()
    for line in (
        r"Give \<host> and `<port>`, see <https://robocomp.org>.",
        r"| `device` | text that matches `/dev/(a\|b)[0-9]*` | `/dev/a0` |  |",
        r'| `text` | text | `` "a  `b` \| \n" `` |  |',
        "| `modes` | a map, each [Mode](#mode): one of slow, fast | `{left arm: slow}` |  |",
        "| `one` | [Mode](#mode): one of slow | `slow` |  |",
        "| `points` | a list of exactly 2 elements, each a list, each of type [Point](#point) | **required** |  |",
        "| `ids` | a list, all different, each a whole number | `[1]` |  |",
        "| `many` | a list, each a whole number | `[11111, 22222, 33333, 44444, 55555, 66666, 77777, 88888, 9]` |  |",
        r"| `slow` | Less than \<1> \| 2. |",
        "| `x` | a number | **required** | two lines |",
        r"- `len(ids) < 3`: give fewer than \<3>, otherwise.",
    ):
        assert line in lines
