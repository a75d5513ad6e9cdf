"""With rcyaml: documents, and the specific part."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from contextlib import ExitStack

from measure import PYTHON, Way
from wishes import VOICE, VOLUME_YAML

RCYAML = (PYTHON, "-m", "robocomp_yaml")
CDSL = "components/speech/speech.cdsl.yaml"
WORKER = "components/speech/src/specificworker.py"


class WithRcyaml(Way):
    name = "rcyaml"

    def prepare(self) -> None:
        self.copy("yaml")
        settings = self.folder / "rcyaml.yaml"
        text = (
            settings.read_text(encoding="utf-8").replace("20000", str(self.base)).replace("20999", str(self.base + 19))
        )
        settings.write_text(text, encoding="utf-8")
        self.run(*RCYAML, "compile")

    def rcyaml(self, *words: str) -> None:
        self.command(*RCYAML, *words, shown=" ".join(["rcyaml", *words]))

    def do_proxy(self) -> None:
        self.edit(
            CDSL,
            ("imports: [Speech]", "imports: [Speech, Mouth]"),
            ("implements: [Speech]\n", "implements: [Speech]\nrequires: [Mouth]\n"),
        )
        self.edit(
            WORKER, ("        return len(text)", "        self.mouth_proxy.open(len(text))\n        return len(text)")
        )
        self.rcyaml("compile", "--merge")
        self.rcyaml("build")

    def do_interface(self) -> None:
        self.write("interfaces/Volume.idsl.yaml", VOLUME_YAML)
        self.edit(
            CDSL,
            ("imports: [Speech, Mouth]", "imports: [Speech, Mouth, Volume]"),
            ("implements: [Speech]", "implements: [Speech, Volume]"),
        )
        self.rcyaml("compile", "--merge")
        self._fill("Volume_setVolume", "self.volume = percent")
        self._fill("Volume_getVolume", "return self.volume")
        self.edit(
            WORKER,
            (
                "    def initialize(self) -> None:\n        pass\n",
                "    def initialize(self) -> None:\n        self.volume = 100\n",
            ),
        )
        self.rcyaml("build")

    def do_method(self) -> None:
        self.edit(
            "interfaces/Speech.idsl.yaml",
            ("returns: int}\n", "returns: int}\n      isSpeaking: {returns: bool}\n"),
        )
        self.rcyaml("compile", "--merge")
        self._fill("Speech_isSpeaking", "return False")
        self.rcyaml("build")

    def do_class(self) -> None:
        self.write("components/speech/src/voice.py", VOICE)
        self.edit(
            CDSL, ("language: python\n", 'language: python\nuses: {libraries: [{pip: jinja2, version: ">=3.1"}]}\n')
        )
        self.edit(
            WORKER,
            ("from generated.genericworker", "from voice import Voice\nfrom generated.genericworker"),
            ("        self.volume = 100\n", "        self.volume = 100\n        self.voice = Voice()\n"),
            (
                "        self.mouth_proxy.open(len(text))\n",
                "        text = self.voice.spoken(text)\n        self.mouth_proxy.open(len(text))\n",
            ),
        )
        self.rcyaml("compile")
        self.rcyaml("build")

    def do_network(self) -> None:
        self.write(
            "head.ddsl.yaml",
            "deployment: Head\n"
            "components:\n"
            "  speech: {component: components/speech}\n"
            "  mouth: {component: components/mouth}\n",
        )
        self.rcyaml("deploy", "up")

    def _fill(self, method: str, body: str) -> None:
        """Writes the body of a stub that `--merge` has added."""
        text = (self.folder / WORKER).read_text(encoding="utf-8")
        (stub,) = re.findall(rf"    def {method}\(.*\n(?:        .*\n?)+", text)
        self.edit(WORKER, (stub, f"{stub.splitlines()[0]}\n        {body}\n"))

    def stop(self) -> None:
        if (self.folder / "head.ddsl.yaml").exists():
            self.run(*RCYAML, "deploy", "down")

    def running(self, task: str) -> Iterator[dict[str, int]]:
        if task == "network":
            try:
                yield self._deployed()
            finally:
                self.stop()
            return
        with ExitStack() as stack:
            ports = self._configured("speech") | self._configured("mouth")
            program = [*RCYAML, "run", "SpeechComp", "--with-needed"]
            stack.enter_context(self.program(program, ".", ports["Speech"]))
            yield ports

    def _configured(self, component: str) -> dict[str, int]:
        text = (self.folder / "components" / component / "etc" / "config").read_text(encoding="utf-8")
        return {name: int(port) for name, port in re.findall(r"^(\w+)\.Endpoints=tcp .*-p (\d+)", text, re.MULTILINE)}

    def _deployed(self) -> dict[str, int]:
        told = json.loads(self.run(*RCYAML, "deploy", "status", "--format", "json"))
        served = [one for process in told["processes"] for one in process["endpoints"]]
        return {one["interface"]: int(one["endpoint"].partition("-p ")[2].split()[0]) for one in served}
