"""The deployment's own folder: only its owner can read it, and its files are written atomically."""

from __future__ import annotations

import contextlib
import errno
import os
import pwd
import re
import shutil
from collections.abc import Iterator, Mapping

from robocomp_yaml.deploy.time_limit import until
from robocomp_yaml.source.discover import kind_of
from robocomp_yaml.source.regular import text
from robocomp_yaml.transactions import whole_file

_NAME = re.compile(r"""^["']?deployment["']?[ \t]*:[ \t]*["']?([_A-Za-z][-A-Za-z0-9_]*)""", re.MULTILINE)
_PARTS = ("config", "logs", "state")
STAGED = "state/next"
"""The folder of staged files, which replace the used ones later."""


def make(folder: str) -> None:
    """Creates the folder and its subfolders. Raises OSError."""
    above = os.path.dirname(folder)
    os.makedirs(above, exist_ok=True)
    whole_file.ignore_all(above, "# What is derived for one machine, and may be secret.\n")
    for path in (folder, *(f"{folder}/{part}" for part in _PARTS)):
        with contextlib.suppress(FileExistsError):
            os.mkdir(path)
        os.chmod(path, 0o700)


def require_own(folder: str) -> None:
    """Raises OSError if another user started the deployment in this folder: what runs there cannot be seen."""
    with contextlib.suppress(FileNotFoundError, NotADirectoryError):
        owner = os.stat(folder).st_uid
        if not os.access(folder, os.R_OK | os.W_OK | os.X_OK) and owner != os.getuid():
            try:
                name = pwd.getpwuid(owner).pw_name
            except KeyError:
                name = str(owner)
            raise PermissionError(errno.EACCES, f"it is of the user '{name}', who alone sees and changes what runs")


def write(folder: str, path: str, text: str) -> None:
    """Writes a file of mode 0600, atomically. Raises OSError."""
    target = f"{folder}/{path}"
    os.makedirs(os.path.dirname(target), mode=0o700, exist_ok=True)
    whole_file.put(target, _bytes(text), 0o600)


def stage(folder: str, files: Mapping[str, str]) -> None:
    """Writes files beside those that are used, and verifies them. Raises OSError; then none is there."""
    drop_staged(folder)
    try:
        for above in {os.path.dirname(path) for path in files}:
            os.makedirs(f"{folder}/{STAGED}/{above}", mode=0o700, exist_ok=True)
        for path, text in files.items():
            whole_file.stage(f"{folder}/{STAGED}/{path}", _bytes(text), 0o600)
        for path, text in files.items():
            with open(f"{folder}/{STAGED}/{path}", "rb") as file:
                if file.read() != _bytes(text):
                    raise OSError(errno.EIO, "what was written cannot be read back", f"{folder}/{path}")
    except OSError:
        drop_staged(folder)
        raise


def drop_staged(folder: str) -> None:
    shutil.rmtree(f"{folder}/{STAGED}", ignore_errors=True)


def put(folder: str, path: str, text: str) -> None:
    """Moves a staged file to its place; without one of that content, writes it. Raises OSError."""
    staged = f"{folder}/{STAGED}/{path}"
    with contextlib.suppress(FileNotFoundError):
        with open(staged, "rb") as file:
            is_it = file.read() == _bytes(text)
        if is_it:
            os.makedirs(os.path.dirname(f"{folder}/{path}"), mode=0o700, exist_ok=True)
            os.replace(staged, f"{folder}/{path}")
            return
    write(folder, path, text)


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogateescape")


def remove(folder: str, path: str) -> None:
    with contextlib.suppress(OSError):
        os.unlink(f"{folder}/{path}")


def sweep(folder: str) -> None:
    """Removes all configurations, and what an ended supervisor left. Logs and databases stay."""
    for where, _, names in os.walk(f"{folder}/config"):
        for name in names:
            with contextlib.suppress(OSError):
                os.unlink(os.path.join(where, name))
    drop_staged(folder)
    for name in ("control", "supervisor"):
        remove(folder, f"state/{name}")
    with contextlib.suppress(OSError):
        if not os.path.getsize(f"{folder}/state/supervisor.log"):
            remove(folder, "state/supervisor.log")


@contextlib.contextmanager
def locked(folder: str, patience: float = 2.0) -> Iterator[bool]:
    """Locks the deployment for a change. Yields False if another rcyaml holds the lock for more than `patience`
    seconds. The lock ends with this process. Raises OSError."""
    make(folder)
    lock = os.open(f"{folder}/state", os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        yield until(lambda: whole_file.lock(lock), patience, 0.05)
    finally:
        os.close(lock)


def deployment_in(path: str) -> str:
    """The name of the deployment in a document. In a document that is not valid YAML, the first text that looks like
    the name; '' if there is none."""
    from robocomp_yaml.source.heading import root_of, text_at_top

    name = text_at_top(root_of(path), "deployment")
    if name:
        return name if _NAME.fullmatch(f"deployment: {name}") else ""
    found = _NAME.search(text(path, "utf-8-sig") or "")
    return found[1] if found else ""


def document_in(folder: str, deployment: str) -> str:
    """The document in this folder of a running deployment; the folder if the document is missing."""
    with contextlib.suppress(OSError):
        for name in sorted(os.listdir(folder)):
            path = os.path.join(folder, name)
            if kind_of(name) == "ddsl" and deployment_in(path) == deployment:
                return path
    return folder
