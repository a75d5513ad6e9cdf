"""The command with which RCManager starts a node: host, folder, program and arguments; and what other texts of the node
repeat of it."""

from __future__ import annotations

import posixpath
import re
import shlex
from collections.abc import Mapping, Sequence

import msgspec

from robocomp_yaml.source.ice_endpoint import spelled_host

ENDPOINT = "{identity}:tcp -h {host} -p {port}"
"""How most users spell the endpoint of a node."""
OF_COMMAND = ("downCommand", "configFile")
"""Texts that repeat the command of a node: `killall -9 {program}`."""
INHERITED = ("tab", "upCommand", "downCommand", "configFile", "workingDir")
"""What a further name of a process has as the first one, unless it says otherwise, or is ALONE."""
ALONE = "alone"
LOCAL = "localhost"
LOOPBACK = frozenset((LOCAL, "127.0.0.1", "::1"))
_REMOTE = re.compile(r"\s*rcremote\s+(?P<host>\S+)\s+(?P<tab>\S+)\s+(?P<folder>\S+)(?P<rest>.*)", re.DOTALL)
_NEEDS_SHELL = re.compile(r"[;&|<>$`()*?]|^\s*\w+=")
_INTERPRETER = re.compile(r"python[\d.]*|perl|ruby|java|node")
_NAMED = re.compile(r"\{(\w+)\}")
_SCRIPTS = (".py", ".sh", ".pl", ".rb", ".jar")
_OPTION = re.compile(r"(?P<option>--Ice\.Config)=(?P<path>.+)", re.DOTALL)
_CONFIG = re.compile(r"(?:^|/)(?:etc/[^/]+|[^/]*config[^/]*|[^/]+\.(?:conf|cfg|toml|ini))$", re.IGNORECASE)


class NodeCommand(msgspec.Struct, frozen=True):
    """A parsed command. `words` are the program and its arguments, without the path of its configuration, which is
    `config`. `config_as` is the option of the configuration, '' where it is an argument. `tab` is the title of the
    window in which `rcremote` starts it, '' where that does not start it."""

    host: str
    folder: str
    words: tuple[str, ...]
    config: str = ""
    config_as: str = ""
    in_shell: bool = False
    tab: str = ""

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
    folder, tab = (remote["folder"], remote["tab"]) if remote else (folder, "")
    if not rest.strip() or (remote is None and text.split()[0] == "rcremote"):
        return None
    if _NEEDS_SHELL.search(_unquoted(rest)):
        return NodeCommand(host, folder, ("sh", "-c", rest.strip()), in_shell=True, tab=tab)
    words = _split(rest)
    return of_words(host, folder, words, tab) if words else None


def of_words(host: str, folder: str, words: tuple[str, ...], tab: str = "") -> NodeCommand:
    last = words[-1]
    option = _OPTION.fullmatch(last)
    plain = NodeCommand(host, folder, words, tab=tab)
    if option and len(words) > 1:
        return NodeCommand(host, folder, words[:-1], option["path"], option["option"], tab=tab)
    follows_program = len(words) > 1 and words[-2] == plain.program and not last.startswith("-")
    if follows_program and _CONFIG.search(last):
        return NodeCommand(host, folder, words[:-1], last, tab=tab)
    return plain


def spelled(host: str, tab: str, folder: str, words: Sequence[str]) -> str:
    """Return the command as RCManager's users write it, with a program below the folder as `./bin/laser`."""
    program, *arguments = words
    home = posixpath.normpath(folder)
    if program.startswith(f"{home}/"):
        program = f"./{posixpath.relpath(program, home)}"
    return f"rcremote {host} {tab} {shlex.quote(folder)} {shlex.join((program, *arguments))}"


def facts(command: NodeCommand) -> dict[str, str]:
    """Return what other texts of a node repeat of its command: `ssh ann@{host} {kill}`. A script is not the program of
    its process."""
    name = posixpath.basename(command.program)
    is_script = command.program != command.words[0] or name.endswith(_SCRIPTS)
    kill = f"pkill -9 -f {name}" if is_script else f"killall -9 {name}"
    words = {"config": command.config, "program": name, "host": command.host, "folder": command.folder}
    return {"kill": kill, **words}


def filled(pattern: str, known: Mapping[str, str]) -> str:
    """Return the text of a pattern."""
    return _NAMED.sub(lambda match: known.get(match[1], match[0]), pattern)


def pattern_of(text: str, known: Mapping[str, str]) -> str:
    """Return the pattern of a text, in which words that are facts are named."""
    if " " in (kill := known.get("kill", "")):
        text = text.replace(kill, "{kill}")
    names = {value: f"{{{name}}}" for name, value in known.items() if value}
    if not text and known.get("config") == "":
        return "{config}"
    return "".join(names.get(word, word) for word in re.split(r"([\s:@]+)", text))


def facts_of_endpoint(identity: str, host: str, port: int) -> dict[str, str]:
    """Return what the endpoint of a node repeats of what its process serves."""
    return {"identity": identity, "host": spelled_host(host), "port": str(port)}


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
