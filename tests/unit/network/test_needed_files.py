"""The files that a process needs: its program, with the libraries of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import pytest
from msgspec.structs import replace

from engine_in_memory import process
from robocomp_yaml.network import shared_libraries
from robocomp_yaml.network.files import needed
from robocomp_yaml.network.network import PROGRAM, EnvironmentVariable, Process


def of(program: str, **more: object) -> Process:
    return replace(process("p"), command=(program, "/an/argument"), kind=PROGRAM, **more)


def test_a_program_with_its_libraries(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[str, list[str]]] = []

    def libraries(program: str, skips: Callable[[str], object], searched: Iterable[str]) -> list[str]:
        asked.append((program, list(searched)))
        return ["/opt/lib/a.so"]

    monkeypatch.setattr(shared_libraries, "of", libraries)
    known: dict[str, tuple[str, ...]] = {}
    program = "/opt/robot/laser"
    path = (EnvironmentVariable("LD_LIBRARY_PATH", "/opt/lib:/opt/more"),)
    assert needed(of(program, env=path), known) == (program, "/opt/lib/a.so")
    assert needed(of(program, watched=("/opt/code.py", program)), known) == (program, "/opt/lib/a.so", "/opt/code.py")
    assert asked == [(program, ["/opt/lib", "/opt/more"])], "once"
    assert needed(of("/usr/bin/env"), known) == needed(of("env"), known) == (), "each host has them"
    assert len(asked) == 1
