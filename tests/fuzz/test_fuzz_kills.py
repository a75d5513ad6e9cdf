"""`kill -9`, and a full disk, at any moment of any command that writes: the next run puts all in order, and nothing of
the user's is ever lost.

How a commit of many files behaves at each of its calls is in tests/integration/transactions/test_writer_faults.py; here whole commands
are killed, at each thing that they do to a disk.
"""

from __future__ import annotations

import errno
import os
import signal
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from conftest import FUZZING, Tree
from disk import tree
from fuzzing import examples, run, standing_in

pytestmark = pytest.mark.processes

SPEECH = "module: RoboCompSpeech\ninterfaces: {Speech: {methods: {say: {in: {text: string}}}}}\n"
COMPONENT: Tree = {
    "Speech.idsl.yaml": SPEECH,
    "speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n",
    "speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters: {volume: {type: int, default: 5}, name: string}\n",
    "src/specificworker.py": "# mine\n",
}
VALUES: Tree = {**COMPONENT, "etc/config.yaml": "component: ../speech.cdsl.yaml\nparameters: {name: a}  # mine\n"}
LEGACY: Tree = {
    "Speech.idsl": "module RoboCompSpeech\n{\n  interface Speech { void say(string text); };\n};\n",
    "speech/speech.cdsl": 'import "Speech.idsl";\nComponent SpeechComp { Communications { implements Speech; }; language python; };\n',
    "speech/etc/config": "Speech.Endpoints=tcp -p 1\nDevice = a\n",
}
COMMANDS: dict[str, tuple[Tree, tuple[str, ...]]] = {
    "compile": (VALUES, ("compile",)),
    "compile of a change": (VALUES, ("compile",)),
    "migrate": (LEGACY, ("migrate", ".")),
    "config set": (VALUES, ("config", "set", "etc/config.yaml", "volume", "7")),
    "config new": (COMPONENT, ("config", "new", "speech.cdsl.yaml")),
    "new": ({**COMPONENT, "rcyaml.yaml": "interfaces: [.]\n", ".gitignore": ""}, ("new", "interface", "Mouth")),
    "graph -o": (COMPONENT, ("graph", "-o", "picture.dot", "--as", "dot")),
}
Then = Callable[[int, str], None]  # told the number and the name of what is about to happen
WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC
TOUCHES = ("os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.link", "os.symlink", "os.chmod", "os.truncate")


def touches(folder: Path, then: Then) -> None:
    """From now on `then` is told, before it happens, of the n-th thing that this process does to files below a folder.
    There is no way back."""
    count = 0

    def hook(event: str, args: tuple[Any, ...]) -> None:
        nonlocal count
        is_open = event == "open" and isinstance(args[2], int) and args[2] & WRITES
        if (
            (is_open or event in TOUCHES)
            and not isinstance(args[0], int)
            and os.path.abspath(os.fsdecode(args[0])).startswith(str(folder))
        ):
            count += 1
            then(count, event)

    sys.addaudithook(hook)


def in_a_child(folder: Path, then: Then, args: tuple[str, ...]) -> int:
    """How a process ends that runs a command: its exit code, or the negative number of the signal."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # other threads of this process have no part in what the child does
        child = os.fork()
    if child == 0:
        code = 99
        try:
            touches(folder, then)
            code = run(*args).exit_code
        finally:
            os._exit(code)
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status)


def prepared(name: str) -> tuple[Tree, tuple[str, ...]]:
    files, args = COMMANDS[name]
    return files, args


def before(name: str) -> None:
    if name == "compile of a change":
        assert run("compile").exit_code == 0
        Path("Speech.idsl.yaml").write_text(SPEECH.replace("say", "tell") + "# changed\n")
        Path("src/specificworker.py").write_text("# mine, edited\n")


def _seen(folder: Path) -> dict[str, str | None]:
    """Files with their texts: without rcyaml's own state, and folders."""
    found = {name: text for name, text in tree(folder).items() if text is not None and "/.rcyaml/" not in f"/{name}"}
    return {name: text for name, text in found.items() if not name.startswith(".vscode/")}


def after(name: str, then: Then) -> int:
    """One run that `then` may end, and one that goes on to the end: all is as after one run, and what was the user's is
    as it was. Gives how the first one ended."""
    files, args = prepared(name)
    with standing_in(files) as folder:
        before(name)
        was = _seen(folder)
        assert run(*args).exit_code == 0
        wanted = _seen(folder)
    kept = {path: text for path, text in was.items() if wanted.get(path) == text}
    with standing_in(files) as folder:
        before(name)
        ended = in_a_child(folder, then, args)
        held = _seen(folder)
        assert {path: held.get(path) for path in kept} == kept
        again = run(*args)
        done = held == wanted and args[0] in ("config", "new")  # it will not write over what is there
        assert again.exit_code == 0 or (done and again.exit_code == 2), again.output
        assert _seen(folder) == wanted
        return ended


def killed_at(number: int) -> Then:
    return lambda count, event: os.kill(os.getpid(), signal.SIGKILL) if count == number else None


def full_at(number: int) -> Then:
    def then(count: int, event: str) -> None:
        if count >= number and event in ("open", "os.mkdir", "os.link"):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    return then


@given(st.sampled_from(sorted(COMMANDS)), st.integers(1, 120), st.sampled_from((killed_at, full_at)))
@examples(20)
def test_any_command_at_any_moment(name: str, number: int, ending: Callable[[int], Then]) -> None:
    assert after(name, ending(number)) in (0, 1, 2, -signal.SIGKILL)


@pytest.mark.parametrize("name", [name for name in COMMANDS if FUZZING or not name.startswith(("compile", "migrate"))])
def test_each_moment_of_a_small_command(name: str) -> None:
    number = 1
    while after(name, killed_at(number)) == -signal.SIGKILL:
        number += 1
    assert number > 2
