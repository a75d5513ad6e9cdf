"""The imports of the supervisor: it runs as long as the robot, and must be small."""

from __future__ import annotations

import subprocess
import sys

_IMPORTED = """
import sys
before = set(sys.modules)
from robocomp_yaml.deploy.local import service, supervisor
print(*sorted({name.partition(".")[0] for name in set(sys.modules) - before} - sys.stdlib_module_names))
"""


def test_only_the_standard_library_is_used() -> None:
    done = subprocess.run([sys.executable, "-c", _IMPORTED], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["robocomp_yaml"]
