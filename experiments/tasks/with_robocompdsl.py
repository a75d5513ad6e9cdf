"""With robocompdsl, RoboComp's own tool: IDSL, CDSL and the specific part. It has no language for deployments."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence

from measure import ENVIRONMENT, PYTHON
from scripted import START, Scripted
from wishes import VOICE, VOLUME_IDSL

TOOL = os.environ.get("ROBOCOMPDSL", "")
WORKER = "speech/src/specificworker.py"
COMMON = "module RoboCompCommonBehavior { interface CommonBehavior { void killYourSelf(); }; };\n"
SCRIPT = (
    START.replace('    $PYTHON "$1/main.py" >', '    (cd "$1" && exec $PYTHON "$3" etc/config) >')
    .replace("start mouth 10102", "start mouth 10102 main.py")
    .replace("10101", "10101 src/speech.py")
)


class WithRobocompdsl(Scripted):
    name = "robocompdsl"
    script = SCRIPT

    def why_not(self) -> str:
        if not TOOL:
            return "ROBOCOMPDSL does not name it: `make experiment ROBOCOMPDSL=/path/to/robocompdsl`"
        for words, why in (
            ([TOOL, "--help"], f"{TOOL} does not work"),
            ([PYTHON, "-c", "import PySide6.QtWidgets, rich.console"], "its components need PySide6 and Rich"),
        ):
            try:
                done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True)
            except OSError as error:
                return f"{TOOL}: {error.strerror}"
            if done.returncode:
                return f"{why}: {(done.stderr.strip().splitlines() or [''])[-1]}"
        return ""

    def prepare(self) -> None:
        self.copy("idsl")
        self.copy("predsl")
        for path in ("main.py", "speechI.py", "worker.py", "config", "Speech.ice"):
            (self.folder / "speech" / path).unlink()
        self._generate(print_=False)
        config = self.folder / "speech/etc/config"
        lines = config.read_text(encoding="utf-8").splitlines()
        lines = [line for line in lines if not line.startswith("Speech.Endpoints")]
        config.write_text("\n".join([self.with_ports("Speech.Endpoints=tcp -p 10101"), *lines, ""]), encoding="utf-8")
        worker = self.folder / WORKER
        text = worker.read_text(encoding="utf-8")
        worker.write_text(text.replace(self._body("ret = int()"), "        return len(text)\n"), encoding="utf-8")

    def _generate(self, *interfaces: str, print_: bool = True) -> None:
        """The generator, and what its CMakeLists.txt calls: Slice of each interface beside the code."""
        act = self.command if print_ else lambda *words, cwd=".", shown="": self.run(*words, cwd=cwd)
        act(TOOL, "-I", "..", "speech.cdsl", ".", cwd="speech", shown="robocompdsl -I .. speech.cdsl .")
        for name in interfaces or ("Speech",):
            words = ("-I", "..", f"../{name}.idsl", f"src/{name}.ice")
            act(TOOL, *words, cwd="speech", shown=f"robocompdsl {' '.join(words)}")
        (self.folder / "speech/src/CommonBehavior.ice").write_text(COMMON, encoding="utf-8")  # an installation has it

    @staticmethod
    def _body(first: str) -> str:
        return f"        {first}\n        #\n        # write your CODE here\n        #\n        return ret\n"

    def do_proxy(self) -> None:
        self.edit(
            "speech/speech.cdsl",
            ('import "Speech.idsl";\n', 'import "Speech.idsl";\nimport "Mouth.idsl";\n'),
            ("\t\timplements Speech;\n", "\t\timplements Speech;\n\t\trequires Mouth;\n"),
        )
        self._generate("Mouth")
        # etc/config is kept, so that the new property is written by hand
        self.edit("speech/etc/config", ("Speech.Endp", "MouthProxy = mouth:tcp -h localhost -p 10102\nSpeech.Endp"))
        self.edit(
            WORKER, ("        return len(text)", "        self.mouth_proxy.open(len(text))\n        return len(text)")
        )

    def do_interface(self) -> None:
        self.write("Volume.idsl", VOLUME_IDSL)
        self.edit(
            "speech/speech.cdsl",
            ('import "Mouth.idsl";\n', 'import "Mouth.idsl";\nimport "Volume.idsl";\n'),
            ("implements Speech;", "implements Speech, Volume;"),
        )
        self._generate("Volume")
        self.edit("speech/etc/config", ("Speech.Endp", "Volume.Endpoints=tcp -p 10103\nSpeech.Endp"))
        # specificworker.py is kept: the new methods are copied from specificworker.py.new
        self._add("    def Volume_setVolume(self, percent):\n        self.volume = percent\n\n")
        self._add("    def Volume_getVolume(self):\n        return self.volume\n\n")
        self.edit(WORKER, ("        self.Period = 2000\n", "        self.Period = 2000\n        self.volume = 100\n"))

    def do_method(self) -> None:
        self.edit("Speech.idsl", ("int say(string text);\n", "int say(string text);\n\t\tbool isSpeaking();\n"))
        self._generate()
        self._add("    def Speech_isSpeaking(self):\n        return False\n\n")

    def do_class(self) -> None:
        self.write("speech/src/voice.py", VOICE)
        self.write("speech/requirements.txt", "jinja2>=3.1\n")
        self.edit(
            WORKER,
            ("import interfaces as ifaces\n", "import interfaces as ifaces\nfrom voice import Voice\n"),
            ("        self.volume = 100\n", "        self.volume = 100\n        self.voice = Voice()\n"),
            (
                "        self.mouth_proxy.open(len(text))\n",
                "        text = self.voice.spoken(text)\n        self.mouth_proxy.open(len(text))\n",
            ),
        )

    def _add(self, method: str) -> None:
        mark = "    #\n    # IMPLEMENTATION of say method from Speech interface\n"
        self.edit(WORKER, (mark, method + mark))

    def programs(self) -> dict[str, tuple[str, Sequence[str]]]:
        return {"Mouth": ("mouth", ["main.py"]), "Speech": ("speech", ["src/speech.py", "etc/config"])}
