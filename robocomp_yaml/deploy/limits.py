"""What the user is told of `limits:` before anything starts: rights that are missing, and limits that need systemd."""

from __future__ import annotations

import subprocess
from collections.abc import Iterable, Iterator, Sequence

import msgspec

from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.diag.codes import deploying as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.model.deployment import ResourceLimits
from robocomp_yaml.network import limit_words
from robocomp_yaml.network.network import Network

_RIGHTS = {"nice": "nice", "realtime": "rtprio", "core": "core", "files": "nofile"}
_WITHIN = 5.0


def tests(own: ResourceLimits) -> list[tuple[str, list[str]]]:
    """The commands that fail where a limit is denied, by the limit's key."""
    return [(key, [*words, "true"]) for key, words in limit_words.by_key(msgspec.to_builtins(own))]


def denied(specs: Sequence[ProcessSpec]) -> list[Diagnostic]:
    """Diagnostics for limits that this machine denies. Equal limits are tried once."""
    known: dict[tuple[str, ...], str] = {}
    found = []
    for spec in specs:
        for key, command in tests(spec.process.limits):
            words = tuple(command)
            if words not in known:
                known[words] = _why_not(command)
            if known[words]:
                found.append(fault(spec, key, known[words], "this machine"))
    return found


def fault(spec: ProcessSpec, key: str, reason: str, where: str) -> Diagnostic:
    """The diagnostic for a limit that is denied."""
    value = getattr(spec.process.limits, key)
    hint = f"remove `{key}:`, or correct it"
    if key in _RIGHTS and value is not None:
        right = "unlimited" if value == -1 and key == "core" else value
        line = f"USER - {_RIGHTS[key]} {right}"
        hint = f"permit it there with a line `{line}` in /etc/security/limits.d/rcyaml.conf, and log in again"
    return codes.LIMIT_DENIED.at(spec.process.span, name=spec.name, key=key, reason=reason, where=where, hint=hint)


def ignored(network: Network, names: Iterable[str]) -> Iterator[Diagnostic]:
    """Notes for limits that only systemd can enforce."""
    for name in names:
        process = network.processes[name]
        if process.limits.cpu is not None:
            yield codes.LIMIT_IGNORED.at(process.span, name=name, value=f"{process.limits.cpu} %")


def _why_not(command: list[str]) -> str:
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=_WITHIN)
    except FileNotFoundError:
        return f"{command[0]} is not installed (Debian: util-linux)"
    except (OSError, subprocess.TimeoutExpired) as error:
        return str(error)
    return in_words(done.stderr or ("it fails" if done.returncode else ""))


def in_words(errors: str) -> str:
    """The reason in the errors of a test, '' if there are none: a process whose niceness is denied goes on."""
    lines = [line.strip() for line in errors.splitlines() if line.strip()]
    return lines[-1].rpartition(": ")[2].lower() if lines else ""
