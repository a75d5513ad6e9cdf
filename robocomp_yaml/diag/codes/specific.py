"""RC62xx: the user's own files of a component, which a compile leaves alone, and a merge brings up to date."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code

_SPEECH = "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      say: {in: {text: string}}\n      stop:\n"
_COMPONENT = "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n"
_HEAD = "from generated.genericworker import GenericWorker\n\n\n"
_INITIALIZE = "    def initialize(self):\n        self.log.info('hello')\n\n    def compute(self):\n        pass\n"
_SAY = "\n    def Speech_say(self, text):\n        print(text)\n"
_STOP = "\n    def Speech_stop(self):\n        print('...')\n"
_CLASS = f"{_HEAD}class SpecificWorker(GenericWorker):\n{_INITIALIZE}"
_SHOUT = "\n    def Speech_shout(self):\n        pass\n"
_FILE = "src/specificworker.py"
_BASE = f".rcyaml/base/{_FILE}"
_SKELETON = f'''"""SpeechComp"""

# This file is yours: rcyaml wrote it once, and will not touch it again.

from __future__ import annotations

{_HEAD}class SpecificWorker(GenericWorker):
    """What SpeechComp does."""

    def initialize(self) -> None:
        """Called once: all proxies are there, and calls from other components wait until this is done."""
        self.log.info("initializing")

    def compute(self) -> None:
        """Called every period (100 ms, unless etc/config says otherwise)."""

    # Speech: other components call these.

    def Speech_say(self, text: str) -> None:
        """Speech.say"""
        self.log.info("Speech_say() is still to be written")

    def Speech_stop(self) -> None:
        """Speech.stop"""
        self.log.info("Speech_stop() is still to be written")
'''
_DOCUMENTS = {"Speech.idsl.yaml": _SPEECH, "speech.cdsl.yaml": _COMPONENT}
_CONFIG = "CommonBehavior.Endpoints=tcp -p 12000\n"
_RIGHT = {**_DOCUMENTS, _FILE: _CLASS + _SAY + _STOP}

LACKING = Code(
    "RC6201",
    "warning",
    "{name} lacks {methods}",
    "An interface that the component implements, or a topic that it subscribes to, has a method that your class does "
    "not have: it was added since `src/` was written, or removed by hand. Calls of it fail until it is there. The "
    "text to paste is shown; `rcyaml compile --merge` puts it in.",
    {**_DOCUMENTS, _FILE: _CLASS + _SAY},
    _RIGHT,
)
OUTDATED = Code(
    "RC6202",
    "warning",
    "{name} does not fit its interface any more",
    "The parameters or the result of this method changed in the interface, and your code still has it as it was: "
    "calls of it will fail. What the method must begin with is shown; the body is for you to adapt. `rcyaml compile "
    "--merge` changes the signature where you did not.",
    {**_DOCUMENTS, _FILE: _CLASS + _STOP + _SAY.replace("text)", "text, volume)", 1)},
    _RIGHT,
)
GONE = Code(
    "RC6203",
    "warning",
    "no interface of the component has {name} any more: nobody calls it",
    "The method was part of an interface when `src/` was written (or last merged), and is not now: it was removed or "
    "renamed there, or the component implements the interface no more. rcyaml deletes nothing of yours.",
    {**_RIGHT, _FILE: _RIGHT[_FILE] + _SHOUT, _BASE: _RIGHT[_FILE] + _SHOUT},
    {**_RIGHT, _BASE: _RIGHT[_FILE] + _SHOUT},
)
CONFLICT = Code(
    "RC6204",
    "error",
    "'{path}' cannot be merged: {reason}",
    "`rcyaml compile --merge` joins three texts: the skeleton that your file came from (kept in `.rcyaml/base/`), your "
    "file, and the skeleton of today. Where you and the skeleton changed the same lines, only you can say what is "
    "right: both are shown, and nothing of this component is written. Change your lines so that they say what you "
    "want, and have the new parts in them; or compile without `--merge`, and paste what is lacking.",
    {
        **_DOCUMENTS,
        _FILE: _SKELETON.replace("(self, text: str)", "(self, text: str, volume: int, voice: str)"),
        _BASE: _SKELETON.replace("(self, text: str)", "(self, text: str, volume: int)"),
    },
    {**_DOCUMENTS, _FILE: _SKELETON, _BASE: _SKELETON.replace("(self, text: str)", "(self, text: str, volume: int)")},
    "compile . --merge",
)
NO_CLASS = Code(
    "RC6205",
    "warning",
    "there is no class {name} in '{path}'",
    "The generated program makes one object of the class SpecificWorker, which is yours. If your file has it, look "
    "for an error of syntax above it.",
    {**_DOCUMENTS, _FILE: _HEAD},
    _RIGHT,
)
CONFIG_LACKS = Code(
    "RC6206",
    "warning",
    "'{path}' lacks {keys}",
    "The component needs an endpoint or an address that it did not need when its configuration was written, and will "
    "not start without. The lines to paste are shown; `rcyaml compile --merge` puts them in.",
    {**_RIGHT, "etc/config": _CONFIG, ".rcyaml/base/etc/config": _CONFIG},
    {**_RIGHT, "etc/config": f"{_CONFIG}Speech.Endpoints=tcp -p 12001\n", ".rcyaml/base/etc/config": _CONFIG},
)
