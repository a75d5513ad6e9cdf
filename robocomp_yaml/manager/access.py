"""Who may ask the manager what: every request is checked here, before anything else sees it.

The address that is printed contains a token. The first request with it gets a cookie, and is sent to the address
without it. A page of another site can neither read the cookie nor send it (`SameSite`), has another `Origin`, and, if
it makes its name mean this machine, another `Host`. Programs send the token as `Authorization: Bearer`.
"""

from __future__ import annotations

import hmac
import ipaddress
from collections.abc import Collection
from html import escape
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qsl, quote, urlencode, urlsplit

import msgspec
from starlette.datastructures import Headers
from starlette.responses import HTMLResponse, PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

READ, OPERATE, EDIT = "read", "operate", "edit"
"""What a request does: it looks, it changes what runs, or it changes documents."""

API = "/api"
SAFE_METHODS = ("GET", "HEAD")
TOKEN = "token"
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
    "font-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "Content-Security-Policy": _POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class AccessRules(msgspec.Struct, frozen=True):
    """`rights` are what requests may do. `hosts` are further names and addresses by which this server may be called;
    the names of this machine for itself always may. `port` is that of the cookie's name, because cookies do not
    distinguish ports."""

    token: str
    rights: Collection[str] = (READ, OPERATE, EDIT)
    hosts: Collection[str] = ()
    port: int = 0
    is_secure: bool = False

    @property
    def cookie(self) -> str:
        return f"rcyaml-{self.port}"

    def knows(self, host: str, own: str = "") -> bool:
        """Whether a request for this `Host` is meant for this server. `own` is the address at which it arrived, which
        is no name that others can make mean this machine."""
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:
            return False
        if name == "localhost" or name in self.hosts:
            return True
        try:
            address = ipaddress.ip_address(name)
            return address.is_loopback or address == ipaddress.ip_address(own or "::1")
        except ValueError:
            return False

    def is_right(self, token: str) -> bool:
        return hmac.compare_digest(token.encode("utf-8", "surrogateescape"), self.token.encode())


class Guard:
    """The application behind these rules."""

    def __init__(self, app: ASGIApp, rules: AccessRules) -> None:
        self.app, self.rules = app, rules

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":  # nothing here is a WebSocket
            if scope["type"] == "lifespan":
                await self.app(scope, receive, send)
            return
        refusal = self._refusal(scope)

        async def send_with_headers(event: Message) -> None:
            if event["type"] == "http.response.start":
                own = [(name.lower().encode(), value.encode()) for name, value in HEADERS.items()]
                named = {name for name, _ in event["headers"]}
                event["headers"] = [*event["headers"], *(one for one in own if one[0] not in named)]
            await send(event)

        await (refusal or self.app)(scope, receive, send_with_headers)

    def _refusal(self, scope: Scope) -> Response | None:
        """The answer to a request that is not let through, None for all others."""
        headers, rules = Headers(scope=scope), self.rules
        own, _ = scope.get("server") or ("", None)
        if not rules.knows(headers.get("host", ""), own if rules.is_secure else ""):
            return PlainTextResponse("this host name does not mean this server", 421)
        if not _is_from_here(headers, scope):
            return PlainTextResponse("a page of another site may not ask this server", 403)
        is_safe = scope["method"] in SAFE_METHODS
        query = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
        token = next((value for name, value in query if name == TOKEN), None)
        if token is not None and is_safe:
            return self._with_cookie(scope, token, [pair for pair in query if pair[0] != TOKEN])
        scheme, _, sent = headers.get("authorization", "").partition(" ")
        if scheme.lower() == "bearer":
            return None if rules.is_right(sent.strip()) else PlainTextResponse("wrong token", 403)
        if not rules.is_right(_cookie(headers, rules.cookie)):
            return PlainTextResponse("open the address that `rcyaml manager` printed: it contains a token", 403)
        if not is_safe and "origin" not in headers and headers.get("sec-fetch-site") != "same-origin":
            return PlainTextResponse("a request that changes something names its origin", 403)
        return None

    def _with_cookie(self, scope: Scope, token: str, query: list[tuple[str, str]]) -> Response:
        if not self.rules.is_right(token):
            return PlainTextResponse("wrong token", 403)
        target = quote("/" + scope["path"].lstrip("/")) + (f"?{urlencode(query)}" if query else "")
        response: Response = RedirectResponse(target, 303)
        if Headers(scope=scope).get("sec-fetch-site", "none") != "none":
            # A browser that follows a link of another site sends no strict cookie after a redirect, but from a page.
            content = (
                f'<!doctype html><meta http-equiv="refresh" content="0;url={escape(target)}"><title>rcyaml</title>'
            )
            response = HTMLResponse(content)
        response.set_cookie(
            self.rules.cookie, token, path="/", httponly=True, samesite="strict", secure=self.rules.is_secure
        )
        return response


def _is_from_here(headers: Headers, scope: Scope) -> bool:
    """Whether a browser sent the request for a page of this server, or for its address bar, or no browser sent it."""
    if headers.get("sec-fetch-site", "none") not in ("same-origin", "none"):
        is_navigation = headers.get("sec-fetch-mode") == "navigate" and scope["method"] in SAFE_METHODS
        if not is_navigation or scope["path"].startswith(f"{API}/"):
            # Only a link may lead here: the cookie is not sent then, but the token may be.
            return False
    origin = headers.get("origin")
    return origin is None or origin == f"{scope['scheme']}://{headers.get('host', '')}"


def _cookie(headers: Headers, name: str) -> str:
    try:
        found = SimpleCookie(headers.get("cookie", "")).get(name)
    except CookieError:
        return ""
    return found.value if found is not None else ""
