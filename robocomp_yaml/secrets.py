"""What is secret: names that say so, and texts with what nobody should read taken out.

Whatever is shown of a document, a command or a state asks here. Parameters may also say it themselves (`secret: true`):
then their types know it. The run times of components have the rule for names once more, and a test compares them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

HIDDEN = "***"
"""What is shown instead of a secret."""

_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z\x80-\U0010ffff]+|[0-9]+")
_STEMS = (
    "password", "passwd", "passphrase", "passcode", "secret", "credential", "contrase",
    "apikey", "accesskey", "privatekey", "authkey", "bearer", "authorization",
)  # fmt: skip
_WORDS = frozenset(("pass", "pwd", "token", "tokens"))
_ENDS = ("token", "tokens", "pwd", "dbpass", "userpass", "rootpass", "adminpass", "wifipass", "mypass", "keypass")
_ABOUT = frozenset((
    "file", "path", "dir", "directory", "folder", "length", "len", "size", "required", "enabled", "count", "policy",
    "prompt", "timeout", "rate", "attempts", "tries", "retries", "limit", "min", "max", "age", "ttl", "lifetime",
    "expiry", "period", "interval", "filter", "band", "through", "type",
))  # fmt: skip
"""Words that end the name of something about a secret, which is none itself."""
_HOW = frozenset((
    "max", "min", "num", "number", "count", "use", "has", "no", "allow", "require", "requires", "show", "hide",
    "enable", "is", "with", "ask", "low", "high", "band", "all", "by", "over", "under", "two", "single", "first", "second",
    "multi",
))  # fmt: skip
"""Words that begin such a name."""


def is_secret(name: str) -> bool:
    """Whether what has this name is to be kept secret: a variable, an option, a parameter, a property."""
    words = [word.lower() for word in _WORD.findall(name)]
    if not words or words[-1] in _ABOUT or words[0] in _HOW or words in (["pwd"], ["oldpwd"]):
        return False
    joined = "".join(words)
    if words[-1] == "private" or any(stem in joined for stem in _STEMS):
        return True
    return any(word in _WORDS or word.endswith(_ENDS) for word in words)


_USER_INFO = re.compile(r"([A-Za-z][A-Za-z0-9+.-]*://[^\s/?#:@'\"<>]*):([^\s/?#'\"<>]+)@")
_ASSIGNMENT = re.compile(
    r"(?P<name>[A-Za-z_\x80-\U0010ffff][\w.\-]*)"
    r"(?P<sign>(?P<close>[\"']?)[ \t]*=[ \t]*|[\"']?[ \t]*:[ \t]+|[\"']:)"
    r"(?P<value>\"(?:[^\"\\]|\\.)*\"?|'[^']*'?|(?:(?:Bearer|Basic|Digest)[ \t]+)?[^\s\"'&;,)}\]]+)"
)
_OPTION = re.compile(
    r"(?P<name>(?<![\w-])--?[A-Za-z][\w.\-]*)(?P<sign>[ \t]+)(?P<value>\"[^\"]*\"?|'[^']*'?|[^\s\"'&;-][^\s\"'&;]*)"
)
_IS_OPTION = re.compile(r"--?[A-Za-z][\w.\-]*\Z")
_WHOLE = re.compile(r"((?:--?)?[A-Za-z_\x80-\U0010ffff][\w.\-]*)([=:])(?!//)(.+)\Z", re.DOTALL)
_REFERENCE = re.compile(r"\$?\{ *(?:env|file) *:|\$\{?[A-Za-z_]")


def masked(text: str) -> str:
    """A text of any kind without the secrets that its own words tell: `user:password@` of URLs, `password=…`,
    `"token": "…"`, `--api-key …`. References to the environment and to files are no secrets."""
    text = url(text)
    if "=" in text or ":" in text:
        text = _ASSIGNMENT.sub(_without_value, text)
    return _OPTION.sub(_without_value, text) if "-" in text else text


def _without_value(found: re.Match[str]) -> str:
    value = found["value"]
    if not is_secret(found["name"]) or _REFERENCE.match(value.strip("\"'")):
        return found[0]
    quote = value[0] if value[0] in "\"'" else ""
    return f"{found['name']}{found['sign']}{quote}{HIDDEN}{quote}"


def url(text: str) -> str:
    """A text without the passwords in its URLs."""
    return _USER_INFO.sub(lambda found: f"{found[1]}:{HIDDEN}@", text) if "@" in text else text


def value(name: str, text: str) -> str:
    """The value of something by its name."""
    if text and is_secret(name) and not _REFERENCE.match(text):
        return HIDDEN
    return masked(text)


def words(command: Iterable[str]) -> Iterator[str]:
    """The words of a command: the value of an option may be the next word."""
    is_value = False
    for word in command:
        option = _IS_OPTION.match(word)
        if is_value and not option:
            yield word if _REFERENCE.match(word) else HIDDEN
            is_value = False
            continue
        is_value = option is not None and is_secret(word)
        found = _WHOLE.match(word)
        if found and is_secret(found[1]) and not _REFERENCE.match(found[3]):
            yield f"{found[1]}{found[2]}{HIDDEN}"
        else:
            yield masked(word)


def command(words_: Iterable[str]) -> str:
    """A command on one line, for people."""
    return " ".join(words(words_))
