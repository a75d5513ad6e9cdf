"""The command that starts a node: host, folder, program and arguments."""

from __future__ import annotations

import posixpath
import re
import shlex

import msgspec

LOCAL = "localhost"
LOOPBACK = frozenset((LOCAL, "127.0.0.1", "::1"))
_REMOTE = re.compile(r"\s*rcremote\s+(?P<host>\S+)\s+(?P<tab>\S+)\s+(?P<folder>\S+)(?P<rest>.*)", re.DOTALL)
_NEEDS_SHELL = re.compile(r"[;&|<>$`()*?]|^\s*\w+=")
_INTERPRETER = re.compile(r"python[\d.]*|perl|ruby|java|node")
_OPTION = re.compile(r"(?P<option>--Ice\.Config)=(?P<path>.+)", re.DOTALL)
_CONFIG = re.compile(r"(?:^|/)(?:etc/[^/]+|[^/]*config[^/]*|[^/]+\.(?:conf|cfg|toml|ini))$", re.IGNORECASE)


class NodeCommand(msgspec.Struct, frozen=True):
    """A parsed command. `words` are the program and its arguments, without the path of its configuration, which is
    `config`. `config_as` is the option of the configuration, '' where it is an argument."""

    host: str
    folder: str
    words: tuple[str, ...]
    config: str = ""
    config_as: str = ""
    in_shell: bool = False

    @property
    def program(self) -> str:
        """The path of the program: of a script, not of its interpreter."""
        first, *more = self.words
        script = more and _INTERPRETER.fullmatch(posixpath.basename(first)) and not more[0].startswith("-")
        return more[0] if script else first

    @property
    def full(self) -> tuple[str, ...]:
        """The words with the configuration, for a program that is not a component."""
        option = f"{self.config_as}={self.config}" if self.config_as else self.config
        return (*self.words, option) if self.config else self.words

    @property
    def stem(self) -> str:
        """The program's name, as a component would be named."""
        return posixpath.basename(self.program).removesuffix(".py").removesuffix(".sh")

    @property
    def key(self) -> tuple[object, ...]:
        """Equal for commands that start the same process."""
        return (self.host, posixpath.normpath(self.folder), self.words, self.config)


def parse(text: str, folder: str) -> NodeCommand | None:
    """Return a manager's `rcremote HOST TAB FOLDER PROGRAM ARGUMENTS…`, or a plain command, which runs on this host in
    `folder`; None where it names no program."""
    remote = _REMOTE.fullmatch(text)
    host, rest = (remote["host"], remote["rest"]) if remote else (LOCAL, text)
    folder = remote["folder"] if remote else folder
    if not rest.strip() or (remote is None and text.split()[0] == "rcremote"):
        return None
    if _NEEDS_SHELL.search(_unquoted(rest)):
        return NodeCommand(host, folder, ("sh", "-c", rest.strip()), in_shell=True)
    words = _split(rest)
    return _with_config(host, folder, words) if words else None


def _with_config(host: str, folder: str, words: tuple[str, ...]) -> NodeCommand:
    last = words[-1]
    option = _OPTION.fullmatch(last)
    plain = NodeCommand(host, folder, words)
    if option and len(words) > 1:
        return NodeCommand(host, folder, words[:-1], option["path"], option["option"])
    follows_program = len(words) > 1 and words[-2] == plain.program and not last.startswith("-")
    if follows_program and _CONFIG.search(last):
        return NodeCommand(host, folder, words[:-1], last)
    return plain


def _unquoted(text: str) -> str:
    """Return the text without its quoted parts."""
    return re.sub(r"'[^']*'|\"[^\"]*\"", "", text)


def _split(text: str) -> tuple[str, ...]:
    try:
        return tuple(shlex.split(text))
    except ValueError:  # an unclosed quote is an ordinary character
        return tuple(text.split())


def is_config(word: str) -> bool:
    """Whether the word at the position of the program is a configuration file."""
    return posixpath.splitext(word)[1] in (".conf", ".cfg", ".toml", ".ini")
