"""The corpus as a repository, migrated once for the tests that read it."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

from conftest import CORPUS
from robocomp_yaml.cli import group


def migrate_components(folder: Path) -> Path:
    """Migrate the corpus from `source`, where each component has a separate folder, to `yaml`."""
    shutil.copytree(CORPUS / "idsl", folder / "source/interfaces", copy_function=shutil.copyfile)
    for path in sorted((CORPUS / "cdsl").glob("*.cdsl")):
        own = folder / "source/components" / path.stem
        own.mkdir(parents=True)
        shutil.copyfile(path, own / path.name)
    arguments = ["migrate", str(folder / "source"), "-o", str(folder / "yaml"), "--report", str(folder / "ledger.json")]
    result = CliRunner().invoke(group, arguments)
    assert isinstance(result.exception, SystemExit) and result.exit_code == 1, result.output
    return folder


@pytest.fixture(scope="module")
def migrated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return migrate_components(tmp_path_factory.mktemp("corpus"))
