"""Which modules `import robocomp_yaml.api` loads."""

from __future__ import annotations

import subprocess
import sys

from conftest import ROOT


def test_the_library_loads_little() -> None:
    code = "import sys, robocomp_yaml.api; print(*(m for m in sys.modules if m.startswith('robocomp_yaml.')))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT).stdout
    assert {name.split(".")[1] for name in out.split()} <= {"api", "diag", "registry"}
