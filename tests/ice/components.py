"""Components compiled for a test, without the command line and the writer."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from robocomp_yaml import pipeline, resources
from robocomp_yaml.diag.diagnostic import ERROR
from robocomp_yaml.emit import slice as slice_target
from robocomp_yaml.emit.component import of_language


@dataclass(frozen=True)
class Built:
    """A compiled component in its folder."""

    name: str
    root: Path
    language: str

    @property
    def command(self) -> list[str | Path]:
        program = self.root / "bin" / self.name
        return [sys.executable, program] if self.language == "python" else [program]

    def configure(self, properties: Mapping[str, object]) -> Built:
        """Writes `etc/config`."""
        (self.root / "etc").mkdir(exist_ok=True)
        lines = "".join(f"{key} = {value}\n" for key, value in properties.items())
        (self.root / "etc" / "config").write_text(lines, encoding="utf-8")
        return self


Build = Callable[[Mapping[str, str]], dict[str, Built]]


def build(documents: Mapping[str, str], folder: Path, *search: Path) -> dict[str, Built]:
    """Writes the documents and compiles the components among them, each in its document's folder and without
    `etc/config`; they come back by name. Imports are looked for in `folder` and `search`."""
    for path, text in documents.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    analysis = pipeline.analyse([str(folder)], [str(folder), *map(str, search)])
    errors = [d for d in analysis.diagnostics if d.severity == ERROR]
    assert not errors, errors
    built = {}
    for linked in analysis.program.components.values():
        component = linked.component
        root = Path(component.path).parent
        files = [(file.path, file.text, file.executable) for file in of_language(linked)]
        files += [(f"slice/{slice_target.file_name(m)}", slice_target.text(m), False) for m in linked.modules()]
        if not component.language.target.runtime:
            files.append(("slice/CommonBehavior.ice", resources.text("templates/slice/CommonBehavior.ice"), False))
        for path, text, executable in files:
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text, encoding="utf-8")
            (root / path).chmod(0o755 if executable else 0o644)
        built[component.name] = Built(component.name, root, component.language.name)
    return built
