"""Draws the pictures of the documentation, in docs/pictures/: networks by `rcyaml graph`, terminals as SVG by Rich.

`make pictures` runs it. The pictures of the manager and of VS Code are screenshots, which their tests take;
`flow.svg` and `architecture.svg` are drawn by hand. All pictures of docs/ together have at most 5 MB, as a test checks.
"""

from __future__ import annotations

import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.terminal_theme import MONOKAI
from rich.text import Text

ROOT = Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs" / "pictures"
ENVIRONMENT = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}", "COLUMNS": "110"}
# A font of the reader's own: the page loads nothing from elsewhere.
_FONTS = re.compile(r"@font-face \{.*?\}\s*", re.DOTALL)

CHECK = (
    "sed -i 's/base_proxy.drive(0.5)/base_proxy.drvie(0.5)/' components/patrolcomp/src/specificworker.py",
    "sed -i 's/requires: .Base./requires: [Basse]/' components/patrolcomp/patrolcomp.cdsl.yaml",
)
SESSIONS = {
    "terminal-check.svg": (CHECK[1:], ("rcyaml check",)),
    "terminal-code.svg": (CHECK[:1], ("rcyaml check",)),
    "terminal-deploy.svg": (
        ("rcyaml -q compile",),
        (
            "rcyaml deploy plan", "rcyaml deploy up", "rcyaml deploy status", "rcyaml call base.Base.drive speed=3",
            "rcyaml deploy down",
        ),
    ),
    "terminal-param.svg": (
        ("rcyaml new parameters PatrolComp", "rcyaml -q compile", "rcyaml -q config new PatrolComp"),
        (
            "rcyaml config set PatrolComp speed 3", "rcyaml config set PatrolComp speed 1.5",
            "rcyaml config show PatrolComp",
        ),
    ),
}  # fmt: skip
"""By the picture: what happens before it, and the commands that it shows, in the tutorial's robot."""


def main() -> None:
    with workspace("patrol") as folder:
        shell("rcyaml -q compile", folder)
        picture("network-patrol.svg", shell("rcyaml graph --as svg", folder))
    with workspace("speech") as folder:
        (folder / "head.ddsl.yaml").write_text(HEAD, encoding="utf-8")
        edit(folder / "components/speech/speech.cdsl.yaml", "imports: [Speech]", "imports: [Speech, Mouth]")
        edit(folder / "components/speech/speech.cdsl.yaml", "implements:", "requires: [Mouth]\nimplements:")
        picture("network-head.svg", shell("rcyaml graph --as svg", folder))
    for name, (before, shown) in SESSIONS.items():
        with workspace("patrol") as folder:
            for command in before:
                shell(command, folder)
            picture(name, terminal(shown, folder))
    total = sum(path.stat().st_size for path in (ROOT / "docs").rglob("*") if path.suffix in (".svg", ".png"))
    print(f"all pictures of docs/ together: {total / 1e6:.1f} MB")


HEAD = """\
deployment: Head
hosts: {onboard: 10.0.0.2, head: 10.0.0.3}
components:
  speech: {component: components/speech, host: onboard, port: 10001}
  mouth: {component: components/mouth, host: head, port: 10002}
  motors: {component: components/jointmotor, host: head, port: 10003}
"""


@contextmanager
def workspace(example: str) -> Iterator[Path]:
    with tempfile.TemporaryDirectory() as parent:
        folder = Path(parent) / example
        shutil.copytree(ROOT / "examples" / example, folder, ignore=shutil.ignore_patterns("__pycache__", ".rcyaml"))
        yield folder


def edit(file: Path, old: str, new: str) -> None:
    file.write_text(file.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")


def shell(command: str, folder: Path) -> str:
    done = subprocess.run(
        ["bash", "-c", command], cwd=folder, env=ENVIRONMENT, text=True, check=False,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    return done.stdout


def terminal(commands: tuple[str, ...], folder: Path) -> str:
    """The commands with what they print, in colours, as an SVG."""
    console = Console(record=True, width=104, file=io.StringIO(), force_terminal=True)
    for command in commands:
        console.print(Text.assemble(("$ ", "dim"), (command, "bold")))
        console.print(Text.from_ansi(shell(command.replace("rcyaml", "rcyaml --color always", 1), folder).rstrip("\n")))
    svg = console.export_svg(title="rcyaml", theme=MONOKAI, unique_id="t")
    return _FONTS.sub("", svg).replace("Fira Code", "ui-monospace")


def picture(name: str, text: str) -> None:
    (PICTURES / name).write_text(text, encoding="utf-8")
    print(f"drew {name}: {len(text) / 1000:.0f} kB")


if __name__ == "__main__":
    main()
