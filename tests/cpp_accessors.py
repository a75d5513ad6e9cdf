"""Generated accessors of C++: one program that has those of many documents, and judges and reads values with them."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from conftest import ROOT
from parameters import Data
from robocomp_yaml.languages import language
from robocomp_yaml.languages.cpp import parameters as cpp_parameters
from robocomp_yaml.parameters.types import Parameters

DRIVER = ROOT / "tests" / "cpp_driver" / "main.cpp"
RUNTIME = ("secrecy", "texts", "references", "kinds", "reading", "editing", "store", "expressions", "pattern")


class Program:
    """Its questions name a member of the parameters that it was made of. It sees no environment."""

    def __init__(self, folder: Path, parameters: Parameters) -> None:
        for name, text in cpp_parameters.texts(parameters, "Driver", "x.pdsl.yaml").items():
            (folder / name).write_text(text, encoding="utf-8")
        (folder / "runtime").symlink_to(Path(language("cpp").templates) / "runtime")
        includes = [f'#include "runtime/{name}.cpp"' for name in RUNTIME] + ['#include "parameters.cpp"']
        (folder / "all.cpp").write_text("\n".join([*includes, f'#include "{DRIVER}"']) + "\n")
        command = ["g++", "-std=c++17", "-Wall", "-Wextra", "-Werror", f"-I{folder}", "-o", str(folder / "driver")]
        done = subprocess.run([*command, str(folder / "all.cpp")], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        self.command = [str(folder / "driver")]

    def judge(self, asked: list[tuple[str, Any]]) -> Iterator[list[str]]:
        """What is wrong with data for members, but for what is about the environment."""
        for words in self.ask([f"judge {member} {encoded(data)}" for member, data in asked]):
            yield problems(words)

    def put(self, asked: list[tuple[str, Any]]) -> Iterator[tuple[dict[str, str], list[str]]]:
        """Each plain value of members that are set to data while a component runs, by its path; and what is wrong."""
        yield from self._values([f"put {member} {encoded(data)}" for member, data in asked])

    def read(self, asked: list[tuple[str, dict[str, str]]]) -> Iterator[tuple[dict[str, str], list[str]]]:
        """Each plain value that properties give a member, by its path; and what is wrong."""
        yield from self._values([f"read {member} {encoded(held)}" for member, held in asked])

    def _values(self, lines: list[str]) -> Iterator[tuple[dict[str, str], list[str]]]:
        for words in self.ask(lines):
            pairs = (word.partition("=") for word in words[1:]) if words[0] == "fits" else ()
            yield {unhexed(key): unhexed(text) for key, _, text in pairs}, problems(words)

    def constraints(self, asked: list[Data]) -> Iterator[list[bool]]:
        """Which constraints hold."""
        for (bits,) in self.ask([f"constraints {encoded(data)}" for data in asked]):
            yield [bit == "1" for bit in bits]

    def ask(self, lines: list[str]) -> Iterator[list[str]]:
        """The words of each answer."""
        done = subprocess.run(
            self.command,
            input="\n".join(lines) + "\n",
            capture_output=True,
            text=True,
            env={"PATH": os.environ["PATH"]},
        )
        assert done.returncode == 0, done.stderr
        answers = done.stdout.splitlines()
        assert len(answers) == len(lines)
        return (answer.split() for answer in answers)


def encoded(data: Any) -> str:
    """JSON without blanks, its texts in hexadecimal."""

    def hexed(data: Any) -> Any:
        if isinstance(data, dict):
            return {hexed(key): hexed(value) for key, value in data.items()}
        if isinstance(data, list):
            return [hexed(item) for item in data]
        return data.encode().hex() if isinstance(data, str) else data

    return json.dumps(hexed(data), separators=(",", ":"))


def unhexed(word: str) -> str:
    return bytes.fromhex(word).decode()


def problems(words: list[str]) -> list[str]:
    messages = [unhexed(word) for word in words[1:]] if words[0] == "no" else []
    return [message for message in messages if " comes from the " not in message]
