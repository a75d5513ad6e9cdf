"""The manifest's text: one line a file, in order, read back as it was."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robocomp_yaml.transactions import manifest
from robocomp_yaml.transactions.manifest import Manifest, ManifestEntry

entries = st.builds(ManifestEntry, st.text(), st.lists(st.text()).map(tuple), st.booleans())


def test_it_reads_well_and_compares_well() -> None:
    held = Manifest(
        {
            "src/é.py": ManifestEntry("ab", ("speech.cdsl.yaml",), once=True),
            "generated/main.py": ManifestEntry("cd", ("../x/a.idsl.yaml", "b.idsl.yaml")),
        }
    )
    assert (
        held.text()
        == """\
{
  "version": 1,
  "files": {
    "generated/main.py": {"hash": "cd", "owners": ["../x/a.idsl.yaml", "b.idsl.yaml"]},
    "src/é.py": {"hash": "ab", "owners": ["speech.cdsl.yaml"], "once": true}
  }
}
"""
    )


@given(st.dictionaries(st.text(st.characters(exclude_categories=["Cs"])), entries))
def test_it_is_read_back_as_it_was(files: dict[str, ManifestEntry]) -> None:
    assert manifest.read(Manifest(files).text().encode("utf-8", "surrogatepass")) == Manifest(files)


def test_there_may_be_none() -> None:
    assert manifest.read(None) == Manifest()


def test_what_it_does_not_know_is_left_alone() -> None:
    with pytest.raises(manifest.Unusable, match="newer"):
        manifest.read(b'{"version": 7, "shape": "unknown"}')
