"""Mistakes in the five tasks that are prone to errors, as edits of one workspace, each with what must be reported.

`test_mistakes.py` tries each of them, and `docs/mistakes.md` is made of the same data.
"""

from __future__ import annotations

from dataclasses import dataclass

CREATING = "Creating components"
PROXIES = "Adding and removing proxies"
INTERFACES = "Changing interfaces"
PARAMETERS = "Configuration parameters"
DEPLOYING = "Dependencies at deployment"

WORKSPACE = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Mouth.idsl.yaml": """\
module: RoboCompMouth
types:
  Shape: {enum: [round, wide]}
  Pose: {struct: {opening: float, width: float, shape: Shape}}
interfaces:
  Mouth:
    methods:
      move: {in: {target: Pose, fast: bool}, returns: Pose}
      close:
topics:
  MouthEvents:
    methods:
      moved: {in: {pose: Pose}}
""",
    "interfaces/Speech.idsl.yaml": """\
module: RoboCompSpeech
interfaces:
  Speech:
    methods:
      say: {in: {text: string, volume: int}, returns: bool}
      stop:
""",
    "interfaces/Camera.idsl.yaml": """\
module: RoboCompCamera
interfaces:
  Camera:
    methods:
      getImage: {in: {width: int, height: int}, returns: string}
""",
    "speech/speech.cdsl.yaml": """\
component: SpeechComp
language: python
imports: [Speech, Mouth, Camera]
implements: [Speech]
requires: [Mouth]
subscribes: [MouthEvents]
""",
    "speech/speech.pdsl.yaml": """\
component: speech.cdsl.yaml
types:
  Voice: {struct: {name: string, pitch: {type: float, range: [0.5, 2], default: 1}}}
parameters:
  speed: {type: int, range: [1, 400], unit: words/min, default: 150, editable: true}
  device: {type: string, values: [alsa, pulse], default: alsa}
  low: {type: int, default: 1}
  high: {type: int, default: 9}
  voices: {list: Voice, size: [1, 3], default: [{name: anna}]}
  apiKey: {type: string, secret: true, optional: true}
constraints:
  - {that: low < high, else: low must be below high}
""",
    "speech/etc/config.yaml": """\
parameters:
  speed: 120
  voices:
    - name: bert
      pitch: 1.5
""",
    "speech/src/specificworker.py": """\
from __future__ import annotations

from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompMouth


class SpecificWorker(GenericWorker):
    def initialize(self) -> None:
        self.words: list[str] = []

    def compute(self) -> None:
        pose = RoboCompMouth.Pose(opening=10.0, width=50.0, shape=RoboCompMouth.Shape.round)
        reached = self.mouth_proxy.move(pose, True)
        self.log.info("%d words per minute, %.1f mm open", self.parameters.speed, reached.opening)
        self.mouth_proxy.close()
        if not self.words:
            self.parameters.speed = 200

    def Speech_say(self, text: str, volume: int) -> bool:
        self.words.append(text)
        return True

    def Speech_stop(self) -> None:
        self.words.clear()

    def MouthEvents_moved(self, pose: RoboCompMouth.Pose) -> None:
        self.log.info("%s", pose.opening)
""",
    "mouth/mouth.cdsl.yaml": """\
component: MouthComp
language: cpp
imports: [Mouth, Camera]
implements: [Mouth]
requires: [Camera]
publishes: [MouthEvents]
""",
    "mouth/mouth.pdsl.yaml": """\
component: mouth.cdsl.yaml
parameters:
  widest: {type: float, range: [10, 90], unit: mm, default: 50, editable: true}
""",
    "mouth/src/specificworker.h": """\
#pragma once

#include "genericworker.h"

class SpecificWorker : public GenericWorker
{
public:
    void initialize();
    void compute();
    RoboCompMouth::Pose Mouth_move(const RoboCompMouth::Pose& target, bool fast);
    void Mouth_close();
};
""",
    "mouth/src/specificworker.cpp": """\
#include "specificworker.h"

void SpecificWorker::initialize()
{
    parameters.setWidest(60);
}

void SpecificWorker::compute()
{
    camera_proxy->getImage(640, 480);
}

RoboCompMouth::Pose SpecificWorker::Mouth_move(const RoboCompMouth::Pose& target, bool fast)
{
    auto pose = target; pose.shape = RoboCompMouth::Shape::wide;
    pose.opening = std::min(pose.opening, parameters.widest());
    events(pose);
    mouthevents_pubproxy->moved(pose);
    return pose;
}

void SpecificWorker::Mouth_close()
{
}
""".replace("    events(pose);\n", ""),
    "camera/camera.cdsl.yaml": """\
component: CameraComp
language: python
imports: [Camera]
implements: [Camera]
""",
    "camera/src/specificworker.py": """\
from __future__ import annotations

from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def initialize(self) -> None:
        self.log.info("sees")

    def compute(self) -> None:
        pass

    def Camera_getImage(self, width: int, height: int) -> str:
        return " " * width * height
""",
    "ear/ear.cdsl.yaml": """\
component: EarComp
language: java
imports: [Speech, Mouth]
requires: [Speech]
publishes: [MouthEvents]
""",
    "ear/ear.pdsl.yaml": """\
component: ear.cdsl.yaml
parameters:
  loudness: {type: float, range: [0, 1], default: 0.5, editable: true}
  mode: {type: string, values: [near, far], default: near}
""",
    "ear/src/SpecificWorker.java": """\
import generated.GenericWorker;
import slice.RoboCompMouth.Pose;
import slice.RoboCompMouth.Shape;

public class SpecificWorker extends GenericWorker {
    @Override
    public void initialize() throws Exception {
        parameters.setLoudness(0.7f);
    }

    @Override
    public void compute() throws Exception {
        if (parameters.loudness() > 0.6f) {
            speech_proxy.say("hello", 5);
        }
        mouthevents_pubproxy.moved(new Pose(1, 2, Shape.round));
    }
}
""",
    "nose/nose.cdsl.yaml": """\
component: NoseComp
language: java
imports: [Camera]
implements: [Camera]
""",
    "nose/src/SpecificWorker.java": """\
import generated.GenericWorker;

public class SpecificWorker extends GenericWorker {
    @Override
    public void initialize() throws Exception {
        log.info("smells");
    }

    @Override
    public void compute() throws Exception {
    }

    @Override
    public String Camera_getImage(int width, int height) {
        return " ".repeat(width * height);
    }
}
""",
    "head.ddsl.yaml": """\
deployment: Head
components:
  speech: {component: speech, port: 11001}
  mouth: {component: mouth, port: 11002}
  camera: {component: camera, port: 11004}
services: {storm: {icestorm: {port: 11003}}}
""",
}


@dataclass(frozen=True)
class Mistake:
    """`edits` are a path with an old and a new text, a path with a whole text, or a path alone, which is removed.
    `at` is where it is reported: FILE:LINE:COLUMN, or FILE. `command` reports it."""

    task: str
    what: str
    edits: tuple[tuple[str, ...], ...]
    code: str
    at: str
    command: str = "check"


SPEECH, MOUTH, HEAD = "speech/speech.cdsl.yaml", "mouth/mouth.cdsl.yaml", "head.ddsl.yaml"
WORKER, HEADER, SOURCE = "speech/src/specificworker.py", "mouth/src/specificworker.h", "mouth/src/specificworker.cpp"
EAR, EAR_CODE = "ear/ear.cdsl.yaml", "ear/src/SpecificWorker.java"
NOSE_CODE = "nose/src/SpecificWorker.java"
I_MOUTH, I_SPEECH = "interfaces/Mouth.idsl.yaml", "interfaces/Speech.idsl.yaml"
PROGRAM = "mouth/bin/MouthComp"
I_CAMERA = "interfaces/Camera.idsl.yaml"
PDSL, VALUES = "speech/speech.pdsl.yaml", "speech/etc/config.yaml"


def one(task: str, what: str, path: str, old: str, new: str, code: str, at: str, command: str = "check") -> Mistake:
    return Mistake(task, what, ((path, old, new),), code, at, command)


MISTAKES = [
    one(CREATING, "a misspelled key", SPEECH, "implements:", "implement:", "RC0202", f"{SPEECH}:4:1"),
    one(CREATING, "a key in other letters", SPEECH, "requires:", "Requires:", "RC0202", f"{SPEECH}:5:1"),
    one(CREATING, "an unknown language", SPEECH, "python", "pyton", "RC0204", f"{SPEECH}:2:11"),
    one(CREATING, "no language", SPEECH, "language: python\n", "", "RC0203", f"{SPEECH}:1:1"),
    one(CREATING, "an import of a file that does not exist", SPEECH, "Camera]", "Kamera]", "RC2101", f"{SPEECH}:3:26"),
    one(CREATING, "an import in other letters", SPEECH, "[Speech, Mouth", "[Speech, mouth", "RC2102", f"{SPEECH}:3:19"),
    one(CREATING, "an interface in other letters", SPEECH, "implements: [Speech]", "implements: [speech]", "RC2003", f"{SPEECH}:4:14"),
    one(CREATING, "an interface whose document is not imported", SPEECH, "imports: [Speech, Mouth, Camera]", "imports: [Speech, Camera]", "RC2003", f"{SPEECH}:5:12"),
    one(CREATING, "a topic that is implemented", SPEECH, "implements: [Speech]", "implements: [Speech, MouthEvents]", "RC2008", f"{SPEECH}:4:22"),
    one(CREATING, "the same interface twice", SPEECH, "requires: [Mouth]", "requires: [Mouth, Mouth]", "RC2005", f"{SPEECH}:5:19"),
    Mistake(CREATING, "two components in one folder", (("speech/other.cdsl.yaml", "component: OtherComp\nlanguage: python\n"),), "RC2010", "speech/speech.cdsl.yaml:1:12"),
    Mistake(CREATING, "two components of one name", (("other/speech.cdsl.yaml", "component: SpeechComp\nlanguage: python\n"),), "RC2011", "speech/speech.cdsl.yaml:1:12"),
    one(CREATING, "a tab in the indentation", I_SPEECH, "  Speech:", "\tSpeech:", "RC0101", f"{I_SPEECH}:3:1"),
    one(CREATING, "a method of the worker whose name has a typing error, in Python", WORKER, "def Speech_stop", "def Speech_stopp", "RC6312", f"{WORKER}:23:9"),
    one(CREATING, "a method of the worker whose name has a typing error, in C++", SOURCE, "SpecificWorker::Mouth_close", "SpecificWorker::Mouth_clsoe", "RC6312", f"{SOURCE}:21:22"),
    one(CREATING, "an attribute of the worker that does not exist", WORKER, "self.log.info(\"%s\"", "self.logger.info(\"%s\"", "RC6316", f"{WORKER}:27:14"),
    one(CREATING, "a method of the worker whose name has a typing error, in Java", NOSE_CODE, "Camera_getImage", "Camera_getImgae", "RC6312", f"{NOSE_CODE}:14:19"),
    one(CREATING, "a worker without its base class, in Python", WORKER, "class SpecificWorker(GenericWorker)", "class SpecificWorker", "RC6208", f"{WORKER}:7:7"),
    one(CREATING, "a worker without its base class, in C++", HEADER, "class SpecificWorker : public GenericWorker", "class SpecificWorker", "RC6208", f"{HEADER}:5:7"),
    one(CREATING, "a misspelled base class, in Java", EAR_CODE, "extends GenericWorker", "extends GenericWorkr", "RC6208", f"{EAR_CODE}:5:14"),
    one(CREATING, "a misspelled module of the generated code", WORKER, "generated.genericworker", "generated.genericworkr", "RC6324", f"{WORKER}:3:16"),
    one(CREATING, "a method without `self`", WORKER, "def Speech_stop(self)", "def Speech_stop()", "RC6322", f"{WORKER}:23:9"),
    Mistake(CREATING, "a document whose name ends with .yml", (("nose/nose.cdsl.yaml",), ("nose/nose.cdsl.yml", "component: NoseComp\nlanguage: java\n")), "RC3332", "nose/nose.cdsl.yml:1:1"),
    one(CREATING, "a syntax error in the user's code", WORKER, "def compute(self) -> None:", "def compute(self) -> None", "RC6317", f"{WORKER}:11:30"),
    one(CREATING, "a variable that is not defined", WORKER, "return True", "return sucess", "RC6331", f"{WORKER}:21:16"),
    one(CREATING, "a forgotten import", WORKER, "from generated.interfaces import RoboCompMouth\n", "", "RC6331", f"{WORKER}:11:16"),
    one(CREATING, "a misspelled `self`", WORKER, "self.words.clear()", "slef.words.clear()", "RC6331", f"{WORKER}:24:9"),
    one(CREATING, "a method that is written twice", WORKER, "        self.words.clear()\n", "        self.words.clear()\n\n    def Speech_stop(self) -> None:\n        pass\n", "RC6332", f"{WORKER}:26:9"),
    one(CREATING, "an `__init__` without that of the base class", WORKER, "    def initialize(self)", "    def __init__(self):\n        self.a = 1\n\n    def initialize(self)", "RC6333", f"{WORKER}:8:9"),
    one(CREATING, "a method without the result that others expect", WORKER, "        return True\n", "", "RC6329", f"{WORKER}:19:9"),
    one(CREATING, "`initialise` instead of `initialize`", WORKER, "def initialize", "def initialise", "RC6201", f"{WORKER}:7:7"),
    one(CREATING, "a name with a blank", SPEECH, "component: SpeechComp", "component: Speech Comp", "RC0205", f"{SPEECH}:1:12"),
    one(CREATING, "a C++ standard that does not exist", MOUTH, "language: cpp", "language: {name: cpp, standard: 21}", "RC0204", f"{MOUTH}:2:33"),
    one(CREATING, "a key without a colon", SPEECH, "language: python", "language python", "RC0101", f"{SPEECH}:2:1"),
    one(CREATING, "a wrong indentation", WORKER, "        return True\n", "       return True\n", "RC6317", f"{WORKER}:21:19"),
    one(CREATING, "a forgotten import of the standard library", WORKER, "self.words.clear()", "time.sleep(1)", "RC6331", f"{WORKER}:24:9"),
    one(CREATING, "an unknown method of the log", WORKER, "self.log.info(\"%s\"", "self.log.inform(\"%s\"", "RC6325", f"{WORKER}:27:18"),
    one(CREATING, "a method that is asynchronous", WORKER, "def Speech_stop", "async def Speech_stop", "RC6336", f"{WORKER}:23:15"),
    one(CREATING, "a method that is a generator", WORKER, "self.words.clear()", "yield self.words", "RC6336", f"{WORKER}:23:9"),
    one(CREATING, "a method that is a property", WORKER, "    def Speech_stop", "    @property\n    def Speech_stop", "RC6336", f"{WORKER}:24:9"),
    one(CREATING, "a result of another type", WORKER, "return True", "return \"done\"", "RC6335", f"{WORKER}:21:16"),
    one(CREATING, "a path without the result that others expect", WORKER, "        return True\n", "        if volume > 3:\n            self.words.clear()\n", "RC6329", f"{WORKER}:19:9"),
    one(CREATING, "a method without its result, in C++", SOURCE, "    return pose;\n", "", "RC6329", f"{SOURCE}:13:37"),
    one(CREATING, "a wrong argument of the worker's own method", WORKER, "self.words: list[str] = []", "self.words: list[str] = []; self.setPeriod(\"fast\")", "RC6308", f"{WORKER}:9:52"),
    one(CREATING, "the name that C++ has in other tools", MOUTH, "language: cpp", "language: c++", "RC0204", f"{MOUTH}:2:11"),
    Mistake(CREATING, "a method of one's own with too few arguments", ((WORKER, "self.words.append(text)", "self.note()\n        self.words.append(text)"), (WORKER, "    def Speech_stop(self)", "    def note(self, text: str) -> None:\n        self.words.append(text)\n\n    def Speech_stop(self)")), "RC6304", f"{WORKER}:20:14"),
    Mistake(CREATING, "a method of one's own with an unknown argument", ((WORKER, "self.words.append(text)", "self.note(word=text)\n        self.words.append(text)"), (WORKER, "    def Speech_stop(self)", "    def note(self, text: str) -> None:\n        self.words.append(text)\n\n    def Speech_stop(self)")), "RC6305", f"{WORKER}:20:19"),
    one(CREATING, "a method of an interface that is called with too few arguments", WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        self.Speech_say(\"hello\")\n", "RC6304", f"{WORKER}:16:14"),
    Mistake(CREATING, "a function of one's own with too many arguments", ((WORKER, "class SpecificWorker", "def half(n: float) -> float:\n    return n / 2\n\n\nclass SpecificWorker"), (WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        half(1.0, 2.0)\n")), "RC6304", f"{WORKER}:20:9"),
    Mistake(CREATING, "a class of one's own without its arguments", ((WORKER, "class SpecificWorker", "class Timer:\n    def __init__(self, seconds):\n        self.seconds = seconds\n\n\nclass SpecificWorker"), (WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        Timer()\n")), "RC6304", f"{WORKER}:21:9"),
    one(CREATING, "an attribute that another function expects of the worker", WORKER, "class SpecificWorker", "def greet(worker: SpecificWorker) -> None:\n    worker.log.inform(\"hello\")\n\n\nclass SpecificWorker", "RC6325", f"{WORKER}:8:16"),
    #
    one(PROXIES, "a requirement in other letters", SPEECH, "requires: [Mouth]", "requires: [mouth]", "RC2003", f"{SPEECH}:5:12"),
    one(PROXIES, "the plural", SPEECH, "requires: [Mouth]", "requires: [Mouths]", "RC2003", f"{SPEECH}:5:12"),
    one(PROXIES, "the name of the component instead of the interface", SPEECH, "requires: [Mouth]", "requires: [MouthComp]", "RC2003", f"{SPEECH}:5:12"),
    one(PROXIES, "a topic that is required", SPEECH, "requires: [Mouth]", "requires: [Mouth, MouthEvents]", "RC2008", f"{SPEECH}:5:19"),
    one(PROXIES, "code that still uses a removed proxy, in Python", SPEECH, "requires: [Mouth]\n", "", "RC6301", f"{WORKER}:13:24"),
    one(PROXIES, "code that still uses a removed proxy, in C++", MOUTH, "requires: [Camera]\n", "", "RC6301", f"{SOURCE}:10:5"),
    one(PROXIES, "code that still publishes to a removed topic", MOUTH, "publishes: [MouthEvents]\n", "", "RC6301", f"{SOURCE}:17:5"),
    one(PROXIES, "code that uses a proxy which the document lacks", WORKER, "self.mouth_proxy.close()", "self.camera_proxy.getImage()", "RC6301", f"{WORKER}:15:14"),
    one(PROXIES, "a proxy under the name of its interface", WORKER, "self.mouth_proxy.close()", "self.Mouth_proxy.close()", "RC6301", f"{WORKER}:15:14"),
    one(PROXIES, "the accessor of a topic in Python's spelling, in C++", SOURCE, "mouthevents_pubproxy", "mouthevents_proxy", "RC6301", f"{SOURCE}:17:5"),
    one(PROXIES, "a method that the interface lacks, in Python", WORKER, "self.mouth_proxy.close()", "self.mouth_proxy.shut()", "RC6302", f"{WORKER}:15:26"),
    one(PROXIES, "a method that the interface lacks, in C++", SOURCE, "camera_proxy->getImage", "camera_proxy->getPicture", "RC6302", f"{SOURCE}:10:19"),
    one(PROXIES, "an event that the topic lacks", SOURCE, "->moved(pose)", "->move(pose)", "RC6303", f"{SOURCE}:17:27"),
    one(PROXIES, "a subscriber whose method has another name", WORKER, "def MouthEvents_moved", "def MouthEvents_onMoved", "RC6201", f"{WORKER}:7:7"),
    one(PROXIES, "code that still uses a removed proxy, in Java", EAR, "requires: [Speech]\n", "", "RC6301", f"{EAR_CODE}:14:13"),
    one(PROXIES, "code that still publishes to a removed topic, in Java", EAR, "publishes: [MouthEvents]\n", "", "RC6301", f"{EAR_CODE}:16:9"),
    one(PROXIES, "a proxy in another form, in Java", EAR_CODE, "speech_proxy", "speechProxy", "RC6301", f"{EAR_CODE}:14:13"),
    one(PROXIES, "a proxy in another form, in C++", SOURCE, "camera_proxy", "cameraPrx", "RC6301", f"{SOURCE}:10:5"),
    one(PROXIES, "a proxy without `self.`", WORKER, "self.mouth_proxy.close()", "mouth_proxy.close()", "RC6321", f"{WORKER}:15:9"),
    one(PROXIES, "a method that is named, and not called", WORKER, "self.mouth_proxy.close()", "self.mouth_proxy.close", "RC6323", f"{WORKER}:15:26"),
    one(PROXIES, "an asynchronous call of a method that the interface lacks", WORKER, "close()", "clseAsync()", "RC6302", f"{WORKER}:15:26"),
    one(PROXIES, "a method that the interface lacks, in Java", EAR_CODE, "proxy.say(", "proxy.tell(", "RC6302", f"{EAR_CODE}:14:26"),
    one(PROXIES, "a call with too few arguments, in Java", EAR_CODE, '"hello", 5', '"hello"', "RC6304", f"{EAR_CODE}:14:26"),
    one(PROXIES, "a wrong type of argument", WORKER, "move(pose, True)", "move(10.0, True)", "RC6328", f"{WORKER}:13:41"),
    one(PROXIES, "a wrong type of argument, in C++", SOURCE, "getImage(640,", 'getImage("640",', "RC6328", f"{SOURCE}:10:28"),
    one(PROXIES, "a wrong type of argument, in Java", EAR_CODE, '"hello", 5', "5, 5", "RC6328", f"{EAR_CODE}:14:30"),
    one(PROXIES, "a variable of a wrong type", WORKER, "move(pose, True)", "move(self.words, True)", "RC6318", f"{WORKER}:13:41", "check --code"),
    one(PROXIES, "another name of a proxy, and a method that it lacks", WORKER, "self.mouth_proxy.close()", "self.mouth = self.mouth_proxy; self.mouth.clos()", "RC6302", f"{WORKER}:15:51"),
    one(PROXIES, "another name of a proxy, in C++", SOURCE, "camera_proxy->getImage(", "auto camera{camera_proxy}; camera->getImag(", "RC6302", f"{SOURCE}:10:40"),
    one(PROXIES, "another name of a proxy, in Java", EAR_CODE, "speech_proxy.say(", "var speech = speech_proxy; speech.sya(", "RC6302", f"{EAR_CODE}:14:47"),
    one(PROXIES, "a proxy to an object that nobody serves", VALUES, "parameters:", 'proxies: {Mouth: "wrongname:tcp -p 10001"}\nparameters:', "RC3337", f"{VALUES}:1:18"),
    one(PROXIES, "a proxy without a TCP port", VALUES, "parameters:", 'proxies: {Mouth: "mouth:tcp -h localhost"}\nparameters:', "RC3338", f"{VALUES}:1:18"),
    one(PROXIES, "a method of the proxy without the proxy", WORKER, "self.mouth_proxy.close()", "self.close()", "RC6316", f"{WORKER}:15:14"),
    one(PROXIES, "a topic that is published, but only subscribed in the document", WORKER, "self.mouth_proxy.close()", "self.mouthevents_proxy.moved(reached)", "RC6301", f"{WORKER}:15:14"),
    one(PROXIES, "a result that is used as another type", WORKER, "reached.opening)", "reached.open)", "RC6325", f"{WORKER}:14:91"),
    one(PROXIES, "an output as an argument, as in C++", WORKER, "self.mouth_proxy.close()", "self.mouth_proxy.close(pose)", "RC6304", f"{WORKER}:15:26"),
    one(PROXIES, "an argument that is computed, and too many", WORKER, "self.mouth_proxy.close()", "self.mouth_proxy.close(len(self.words))", "RC6304", f"{WORKER}:15:26"),
    one(PROXIES, "an enumerator as an argument of another type", WORKER, "move(pose, True)", "move(RoboCompMouth.Shape.round, True)", "RC6328", f"{WORKER}:13:41"),
    one(PROXIES, "a wrong type of argument, by its name", WORKER, "move(pose, True)", "move(target=10.0, fast=True)", "RC6328", f"{WORKER}:13:48"),
    one(PROXIES, "a struct that is indexed with a number", WORKER, "reached.opening)", "reached[0])", "RC6330", f"{WORKER}:14:91"),
    one(PROXIES, "a struct that is indexed", WORKER, "reached.opening)", "reached['opening'])", "RC6330", f"{WORKER}:14:92"),
    one(PROXIES, "the result of an asynchronous call, without `result()`", WORKER, "= self.mouth_proxy.move(pose, True)", "= self.mouth_proxy.moveAsync(pose, True)", "RC6325", f"{WORKER}:14:91"),
    one(PROXIES, "a proxy in an annotated parameter", WORKER, "    def Speech_stop(self)", "    def rest(self, mouth: RoboCompMouth.MouthPrx) -> None:\n        mouth.clos()\n\n    def Speech_stop(self)", "RC6302", f"{WORKER}:24:15"),
    one(PROXIES, "a proxy in an annotated attribute", WORKER, "    def Speech_stop(self)", "    other: RoboCompMouth.MouthPrx | None = None\n\n    def rest(self) -> None:\n        self.other.clos()\n\n    def Speech_stop(self)", "RC6302", f"{WORKER}:26:20"),
    one(PROXIES, "a proxy with another time limit", WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        self.mouth_proxy.ice_invocationTimeout(500).clos()\n", "RC6302", f"{WORKER}:16:53"),
    one(PROXIES, "a misspelled method of Ice", WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        self.mouth_proxy.ice_pign()\n", "RC6302", f"{WORKER}:16:26"),
    one(PROXIES, "a cast to a proxy", WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        mouth = RoboCompMouth.MouthPrx.checkedCast(self.mouth_proxy)\n        mouth.clos()\n", "RC6302", f"{WORKER}:17:15"),
    one(PROXIES, "one of two proxies", WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        mouth = self.mouth_proxy or None\n        mouth.clos()\n", "RC6302", f"{WORKER}:17:15"),
    one(PROXIES, "a call without a result as a condition", WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        if self.mouth_proxy.close():\n            self.words.clear()\n", "RC6326", f"{WORKER}:16:29"),
    one(PROXIES, "a dereferenced proxy, in C++", SOURCE, "    camera_proxy->getImage(640, 480);\n", "    (*camera_proxy).getImag(640, 480);\n", "RC6302", f"{SOURCE}:10:21"),
    one(PROXIES, "a reference to the proxy, in C++", SOURCE, "    camera_proxy->getImage(640, 480);\n", "    auto& camera = *camera_proxy;\n    camera.getImag(640, 480);\n", "RC6302", f"{SOURCE}:11:12"),
    one(PROXIES, "a proxy that a lambda captures, in C++", SOURCE, "    camera_proxy->getImage(640, 480);\n", "    auto look = [camera = camera_proxy] { return camera->getImag(640, 480); };\n    look();\n", "RC6302", f"{SOURCE}:10:58"),
    one(PROXIES, "a proxy with a dot instead of an arrow, in C++", SOURCE, "    camera_proxy->getImage(640, 480);\n", "    camera_proxy.getImage(640, 480);\n", "RC6325", f"{SOURCE}:10:18"),
    one(PROXIES, "a proxy as a parameter, in C++", SOURCE, "void SpecificWorker::compute()", "static void look(const RoboCompCamera::CameraPrxPtr& camera)\n{\n    camera->getImag(640, 480);\n}\n\nvoid SpecificWorker::compute()", "RC6302", f"{SOURCE}:10:13"),
    #
    one(INTERFACES, "a method that is added, and not yet implemented", I_SPEECH, "      stop:\n", "      stop:\n      pause:\n", "RC6201", f"{WORKER}:7:7"),
    one(INTERFACES, "a method that is renamed, and still called in Python", I_MOUTH, "      close:", "      shut:", "RC6302", f"{WORKER}:15:26"),
    one(INTERFACES, "a method that is renamed, and still called in C++", I_CAMERA, "      getImage:", "      getPicture:", "RC6302", f"{SOURCE}:10:19"),
    one(INTERFACES, "a method that is removed, and still implemented", I_SPEECH, "      stop:\n", "", "RC6203", f"{WORKER}:23:9"),
    one(INTERFACES, "a new parameter: the call in Python is stale", I_MOUTH, "fast: bool}", "fast: bool, force: float}", "RC6304", f"{WORKER}:13:36"),
    one(INTERFACES, "a new parameter: the call in C++ is stale", I_CAMERA, "height: int}", "height: int, depth: int}", "RC6304", f"{SOURCE}:10:19"),
    one(INTERFACES, "a new parameter: the method in Python is stale", I_SPEECH, "volume: int}", "volume: int, voice: string}", "RC6202", f"{WORKER}:19:9"),
    one(INTERFACES, "a new parameter: the method in C++ is stale", I_MOUTH, "fast: bool}", "fast: bool, force: float}", "RC6202", f"{HEADER}:10:25"),
    one(INTERFACES, "a parameter of another type: the method in Python is stale", I_SPEECH, "volume: int}", "volume: string}", "RC6202", f"{WORKER}:19:9"),
    one(INTERFACES, "a parameter of another type: the method in C++ is stale", I_MOUTH, "fast: bool}", "fast: float}", "RC6202", f"{SOURCE}:13:37"),
    one(INTERFACES, "a result of another type: the method in C++ is stale", I_MOUTH, "fast: bool}, returns: Pose", "fast: bool}, returns: Shape", "RC6202", f"{HEADER}:10:25"),
    one(INTERFACES, "a result of another type: the method in Java is stale", I_CAMERA, "returns: string", "returns: int", "RC6202", f"{NOSE_CODE}:14:19"),
    one(INTERFACES, "a method that is renamed, and implemented in Java", I_CAMERA, "      getImage:", "      getPicture:", "RC6201", f"{NOSE_CODE}:3:14"),
    one(INTERFACES, "an enumerator that is removed, and still used in Java", I_MOUTH, "[round, wide]", "[oval, wide]", "RC6315", f"{EAR_CODE}:16:57"),
    one(INTERFACES, "a type that is renamed, and still imported in Java", I_MOUTH, "  Shape: {enum: [round, wide]}\n  Pose: {struct: {opening: float, width: float, shape: Shape}}", "  Form: {enum: [round, wide]}\n  Pose: {struct: {opening: float, width: float, shape: Form}}", "RC6314", f"{EAR_CODE}:3:28"),
    one(INTERFACES, "a module that is renamed, and still imported in Java", I_MOUTH, "module: RoboCompMouth", "module: RoboCompLips", "RC6313", f"{EAR_CODE}:2:14"),
    one(INTERFACES, "a parameter of another type: the call in Python is stale", I_MOUTH, "fast: bool}", "fast: string}", "RC6328", f"{WORKER}:13:47"),
    one(INTERFACES, "an `out:` that is added: the use of the result is stale", I_MOUTH, "fast: bool}, returns: Pose}", "fast: bool}, returns: Pose, out: {age: int}}", "RC6326", f"{WORKER}:14:91"),
    one(INTERFACES, "a result that is removed, and still used", I_MOUTH, "fast: bool}, returns: Pose}", "fast: bool}}", "RC6326", f"{WORKER}:14:91"),
    one(INTERFACES, "a result that is unpacked to too many variables", WORKER, "reached = self", "reached, more = self", "RC6326", f"{WORKER}:13:42"),
    one(INTERFACES, "a member that is renamed, and still read in C++", I_MOUTH, "{opening: float, ", "{gap: float, ", "RC6325", f"{SOURCE}:16:10"),
    one(INTERFACES, "a member that is renamed, and still read by a method in Python", I_MOUTH, "{opening: float, ", "{gap: float, ", "RC6325", f"{WORKER}:27:34"),
    one(INTERFACES, "a member that is added: the construction in Java is stale", I_MOUTH, "width: float, ", "width: float, depth: float, ", "RC6304", f"{EAR_CODE}:16:40"),
    one(INTERFACES, "parameters that change places: the call in Java is stale", I_SPEECH, "text: string, volume: int", "volume: int, text: string", "RC6328", f"{EAR_CODE}:14:30"),
    one(INTERFACES, "an unknown exception", I_SPEECH, "      stop:", "      stop: {throws: [Stuck]}", "RC1011", f"{I_SPEECH}:6:23"),
    one(INTERFACES, "parameters that change places: the method in C++ is stale", I_MOUTH, "{target: Pose, fast: bool}", "{fast: bool, target: Pose}", "RC6202", f"{HEADER}:10:25"),
    one(INTERFACES, "an enum instead of a number: the construction in Python is stale", I_MOUTH, "opening: float", "opening: Shape", "RC6328", f"{WORKER}:12:43"),
    one(INTERFACES, "a parameter that is removed: the call in Python is stale", I_MOUTH, "{target: Pose, fast: bool}", "{target: Pose}", "RC6304", f"{WORKER}:13:36"),
    one(INTERFACES, "a word of another language for a type", I_MOUTH, "{struct: {opening", "{class: {opening", "RC0202", f"{I_MOUTH}:4:10"),
    one(INTERFACES, "a word of Slice as a name", I_SPEECH, "      stop:", "      module:", "RC1001", f"{I_SPEECH}:6:7"),
    one(INTERFACES, "a struct in itself", I_MOUTH, "width: float", "width: Pose", "RC1015", f"{I_MOUTH}:4:35"),
    one(INTERFACES, "a member of a struct that is renamed, and still set", I_MOUTH, "{opening: float, ", "{gap: float, ", "RC6305", f"{WORKER}:12:35"),
    one(INTERFACES, "an enumerator that is removed, and still used", I_MOUTH, "[round, wide]", "[oval, wide]", "RC6315", f"{WORKER}:12:87"),
    one(INTERFACES, "an enumerator that is removed, and still used in C++", I_MOUTH, "[round, wide]", "[round, oval]", "RC6315", f"{SOURCE}:15:60"),
    one(INTERFACES, "a type that is renamed, and still used", I_MOUTH, "{target: Pose, ", "{target: Poses, ", "RC1010", f"{I_MOUTH}:8:27"),
    one(INTERFACES, "a module that is renamed, and still imported by code", I_MOUTH, "module: RoboCompMouth", "module: RoboCompLips", "RC6313", f"{WORKER}:4:34"),
    one(INTERFACES, "a type that does not exist", I_SPEECH, "volume: int}", "volume: integer}", "RC1010", f"{I_SPEECH}:5:40"),
    one(INTERFACES, "a name twice", I_MOUTH, "{opening: float, width: float,", "{opening: float, Opening: float,", "RC1004", f"{I_MOUTH}:4:35"),
    Mistake(INTERFACES, "a document that is deleted, and still imported", ((I_MOUTH,),), "RC2101", f"{SPEECH}:3:19"),
    one(INTERFACES, "an event with a result", I_MOUTH, "moved: {in: {pose: Pose}}", "moved: {in: {pose: Pose}, returns: bool}", "RC0204", f"{I_MOUTH}:13:33"),
    Mistake(INTERFACES, "a member that is renamed, and still read of an annotated parameter", ((I_MOUTH, "{opening: float", "{gap: float"), (WORKER, "    def Speech_stop(self)", "    def show(self, pose: RoboCompMouth.Pose) -> None:\n        self.log.info(\"%s\", pose.opening)\n\n    def Speech_stop(self)")), "RC6325", f"{WORKER}:24:34"),
    Mistake(INTERFACES, "a member that is renamed, and still read of a list", ((I_MOUTH, "{opening: float", "{gap: float"), (WORKER, "    def Speech_stop(self)", "    def show(self, poses: list[RoboCompMouth.Pose]) -> None:\n        print([pose.opening for pose in poses])\n\n    def Speech_stop(self)")), "RC6325", f"{WORKER}:24:21"),
    Mistake(INTERFACES, "a member of the result of a method of one's own", ((I_MOUTH, "{opening: float", "{gap: float"), (WORKER, "    def Speech_stop(self)", "    def rest(self) -> RoboCompMouth.Pose:\n        return self.mouth_proxy.move(RoboCompMouth.Pose(), True)\n\n    def show(self) -> None:\n        print(self.rest().opening)\n\n    def Speech_stop(self)")), "RC6325", f"{WORKER}:27:27"),
    one(INTERFACES, "a struct that is added to a number", WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        print(self.mouth_proxy.move(pose, True) + 1)\n", "RC6337", f"{WORKER}:16:32"),
    one(INTERFACES, "a list that becomes one struct: the loop is stale", WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        for one in self.mouth_proxy.move(pose, True):\n            print(one)\n", "RC6326", f"{WORKER}:16:37"),
    one(INTERFACES, "a member of the elements of a vector, in C++", SOURCE, "    camera_proxy->getImage(640, 480);\n", "    std::vector<RoboCompMouth::Pose> poses(3);\n    poses.at(0).openning = 3;\n", "RC6325", f"{SOURCE}:11:17"),
    #
    one(PARAMETERS, "a misspelled parameter in the values", VALUES, "speed:", "sped:", "RC3301", f"{VALUES}:2:3"),
    one(PARAMETERS, "a parameter in other letters in the values", VALUES, "speed:", "Speed:", "RC3301", f"{VALUES}:2:3"),
    one(PARAMETERS, "a value out of its range", VALUES, "speed: 120", "speed: 1200", "RC3303", f"{VALUES}:2:10"),
    one(PARAMETERS, "a value with its unit", VALUES, "speed: 120", "speed: 120 words/min", "RC3302", f"{VALUES}:2:10"),
    one(PARAMETERS, "a text instead of a number", VALUES, "speed: 120", 'speed: "120"', "RC3302", f"{VALUES}:2:10"),
    one(PARAMETERS, "a value that is not one of the allowed ones", VALUES, "speed: 120", "device: jack", "RC3303", f"{VALUES}:2:11"),
    one(PARAMETERS, "a misspelled member of a record", VALUES, "pitch:", "picth:", "RC3301", f"{VALUES}:5:7"),
    one(PARAMETERS, "a member that is missing", VALUES, "    - name: bert\n      pitch: 1.5\n", "    - pitch: 1.5\n", "RC3307", f"{VALUES}:4:7"),
    one(PARAMETERS, "values that break a constraint", VALUES, "speed: 120", "low: 10", "RC3308", f"{VALUES}:2:3"),
    one(PARAMETERS, "a default out of its range", PDSL, "default: 150", "default: 500", "RC3113", f"{PDSL}:5:65"),
    one(PARAMETERS, "a secret in plain text", VALUES, "speed: 120", "apiKey: 7dQf93kLmZp2", "RC3311", f"{VALUES}:2:11"),
    one(PARAMETERS, "a removed parameter that the values still set", PDSL, "  speed: {type: int, range: [1, 400], unit: words/min, default: 150, editable: true}\n", "", "RC3301", f"{VALUES}:2:3"),
    Mistake(PARAMETERS, "a removed parameter that code still reads", ((PDSL, "  speed: {type: int, range: [1, 400], unit: words/min, default: 150, editable: true}\n", ""), (VALUES, "  speed: 120\n", "")), "RC6306", f"{WORKER}:14:76"),
    one(PARAMETERS, "a misspelled parameter in Python", WORKER, "self.parameters.speed, reached", "self.parameters.sped, reached", "RC6306", f"{WORKER}:14:76"),
    one(PARAMETERS, "a misspelled parameter in C++", SOURCE, "parameters.widest()", "parameters.widset()", "RC6306", f"{SOURCE}:16:54"),
    one(PARAMETERS, "a misspelled path in code", WORKER, "self.parameters.speed = 200", 'self.parameters.set("voices[0].picth", 1.2)', "RC6306", f"{WORKER}:17:34"),
    one(PARAMETERS, "code that sets a value out of its range, in Python", WORKER, "speed = 200", "speed = 2000", "RC6308", f"{WORKER}:17:37"),
    one(PARAMETERS, "code that sets a value out of its range, in C++", SOURCE, "setWidest(60)", "setWidest(600)", "RC6308", f"{SOURCE}:5:26"),
    one(PARAMETERS, "code that sets a parameter which is not editable", WORKER, "self.parameters.speed = 200", 'self.parameters.device = "pulse"', "RC6307", f"{WORKER}:17:29"),
    one(PARAMETERS, "a misspelled parameter in Java", EAR_CODE, "parameters.loudness()", "parameters.loudnes()", "RC6306", f"{EAR_CODE}:13:24"),
    one(PARAMETERS, "code that sets a value out of its range, in Java", EAR_CODE, "setLoudness(0.7f)", "setLoudness(7)", "RC6308", f"{EAR_CODE}:8:32"),
    one(PARAMETERS, "code that sets a parameter which is not editable, in Java", EAR_CODE, "setLoudness(0.7f)", 'setMode("far")', "RC6307", f"{EAR_CODE}:8:20"),
    one(PARAMETERS, "a misspelled path in Java", EAR_CODE, "setLoudness(0.7f)", 'set("loudnes", 0.2)', "RC6306", f"{EAR_CODE}:8:25"),
    one(PARAMETERS, "a parameter that is read as an attribute of the worker", WORKER, "self.parameters.speed, reached", "self.speed, reached", "RC6316", f"{WORKER}:14:65"),
    one(PARAMETERS, "a malformed endpoint in a flat etc/config", "camera/etc/config", "Camera.Endpoints=tcp", "Camera.Endpoints=tpc", "RC0208", "camera/etc/config:5:18"),
    one(PARAMETERS, "a line with a colon in a flat etc/config", "camera/etc/config", "period.compute=100", "period.compute: 100", "RC3335", "camera/etc/config:10:1"),
    one(PARAMETERS, "a property twice in a flat etc/config", "camera/etc/config", "period.compute=100", "period.compute=100\nperiod.compute=50", "RC3336", "camera/etc/config:11:1"),
    one(PARAMETERS, "an endpoint without a value in a flat etc/config", "camera/etc/config", "Camera.Endpoints=", "Camera.Endpoints=\n#", "RC6209", "camera/etc/config:5:1"),
    one(PARAMETERS, "a misspelled property of Ice", VALUES, "parameters:", "ice: {MesageSizeMax: 20004}\nparameters:", "RC3333", f"{VALUES}:1:7"),
    one(PARAMETERS, "an impossible value of a property of Ice", VALUES, "parameters:", 'ice: {Warn.Connections: "yes"}\nparameters:', "RC3334", f"{VALUES}:1:25"),
    one(PARAMETERS, "two endpoints at one port", VALUES, "parameters:", "endpoints: {Speech: tcp -p 12000, CommonBehavior: tcp -p 12000}\nparameters:", "RC3339", f"{VALUES}:1:51"),
    one(PARAMETERS, "a comparison with a value that is not allowed", WORKER, "if not self.words:", 'if self.parameters.device == "puls":', "RC6327", f"{WORKER}:16:38"),
    one(PARAMETERS, "a comparison with a number out of range, in C++", SOURCE, "camera_proxy->", "if (parameters.widest() == 500) camera_proxy->", "RC6327", f"{SOURCE}:10:32"),
    one(PARAMETERS, "a comparison with a value that is not allowed, in Java", EAR_CODE, "parameters.loudness() > 0.6f", 'parameters.mode().equals("nar")', "RC6327", f"{EAR_CODE}:13:38"),
    one(PARAMETERS, "a parameter by its key instead of an attribute", WORKER, "self.parameters.speed, reached", 'self.parameters["speed"], reached', "RC6330", f"{WORKER}:14:77"),
    one(PARAMETERS, "a parameter that is called, as in C++", WORKER, "self.parameters.speed, reached", "self.parameters.speed(), reached", "RC6334", f"{WORKER}:14:76"),
    one(PARAMETERS, "a getter that is not called, in C++", SOURCE, "parameters.widest()", "parameters.widest", "RC6323", f"{SOURCE}:16:54"),
    one(PARAMETERS, "code that sets a text instead of a number, in C++", SOURCE, "setWidest(60)", 'setWidest("wide")', "RC6308", f"{SOURCE}:5:26"),
    one(PARAMETERS, "a path to a parameter that is not editable", WORKER, "self.parameters.speed = 200", 'self.parameters.set("device", "pulse")', "RC6307", f"{WORKER}:17:34"),
    one(PARAMETERS, "a range in words of other formats", PDSL, "range: [1, 400]", "min: 1", "RC0202", f"{PDSL}:5:22"),
    one(PARAMETERS, "a misspelled key of an entry", HEAD, "speech: {component: speech, port: 11001}", "speech: {component: speech, port: 11001, set: {sped: 3}}", "RC3301", f"{HEAD}:3:50"),
    one(PARAMETERS, "a number that is added to a text", WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        self.log.info(\"speed: \" + self.parameters.speed)\n", "RC6337", f"{WORKER}:16:51"),
    one(PARAMETERS, "a text that is added to a number", WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        print(self.parameters.device + 1)\n", "RC6337", f"{WORKER}:16:31"),
    one(PARAMETERS, "a member of a record in a numbered loop", WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        for number, voice in enumerate(self.parameters.voices):\n            print(number, voice.picth)\n", "RC6306", f"{WORKER}:17:33"),
    one(PARAMETERS, "a member of the greatest record", WORKER, "        self.mouth_proxy.close()\n", "        self.mouth_proxy.close()\n        voice = max(self.parameters.voices, key=lambda one: one.pitch)\n        print(voice.picth)\n", "RC6306", f"{WORKER}:17:21"),
    one(PARAMETERS, "a property of Ice among the parameters", VALUES, "parameters:\n", "parameters:\n  Ice.MessageSizeMax: 1000\n", "RC3301", f"{VALUES}:2:3"),
    one(PARAMETERS, "an endpoint among the parameters", VALUES, "parameters:\n", "parameters:\n  Speech.Endpoints: tcp -p 12000\n", "RC3301", f"{VALUES}:2:3"),
    #
    one(DEPLOYING, "nobody serves what a component requires", HEAD, "  mouth: {component: mouth, port: 11002}\n", "", "RC4201", f"{HEAD}:3:3"),
    one(DEPLOYING, "two serve it", HEAD, "services:", "  mouth2: {component: mouth, port: 11005}\nservices:", "RC4202", f"{HEAD}:3:3"),
    one(DEPLOYING, "a topic without an IceStorm", HEAD, "services: {storm: {icestorm: {port: 11003}}}\n", "", "RC4208", f"{HEAD}:3:3"),
    one(DEPLOYING, "two components at one port", HEAD, "port: 11002", "port: 11001", "RC4303", f"{HEAD}:4:35"),
    one(DEPLOYING, "an unknown host", HEAD, "port: 11002}", "port: 11002, host: brian}", "RC4002", f"{HEAD}:4:48"),
    one(DEPLOYING, "a folder without a component", HEAD, "component: mouth", "component: mout", "RC4101", f"{HEAD}:4:22"),
    one(DEPLOYING, "a connection to an unknown entry", HEAD, "port: 11001}", "port: 11001, connect: {Mouth: moth}}", "RC4205", f"{HEAD}:3:61"),
    one(DEPLOYING, "a connection of a port that the component lacks", HEAD, "port: 11001}", "port: 11001, connect: {Moth: mouth}}", "RC4007", f"{HEAD}:3:54"),
    one(DEPLOYING, "a connection to a component that does not serve the interface", HEAD, "port: 11001}", "port: 11001, connect: {Mouth: storm}}", "RC4204", f"{HEAD}:3:61"),
    one(DEPLOYING, "components that wait for each other", "camera/camera.cdsl.yaml", "imports: [Camera]\n", "imports: [Camera, Mouth]\nrequires: [Mouth]\n", "RC4401", f"{HEAD}:4:3"),
    one(DEPLOYING, "an `after:` that leads back", HEAD, "port: 11002}", "port: 11002, after: [speech]}", "RC4401", f"{HEAD}:3:3"),
    one(DEPLOYING, "an entry twice", HEAD, "services:", "  mouth: {component: mouth, port: 11005}\nservices:", "RC0103", f"{HEAD}:6:3"),
    one(DEPLOYING, "a port out of range", HEAD, "port: 11002", "port: 110020", "RC0204", f"{HEAD}:4:35"),
    one(DEPLOYING, "ports of instances that are too high", HEAD, "mouth: {component: mouth, port: 11002", "\"mouth{i}\": {component: mouth, port: 65535, instances: 3", "RC4302", f"{HEAD}:4:40"),
    one(DEPLOYING, "a misspelled restart policy", HEAD, "port: 11002}", "port: 11002, restart: onfailure}", "RC0204", f"{HEAD}:4:51"),
    Mistake(DEPLOYING, "a component that is not built", ((PROGRAM,),), "RC4403", f"{HEAD}:4:3"),
    Mistake(DEPLOYING, "a component that is older than its code", ((SOURCE, "640", "320"),), "RC7016", f"{HEAD}:4:3", "deploy plan head.ddsl.yaml"),
    Mistake(DEPLOYING, "a program that does not exist", ((HEAD, "component: mouth, port: 11002", "program: bin/mouht"),), "RC4404", f"{HEAD}:4:3"),
    one(DEPLOYING, "a proxy to an object that the entry does not serve", HEAD, "port: 11001}", 'port: 11001, connect: {Mouth: "mouht:tcp -p 11002"}}', "RC4313", f"{HEAD}:3:61"),
    one(DEPLOYING, "a proxy without a TCP port", HEAD, "port: 11001}", 'port: 11001, connect: {Mouth: "mouth:tcp"}}', "RC4312", f"{HEAD}:3:61"),
    one(DEPLOYING, "an entry that starts after itself", HEAD, "port: 11002}", "port: 11002, after: [mouth]}", "RC4402", f"{HEAD}:4:50"),
    one(DEPLOYING, "a component by its name instead of its folder", HEAD, "component: mouth", "component: MouthComp", "RC4101", f"{HEAD}:4:22"),
    one(DEPLOYING, "a property of Ice in `set:`", HEAD, "port: 11001}", "port: 11001, set: {Ice.MessageSizeMax: 1000}}", "RC3301", f"{HEAD}:3:50"),
    one(DEPLOYING, "a proxy in `set:`", HEAD, "port: 11001}", "port: 11001, set: {MouthProxy: \"mouth:tcp -p 11002\"}}", "RC3301", f"{HEAD}:3:50"),
    one(DEPLOYING, "a port of an interface that the component lacks", HEAD, "port: 11001}", "ports: {Speach: 11001}}", "RC4007", f"{HEAD}:3:39"),
    one(DEPLOYING, "a topic that the component lacks", HEAD, "port: 11001}", "port: 11001, topics: {MouthEvent: mine}}", "RC4007", f"{HEAD}:3:53"),
    one(DEPLOYING, "instances without their number in the name", HEAD, "port: 11001}", "instances: 2}", "RC4008", f"{HEAD}:3:42"),
    Mistake(DEPLOYING, "a connection to an instance that does not exist", ((HEAD, "  mouth: {component: mouth, port: 11002}", "  mouth{i}: {component: mouth, instances: 2}"), (HEAD, "port: 11001}", "port: 11001, connect: {Mouth: mouth5}}")), "RC4205", f"{HEAD}:3:61"),
    one(DEPLOYING, "a required component that is switched off", HEAD, "port: 11002}", "port: 11002, enabled: false}", "RC4207", f"{HEAD}:3:3"),
    one(DEPLOYING, "a range of ports that is too small", HEAD, "components:", "ports: {from: 12000, to: 12001}\ncomponents:", "RC6011", f"{HEAD}:2:8"),
    one(DEPLOYING, "a time with an unknown unit", HEAD, "port: 11001}", "port: 11001, ready: 10 sec}", "RC0204", f"{HEAD}:3:51"),
    one(DEPLOYING, "an unknown service", HEAD, "icestorm:", "icestrom:", "RC0202", f"{HEAD}:6:20"),
]  # fmt: skip
