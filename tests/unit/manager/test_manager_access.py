"""Who may ask the manager what."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

pytest.importorskip("starlette", reason="pip install rcyaml[manager]")

from starlette.responses import PlainTextResponse
from starlette.types import Message

from robocomp_yaml.manager.access import HEADERS, AccessRules, Guard

TOKEN = "a-good-token"
HERE = "127.0.0.1:7410"
COOKIE = {"cookie": f"rcyaml-7410={TOKEN}"}


def ask(
    path: str = "/api", method: str = "GET", rules: AccessRules | None = None, **headers: str
) -> tuple[int, dict[str, str]]:
    """The status and the headers of an answer."""
    rules = rules or AccessRules(TOKEN, port=7410)
    sent = {"host": HERE} | {name.replace("_", "-"): value for name, value in headers.items()}
    path, _, query = path.partition("?")
    scope: dict[str, Any] = {
        "type": "http", "method": method, "path": path, "query_string": query.encode(), "scheme": "http",
        "server": ("10.0.0.2", 7410),
        "headers": [(name.encode(), value.encode("latin-1")) for name, value in sent.items()],
    }  # fmt: skip
    messages: list[Message] = []

    async def receive() -> Message:
        return {"type": "http.request", "body": b""}

    async def send(message: Message) -> None:
        messages.append(message)

    asyncio.run(Guard(PlainTextResponse("inside"), rules)(scope, receive, send))
    start = messages[0]
    return start["status"], {name.decode(): value.decode() for name, value in start["headers"]}


def test_a_request_needs_the_token() -> None:
    assert ask()[0] == 403
    assert ask(**COOKIE)[0] == 200
    assert ask(authorization=f"Bearer {TOKEN}")[0] == 200
    assert ask(authorization="Bearer other", **COOKIE)[0] == 403
    assert ask(cookie=f"rcyaml-7411={TOKEN}")[0] == 403  # of another manager
    assert ask(cookie="rcyaml-7410=")[0] == 403
    assert ask(cookie="\xff;;=")[0] == 403
    assert ask("/api", rules=AccessRules("", port=7410), cookie="rcyaml-7410=x")[0] == 403


def test_the_token_leaves_the_address_and_becomes_a_cookie() -> None:
    status, headers = ask(f"/page?a=b&token={TOKEN}&c=")
    assert (status, headers["location"]) == (303, "/page?a=b&c=")
    cookie = headers["set-cookie"]
    assert cookie.startswith(f"rcyaml-7410={TOKEN};")
    assert {"HttpOnly", "SameSite=strict", "Path=/"} <= set(cookie.split("; "))
    assert "Secure" in ask(f"/?token={TOKEN}", rules=AccessRules(TOKEN, port=7410, is_secure=True))[1]["set-cookie"]
    assert ask("/?token=other")[0] == 403
    assert ask("/?token=")[0] == 403
    assert ask(f"//evil.com/?token={TOKEN}")[1]["location"] == "/evil.com/"
    assert ask(f"/\\evil.com?token={TOKEN}")[1]["location"] == "/%5Cevil.com"
    assert ask(f"/?token={TOKEN}", "POST")[0] == 403


@pytest.mark.parametrize(
    ("host", "is_own"),
    [
        ("127.0.0.1:7410", True), ("localhost:7410", True), ("localhost:9000", True), ("[::1]:7410", True),
        ("127.0.0.1", True), ("evil.com:7410", False), ("localhost.evil.com", False), ("10.0.0.2:7410", False),
        ("0.0.0.0:7410", False), ("", False), ("[::1", False), ("127.0.0.1.evil.com", False),
    ],
)  # fmt: skip
def test_a_name_that_leads_here_is_not_enough(host: str, is_own: bool) -> None:
    assert ask(**COOKIE, host=host)[0] == (200 if is_own else 421)
    assert ask(f"/?token={TOKEN}", host=host)[0] == (303 if is_own else 421)


def test_the_names_at_which_it_listens_are_its_own() -> None:
    rules = AccessRules(TOKEN, hosts=("robot", "10.0.0.2"), port=7410)
    assert ask(rules=rules, host="robot:7410", **COOKIE)[0] == 200
    assert ask(rules=rules, host="10.0.0.2:7410", **COOKIE)[0] == 200
    assert ask(rules=rules, host="10.0.0.3:7410", **COOKIE)[0] == 421


def test_pages_of_other_sites_are_refused() -> None:
    for headers in (
        {"origin": "http://evil.com"}, {"origin": "null"}, {"origin": f"https://{HERE}"},
        {"origin": "http://localhost:7410"}, {"origin": f"http://{HERE}0"}, {"sec_fetch_site": "cross-site"},
        {"sec_fetch_site": "same-site"},
    ):  # fmt: skip
        for method in ("GET", "POST"):
            assert ask("/api", method, **COOKIE, **headers)[0] == 403, headers
    assert ask(**COOKIE, origin=f"http://{HERE}", sec_fetch_site="same-origin")[0] == 200
    assert ask(**COOKIE, sec_fetch_site="cross-site", sec_fetch_mode="navigate")[0] == 200  # a link
    assert ask("/api", "POST", **COOKIE, sec_fetch_site="cross-site", sec_fetch_mode="navigate")[0] == 403


def test_a_change_names_its_origin() -> None:
    assert ask("/api", "POST", **COOKIE)[0] == 403
    assert ask("/api", "POST", **COOKIE, origin=f"http://{HERE}")[0] == 200
    assert ask("/api", "POST", **COOKIE, sec_fetch_site="same-origin")[0] == 200
    assert ask("/api", "POST", authorization=f"bearer {TOKEN}")[0] == 200  # no browser sends it by itself


def test_every_answer_has_the_policies() -> None:
    for headers in (ask(**COOKIE)[1], ask()[1], ask(host="evil.com")[1], ask(f"/?token={TOKEN}")[1]):
        assert {name: headers[name.lower()] for name in HEADERS} == HEADERS
    assert "unsafe" not in HEADERS["Content-Security-Policy"]


@pytest.mark.parametrize(("host", "is_own"), [("10.0.0.2:7410", True), ("10.0.0.3:7410", False), ("robot:7410", False)])
def test_a_server_for_others_knows_the_address_at_which_it_is_called(host: str, is_own: bool) -> None:
    rules = AccessRules(TOKEN, port=7410, is_secure=True)
    assert ask(rules=rules, host=host, **COOKIE)[0] == (200 if is_own else 421)
    assert ask(host=host, **COOKIE)[0] == 421
