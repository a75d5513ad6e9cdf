"""The reader of proxies and endpoints against Ice's own: what one takes, the other takes."""

from __future__ import annotations

import os
import re

import pytest
from hypothesis import HealthCheck, assume, example, given, settings
from hypothesis import strategies as st

from robocomp_yaml.source import ice_endpoint, ice_proxy
from robocomp_yaml.source.ice_options import InvalidIceText

Ice = pytest.importorskip("Ice", reason="needs Ice's Python module (Debian: python3-zeroc-ice)")

CASES = int(os.environ.get("RCYAML_CASES", "1500"))
PIECES = (
    "s", "lamps", "/", "\\", "\\/", "\\\\", '"', "'", " ", "\t", ":", "@", "tcp", "udp", "ssl", "ws", "wss", "default",
    "opaque", "tpc", "-h", "-p", "-t", "-z", "-r", "-c", "-e", "-f", "-o", "-O", "-d", "-D", "-s", "-q", "--ttl",
    "--interface", "--sourceAddress", "-timeout", "-v", "127.0.0.1", "::1", "*", "localhost", "1", "10001", "65536",
    "-1", "+7", "07", "0x10", "1.0", "1.1", "2.256", "infinite", "\x01", "\x7f", "é", "\\377", "\\400", "\\u00e9",
    "\\ud800", "\\x", "\\x4", "\\n", "-", "--", "", "99", "AAAA", "=", "$", "\n", "\v", "a b", "//", " :", ": ",
)  # fmt: skip
ANY = st.lists(st.sampled_from(PIECES), max_size=14).map("".join)
SPACED = st.lists(st.sampled_from(PIECES), max_size=14).map(" ".join)
OPTIONS = st.lists(
    st.sampled_from((
        "-h 127.0.0.1", "-h localhost", '-h "::1"', "-h *", "-p 10001", "-p 0", "-p 65535", "-p 65536", "-p -1", "-p",
        "-t 5000", "-t infinite", "-t 0", "-z", "-z x", "-r /x", "-r", "-c", "--ttl 3", "--ttl -3", "--ttl x",
        "--interface 127.0.0.1", "--interface *", "--sourceAddress 127.0.0.1", "--sourceAddress here", "-q 1", "-h ''",
        "-v 1.0", "-e 1.0", "-e one", "-timeout 5", "-p ' 7'", "-p '7 '", "x", "-p 4294967297", "-h 'a b'", "-", "-zz",
    )),
    max_size=5,
).map(" ".join)  # fmt: skip
PROTOCOLS = st.sampled_from(("tcp", "udp", "ssl", "ws", "wss", "default", "tpc", ""))
ENDPOINT = st.tuples(PROTOCOLS, OPTIONS).map(" ".join)
ENDPOINTS = st.lists(ENDPOINT, min_size=1, max_size=3).map(":".join)
IDENTITIES = st.sampled_from(("s", "lamps/left", '"a b"', "'a:b'", "a/b/c", "/a", "a/", '""', "a\\/b", "a\\\\/b", "é"))
HEADS = st.sampled_from(("", " -t", " -f face", " -f", " -f ''", " -e 1.0", " -p 1.0", " -e 1", " -q", " -o x", " -s"))
PROXIES = st.tuples(IDENTITIES, HEADS, st.just(":"), ENDPOINTS).map("".join)
AT = st.sampled_from(("@ A", "@A", "@", '@ "A b"', '@ ""', "@ A b", " @A:tcp", "@\\x"))
ADAPTERS = st.tuples(IDENTITIES, HEADS, AT).map("".join)


@st.composite
def mutated(draw: st.DrawFn, texts: st.SearchStrategy[str]) -> str:
    """A text with a few signs left out, doubled or put in."""
    text = draw(texts)
    for _ in range(draw(st.integers(0, 3))):
        at = draw(st.integers(0, len(text)))
        piece = draw(st.sampled_from((*PIECES, text[at : at + 1] * 2)))
        text = text[:at] + piece + text[at + draw(st.integers(0, 2)) :]
    return text


@pytest.fixture(scope="module")
def communicator():
    made = Ice.InitializationData()
    made.properties = Ice.createProperties(
        ["--Ice.Plugin.IceSSL=IceSSL:createIceSSL", "--Ice.Warn.Endpoints=0", "--Ice.LogFile=/dev/null"]
    )
    with Ice.initialize(made) as communicator:
        yield communicator


def is_taken(parse, text: str) -> bool:
    try:
        parse(text)
    except InvalidIceText as refused:
        assert 0 <= refused.start <= refused.end <= len(text)
        assert refused.problem
        return False
    return True


@given(ANY | SPACED | mutated(PROXIES) | mutated(ADAPTERS) | PROXIES)
@settings(max_examples=CASES, suppress_health_check=list(HealthCheck), deadline=None)
@example("moouth sp")
@example("a // b")
@example("s:tcp -q 1")
@example("s:tcp -p 1:tpc -p 2")
@example("s:ws -r -p 10 /path")
@example('s:tcp -h "a:b" -p 1')
@example("s:tcp -h 'a:b' -p 1")
@example("s:opaque -t 99 -v AAAA")
@example("s:opaque -t 40000 -v AAAA")
@example("s:opaque -t 99 -t 98 -v A")
@example("s -f \\/ @ \\/")
@example("s:udp -v 1.0 -e 256.0")
def test_accepts_the_proxies_that_ice_accepts(communicator, text: str) -> None:
    assume("\0" not in text)
    assume(not re.search(r"opaque(?!.*-t *99)", text))  # its bytes would be looked into, if Ice knew the type
    try:
        by_ice = communicator.stringToProxy(text)
    except Ice.LocalException:
        by_ice = None  # which is also what Ice makes of no proxy at all
    assert is_taken(ice_proxy.parse_proxy, text) == (by_ice is not None)
    if by_ice is not None and not re.search(r"\\[0-7x]", text):  # bytes that are no UTF-8 have no text in Python
        ours, identity = ice_proxy.parse_proxy(text), by_ice.ice_getIdentity()
        assert (ours.category, ours.name) == (identity.category, identity.name)
        assert ours.adapter == by_ice.ice_getAdapterId()
        infos = [_innermost(endpoint.getInfo()) for endpoint in by_ice.ice_getEndpoints()]
        assert len(infos) == len(ours.endpoints)
        for info, endpoint in zip(infos, ours.endpoints, strict=True):
            host = "" if getattr(info, "host", "") in ("0.0.0.0", "::") else getattr(info, "host", "")
            assert (getattr(info, "port", 0), host) == (endpoint.port, endpoint.host)


def _innermost(info):
    return info if info.underlying is None else _innermost(info.underlying)


@given(mutated(ENDPOINTS) | ENDPOINTS)
@settings(max_examples=CASES // 3, suppress_health_check=list(HealthCheck), deadline=None)
@example("tcp -p 0:")
@example("tcp -p 0: ")
@example(":tcp")
@example("tcp -p 0::tcp")
@example("tcp --sourceAddress 127.0.0.1")
@example("udp -h * --interface *")
def test_accepts_the_endpoints_that_ice_accepts(communicator, text: str) -> None:
    """Ice has to listen there to say it: only on this machine, and without looking up names."""
    assume("opaque" not in text and "\0" not in text)
    is_ours = is_taken(ice_endpoint.parse_endpoints, text)
    if is_ours:
        hosts = {endpoint.host for endpoint in ice_endpoint.parse_endpoints(text)}
        assume(hosts <= {"", "127.0.0.1", "::1", "localhost"})
    name = f"A{hash(text) % 10**9}"
    try:
        communicator.createObjectAdapterWithEndpoints(name, text).destroy()
        by_ice = True
    except Ice.EndpointParseException:
        by_ice = False
    except Ice.LocalException:
        by_ice = True  # it was understood, and could not be had
    assert is_ours == by_ice
