"""By hand: a component of the kind that the paper calls pre-DSL, with its communication in the user's files."""

from __future__ import annotations

from collections.abc import Sequence

from scripted import Scripted
from wishes import VOICE, VOLUME_ICE


class ByHand(Scripted):
    name = "by hand"

    def prepare(self) -> None:
        self.copy("predsl")

    def do_proxy(self) -> None:
        self.edit("speech/config", ("Ice.Warn", "MouthProxy=mouth:tcp -h localhost -p 10102\nIce.Warn"))
        self.edit(
            "speech/main.py",
            (
                'str(HERE / "Speech.ice")])\n',
                'str(HERE / "Speech.ice")])\n'
                'Ice.loadSlice("", ["--all", f"-I{HERE}", str(HERE.parent / "mouth" / "Mouth.ice")])\n\n'
                "import RoboCompMouth\n",
            ),
            (
                "        worker = Worker()\n",
                '        text = communicator.getProperties().getProperty("MouthProxy")\n'
                "        if not text:\n"
                '            print("config: MouthProxy is missing")\n'
                "            return 1\n"
                "        try:\n"
                "            mouth = RoboCompMouth.MouthPrx.checkedCast(communicator.stringToProxy(text))\n"
                "        except Ice.Exception as error:\n"
                '            print(f"cannot reach the mouth at {text}: {error}")\n'
                "            return 1\n"
                "        worker = Worker(mouth)\n",
            ),
        )
        self.edit(
            "speech/worker.py",
            ("def __init__(self):", "def __init__(self, mouth):"),
            ("        self.ended = ", "        self.mouth = mouth\n        self.ended = "),
            ("        return len(text)", "        self.mouth.open(len(text))\n        return len(text)"),
        )

    def do_interface(self) -> None:
        self.write("speech/Volume.ice", VOLUME_ICE)
        self.write(
            "speech/volumeI.py",
            '"""The servant of Volume: it hands calls to the worker."""\n\n'
            "import RoboCompVolume\n\n\n"
            "class VolumeI(RoboCompVolume.Volume):\n"
            "    def __init__(self, worker):\n"
            "        self.worker = worker\n\n"
            "    def setVolume(self, percent, current=None):\n"
            "        self.worker.Volume_setVolume(percent)\n\n"
            "    def getVolume(self, current=None):\n"
            "        return self.worker.Volume_getVolume()\n",
        )
        self.edit("speech/config", ("Ice.Warn", "Volume.Endpoints=tcp -h localhost -p 10103\nIce.Warn"))
        self.edit(
            "speech/main.py",
            (
                'str(HERE / "Speech.ice")])\n',
                'str(HERE / "Speech.ice")])\nIce.loadSlice("", ["--all", f"-I{HERE}", str(HERE / "Volume.ice")])\n',
            ),
            ("from speechI import SpeechI\n", "from speechI import SpeechI\nfrom volumeI import VolumeI\n"),
            (
                "        speech.activate()\n",
                "        speech.activate()\n"
                '        volume = communicator.createObjectAdapter("Volume")\n'
                '        volume.add(VolumeI(worker), Ice.stringToIdentity("volume"))\n'
                "        volume.activate()\n",
            ),
        )
        self.edit(
            "speech/worker.py",
            ("        self.mouth = mouth\n", "        self.mouth = mouth\n        self.volume = 100\n"),
            (
                "    def Speech_say(",
                "    def Volume_setVolume(self, percent):\n        self.volume = percent\n\n"
                "    def Volume_getVolume(self):\n        return self.volume\n\n    def Speech_say(",
            ),
        )

    def do_method(self) -> None:
        self.edit(
            "speech/Speech.ice", ("    int say(string text);\n", "    int say(string text);\n    bool isSpeaking();\n")
        )
        self.edit(
            "speech/speechI.py",
            (
                "        return self.worker.Speech_say(text)\n",
                "        return self.worker.Speech_say(text)\n\n"
                "    def isSpeaking(self, current=None):\n        return self.worker.Speech_isSpeaking()\n",
            ),
        )
        self.edit(
            "speech/worker.py",
            (
                "    def Speech_say(",
                "    def Speech_isSpeaking(self):\n        return False\n\n    def Speech_say(",
            ),
        )

    def do_class(self) -> None:
        self.write("speech/voice.py", VOICE)
        self.write("speech/requirements.txt", "jinja2>=3.1\n")
        self.edit(
            "speech/worker.py",
            ("import threading\n", "import threading\n\nfrom voice import Voice\n"),
            ("        self.volume = 100\n", "        self.volume = 100\n        self.voice = Voice()\n"),
            (
                "        self.mouth.open(len(text))\n",
                "        text = self.voice.spoken(text)\n        self.mouth.open(len(text))\n",
            ),
        )

    def programs(self) -> dict[str, tuple[str, Sequence[str]]]:
        return {name: (".", [str(self.folder / name.lower() / "main.py")]) for name in ("Mouth", "Speech")}
