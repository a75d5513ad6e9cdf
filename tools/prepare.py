"""What `make demo` and `make test` need before they can begin: packages of the system, an environment, Ice.

Installed where that may be done (as root, or by a sudo that asks for no password), else it is said who can do it and
how. What is called keeps quiet as long as all is well, and a line shows how far it is; where it fails, all that it said
is shown. Runs with any Python 3.7, and needs nothing else.

  prepare.py system GOAL PACKAGE...   Debian's packages for `make GOAL`
  prepare.py environment [EXTRA]      rcyaml and its dependencies, in .venv
  prepare.py ice                      Ice, compiled into .venv
  prepare.py advise                   says how one comes to Ice
"""

from __future__ import annotations

import hashlib
import importlib.util
import json
import os
import re
import shutil
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
DURATION = {"demo": "about half a minute", "test": "some minutes"}  # of 10 and of 700 MB, on a fast line
QUIETLY = {"DEBIAN_FRONTEND": "noninteractive", "PIP_DISABLE_PIP_VERSION_CHECK": "1", "LC_ALL": "C.UTF-8"}
APT = ["-o", "DPkg::Lock::Timeout=120", "-o", "Dpkg::Use-Pty=0", "-q"]
FOR_ADMINISTRATORS = "sudo apt install python3-zeroc-ice"
LASTS = "some ten minutes"
COMPILING = "Compiling Ice needs g++ and the headers of Python, OpenSSL and bzip2"
HEADER_PACKAGES = "g++ python3-dev libssl-dev libbz2-dev"
ICE_FILES = 250  # that a compiler is called for
# Whether some Python would run a component: asked of the rule that every component has.
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
    """What is to be said before all ends with exit code 1."""


def main(goal: str, *words: str) -> None:
    if goal == "system":
        system(words[0], words[1:])
    elif goal == "environment":
        environment(*words)
    else:
        {"ice": ice, "advise": advise}[goal]()


def system(goal: str, packages: Sequence[str]) -> None:
    """Where it may not, the demo says what it lacks when it comes to it."""
    missing = [package for package in packages if not is_there(package)]
    if not missing:
        return
    as_root = rights()
    if as_root is None:
        if goal == "test":
            show(f"some tests will be skipped; to run them all: sudo apt install {' '.join(missing)}")
        return
    show(f"make {goal} needs packages of Debian, and installs them: {' '.join(missing)}")
    call([*as_root, "apt-get", *APT, "update"], "asking for the newest packages")
    count = len(missing)
    what = f"installing {f'{count} packages' if count > 1 else missing[0]}, which takes {DURATION[goal]}"
    call([*as_root, "apt-get", *APT, "install", "-y", "--no-install-recommends", *missing], what, of_apt)


def is_there(package: str) -> bool:
    """Some things come from elsewhere just as well."""
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
    """The words that come before what only root may do; None where that may not be done."""
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
    what = f"rcyaml and what its {extra}s need" if extra else "rcyaml"
    spec = f"{ROOT}[{extra}]" if extra else str(ROOT)
    call([PYTHON, "-m", "pip", "install", "--editable", spec], f"installing {what} into {shown()}", of_pip)


def without_ensurepip() -> None:
    """Debian keeps pip in a package of its own: it is fetched from where it would be updated from."""
    call([sys.executable, "-m", "venv", "--clear", "--without-pip", "--system-site-packages", ENVIRONMENT],
         f"making {shown()}")  # fmt: skip
    wheel = ENVIRONMENT / "pip.whl"
    try:
        with urllib.request.urlopen(PIP, timeout=60) as answer:
            found = next(one for one in json.load(answer)["urls"] if one["packagetype"] == "bdist_wheel")
        with urllib.request.urlopen(urllib.parse.urljoin(PIP, found["url"]), timeout=60) as answer:
            content = answer.read()
        if hashlib.sha256(content).hexdigest() != found["digests"]["sha256"]:
            raise ValueError("its digest is not the one that was announced")
    except (OSError, ValueError, KeyError, StopIteration) as error:
        raise Failed(
            f"{sys.executable} has no pip, and it cannot be fetched ({error}). "
            "An administrator installs it: sudo apt install python3-venv"
        ) from None
    named = ENVIRONMENT / found["filename"]
    wheel.write_bytes(content)
    wheel.rename(named)
    call([PYTHON, named / "pip", "install", named], f"installing pip into {shown()}")
    named.unlink()


def advise() -> None:
    """What one can do who has no Ice, and could not have it installed."""
    if os.environ.get("RCYAML_PYTHON"):
        subprocess.run([sys.executable, "-c", ASK_FOR_ICE, ASK_FOR_ICE], stdout=subprocess.DEVNULL)
        return
    show("Running the network needs Ice for Python, which is not here. An administrator installs it in half a minute:")
    show(f"\n  {FOR_ADMINISTRATORS}\n\nWithout such rights, it is compiled into {shown()}: {LASTS}, with progress.")
    if not can_compile():
        show(f"{COMPILING}, not all of which are here ({HEADER_PACKAGES}).")
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
            f"{COMPILING}, not all of which are here. An administrator installs these:\n"
            f"  sudo apt install {HEADER_PACKAGES}\nor sooner Ice itself:\n  {FOR_ADMINISTRATORS}"
        )
    show(f"Ice is compiled for this Python, which takes {LASTS}.")
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


def call(command: Sequence[str | Path], doing: str, told: Callable[[str], str] = lambda line: "") -> None:
    """Runs a command, and says how far it is: by `told`, which turns a line of it into few words. All that it said is
    shown where it fails."""
    progress = Progress(doing)
    try:
        running = subprocess.Popen(
            command, cwd=ROOT, env={**os.environ, **QUIETLY}, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8", errors="replace",
        )  # fmt: skip
    except OSError as error:
        progress.end("failed")
        raise Failed(f"cannot run {command[0]}: {error.strerror}") from None
    said = []
    with running:
        try:
            for line in running.stdout or ():
                said.append(line)
                progress.note = told(line) or progress.note
        except KeyboardInterrupt:
            running.terminate()
            raise
        finally:
            progress.end("done" if running.wait() == 0 else "failed")
    if running.returncode:
        raise Failed("".join(said).rstrip() + f"\n\n{doing.partition(',')[0]} failed, see above: {words_of(command)}")


class Progress:
    """One line that is renewed on a terminal; else one at the beginning, at the end, and each quarter of a minute."""

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
