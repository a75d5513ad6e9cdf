"""The reader and writer of property files against the real `Ice.Properties`."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from robocomp_yaml.source import properties

Ice = pytest.importorskip("Ice", reason="needs Ice's Python module (Debian: python3-zeroc-ice)")

PIECES = ("\\", " ", "#", "=", "a", "b", "\t", "\r", "\\ ", '"', "é", "\n", "\\\\", "\ufeff")
FILES = st.lists(st.sampled_from(PIECES), max_size=30).map("".join)
WORDS = st.text(st.characters(exclude_categories=("Cs",), exclude_characters="\0\r\n"), min_size=1, max_size=12)
HARD_WORDS = st.lists(st.sampled_from(("\\", " ", "#", "=", "a", "\t", '"', "é")), min_size=1, max_size=8).map("".join)


@pytest.fixture(scope="module")
def by_ice(tmp_path_factory: pytest.TempPathFactory):
    path = tmp_path_factory.mktemp("ice") / "config"

    def read(text: str) -> dict[str, str]:
        path.write_bytes(text.encode())
        held = Ice.createProperties()
        held.load(str(path))
        return dict(held.getPropertiesForPrefix(""))

    return read


@given(FILES)
@settings(max_examples=1000, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@example("a=x\\ \\")
@example("\\\t=b")
@example("a=1\r\na=\nb=2 # c\r\nb\nc=\\")
@example("\ufeffa=1\n\ufeffb=2\n")
def test_reads_what_ice_reads(by_ice, text: str) -> None:
    assert properties.read(text).values == by_ice(text)


@given(st.dictionaries(WORDS | HARD_WORDS, WORDS | HARD_WORDS, max_size=5))
@settings(max_examples=500, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_ice_reads_what_we_write(by_ice, entries: dict[str, str]) -> None:
    writable = {k: v for k, v in entries.items() if not properties.unwritable(k, v)}
    assert by_ice("".join(properties.entry_line(k, v) + "\n" for k, v in writable.items())) == writable


@pytest.mark.parametrize(("key", "value"), [(" a", "1"), ("a ", "1"), ("", "1"), ("a", ""), ("a", "\t1"), ("a", "1\t")])
def test_no_spelling_of_an_unwritable_entry_is_known_to_ice(by_ice, key: str, value: str) -> None:
    """What `unwritable` refuses is not refused for nothing: the obvious spellings all give something else."""
    escaped = value.replace(" ", "\\ "), value.replace("\t", "\\\t"), value
    for spelled in escaped:
        for name in (key, key.replace(" ", "\\ ")):
            assert by_ice(f"{name}={spelled}\n") != {key: value}


def test_reads_every_config_of_the_corpus_as_ice_does(by_ice) -> None:
    corpus = Path(__file__).resolve().parents[2].parent / "shared" / "corpus"
    if not corpus.is_dir():
        pytest.skip("the corpus of legacy files is not beside the checkout")
    files = [path for path in sorted((corpus / "config").rglob("*")) if path.is_file()]
    assert files
    for path in files:
        text = path.read_text(encoding="utf-8")
        assert properties.read(text).values == by_ice(text), path
