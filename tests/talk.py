"""Small workspaces of components over one interface document, linked: what tests of ports and configs start from."""

from __future__ import annotations

from pathlib import Path

from conftest import write_tree
from robocomp_yaml.emit.layout import CONFIG
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.pipeline import analyse

INTERFACES = """\
module: RoboCompTalk
interfaces:
  Speech:
    doc: |
      Says things,
      aloud.

      More than one wants to know.
    methods: {say: {in: {text: string}}}
  Mouth:
    methods: {open: }
topics:
  Heard:
    doc: What was heard.
    methods: {word: {in: {text: string}}}
"""


def component(name: str, **lists: str) -> str:
    return f"component: {name}\nlanguage: python\nimports: [Talk]\n" + "".join(
        f"{key}: {value}\n" for key, value in lists.items()
    )


def workspace(documents: dict[str, str], **configs: str) -> dict[str, LinkedComponent]:
    """Writes components (folder to document) and configs (by folder) below the working folder, and links them."""
    write_tree(
        Path(),
        {
            "rcyaml.yaml": "interfaces: [idsl/]\n",
            "idsl/Talk.idsl.yaml": INTERFACES,
            **{f"{folder}/{folder}.cdsl.yaml": text for folder, text in documents.items()},
            **{f"{folder}/{CONFIG}": text for folder, text in configs.items()},
        },
    )
    program = analyse(["."]).program
    return {Path(linked.component.path).parent.name: linked for linked in program.components.values()}
