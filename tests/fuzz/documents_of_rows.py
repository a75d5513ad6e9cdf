"""Seeds: the examples of all diagnostics, wrong and right, which hold every construct of every format."""

from __future__ import annotations

from conftest import ROOT, Tree
from robocomp_yaml.diag.codes import table
from robocomp_yaml.diag.page import Repeated

LARGE = 20_000
LEGACY = (
    ".idsl",
    ".ice",
    ".cdsl",
    ".smdsl",
    ".jcdsl",
    ".pdsl",
    ".pconf",
    ".conf",
    ".toml",
    ".xml",
    ".launcher",
    "config",
)


def _trees() -> list[tuple[str, Tree]]:
    found: list[tuple[str, Tree]] = []
    for row in table().values():
        for files in (row.wrong, row.right):
            large = any(
                isinstance(text, Repeated) or (text is not None and len(text) > LARGE) for text in files.values()
            )
            if not large and not any(isinstance(text, str) and text.startswith("-> ") for text in files.values()):
                found.append((row.command, files))  # type: ignore[arg-type]
    return found


def _editor() -> Tree:
    folder = ROOT / "tests" / "editor" / "documents"
    return {path.name: path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.yaml"))}


DOCUMENTS: list[Tree] = [
    files
    for command, files in _trees()
    if not command.startswith("migrate") and any(n.endswith(".yaml") for n in files)
] + [_editor()]
LEGACY_FILES: list[Tree] = [files for command, files in _trees() if command.startswith("migrate")]
