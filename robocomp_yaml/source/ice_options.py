"""The words of an Ice endpoint, and the options of each protocol."""

from __future__ import annotations

import re
from collections.abc import Callable

import msgspec

from robocomp_yaml.patterns import pattern

BLANKS = " \t\r\n"
LAST_PORT = 65535

_INT = pattern(r"[ \t\n\v\f\r]*[-+]?[0-9]+\Z")
_BASE64 = pattern(r"[A-Za-z0-9+/=]+\Z")
_IN_DOUBLE, _IN_SINGLE = (rf"(?:\\{quote}|[^{quote}\\]|\\(?!{quote}))*" for quote in "\"'")
_WORD = pattern(rf"""(?:"{_IN_DOUBLE}"|'{_IN_SINGLE}'|\\["']|[^"' \t\r\n\\]|\\(?!["']))*""")
_QUOTED = pattern(rf""""({_IN_DOUBLE})"|'({_IN_SINGLE})'|\\(["'])""")
_DEVICE = pattern(r"[0-9A-Fa-f]{2}(:[0-9A-Fa-f]{2}){5}\Z")


class InvalidIceText(ValueError):
    """A text that Ice rejects: why, and the indices of the invalid part. `meant` are candidates that would be valid."""

    def __init__(self, problem: str, start: int, end: int, meant: tuple[str, ...] = ()) -> None:
        super().__init__(problem)
        self.problem, self.start, self.end, self.meant = problem, start, end, meant


class Word(msgspec.Struct, frozen=True):
    """A word without its quotes, and its indices with them."""

    text: str
    start: int
    end: int


def after_blanks(text: str, start: int) -> int:
    while start < len(text) and text[start] in BLANKS:
        start += 1
    return start


def words_of(text: str, start: int, end: int) -> list[Word]:
    """The words of text[start:end], split as in a shell: quotes of both kinds, anywhere in a word, and backslashes
    before quotes. Raises InvalidIceText for an unclosed quote."""
    words: list[Word] = []
    while (at := after_blanks(text, start)) < end:
        match = _WORD.match(text, at, end)
        assert match is not None  # it may be empty
        start = match.end()
        if start < end and text[start] not in BLANKS:
            raise InvalidIceText("a quote is not closed", start, end)
        if plain := _QUOTED.sub(_unquoted, match[0]):
            words.append(Word(plain, at, start))
    return words


def _unquoted(part: re.Match[str]) -> str:
    return part[part.lastindex or 0].replace(f"\\{part[0][0]}", part[0][0])


class _Ip:
    """Reads the options of TCP, ssl, ws and wss."""

    accepted: tuple[str, ...] = ("-h", "-p", "-t", "-z", "--sourceAddress")

    def __init__(self, protocol: str, for_adapter: bool) -> None:
        self.protocol, self.for_adapter = protocol, for_adapter
        self.port = 0
        self.host = ""
        self.others: list[tuple[Word, Word]] = []
        """The first and last word of each option except host and port."""
        self._host_at: Word | None = None
        self._source_at: Word | None = None
        if protocol in ("ws", "wss"):
            self.accepted = (*self.accepted, "-r")

    def read(self, words: list[Word], is_known: Callable[[Word, Word | None], bool]) -> list[Word]:
        """Reads options, each with its value if the next word is not an option; returns the words that are unknown."""
        unknown: list[Word] = []
        at = 0
        while at < len(words):
            option, argument = words[at], None
            at += 1
            if len(option.text) < 2 or option.text[0] != "-":
                unknown.append(option)
                continue
            if at < len(words) and words[at].text[0] != "-":
                argument = words[at]
                at += 1
            if not is_known(option, argument):
                unknown += [option] if argument is None else [option, argument]
            elif option.text not in ("-h", "-p"):
                self.others.append((option, argument or option))
        return unknown

    def is_known(self, option: Word, argument: Word | None) -> bool:
        if self._is_of_ip(option, argument):
            return True
        match option.text[1]:
            case "t":
                _timeout(option, argument)
            case "z":
                forbid_value(option, argument)
            case _:
                return False
        return True

    def _is_of_ip(self, option: Word, argument: Word | None) -> bool:
        match option.text:
            case "-h":
                self._host_at = _required(option, argument, "a value; an IPv6 address must be in double quotes")
                self.host = self._host_at.text
            case "-p":
                self.port = _number(option, argument, "a port", 0, LAST_PORT)
            case "--sourceAddress":
                self._source_at = _required(option, argument)
                if not _is_address(self._source_at.text):
                    raise _wrong(self._source_at, "is not an IP address")
            case _:
                return False
        return True

    def is_resource(self, option: Word, argument: Word | None) -> bool:
        """Whether the option is the resource of a web socket."""
        if option.text[1] != "r":
            return False
        _required(option, argument)
        return True

    def finish(self, protocol: Word) -> None:
        if self._host_at is not None and self.host == "*" and not self.for_adapter:
            raise _wrong(self._host_at, "means all network interfaces, and a proxy needs one host")
        if self._source_at is not None and self.for_adapter:
            raise _wrong(self._source_at, "is the source of calls, which is allowed only in a proxy")


class _Udp(_Ip):
    accepted = ("-h", "-p", "-c", "-z", "--interface", "--ttl", "--sourceAddress")
    _interface_at: Word | None = None

    def is_known(self, option: Word, argument: Word | None) -> bool:
        match option.text:
            case "-c" | "-z":
                forbid_value(option, argument)
            case "-v" | "-e":
                check_version(option, argument)
            case "--interface":
                self._interface_at = _required(option, argument)
            case "--ttl":
                _number(option, argument, "a TTL", -(1 << 31), (1 << 31) - 1)
            case _:
                return self._is_of_ip(option, argument)
        return True

    def finish(self, protocol: Word) -> None:
        super().finish(protocol)
        at = self._interface_at
        if at is not None and at.text == "*" and not self.for_adapter:
            raise _wrong(at, "means all network interfaces, and a proxy needs one")


class _Bluetooth(_Ip):
    accepted = ("-a", "-u", "-c", "-t", "-z", "--name")
    _has_id = False
    _channel_at: Word | None = None

    def is_known(self, option: Word, argument: Word | None) -> bool:
        if argument is not None and not argument.text.strip(BLANKS):
            argument = None
        match option.text:
            case "-a":
                word = _required(option, argument)
                address = word.text.strip(BLANKS)
                if not _DEVICE.match(address) and not (address == "*" and self.for_adapter):
                    raise _wrong(word, "is not a Bluetooth address")
            case "-u":
                _required(option, argument)
                self._has_id = True
            case "-c":
                self._channel_at = argument if _number(option, argument, "a channel", 0, 30) else None
            case "-t":
                if argument is None or argument.text.strip(BLANKS) != "infinite":
                    _timeout(option, argument)
            case "-z":
                forbid_value(option, argument)
            case "--name":
                _required(option, argument)
            case _:
                return False
        return True

    def finish(self, protocol: Word) -> None:
        if not self.for_adapter and not self._has_id:
            raise _wrong(protocol, "needs the UUID of a service, `-u UUID`")
        if not self.for_adapter and self._channel_at is not None:
            raise _wrong(self._channel_at, "is a channel, which is allowed only in an adapter")


class _Opaque(_Ip):
    """The content of the bytes is not checked."""

    accepted = ("-t", "-v", "-e")
    _has_type = _has_bytes = False

    def is_known(self, option: Word, argument: Word | None) -> bool:
        match option.text[1]:
            case "t":
                if self._has_type:
                    raise _wrong(option, "is written twice")
                self._has_type = _number(option, argument, "a type", 0, LAST_PORT) <= 32767
            case "v":
                word = _required(option, argument)
                if self._has_bytes:
                    raise _wrong(option, "is written twice")
                if not _BASE64.match(word.text):
                    raise _wrong(word, "is not Base64")
                self._has_bytes = True
            case "e":
                check_version(option, argument)
            case _:
                return False
        return True

    def finish(self, protocol: Word) -> None:
        if not self._has_type:
            raise _wrong(protocol, "needs a type, `-t NUMBER` up to 32767")
        if not self._has_bytes:
            raise _wrong(protocol, "needs its bytes in Base64, `-v BYTES`")


PROTOCOLS: dict[str, type[_Ip]] = {
    "tcp": _Ip, "default": _Ip, "udp": _Udp, "ssl": _Ip, "ws": _Ip, "wss": _Ip, "bt": _Bluetooth, "bts": _Bluetooth,
    "opaque": _Opaque,
}  # fmt: skip


def _wrong(word: Word, problem: str) -> InvalidIceText:
    return InvalidIceText(f"'{word.text}' {problem}", word.start, word.end)


def _required(option: Word, argument: Word | None, what: str = "a value") -> Word:
    if argument is None:
        raise _wrong(option, f"needs {what}")
    return argument


def forbid_value(option: Word, argument: Word | None) -> None:
    """Raises InvalidIceText if the option has a value."""
    if argument is not None:
        problem = f"'{option.text}' has the value '{argument.text}', and must have none"
        raise InvalidIceText(problem, argument.start, argument.end)


def _number(option: Word, argument: Word | None, what: str, least: int, most: int) -> int:
    word = _required(option, argument)
    if not _is_in(word.text, least, most):
        raise _wrong(word, f"is not {what} from {least} to {most}")
    return int(word.text)


def _is_in(text: str, least: int, most: int) -> bool:
    is_short = len(text) < 300  # Python limits the digits of int()
    return is_short and bool(_INT.match(text)) and least <= int(text) <= most


def _timeout(option: Word, argument: Word | None) -> None:
    if _required(option, argument).text != "infinite":
        _number(option, argument, "a timeout in milliseconds", 1, (1 << 31) - 1)


def check_version(option: Word, argument: Word | None) -> None:
    """Raises InvalidIceText if the option's value is not a version such as 1.0."""
    word = _required(option, argument)
    major, dot, minor = word.text.partition(".")
    if not dot or not _is_in(major, 1, 255) or not _is_in(minor, 0, 255):
        raise _wrong(word, "is not a version, such as 1.0")


def _is_address(text: str) -> bool:
    """Whether the C library accepts the text as an IP address: `127.1` is one."""
    import socket

    address, percent, scope = text.partition("%")
    try:
        socket.getaddrinfo(address, None, flags=socket.AI_NUMERICHOST)
    except (OSError, UnicodeError, ValueError):
        return False
    return not percent or (bool(scope) and ":" in address)
