"""The text of the manifest: one line for each file, in order; reading it returns the same manifest."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robocomp_yaml.transactions import manifest
from robocomp_yaml.transactions.manifest import Manifest, ManifestEntry

entries = st.builds(ManifestEntry, st.text(), st.lists(st.text()).map(tuple), st.booleans())


def test_the_text_has_one_line_for_each_file() -> None:
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
def test_reading_returns_what_was_written(files: dict[str, ManifestEntry]) -> None:
    assert manifest.read(Manifest(files).text().encode("utf-8", "surrogatepass")) == Manifest(files)


def test_no_manifest() -> None:
    assert manifest.read(None) == Manifest()


def test_an_unknown_manifest_is_rejected() -> None:
    with pytest.raises(manifest.Unusable, match="later version"):
        manifest.read(b'{"version": 7, "shape": "unknown"}')
