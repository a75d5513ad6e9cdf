"""The modules of a package."""

from __future__ import annotations

import pkgutil
from pathlib import Path

import pytest

from robocomp_yaml import check, languages, registry
from robocomp_yaml.check import cdsl, ddsl, idsl
from robocomp_yaml.diag import codes
from robocomp_yaml.emit import exports


@pytest.mark.parametrize("package", [check, cdsl, ddsl, idsl, codes, exports, languages], ids=lambda one: one.__name__)
def test_modules_are_those_of_pkgutil(package: object) -> None:
    found = list(pkgutil.iter_modules(package.__path__))
    assert registry.module_names(package.__path__) == sorted(one.name for one in found if one.name[0] != "_")
    packages = sorted(one.name for one in found if one.ispkg and one.name[0] != "_")
    assert registry.module_names(package.__path__, packages=True) == packages


def test_other_files_are_ignored(tmp_path: Path) -> None:
    for name in ("arm.py", "_own.py", "notes.md", "arm.py.orig", "2nd.py", "a-b.py", "README"):
        (tmp_path / name).write_text("")
    for name in ("base", "__pycache__", "templates"):
        (tmp_path / name).mkdir()
    (tmp_path / "base/__init__.py").write_text("")
    assert registry.module_names([str(tmp_path)]) == ["arm", "base"]
