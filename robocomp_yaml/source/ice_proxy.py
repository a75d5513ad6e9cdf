"""Parses proxies as Ice 3.7 does: `lamps/left -t:tcp -h 10.0.0.9 -p 10002`, or `left @ Adapter`."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache

import msgspec
from msgspec.structs import replace

from robocomp_yaml.source.ice_endpoint import IceEndpoint, UnknownProtocol, read_endpoint, segments
from robocomp_yaml.source.ice_options import BLANKS, InvalidIceText, Word, after_blanks, check_version, forbid_value

_END = re.compile(f"[{BLANKS}:@]")
_BLANK = re.compile(f"[{BLANKS}]")
_SIGNS = {"a": "\a", "b": "\b", "f": "\f", "n": "\n", "r": "\r", "t": "\t", "v": "\v"} | {c: c for c in "\\'\"?"}
_ESCAPE = re.compile(
    r"\\(?:(?P<sign>[abfnrtv\\'\"?])|(?P<octal>[0-7]{1,3})|x(?P<hex>[0-9A-Fa-f]{1,2})|u(?P<short>[0-9A-Fa-f]{4})"
    r"|U(?P<long>[0-9A-Fa-f]{8})|(?P<slash>/)|(?P<wrong>[xuU]))|(?P<control>[\0-\x1f\x7f])"
)
_OPTIONS = ("-f", "-t", "-o", "-O", "-d", "-D", "-s", "-e", "-p")
_ALONE = ("-t", "-o", "-O", "-d", "-D", "-s")


class Proxy(msgspec.Struct, frozen=True):
    """`identity` is the text as written, without quotes; `category` and `name` are its parsed parts. `options` are the
    letters of the options. Without `endpoints` Ice looks up the proxy by `adapter`, or, if that is '', by its identity.
    `unknown` are endpoints of unknown protocols, which Ice ignores as long as there are others."""

    identity: str
    category: str
    name: str
    options: str = ""
    endpoints: tuple[IceEndpoint, ...] = ()
    adapter: str = ""
    unknown: tuple[UnknownProtocol, ...] = ()

    @property
    def is_plain(self) -> bool:
        """Whether calls are two-way, and to the object itself, not to a facet."""
        return not set(self.options) - set("tep")


@lru_cache(4096)
def parse_proxy(text: str) -> Proxy:
    """The proxy in a text. Raises InvalidIceText, also for `""`, which Ice reads as a null proxy."""
    start = after_blanks(text, 0)
    if start == len(text):
        raise InvalidIceText("it is empty", 0, len(text))
    word = _word(text, start, _END)
    if word.start == word.end:
        raise InvalidIceText("the identity is missing", start, start + 1)
    category, name = _identity(word)
    if not name:
        raise InvalidIceText("its identity has no name", word.start, word.end)
    letters, at = _options(text, word.end)
    if at == len(text):
        return Proxy(word.text, category, name, letters)
    if text[at] == "@":
        return Proxy(word.text, category, name, letters, adapter=_adapter(text, at))
    endpoints: list[IceEndpoint] = []
    unknown: list[UnknownProtocol] = []
    for begin, end in segments(text, at):
        try:
            endpoints.append(read_endpoint(text, begin, end, for_adapter=False))
        except UnknownProtocol as error:
            unknown.append(error)
    if not endpoints:
        raise unknown[0]
    return Proxy(word.text, category, name, letters, tuple(endpoints), unknown=tuple(unknown))


def proxy_at(text: str) -> Proxy | None:
    """The proxy in a text; None if the text is invalid."""
    try:
        return parse_proxy(text)
    except InvalidIceText:
        return None


def reached_at(text: str, address: str, is_here: Callable[[str], bool]) -> str:
    """The proxy with `address` in its endpoints that have no host, or one that `is_here`; the text as it is, if it has
    no endpoints."""
    proxy = proxy_at(text)
    if proxy is None or not proxy.endpoints:
        return text
    head = text[: text.index(":", text.index(proxy.identity) + len(proxy.identity))].rstrip(BLANKS)
    endpoints = [
        replace(one, host=address).reached_at(address)
        if not one.host or is_here(one.host)
        else one.reached_at(one.host)
        for one in proxy.endpoints
    ]
    return ":".join([head, *endpoints])


def _options(text: str, at: int) -> tuple[str, int]:
    """The letters of a proxy's options, and the index after them."""
    letters = ""
    while True:
        at = after_blanks(text, at)
        if at == len(text) or text[at] in ":@":
            return letters, at
        end = _until(text, at, _END)
        option, argument = Word(text[at:end], at, end), None
        at = end
        if len(option.text) != 2 or option.text[0] != "-":
            problem = f"'{option.text}' is not an option, a colon or @, which are expected here"
            raise InvalidIceText(problem, option.start, option.end)
        following = after_blanks(text, at)
        if following < len(text) and text[following] not in "@:-":
            argument = _word(text, following, _END)
            at = argument.end
            argument = argument if argument.text else None
        if option.text not in _OPTIONS:
            known = f"{', '.join(_OPTIONS[:-1])} and {_OPTIONS[-1]}"
            raise InvalidIceText(f"a proxy has no option '{option.text}', only {known}", option.start, option.end)
        _check(option, argument)
        letters += option.text[1]


def _check(option: Word, argument: Word | None) -> None:
    if option.text in _ALONE:
        forbid_value(option, argument)
    elif option.text == "-f":
        if argument is None:
            raise InvalidIceText("'-f' needs the name of a facet", option.start, option.end)
        unescaped(argument)
    else:
        check_version(option, argument)


def _adapter(text: str, at: int) -> str:
    start = after_blanks(text, at + 1)
    if start == len(text):
        raise InvalidIceText("the adapter is missing after the @", at, at + 1)
    word = _word(text, start, _BLANK)
    more = after_blanks(text, word.end)
    if more < len(text):
        raise InvalidIceText("the proxy must end after the adapter", more, len(text))
    name = unescaped(word)
    if not name:
        raise InvalidIceText("the adapter has no name", word.start, word.end)
    return name


def _until(text: str, at: int, end: re.Pattern[str]) -> int:
    match = end.search(text, at)
    return match.start() if match else len(text)


def _word(text: str, start: int, end: re.Pattern[str]) -> Word:
    """The word at `start`: a text in quotes, or the text before the next match of `end`. Its indices include quotes."""
    quote = text[start]
    if quote not in "\"'":
        stop = _until(text, start, end)
        return Word(text[start:stop], start, stop)
    at = text.find(quote, start + 1)
    while at > 0 and text[at - 1] == "\\":  # Ice does not check whether the backslash is itself escaped
        at = text.find(quote, at + 1)
    if at < 0:
        raise InvalidIceText("a quote is not closed", start, len(text))
    return Word(text[start + 1 : at], start, at + 1)


def _identity(word: Word) -> tuple[str, str]:
    """Category and name, which are separated by an unescaped slash."""
    slashes = [match.start() for match in re.finditer(r"\\.|/", word.text, re.DOTALL) if match[0] == "/"]
    if len(slashes) > 1:
        raise InvalidIceText("an identity is CATEGORY/NAME, with one slash", word.start, word.end)
    if not slashes:
        return "", unescaped(word, is_identity=True)
    parts = word.text[: slashes[0]], word.text[slashes[0] + 1 :]
    category, name = (unescaped(Word(part, word.start, word.end), is_identity=True) for part in parts)
    return category, name


def unescaped(word: Word, *, is_identity: bool = False) -> str:
    """The text of a word with Ice's escape sequences replaced. In an identity, `\\/` is a slash. Before any other
    character a backslash is literal. Raises InvalidIceText."""

    def replaced(match: re.Match[str]) -> str:
        if match["control"]:
            raise InvalidIceText(f"{match[0]!r} is not a printable character", word.start, word.end)
        if match["sign"]:
            return _SIGNS[match["sign"]]
        if match["slash"]:
            return "/" if is_identity else match[0]
        digits = match["hex"] or match["short"] or match["long"]
        number = int(digits, 16) if digits else int(match["octal"] or "400", 8)
        is_character = number < 256 if match["octal"] else number < 0xD800 or 0xDFFF < number < 0x110000
        if match["wrong"] or not is_character:
            raise InvalidIceText(f"'{match[0]}' is not a character", word.start, word.end)
        is_byte = (match["octal"] or match["hex"]) and number > 127  # a byte of a UTF-8 sequence
        return chr(0xDC00 + number) if is_byte else chr(number)

    text = _ESCAPE.sub(replaced, word.text)
    return text.encode(errors="surrogateescape").decode(errors="surrogateescape")
