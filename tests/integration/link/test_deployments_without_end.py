"""Deployments that become too large because they include each other."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml.pipeline import analyse


@pytest.mark.parametrize(
    "documents",
    [
        {f"l{n}": f"deployment: L{n}\ninclude: {{a: l{n + 1}.ddsl.yaml, b: l{n + 1}.ddsl.yaml}}\n" for n in range(40)},
        {f"l{n}": f"deployment: L{n}\ninclude: [l{n + 1}.ddsl.yaml]\n" for n in range(1500)},
    ],
    ids=["by two", "one by one"],
)
def test_includes_that_grow_without_end_are_rejected(tmp_path: Path, documents: dict[str, str]) -> None:
    last = "deployment: Last\ncomponents:\n  x{i}: {program: sleep, instances: 3}\n"
    files = {f"{name}.ddsl.yaml": text for name, text in documents.items()}
    write_tree(tmp_path, {**files, f"l{len(documents)}.ddsl.yaml": last})
    said = analyse([str(tmp_path / "l0.ddsl.yaml")]).diagnostics
    assert [d.code for d in said] == ["RC4108"]
