"""What components say of themselves, as bytes: also bytes that are cut off, or are something else."""

from __future__ import annotations

import struct

import pytest

from robocomp_yaml.wire import introspection, protocol
from robocomp_yaml.wire.introspection import Facts
from robocomp_yaml.wire.protocol import size, text

LONG = "é" * 200
REPORT = (
    size(2)
    + text("state") + size(1) + text("Arm") + size(2) + text("state") + text("running") + text("why") + text(LONG)
    + size(1) + text("since") + struct.pack("<d", 1.5)
    + text("calls") + size(0)
)  # fmt: skip


def test_a_report() -> None:
    facts = Facts("Arm", {"state": "running", "why": LONG}, {"since": 1.5})
    assert introspection.sections_of(REPORT) == {"state": [facts], "calls": []}


@pytest.mark.parametrize("length", [0, 1, 3, 10, 40, len(REPORT) - 1])
def test_a_report_that_is_cut_off(length: int) -> None:
    with pytest.raises(ValueError, match="shorter than expected"):
        introspection.sections_of(REPORT[:length])


@pytest.mark.parametrize(
    "data", [b"\xff\xff\xff\xff\xff", b"\xff\x00\x00\x00\x80", b"\x01\xfe" + b"x" * 9, b"\xfe" * 50]
)
def test_something_else(data: bytes) -> None:
    with pytest.raises(ValueError, match="shorter than expected"):
        introspection.sections_of(data)


def test_the_names_of_sections() -> None:
    assert introspection.names([]) == b"\0"
    assert introspection.names(["state", "calls"]) == b"\x02\x05state\x05calls"


def test_a_request() -> None:
    """As Ice 3.7 writes it."""
    plain, faceted = protocol.request("a/b", "ice_ping"), protocol.request("b", "report", "rcyaml", b"\0")
    assert plain[:4] == b"IceP" and int.from_bytes(plain[10:14], "little") == len(plain)
    assert plain[14:] == b"\x01\0\0\0\x01b\x01a\0\x08ice_ping\x02\0\x06\0\0\0\x01\x01"
    assert faceted[14:] == b"\x01\0\0\0\x01b\0\x01\x06rcyaml\x06report\x02\0\x07\0\0\0\x01\x01\0"
