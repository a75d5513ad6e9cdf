"""What is a reference, in properties and in data, and what it stands for."""

from __future__ import annotations

from pathlib import Path

import pytest

from robocomp_yaml.semantics import references


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("${env:A_1}", {"env": "A_1"}),
        ("${file:/a b/c}", {"file": "/a b/c"}),
        ("${file:${env:X}}", {"file": "${env:X}"}),
        ("${env:1A}", None),
        ("${env:}", None),
        ("${env:A}x", None),
        ("x${env:A}", None),
        ("${file:a/}", None),
        ("${file:a }", None),
        ("${file:a\nb}", None),
        ("${path:a}", None),
        ("${env}", None),
        ("${}", None),
    ],
)
def test_references_in_properties(text: str, found: dict[str, str] | None) -> None:
    assert references.read(text) == found
    if found:
        assert references.spelled(*next(iter(found.items()))) == text
        assert references.is_sound(found) and references.unresolved(text) == references.Unresolved(found)
    else:
        assert references.unresolved(text) == references.resolved(text) == text


def test_what_only_looks_like_one() -> None:
    assert references.is_reference({"env": 3}) and not references.is_sound({"env": 3})
    assert not references.is_reference({"env": "A", "file": "b"}) and not references.is_reference({"x": "A"})
    assert references.referred({"file": "a/"}) == {"file": "a/"}, "it stays what it is, and is refused as that"


def test_what_they_stand_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "key").write_bytes(b"s3cret\r\n")
    monkeypatch.setenv("ARM", "7")
    assert references.resolved("${file:key}", str(tmp_path)) == "s3cret"
    assert references.referred({"env": "ARM"}) == "7"
    missing = references.resolved("${file:none}", str(tmp_path))
    assert isinstance(missing, references.Missing)
    assert missing.why == f"comes from the file {tmp_path}/none, which cannot be read: No such file or directory"
