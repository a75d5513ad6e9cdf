"""rcyaml in an environment without the packages of the system, as pipx makes it, uses Debian's Ice."""

from __future__ import annotations

import subprocess
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import pytest

from robocomp_yaml.wire.debians_ice import FOLDER

ALONE = """\
import sys
from pathlib import Path
sys.path[:] = [one for one in sys.path if not (Path(one) / "Ice").is_dir()]
try:
    import Ice
except ImportError:
    print("without")
"""


def printed(code: str) -> str:
    return subprocess.run([sys.executable, "-c", ALONE + code], capture_output=True, text=True, check=True).stdout


@pytest.mark.skipif(
    not any(Path(FOLDER, f"IcePy{suffix}").exists() for suffix in EXTENSION_SUFFIXES if "-" in suffix),
    reason="Debian has no Ice for this Python (Debian: python3-zeroc-ice)",
)
@pytest.mark.parametrize("module", ["robocomp_yaml.wire.client", "robocomp_yaml.deploy.icegrid.grid"])
def test_it_is_used(module: str) -> None:
    code = f"import {module}, Ice\nprint(Ice.__file__)\nassert {FOLDER!r} not in sys.path\n"
    assert printed(code) == f"without\n{FOLDER}/Ice/__init__.py\n"


def test_nothing_else_comes_from_there() -> None:
    assert (
        printed("import robocomp_yaml.wire\nimport importlib.util\nprint(importlib.util.find_spec('apt'))")
        == "without\nNone\n"
    )


def test_without_it_the_message_names_the_python() -> None:
    code = (
        "from robocomp_yaml.wire import debians_ice\ndebians_ice.FOLDER = '/nowhere'\n"
        "from robocomp_yaml.api.refusals import without_ice\n"
        "try:\n    without_ice()\nexcept Exception as error:\n    print(error)\n"
    )
    said = printed(code)
    assert f"the Python of rcyaml ({sys.executable}) has no Ice" in said and "rcyaml[ice]" in said
