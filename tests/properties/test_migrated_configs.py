"""Random configs: the documents give the properties again that Ice reads from the file."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from hypothesis import example, given, settings
from hypothesis import strategies as st

from parameters import as_dict
from robocomp_yaml.legacy.migration import migrate
from robocomp_yaml.legacy.settings.plan import Corrections
from robocomp_yaml.parameters.layers.effective import effective
from robocomp_yaml.parameters.writing.properties import properties
from robocomp_yaml.pipeline import analyse
from robocomp_yaml.source import properties as ice

WORD = st.sampled_from(["Laser", "a", "x", "2d", "Motor", "Params_", "rx_", "Period", "period", "Compute", "num", "ID:",
                        "Ice", "Endpoints", "Proxies", "Proxy", "TopicManager", "Prefix", "IceStorm", "é", "null", "x-y",
                        "0", "007", "on", "legacy", "env"])  # fmt: skip
KEY = st.lists(WORD | st.integers(0, 3).map(str) | st.just("."), min_size=1, max_size=5).map("".join)
SCALAR = st.one_of(
    st.sampled_from(["true", "False", "on", "null", "~", "1e3", "-0", "+5", ".5", "2000.", "0x1F", "007", "1_000", "0,5",
                     "12:30", "tcp -p 10", "laser:tcp -h h -p 1", "IceStorm/TopicManager:default -p 9", "{x}", "[1, 2]",
                     "/a b/c", "http://x", "${env:HOME}", "a:b", "- a", "9223372036854775808", "1e999", "Laser"]),
    st.integers().map(str), st.floats(allow_nan=False).map(repr), st.text("ab,; \t\"'\\#:{}é", max_size=8),
)  # fmt: skip
VALUE = st.one_of(
    SCALAR,
    st.lists(SCALAR, min_size=2, max_size=4).map(",".join),
    st.lists(SCALAR, min_size=2, max_size=4).map(", ".join),
    st.lists(SCALAR, min_size=2, max_size=3).map(";".join),
    SCALAR.map(lambda text: f'"{text}"'),
)
COMMENT = st.sampled_from(["", "", "  # name, id", "#x", " # a b c"])
LINE = st.one_of(
    st.builds(lambda key, value, comment: f"{key} = {value}{comment}", KEY, VALUE, COMMENT),
    st.builds(lambda stem, number, row: f"{stem}{number}={row}", WORD, st.integers(0, 2), VALUE),
    st.sampled_from(["", "# name, id, zero", "#Motor0 = a,1", "no entry", "Endpoints.Laser = tcp -p 1"]),
)


def exported(document: str) -> dict[str, str]:
    analysis = analyse((document,), ())
    assert [d for d in analysis.diagnostics if d.severity == "error"] == []
    linked = analysis.program.values[os.path.realpath(document)]
    values, found = effective(linked)
    assert values is not None, found
    sections, faults = properties(linked, values)
    assert faults == []
    return as_dict(sections)


@settings(deadline=None, max_examples=200)
@given(st.lists(LINE, min_size=1, max_size=12).map("\n".join))
@example("Endpoints.Laser = tcp -p 1\nLaser0=true,true,true\nLaser1=true,true")  # texts without quotes in flat TOML
@example('Endpoints.Laser = tcp -p 1\nLaser0="a,b"\nLaser1=true\nLaser2= x , y')
def test_the_properties_come_back(text: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "etc" / "config"
        path.parent.mkdir()
        path.write_text(text, encoding="utf-8")
        run = migrate([folder], None, (), force=False, guesses=Corrections(), exact=True)
        run.write()
        (entry,) = run.entries
        assert entry.lines().total() == entry.file.source.lines  # type: ignore[union-attr]
        if entry.outputs:
            meant = {key: value for key, value in ice.read(text).values.items() if not ice.unwritable(key, value)}
            assert exported(entry.outputs[0]) == meant or any("quotes" in d.message for d in entry.diagnostics)
        else:
            assert entry.status in ("refused", "skipped")  # the latter if there is nothing in it
