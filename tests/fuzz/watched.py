"""Runs rcyaml and says, as JSON, what it did beyond reading: `python watched.py "ARGS" "ARGS" …`, in a process of its own.
The report goes to the file $WATCHED."""

from __future__ import annotations

import json
import os
import sys

WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC
CHANGES = ("os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.link", "os.symlink", "os.chmod", "os.chown", "os.truncate",
           "shutil.rmtree", "shutil.move", "shutil.copyfile")  # fmt: skip
STARTS = ("subprocess.Popen", "os.system", "os.exec", "os.posix_spawn", "os.spawn", "os.fork", "os.forkpty", "pty.spawn",
          "socket.connect", "socket.bind", "socket.getaddrinfo", "ctypes.dlopen", "webbrowser.open", "ftplib.connect",
          "urllib.Request", "smtplib.connect")  # fmt: skip
written: list[str] = []
started: list[str] = []
watching = True


def hook(event: str, args: tuple[object, ...]) -> None:
    if not watching:
        return
    if event in STARTS:
        started.append(f"{event} {args[0]!r}")
    paths: list[object] = []
    if event == "open" and isinstance(args[2], int) and args[2] & WRITES:
        paths = [args[0]]
    elif event in CHANGES:
        paths = list(args[:2]) if event in ("os.rename", "os.link") else [args[1] if event == "os.symlink" else args[0]]
    for path in paths:
        if isinstance(path, str | bytes | os.PathLike):
            name = os.fsdecode(path)
            if not name.startswith("/proc/self/fd/") and name != os.devnull:
                folder = os.path.dirname(os.path.abspath(name))
                written.append(os.path.join(os.path.realpath(folder), os.path.basename(name)))


sys.addaudithook(hook)
from robocomp_yaml.cli import group  # noqa: E402 (watched, too)

codes: list[object] = []
for line in sys.argv[1:]:
    try:
        group(line.split(), prog_name="rcyaml")
    except SystemExit as end:
        codes.append(end.code)
watching = False
modules = sorted({os.path.abspath(str(m.__file__)) for m in list(sys.modules.values()) if getattr(m, "__file__", None)})
with open(os.environ["WATCHED"], "w", encoding="utf-8") as report:
    json.dump({"codes": codes, "written": written, "started": started, "modules": modules}, report)
