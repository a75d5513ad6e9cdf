"""Commands as a user would type them, in a copy of examples: each is shown before it runs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

BOLD, DIM, PLAIN = ("\x1b[1m", "\x1b[2m", "\x1b[0m") if sys.stdout.isatty() else ("", "", "")
# As in an active virtual environment, this Python is the first on the path: components use it if it has Ice.
ENVIRONMENT = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', os.defpath)}"}
RCYAML = [sys.executable, "-m", "robocomp_yaml"]


def say(text: str) -> None:
    print(text, flush=True)


def comment(text: str) -> None:
    say(f"\n{DIM}# {text}{PLAIN}")


class Session:
    """The commands in one folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def run(self, *words: str) -> None:
        """Runs a command, and shows the command and its output. Raises CalledProcessError if it fails."""
        say(f"{BOLD}$ {' '.join(word if word.isalnum() else _quoted(word) for word in words)}{PLAIN}")
        colors = ["--color", "always" if sys.stdout.isatty() else "never"]
        command = [*RCYAML, *colors, *words[1:]] if words[0] == "rcyaml" else words
        subprocess.run(command, cwd=self.folder, check=True, env=ENVIRONMENT)

    def answer(self, *words: str) -> dict[str, Any]:
        """The JSON output of a command of rcyaml, which is not shown."""
        answer: dict[str, Any] = json.loads(self._json(words))
        return answer

    def answers(self, *words: str) -> list[dict[str, Any]]:
        """The same of a command that prints JSON line by line."""
        return [json.loads(line) for line in self._json(words).splitlines()]

    def _json(self, words: Sequence[str]) -> str:
        return subprocess.run(
            [*RCYAML, *words, "--format", "json"],
            cwd=self.folder, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        ).stdout  # fmt: skip


def _quoted(word: str) -> str:
    return f"'{word}'" if set(word) & set(" :") else word


def ends(main: Callable[[], int], name: str) -> None:
    """Runs `main`, and ends with its exit code, 1 if a command failed, or 130 after Ctrl-C."""
    try:
        sys.exit(main())
    except subprocess.CalledProcessError as failure:
        sys.exit(f"\nThe {name} ends here: a command failed (exit code {failure.returncode}); see its output above.")
    except KeyboardInterrupt:
        sys.exit(130)
