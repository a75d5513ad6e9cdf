"""How to install an extra depends on the environment in which rcyaml runs."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from robocomp_yaml.diag import extras


def test_of_pipx(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "pipx_metadata.json").touch()
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    assert extras.command("lsp") == "pipx runpip rcyaml install 'rcyaml[lsp]'"


def test_of_an_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    monkeypatch.setattr(sys, "executable", "/my env/bin/python")
    assert extras.command("lsp") == "'/my env/bin/python' -m pip install 'rcyaml[lsp]'"


def test_of_the_system(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "prefix", sys.base_prefix)
    assert extras.command("lsp") == "pip install 'rcyaml[lsp]'"
