"""Proxies and endpoints as text: what they mean, and where they are wrong. Ice's own verdicts are in tests/ice."""

from __future__ import annotations

import pytest

from robocomp_yaml.source.ice_endpoint import IceEndpoint, fixed_endpoint, parse_endpoint
from robocomp_yaml.source.ice_options import InvalidIceText
from robocomp_yaml.source.ice_proxy import parse_proxy, proxy_at


@pytest.mark.parametrize(
    ("text", "where", "problem"),
    [
        ("lamp left", "left", "'left' is not an option"),
        ("lamp -x:tcp", "-x", "no option '-x'"),
        ("lamp -o yes:tcp -p 1", "yes", "'-o' has the value 'yes'"),
        ("lamp:tcp -p 65536", "65536", "from 0 to 65535"),
        ("lamp:tcp -h * -p 1", "*", "means all network interfaces"),
        ("lamp:udp -t 5", "-t", "udp has no option '-t', only -h, -p, -c"),
        ("lamp:ws -r", "-r", "needs a value"),
        ("lamp:tcp -t 0", "0", "timeout"),
        ("lamp:tcp -h 'a b", "'a b", "a quote is not closed"),
        ("lamp:tpc -p 1", "tpc", "unknown protocol 'tpc'"),
        ("lamp:tcp -h ::1 -p 1", "-h", "an IPv6 address must be in double quotes"),
        ("lamp:", ":", "an endpoint is missing"),
        ("lamp @", "@", "adapter is missing"),
        ("lamp @ A b", "b", "must end after the adapter"),
        ("a/b/c:tcp", "a/b/c", "one slash"),
        ("room/:tcp", "room/", "no name"),
        (":tcp -p 1", ":", "identity is missing"),
        ("lamp -e 1:tcp", "1", "not a version"),
        ("l\\x:tcp", "l\\x", "is not a character"),
        ("lamp:tcp --sourceAddress lamp", "lamp", "not an IP address"),
        ('lamp:bt -a "00:11:22:33:44:55"', "bt", "UUID"),
        ("lamp:bt -a 00:00", "00", "Bluetooth"),
        ("lamp:opaque -t 99", "opaque", "-v BYTES"),
    ],
)
def test_what_is_wrong_and_where(text: str, where: str, problem: str) -> None:
    with pytest.raises(InvalidIceText) as refused:
        parse_proxy(text)
    assert problem in refused.value.problem
    assert text[refused.value.start : refused.value.end] == where


def test_what_it_means() -> None:
    found = parse_proxy('"room 1/left" -o -f face:tcp -h "::1" -t 500 -p 10002 -z:tpc -p 1 : ssl -p 7')
    assert (found.category, found.name, found.options) == ("room 1", "left", "of")
    assert found.endpoints == (IceEndpoint(10002, "tcp", "::1", "-t 500 -z"), IceEndpoint(7, "ssl"))
    assert [unknown.meant[0] for unknown in found.unknown] == ["tcp"]
    assert not found.is_plain and parse_proxy("a -t -e 1.0:tcp").is_plain
    assert parse_proxy("a\\/b\\u00e9\\303\\251 @ 'A 1'").name == "a/béé"
    assert parse_proxy("a @ 'A 1'").adapter == "A 1"
    assert proxy_at("two words") is None


def test_nobody_means_bluetooth() -> None:
    with pytest.raises(InvalidIceText) as refused:
        parse_proxy("lamp:tls -p 1")
    assert "ssl" in refused.value.meant and "bts" not in refused.value.meant


@pytest.mark.parametrize(
    "text", ["", "tcp", "tcp -p 0", "udp:tcp -p 1", "tcp -p 1:tpc -p 2", "tcp -p 1 -q", ":tcp -p 1"]
)
def test_no_fixed_endpoint(text: str) -> None:
    with pytest.raises(InvalidIceText):
        fixed_endpoint(text)
    assert parse_endpoint(text) is None


def test_the_first_of_several_endpoints() -> None:
    assert fixed_endpoint('ws -h "a:b" -p 1 -r "/x:y":tcp') == IceEndpoint(1, "ws", "a:b", '-r "/x:y"')
    assert fixed_endpoint("tcp -h 0.0.0.0 -p 1 -p 2").reached_at("::1") == 'tcp -h "::1" -p 2'
