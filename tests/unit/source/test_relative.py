"""Relative paths are those of `os.path.relpath`."""

from __future__ import annotations

import os

import pytest

from robocomp_yaml.source.relative import relative

PATHS = ("", ".", "a", "a/b", "ab/c", "a/./b", "a//b", "../a", "a/../b", "/", "/a/b", "..a", ".a/b", "a/b/c.yaml")


@pytest.mark.parametrize("start", PATHS)
@pytest.mark.parametrize("path", PATHS)
def test_as_relpath(path: str, start: str) -> None:
    assert relative(path, start) == os.path.relpath(path or ".", start or ".")
