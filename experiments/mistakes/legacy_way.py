"""A legacy component in a folder, and what each tool reports about it: the steps of rcyaml, robocompdsl, the Slice
compiler, the compiler of its language, and a run."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path[:0] = [str(HERE.parent / "tasks"), str(ROOT / "tests")]

from legacy_mistakes import CONFIG, CPP, HEADER, WORKER, WORKER_CPP  # noqa: E402
from measure import ENVIRONMENT, PYTHON, Failed, Way  # noqa: E402
from with_robocompdsl import TOOL  # noqa: E402

from editor.yaml_language_server import LanguageServer  # noqa: E402 - after the path

COMPONENT = "components/speech"
DEPLOYMENT = "sub.ddsl.yaml"
ROBOCOMP = os.environ.get("ROBOCOMP", "")  # a checkout of RoboComp's core: its classes, for C++
QT = (
    os.environ.get("QT5", "/usr/include/x86_64-linux-gnu/qt5"),
    ("", "QtCore", "QtGui", "QtNetwork", "QtWidgets", "QtXml"),
)
NOTHING, NO_TOOL, UNSUITED = "nothing", "-", "no language for it"
TRACEBACK, ERROR = "a traceback", "an error"
SEVERITIES = ("error", "warning")
CALL = """\
import sys, Ice
Ice.loadSlice("", ["--all", "-I" + sys.argv[1], sys.argv[1] + "/Speech.ice"])
import RoboCompSpeech
with Ice.initialize() as communicator:
    proxy = communicator.stringToProxy(f"speech:tcp -h localhost -p {sys.argv[2]} -t 5000")
    assert RoboCompSpeech.SpeechPrx.uncheckedCast(proxy).say("hello") == 5
"""
Report = tuple[str, str, str]  # severity, code, file


class Editor(LanguageServer):
    """`rcyaml lsp`, as an editor asks it that has all documents and the user's code open."""

    TIMEOUT = 60.0

    def all_marks(self, folder: Path, paths: Iterable[Path]) -> list[Report]:
        self.start(folder, {}, {"schemaServer": "no"})
        opened = list(paths)
        for path in opened:
            self.open(path, path.read_text(encoding="utf-8"))
        for path in opened:
            if path.name.endswith(".yaml"):
                self.diagnostics(path)
        self._wait_until_idle()
        latest = {uri: list(marks.queue)[-1:] for uri, marks in self._diagnostics.items()}
        self.stop()
        return sorted(
            (SEVERITIES[one["severity"] - 1], str(one["code"]), Path(uri).name)
            for uri, marks in latest.items()
            for one in (marks[0] if marks else [])
            if one["severity"] <= len(SEVERITIES)
        )

    def _wait_until_idle(self) -> None:
        """Until nothing was computed for two seconds: the rest of the workspace follows a moment later."""
        known, since = -1.0, time.monotonic()
        while time.monotonic() - since < 2:
            used = sum(
                int((one / "schedstat").read_text().split()[0])
                for one in Path(f"/proc/{self._process.pid}/task").iterdir()
            )
            if used > known + 2e6:
                known, since = used, time.monotonic()
            time.sleep(0.1)


class Legacy(Way):
    """The legacy component in Python."""

    name = "legacy"
    own_files = (WORKER,)

    def prepare(self) -> None:
        self.copy("../mistakes/legacy")
        self.mouth = self.folder.parent / "mouth"  # it is no part of what is migrated
        self.mouth.mkdir(exist_ok=True)
        for path in ("Mouth.ice", "config", "main.py"):
            text = (HERE.parent / "tasks/predsl/mouth" / path).read_text(encoding="utf-8")
            (self.mouth / path).write_text(self.with_ports(text), encoding="utf-8")
        for path in (CONFIG, *self.own_files):
            file = self.folder / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(self.with_ports(OWN[path]), encoding="utf-8")

    # RoboComp's tools.

    def generate(self) -> str:
        """What robocompdsl reports."""
        said = self._tool("speech.cdsl", ".")
        for name in ("Speech", "Mouth"):
            said = said if said != NOTHING else self._tool(f"../../interfaces/{name}.idsl", f"src/{name}.ice")
        shutil.copy(ROOT / "templates" / "slice" / "CommonBehavior.ice", self.folder / COMPONENT / "src")
        return said

    def _tool(self, source: str, target: str) -> str:
        done = self._try(TOOL, "-I", "../../interfaces", source, target)
        output = done.stdout + done.stderr
        if "Traceback" in output:
            return TRACEBACK
        if done.returncode:
            return ERROR
        return "a message" if "Unknown" in output else NOTHING

    def _try(self, *words: str, cwd: str = COMPONENT) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            words, cwd=self.folder / cwd, env=ENVIRONMENT, capture_output=True, text=True, check=False
        )

    def slice(self, target: str = "") -> str:
        """What the Slice compiler reports; `target` gets what it writes."""
        if not shutil.which("slice2cpp"):
            return NO_TOOL
        source = self.folder / COMPONENT / "src"
        files = [str(one) for one in sorted(source.glob("*.ice"))]
        with tempfile.TemporaryDirectory() as folder:
            done = self._try("slice2cpp", f"-I{source}", "--output-dir", target or folder, *files)
        return ERROR if done.returncode else NOTHING

    def compiler(self) -> str:
        """What Python's own compiler reports."""
        done = self._try(PYTHON, "-c", f"compile(open({str(self.folder / WORKER)!r}).read(), 'worker', 'exec')")
        return ERROR if done.returncode else NOTHING

    def start(self) -> str:
        """What a run shows: the component is started, and called once."""
        ports = self.ports()
        with self.program([PYTHON, "main.py"], str(self.mouth), ports["Mouth"]):
            try:
                with self.program([PYTHON, "src/speech.py", "etc/config"], COMPONENT, ports["Speech"]):
                    return self._call()
            except Failed:
                return "the start fails"

    def _call(self) -> str:
        words = (PYTHON, "-c", CALL, str(HERE.parent / "tasks" / "slice"), str(self.ports()["Speech"]))
        return "the call fails" if self._try(*words).returncode else NOTHING

    def clear(self) -> None:
        """Removes what RoboComp's tools wrote, which is no part of a migrated component."""
        for file in (self.folder / COMPONENT).rglob("*"):
            if file.is_file() and str(file.relative_to(self.folder)) not in OWN and file.suffix != ".cdsl":
                file.unlink()

    # rcyaml.

    def rcyaml(self) -> dict[str, list[Report]]:
        """What each step of rcyaml reports, without notes. The last one, a run, only if no step before has an error."""
        found = {"migrate": self._reports("migrate", ".")}
        found["editor"] = Editor([PYTHON, "-m", "robocomp_yaml", "lsp"]).all_marks(self.folder, self._opened())
        found["check"] = self._reports("check")
        found["compile"] = self._reports("compile")
        found["build"] = self._reports("build")
        with self.program([PYTHON, "main.py"], str(self.mouth), self.ports()["Mouth"]):
            found["deploy"] = self._reports("deploy", "plan") or self._reports("deploy", "up", "--timeout", "20s")
            try:
                found["running"] = (
                    [] if found["deploy"] or self._call() == NOTHING else [("error", "the call fails", "")]
                )
            finally:
                self._try(PYTHON, "-m", "robocomp_yaml", "deploy", "down", cwd=".")
        return found

    def _opened(self) -> Iterable[Path]:
        yield from sorted(one for one in self.folder.rglob("*.yaml") if ".rcyaml" not in one.parts)
        yield from (self.folder / path for path in self.own_files)

    def _reports(self, *command: str) -> list[Report]:
        done = self._try(PYTHON, "-m", "robocomp_yaml", *command, "--format", "json", cwd=".")
        try:
            answer: dict[str, Any] = json.loads(done.stdout)
        except ValueError:
            return [("error", "a message", "")] if done.returncode else []
        reports = [(one["severity"], one["code"], Path(one["file"]).name) for one in answer["diagnostics"]]
        return sorted(one for one in reports if one[0] in SEVERITIES)


class LegacyCpp(Legacy):
    """The same component in C++. Without RoboComp's libraries, which it would be linked with, it is not run."""

    own_files = (HEADER, WORKER_CPP)

    def prepare(self) -> None:
        super().prepare()
        self.edit(f"{COMPONENT}/speech.cdsl", ("language Python;", "language Cpp;"))

    def compiler(self) -> str:
        """What g++ reports about the user's code and the servant, which robocompdsl generated."""
        if not ROBOCOMP or not shutil.which("g++") or not Path(QT[0]).is_dir():
            return NO_TOOL
        source = self.folder / COMPONENT / "src"
        self.slice(str(source))
        include = [f"-I{source}", f"-I{ROBOCOMP}/classes", *(f"-I{Path(QT[0], one)}" for one in QT[1])]
        for file in ("specificworker.cpp", "speechI.cpp"):
            words = ("g++", "-std=c++20", "-fPIC", "-fsyntax-only", *include, str(source / file))
            if self._try(*words).returncode:
                return ERROR
        return NOTHING

    def start(self) -> str:
        return NO_TOOL


OF_LANGUAGE = {CPP: LegacyCpp}


def legacy_of(language: str, folder: Path) -> Legacy:
    """A legacy component without a mistake, in a new folder."""
    made = OF_LANGUAGE.get(language, Legacy)(folder / "legacy")
    with suppress(FileExistsError):
        made.folder.mkdir(parents=True)
    made.prepare()
    return made


OWN = {
    CONFIG: """\
Speech.Endpoints=tcp -p 10101
MouthProxy = mouth:tcp -h localhost -p 10102
Volume=50
Ice.Warn.Connections=0
""",
    WORKER: """\
from genericworker import *


class SpecificWorker(GenericWorker):
    def __init__(self, proxy_map, startup_check=False):
        super(SpecificWorker, self).__init__(proxy_map)

    def setParams(self, params):
        self.volume = int(params["Volume"])
        return True

    def Speech_say(self, text):
        self.mouth_proxy.open(len(text))
        return len(text)
""",
    HEADER: """\
#ifndef SPECIFICWORKER_H
#define SPECIFICWORKER_H

#include <genericworker.h>

class SpecificWorker : public GenericWorker
{
Q_OBJECT
public:
\tSpecificWorker(MapPrx& mprx, bool startup_check) : GenericWorker(mprx) {}
\tbool setParams(RoboCompCommonBehavior::ParameterList params);
\tint Speech_say(const std::string &text);

public slots:
\tvoid initialize() {}
\tvoid compute() {}
\tvoid emergency() {}
\tvoid restore() {}
\tint startup_check() { return 0; }
private:
\tint volume = 0;
};

#endif
""",
    WORKER_CPP: """\
#include "specificworker.h"

bool SpecificWorker::setParams(RoboCompCommonBehavior::ParameterList params)
{
\tvolume = std::stoi(params["Volume"].value);
\treturn true;
}

int SpecificWorker::Speech_say(const std::string &text)
{
\tmouth_proxy->open(text.size());
\treturn text.size();
}
""",
}
"""The user's files, which robocompdsl keeps."""
