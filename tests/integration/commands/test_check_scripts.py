"""`rcyaml check` reads mock scripts, too: below folders, and by their paths."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree

pytest.importorskip("Ice", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
Rcyaml = Callable[..., Result]

DOCUMENTS = {
    "rcyaml.yaml": "",
    "interfaces/Laser.idsl.yaml": "module: RoboCompLaser\ninterfaces:\n  Laser:\n    methods:\n      scan: {in: {beams: int}, returns: float}\n",
    "mocks/fine.mock.yaml": "interfaces:\n  Laser:\n    methods: {scan: {returns: 2.5}}\n",
}


def test_a_script_without_errors(tmp_path: Path, rcyaml: Rcyaml) -> None:
    write_tree(tmp_path, DOCUMENTS)
    assert rcyaml("check").stdout == "2 documents: nothing wrong\n"
    assert rcyaml("check", "mocks").stdout == "1 document: nothing wrong\n"
    assert rcyaml("check", "mocks/fine.mock.yaml").stdout == "1 document: nothing wrong\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("interfaces: {Lasre: {}}\n", "an interface or topic 'Lasre'"),
        ("interfaces:\n  Laser:\n    methods: {scan: {returns: far}}\n", "must be a number"),
        ("interfaces:\n  Laser:\n    methods: {scna: {}}\n", "did you mean 'scan'?"),
        ("interfaces:\n  Laser: {endpiont: tcp -p 1}\n", "unknown key 'endpiont'"),
        ("interfaces:\n  Laser: {endpoint: tpc -p 1}\n", "did you mean 'tcp'?"),
        ("interfaces:\n  Laser: {endpoint: tcp -p far}\n", "RC0208"),
        ("storm: IceStorm/TopicManager:tcp -p\n", "RC0208"),
        ("interfaces: [\n", "RC0101"),
    ],
)
@pytest.mark.parametrize("path", [".", "mocks", "mocks/bad.mock.yaml"])
def test_what_is_wrong_with_a_script(tmp_path: Path, rcyaml: Rcyaml, text: str, said: str, path: str) -> None:
    write_tree(tmp_path, {**DOCUMENTS, "mocks/bad.mock.yaml": text})
    found = rcyaml("check", path)
    assert found.exit_code == 1 and said in found.stdout and "mocks/bad.mock.yaml:" in found.stdout
    assert found.stdout.rstrip().endswith(": 1 error")


def test_an_error_of_a_document_is_reported_once(tmp_path: Path, rcyaml: Rcyaml) -> None:
    write_tree(
        tmp_path,
        {**DOCUMENTS, "interfaces/Laser.idsl.yaml": DOCUMENTS["interfaces/Laser.idsl.yaml"].replace("float", "flaot")},
    )
    assert rcyaml("check").stdout.count("error[") == 1
