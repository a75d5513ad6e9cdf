"""Java components, built once per test run."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

needs_java = pytest.mark.skipif(
    not all(map(shutil.which, ("javac", "slice2java"))) or not any(Path("/usr/share/java").glob("ice-3.7*.jar")),
    reason="Java or Ice for Java is not installed "
    "(Debian: openjdk-17-jdk-headless libzeroc-ice3.7-java zeroc-ice-compilers)",
)


def java_build(root: Path) -> None:
    """Builds as users do; a warning of the compiler is a failure."""
    done = subprocess.run([root / "generated" / "build"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stderr == ""
