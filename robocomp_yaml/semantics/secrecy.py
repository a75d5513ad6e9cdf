# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""Which names are names of secrets, and what is shown instead of a secret."""

from __future__ import annotations

import re

HIDDEN = "***"
"""What is shown instead of a secret."""

# A negated class for letters beyond ASCII: `re` needs milliseconds to compile ranges up to the end of Unicode.
_WORD = r"[A-Z]+(?![a-z])|[A-Z]?[^\x00-`{-\x7f]+|[0-9]+"
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
"""Last words of names that are about a secret, but are not secret."""
_HOW = frozenset((
    "max", "min", "num", "number", "count", "use", "has", "no", "allow", "require", "requires", "show", "hide",
    "enable", "is", "with", "ask", "low", "high", "band", "all", "by", "over", "under", "two", "single", "first",
    "second", "multi",
))  # fmt: skip
"""First words of such names."""


def is_secret(name: str) -> bool:
    """Whether a variable, an option, a parameter or a property of this name is secret."""
    words = [word.lower() for word in re.findall(_WORD, name)]
    if not words or words[-1] in _ABOUT or words[0] in _HOW or words in (["pwd"], ["oldpwd"]):
        return False
    joined = "".join(words)
    if words[-1] == "private" or any(stem in joined for stem in _STEMS):
        return True
    return any(word in _WORDS or word.endswith(_ENDS) for word in words)


USER_INFO = r"([A-Za-z][A-Za-z0-9+.-]{0,30}://[^\s/?#:@'\"<>]*):([^\s/?#'\"<>]+)@"
"""A regular expression of a user and a password in a URL; a string, because most runs never use it."""


def url(text: str) -> str:
    """A text without the passwords in its URLs."""
    return re.sub(USER_INFO, lambda found: f"{found[1]}:{HIDDEN}@", text) if "@" in text else text


def shown(name: str, text: str) -> str:
    """A text as it may be shown: HIDDEN if its name is the name of a secret."""
    return HIDDEN if text and is_secret(name) else url(text)
