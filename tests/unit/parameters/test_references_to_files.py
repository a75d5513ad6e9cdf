"""References to files: as properties of a file in another folder spell them."""

from __future__ import annotations

import pytest

from parameters import tree
from robocomp_yaml.parameters.spelling.references import text


@pytest.mark.parametrize(
    ("path", "folder", "spelled"),
    [
        ("key.txt", "/robot/etc", "key.txt"),
        ("key.txt", "/robot", "etc/key.txt"),
        ("../key.txt", "/robot/other", "../key.txt"),
        ("../key.txt", "/robot", "key.txt"),
        ("../key.txt", None, "/robot/key.txt"),
        ("/run/key.txt", "/robot", "/run/key.txt"),
        ("~/key.txt", None, "~/key.txt"),
    ],
)
def test_a_path_is_relative_to_the_written_file(path: str, folder: str | None, spelled: str) -> None:
    node = tree(f"file: {path}", "/robot/etc/c.config.yaml")
    assert text({"file": path}, node, folder) == f"${{file:{spelled}}}"
    assert text({"file": path}, None, folder) == f"${{file:{path}}}", "a default is in no document"
    assert text({"env": path}, node, folder) == f"${{env:{path}}}"
