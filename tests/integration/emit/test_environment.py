"""`check --environment`: warnings about libraries that are not installed."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import write_tree
from robocomp_yaml.emit import environment

pytestmark = pytest.mark.processes  # runs cmake and pkg-config

Run = Callable[..., Result]


def warnings_of(rcyaml: Run, folder: Path, libraries: list[dict[str, str]], language: str = "cpp") -> list[str]:
    document = {"component": "A", "language": language, "uses": {"libraries": libraries}}
    write_tree(folder, {"a.cdsl.yaml": json.dumps(document)})
    result = rcyaml("check", "--environment", "--format", "json")
    assert result.exit_code == 0
    return [d["message"] for d in json.loads(result.stdout)["diagnostics"]]


@pytest.mark.skipif(not all(map(shutil.which, ("cmake", "g++"))), reason="CMake or g++ is not installed")
def test_cmake_finds_packages_and_libraries(rcyaml: Run, tmp_path: Path) -> None:
    there = [{"cmake": "Threads"}, {"link": "m"}, {"link": "pthread"}]
    lost = [{"cmake": "LostPackage"}, {"link": "lostlibrary"}]
    assert warnings_of(rcyaml, tmp_path, [*there, *lost]) == [
        "the CMake package LostPackage is not installed on this machine",
        "the library lostlibrary is not installed on this machine",
    ]


@pytest.mark.skipif(not all(map(shutil.which, ("cmake", "g++"))), reason="CMake or g++ is not installed")
def test_a_package_with_an_error_does_not_hide_others(
    rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_tree(tmp_path, {"lib/cmake/Bad/BadConfig.cmake": "message(FATAL_ERROR no)\n"})
    monkeypatch.setenv("CMAKE_PREFIX_PATH", str(tmp_path))
    assert warnings_of(rcyaml, tmp_path, [{"cmake": "Bad"}, {"link": "m"}]) == [
        "the CMake package Bad is not installed on this machine"
    ]


def test_pkg_config_versions(rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if shutil.which("pkg-config") is None:
        pytest.skip("pkg-config is not installed")
    write_tree(tmp_path, {"own.pc": "Name: own\nDescription: mine\nVersion: 3.10.1\n"})
    monkeypatch.setenv("PKG_CONFIG_PATH", str(tmp_path))
    versions = (">=3.9, <4", "3.10", ">3.10.1", "==3.10.1.0")
    libraries = [{"pkg-config": "own", "version": version} for version in versions]
    assert warnings_of(rcyaml, tmp_path, [*libraries, {"pkg-config": "lost-module"}]) == [
        "the pkg-config module own >3.10.1 is not installed on this machine: version 3.10.1 is installed",
        "the pkg-config module lost-module is not installed on this machine",
    ]


@pytest.mark.parametrize("language", ["python", "cpp"])
def test_pip_versions(rcyaml: Run, tmp_path: Path, language: str) -> None:
    versions = [{"pip": "click", "version": version} for version in (">=2, !=7.0", "<2")]
    libraries = [{"pip": "Click"}, *versions, {"pip": "no-such-thing"}]
    found = warnings_of(rcyaml, tmp_path, libraries, language)
    assert len(found) == 2
    assert found[0].startswith("the Python package click <2 is not installed on this machine: version ")
    assert found[1] == "the Python package no-such-thing is not installed on this machine"


def test_missing_programs_are_reported(rcyaml: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(environment.shutil, "which", lambda name: None)
    assert warnings_of(rcyaml, tmp_path, [{"cmake": "A"}, {"pkg-config": "b"}]) == [
        "the CMake package A is not installed on this machine: CMake, which would detect it, is missing, too",
        "the pkg-config module b is not installed on this machine: pkg-config, which would detect it, is missing, too",
    ]
