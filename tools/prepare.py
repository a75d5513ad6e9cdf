"""The requirements of `make demo` and `make test`: packages of the system, a virtual environment, Ice.

They are installed if possible (as root, or by a sudo that needs no password). Otherwise a message says who can install
them, and how. The output of commands is hidden while they succeed, and one line shows the progress; if a command fails,
its whole output is printed. Runs with any Python from 3.7 on, without other packages.

    prepare.py system GOAL PACKAGE...   Debian's packages for `make GOAL`
    prepare.py environment [EXTRA]      rcyaml and its dependencies, in .venv
    prepare.py page                     the page of the manager, in .venv
    prepare.py ice                      Ice, compiled into .venv
    prepare.py advise                   prints how to install Ice
"""

from __future__ import annotations

import hashlib
import importlib.util
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import sysconfig
import threading
import time
import urllib.parse
import urllib.request
from collections.abc import Callable, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ENVIRONMENT = ROOT / os.environ.get("VENV", ".venv")
PYTHON = ENVIRONMENT / "bin" / "python"
OLDEST = (3, 11)
DURATION = {
    "demo": "about half a minute",
    "case-study": "a minute or two",
    "experiment": "about half a minute",
    "test": "some minutes",
}  # on a fast network
QUIETLY = {
    "DEBIAN_FRONTEND": "noninteractive", "PIP_DISABLE_PIP_VERSION_CHECK": "1", "LC_ALL": "C.UTF-8",
    "npm_config_fetch_retries": "1", "npm_config_fetch_timeout": "20000",
}  # fmt: skip
LOCALHOST = "localhost"
LONGEST_PAGE = 180.0  # seconds, then its registry is out of reach
APT = ["-o", "DPkg::Lock::Timeout=120", "-o", "Dpkg::Use-Pty=0", "-q"]
FOR_ADMINISTRATORS = "sudo apt install python3-zeroc-ice"
LASTS = "some ten minutes"
COMPILING = "Compiling Ice needs g++ and the headers of Python, OpenSSL and bzip2"
HEADER_PACKAGES = "g++ python3-dev libssl-dev libbz2-dev"
ICE_FILES = 250  # files that are compiled
# Whether there is a Python for components, by the function with which each component chooses one.
ASK_FOR_ICE = f"""\
import sys
sys.path.insert(0, {str(ROOT / "robocomp_yaml" / "languages" / "python" / "templates" / "runtime")!r})
import interpreter
try:
    interpreter.settle({str(ROOT)!r}, ["-c", sys.argv[1], sys.argv[1]])
except interpreter.NoPython as error:
    sys.exit(f"make: {{error}}")
"""
HEADERS = "#include <Python.h>\n#include <openssl/ssl.h>\n#include <bzlib.h>\n"
PIP = "https://pypi.org/pypi/pip/json"


class Failed(Exception):
    """An error: its message is printed, and the exit code is 1."""


def main(goal: str, *words: str) -> None:
    if goal == "system":
        system(words[0], words[1:])
    elif goal == "environment":
        environment(*words)
    else:
        {"ice": ice, "advise": advise, "page": page}[goal]()


def system(goal: str, packages: Sequence[str]) -> None:
    """Installs the missing packages. Without the rights, the demo itself reports what is missing."""
    name_this_machine()
    missing = [package for package in packages if not is_installed(package)]
    if not missing:
        return
    as_root = rights()
    if as_root is None:
        if goal == "test":
            show(f"some tests will be skipped; to run them all: sudo apt install {' '.join(missing)}")
        return
    show(f"make {goal} needs packages of Debian, and installs them: {' '.join(missing)}")
    call([*as_root, "apt-get", *APT, "update"], "updating the list of packages")
    count = len(missing)
    what = f"installing {f'{count} packages' if count > 1 else missing[0]}, which takes {DURATION[goal]}"
    call([*as_root, "apt-get", *APT, "install", "-y", "--no-install-recommends", *missing], what, of_apt)


def name_this_machine(hosts: Path = Path("/etc/hosts")) -> None:
    """Sees to it that 'localhost' is known. The smallest Debian has no /etc/hosts. Raises Failed if a person must."""
    if knows_localhost():
        return
    line = f"127.0.0.1 {LOCALHOST}"
    as_root = rights()
    if as_root is None or hosts.exists():
        raise Failed(
            f"this machine does not know the name {LOCALHOST}. An administrator adds this line to {hosts}: {line}"
        )
    call(
        [*as_root, "sh", "-c", f"echo '{line}' > {hosts}"],
        f"writing {hosts}, which is missing, so that {LOCALHOST} is known",
    )


def knows_localhost() -> bool:
    try:
        return bool(socket.getaddrinfo(LOCALHOST, None, socket.AF_INET))
    except OSError:
        return False


def is_installed(package: str) -> bool:
    """Whether a package is installed, or what it provides comes from elsewhere."""
    if package == "python3-zeroc-ice" and has_ice():
        return True
    if package == "python3-venv" and (importlib.util.find_spec("ensurepip") or has_pip()):
        return True
    if package in ("nodejs", "npm", "git") and shutil.which(package.replace("nodejs", "node")):
        return True
    try:
        state = subprocess.run(
            ["dpkg-query", "-W", "-f", "${Status}", package], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        )
    except OSError:
        return False
    return b"ok installed" in state.stdout


def rights() -> list[str] | None:
    """The beginning of a command line for root; None if root's rights are not available."""
    if not shutil.which("apt-get"):
        return None
    if os.geteuid() == 0:
        return ["env"]
    if shutil.which("sudo") and answers(["sudo", "-n", "true"]):
        return ["sudo", "-n", "env", "DEBIAN_FRONTEND=noninteractive"]
    return None


def has_ice() -> bool:
    return answers([PYTHON if answers([PYTHON, "-c", ""]) else sys.executable, "-c", ASK_FOR_ICE, ASK_FOR_ICE])


def has_pip() -> bool:
    return answers([PYTHON, "-m", "pip", "--version"])


def environment(extra: str = "") -> None:
    if sys.version_info < OLDEST:
        raise Failed(
            "rcyaml needs Python {}.{} or later, and {} is {}.{}".format(*OLDEST, sys.executable, *sys.version_info[:2])
            + ": make PYTHON=/path/to/a/newer/python3"
        )
    if not has_pip():
        if importlib.util.find_spec("ensurepip"):
            call([sys.executable, "-m", "venv", "--clear", "--system-site-packages", ENVIRONMENT], f"making {shown()}")
        else:
            without_ensurepip()
    users = {"lsp": "language server needs"}.get(extra, f"{extra.rstrip('s')}s need")
    what = f"rcyaml and what its {users}" if extra else "rcyaml"
    spec = f"{ROOT}[{extra}]" if extra else str(ROOT)
    call([PYTHON, "-m", "pip", "install", "--editable", spec], f"installing {what} into {shown()}", of_pip)


def page() -> None:
    """Builds the page of the manager, which needs PyPI (Node) and npm's registry (esbuild). Without, nothing fails."""
    wanted = ["--editable", f"{ROOT}[manager]", ROOT / "web"]
    try:
        call([PYTHON, "-m", "pip", "install", *wanted], "building the page of the manager", of_pip, LONGEST_PAGE)
    except Failed as error:
        last = "\n".join(str(error).splitlines()[-3:])
        show(f"{last}\nThe page of the manager is not built: its tests are skipped, and the demo does not show it.")


def without_ensurepip() -> None:
    """Creates an environment without ensurepip, which Debian has in another package, and installs pip from PyPI."""
    call([sys.executable, "-m", "venv", "--clear", "--without-pip", "--system-site-packages", ENVIRONMENT],
         f"making {shown()}")  # fmt: skip
    wheel = ENVIRONMENT / "pip.whl"
    try:
        with urllib.request.urlopen(PIP, timeout=60) as answer:
            found = next(one for one in json.load(answer)["urls"] if one["packagetype"] == "bdist_wheel")
        with urllib.request.urlopen(urllib.parse.urljoin(PIP, found["url"]), timeout=60) as answer:
            content = answer.read()
        if hashlib.sha256(content).hexdigest() != found["digests"]["sha256"]:
            raise ValueError("its digest differs from that of the index")
    except (OSError, ValueError, KeyError, StopIteration) as error:
        raise Failed(
            f"{sys.executable} has no pip, and pip cannot be downloaded ({error}). "
            "An administrator installs it: sudo apt install python3-venv"
        ) from None
    named = ENVIRONMENT / found["filename"]
    wheel.write_bytes(content)
    wheel.rename(named)
    call([PYTHON, named / "pip", "install", named], f"installing pip into {shown()}")
    named.unlink()


def advise() -> None:
    """Prints how to install Ice, if it is missing and could not be installed."""
    if os.environ.get("RCYAML_PYTHON"):
        subprocess.run([sys.executable, "-c", ASK_FOR_ICE, ASK_FOR_ICE], stdout=subprocess.DEVNULL)
        return
    show("Running the network needs Ice for Python, which is missing. An administrator installs it in half a minute:")
    show(f"\n  {FOR_ADMINISTRATORS}\n\nWithout such rights, compile it into {shown()}: {LASTS}.")
    if not can_compile():
        show(f"{COMPILING}, some of which are missing ({HEADER_PACKAGES}).")
    show("\n  make ice demo\n")


def can_compile() -> bool:
    include = sysconfig.get_paths()["include"]
    compiler = shutil.which("g++") or shutil.which("c++")
    return bool(compiler) and answers([compiler or "", "-fsyntax-only", f"-I{include}", "-x", "c++", "-"], HEADERS)


def ice() -> None:
    if answers([PYTHON, "-c", "import Ice"]):
        show(f"{shown()} has Ice already")
        return
    if not can_compile():
        raise Failed(
            f"{COMPILING}, some of which are missing. An administrator installs these:\n"
            f"  sudo apt install {HEADER_PACKAGES}\nor faster Ice itself:\n  {FOR_ADMINISTRATORS}"
        )
    show(f"Compiling Ice for this Python takes {LASTS}.")
    compiled = 0

    def of_compiler(line: str) -> str:
        nonlocal compiled
        compiled += bool(re.search(r"(g\+\+|gcc|cc|c\+\+|clang\S*) .* -c ", line))
        return f"{compiled} of about {ICE_FILES} files" if compiled else of_pip(line)

    command = [PYTHON, "-m", "pip", "install", "-v", "--editable", f"{ROOT}[ice]"]
    call(command, f"compiling Ice into {shown()}", of_compiler)


def of_apt(line: str) -> str:
    words = line.split()
    names = {"Get:": "fetching", "Unpacking": "unpacking", "Setting up": "setting up"}
    for start, doing in names.items():
        if line.startswith(start):
            rest = words[4:5] if start == "Get:" else words[len(start.split()) :]
            return f"{doing} {rest[0]}" if rest else ""
    return ""


def of_pip(line: str) -> str:
    found = re.match(r"\s*(Collecting [\w.-]+|Building wheel for [\w.-]+|Installing collected packages)", line)
    return found[1][0].lower() + found[1][1:] if found else ""


def call(
    command: Sequence[str | Path], doing: str, describe: Callable[[str], str] = lambda line: "",
    longest: float | None = None,
) -> None:  # fmt: skip
    """Runs a command with a progress line. `describe` turns a line of its output into a short text. If the command
    fails, or takes more seconds than `longest`, its whole output is printed. Raises Failed."""
    progress = Progress(doing)
    try:
        running = subprocess.Popen(
            command, cwd=ROOT, env={**os.environ, **QUIETLY}, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8", errors="replace",
            start_new_session=longest is not None,
        )  # fmt: skip
    except OSError as error:
        progress.end("failed")
        raise Failed(f"cannot run {command[0]}: {error.strerror}") from None
    output = []
    limit = threading.Timer(longest, os.killpg, (running.pid, signal.SIGTERM)) if longest is not None else None
    with running:
        try:
            if limit is not None:
                limit.start()
            for line in running.stdout or ():
                output.append(line)
                progress.note = describe(line) or progress.note
        except KeyboardInterrupt:
            running.terminate()
            raise
        finally:
            progress.end("done" if running.wait() == 0 else "failed")
            if limit is not None:
                limit.cancel()
    if running.returncode:
        raise Failed("".join(output).rstrip() + f"\n\n{doing.partition(',')[0]} failed, see above: {words_of(command)}")


class Progress:
    """A progress line that is updated on a terminal; on other outputs, a line at the beginning, at the end, and every
    15 seconds."""

    def __init__(self, doing: str) -> None:
        self.doing, self.note, self.began = doing, "", time.monotonic()
        self._live = sys.stdout.isatty()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        if not self._live:
            show(f"{doing} ...")
        self._thread.start()

    def _run(self) -> None:
        while not self._over.wait(0.2 if self._live else 15):
            seconds = f"{time.monotonic() - self.began:.0f} s"
            if self._live:
                line = f"{self.doing} ... {seconds}  {self.note}"
                width = shutil.get_terminal_size().columns - 1
                print(f"\r{line[:width]}\x1b[K", end="", flush=True)
            else:
                show(f"  ... {seconds}  {self.note}".rstrip())

    def end(self, how: str) -> None:
        self._over.set()
        self._thread.join()
        start = f"\r\x1b[K{self.doing}: " if self._live else "  "
        show(f"{start}{how} after {time.monotonic() - self.began:.0f} s")


def answers(command: Sequence[str | Path], given: str = "") -> bool:
    try:
        return (
            subprocess.run(
                command, input=given.encode(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=ROOT
            ).returncode
            == 0
        )
    except OSError:
        return False


def shown() -> str:
    return os.path.relpath(ENVIRONMENT, ROOT)


def words_of(command: Sequence[str | Path]) -> str:
    return " ".join(map(str, command)).replace(f"{ROOT}/", "")


def show(text: str) -> None:
    print(text, flush=True)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except Failed as failure:
        print(failure, file=sys.stderr)
        sys.exit(1)
    except KeyboardInterrupt:
        sys.exit(130)
