"""The case study of RoboComp's DSL paper: speech that moves a robotic mouth, in four changes.

A robot speaks. Then it gets a mouth: a proxy in the component's document, a parameter, a deployment of three
components, and at last a method with the code that uses them. After each change all is compiled, built and deployed,
and looked at from outside, over Ice. Works on a copy of `examples/speech/` in `.case-study/`; run it with `make
case-study`.
"""

from __future__ import annotations

import difflib
import shutil
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from session import Session, comment, ends, say

HERE = Path(__file__).resolve().parent
FOLDER = HERE.parent / ".case-study"
TEXT = "I am Shelly, and I can move my mouth"

Edits = Mapping[str, tuple[tuple[str, str], ...]]
"""By the path of a file: texts, each with what replaces it."""

PROXY: Edits = {
    "components/speech/speech.cdsl.yaml": (
        ("imports: [Speech]\n", "imports: [Speech, Mouth]\n"),
        ("implements: [Speech]\n", "implements: [Speech]\nrequires: [{Mouth: {interface: Mouth, absent: ignore}}]\n"),
    ),
}
PARAMETER: Edits = {
    "components/speech/speech.pdsl.yaml": (
        (
            "parameters:\n",
            "parameters:\n  mouthSynchronization: {type: bool, default: true, editable: true, "
            "doc: Move the mouth while speaking.}\n",
        ),
    ),
}
DEPLOYMENT: Edits = {
    "head.ddsl.yaml": (
        (
            "  speech: {component: components/speech}\n",
            "  speech: {component: components/speech}\n"
            "  mouth: {component: components/mouth}\n"
            "  motors: {component: components/jointmotor}\n",
        ),
    ),
}
METHOD: Edits = {
    "interfaces/Speech.idsl.yaml": (
        (
            "      isSpeaking:",
            "      synchronizeMouth: {in: {on: bool}, doc: Whether the mouth moves with the voice from now on.}\n"
            "      isSpeaking:",
        ),
    ),
    "components/speech/src/specificworker.py": (
        (
            "                self.sound.popleft()\n",
            "                loudness = self.sound.popleft()\n"
            "            elif not self.sound:\n"
            "                return\n"
            "        if self.parameters.mouthSynchronization:\n"
            "            self.mouth_proxy.setLoudness(loudness)\n",
        ),
        (
            "    def Speech_isSpeaking(",
            "    def Speech_synchronizeMouth(self, on: bool) -> None:\n"
            "        self.parameters.mouthSynchronization = on\n\n"
            "    def Speech_isSpeaking(",
        ),
    ),
}


class CaseStudy:
    """The case study in a folder."""

    def __init__(self, folder: Path) -> None:
        self.session = Session(folder)

    def copy(self) -> None:
        """A fresh copy of the example."""
        shutil.rmtree(self.session.folder, ignore_errors=True)
        made = shutil.ignore_patterns("__pycache__", ".gitignore")
        shutil.copytree(HERE / "speech", self.session.folder, ignore=made)

    def edit(self, edits: Edits) -> None:
        """Changes files as a user would, and shows the lines."""
        for path, changes in edits.items():
            file = self.session.folder / path
            before = after = file.read_text(encoding="utf-8")
            for old, new in changes:
                if after.count(old) != 1:
                    raise ValueError(f"{path} does not contain this once: {old!r}")
                after = after.replace(old, new)
            file.write_text(after, encoding="utf-8")
            lines = difflib.unified_diff(before.splitlines(), after.splitlines(), path, path, n=0, lineterm="")
            say("\n".join(line for line in lines if not line.startswith(("---", "@@"))))

    def deploy(self) -> None:
        """Compile, build, and what changed is started again."""
        self.session.run("rcyaml", "compile", "--merge")
        self.session.run("rcyaml", "deploy", "up", "--build")

    def openings(self) -> list[float]:
        """Says a text. Returns how wide the mouth is, ten times a second while it is said."""
        self.session.run("rcyaml", "call", "speech.Speech.say", f"text={TEXT}")
        answers = self.session.answers("call", "mouth.Mouth.getOpening", "--repeat", "15", "--every", "0.1 s")
        widths = [float(one["returns"]) for one in answers]
        say(f"the mouth is open by {', '.join(f'{width:.0f}' for width in widths)} mm")
        return widths


def walk(study: CaseStudy, look: Callable[[str], None] = lambda step: None) -> None:
    """The whole case study. `look` is called after each step."""
    run = study.session.run
    comment("A robot that speaks: each text becomes a sound file.")
    study.deploy()
    run("rcyaml", "call", "speech.Speech.say", "text=Hello")
    look("speech")
    comment("1. SpeechComp gets a proxy to MouthComp, in its document. It works without a mouth, too.")
    study.edit(PROXY)
    study.deploy()
    run("rcyaml", "param", "list", "speech")
    look("proxy")
    comment("2. It gets a parameter: whether the mouth moves while it speaks.")
    study.edit(PARAMETER)
    study.deploy()
    run("rcyaml", "param", "get", "speech", "mouthSynchronization")
    look("parameter")
    comment("3. The mouth and its motors join the network: two components in C++.")
    study.edit(DEPLOYMENT)
    study.deploy()
    run("rcyaml", "call", "mouth.Mouth.setLoudness", "loudness=1")
    run("rcyaml", "call", "mouth.Mouth.getOpening")
    run("rcyaml", "call", "motors.JointMotor.getPositions")
    look("deployment")
    comment("4. A method switches it while the robot speaks. This is the only change of code in src/.")
    study.edit(METHOD)
    study.deploy()
    study.openings()
    run("rcyaml", "call", "speech.Speech.synchronizeMouth", "on=false")
    time.sleep(1)  # the mouth closes
    study.openings()
    look("method")


def main() -> int:
    study = CaseStudy(FOLDER)
    if (FOLDER / "head.ddsl.yaml").is_file():
        study.session.answer("deploy", "down")  # the network of a walk that was killed
    study.copy()
    try:
        walk(study)
    finally:
        comment("All processes are stopped.")
        study.session.run("rcyaml", "deploy", "down")
    sounds = FOLDER / "components/speech/sounds"
    comment(f"{sounds.relative_to(HERE.parent)}/ has the voice, and ways.svg of JointMotorComp the way of its motors.")
    return 0


if __name__ == "__main__":
    ends(main, "case study")
