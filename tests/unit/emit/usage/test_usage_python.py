"""What is reported about the use of the worker in Python: all that is certain, and nothing else."""

from __future__ import annotations

import ast
import textwrap

import pytest

from conftest import ROOT
from judged_code import MACHINE, Link, component, found
from robocomp_yaml.emit.usage.judge import judge
from robocomp_yaml.languages.python.names import WORKER_ATTRIBUTES

NAMES = "Fake, Foreign, Ice, Meta, contextlib, decorated, loadUi, name, other, path, run, speed, use"
HEAD = (
    "from generated.genericworker import GenericWorker\nfrom generated.interfaces import RoboCompMouth\n"
    f"from elsewhere import {NAMES}\n"
)
CLASS = "\n\nclass SpecificWorker(GenericWorker):\n    def Ear_hear(self, text):\n        pass\n\n"


def worker(body: str, head: str = "") -> dict[str, str]:
    method = "    def compute(self):\n" + textwrap.indent(textwrap.dedent(body), "        ")
    return {"specificworker.py": HEAD + head + CLASS + method + "\n"}


@pytest.mark.parametrize(
    ("body", "code", "text"),
    [
        ("self.moth_proxy.close()", "RC6301", "moth_proxy"),
        ("self.ear_proxy.hear('x')", "RC6301", "ear_proxy"),
        ("if self.moth_proxy: pass", "RC6301", "moth_proxy"),
        ("print('ä', self.moth_proxy)", "RC6301", "moth_proxy"),
        ("self.mouth_proxy.shut()", "RC6302", "shut"),
        ("f = self.mouth_proxy.shut", "RC6302", "shut"),
        ("mouth = self.mouth_proxy\nmouth.shut()", "RC6302", "shut"),
        ("me = self\nme.mouth_proxy.shut()", "RC6302", "shut"),
        ("def later():\n    self.mouth_proxy.shut()\nlater()", "RC6302", "shut"),
        ("run = lambda: self.mouth_proxy.shut()", "RC6302", "shut"),
        ("[self.mouth_proxy.shut() for _ in range(3)]", "RC6302", "shut"),
        ("try:\n    self.mouth_proxy.shut()\nexcept Exception:\n    pass", "RC6302", "shut"),
        ("print(self.mouth_proxy.move(\n    RoboCompMouth.Pose(),\n    True,\n).opening, self.mouth_proxy.shut())", "RC6302", "shut"),
        ("self.news_proxy.tell('x')", "RC6303", "tell"),
        ("self.mouth_proxy.move(1)", "RC6304", "move"),
        ("self.mouth_proxy.move(other, 2, {}, 3)", "RC6304", "move"),
        ("self.mouth_proxy.where(1, 2)", "RC6304", "where"),
        ("move = self.mouth_proxy.move\nmove(1)", "RC6304", "move"),
        ("self.mouth_proxy.move(other, slow=True)", "RC6305", "slow"),
        ("RoboCompMouth.Pose(gap=1)", "RC6305", "gap"),
        ("RoboCompMouth.Pose(1, 2, 3)", "RC6304", "Pose"),
        ("print(self.parameters.sped)", "RC6306", "sped"),
        ("print(self.parameters.now.sped)", "RC6306", "sped"),
        ("print(self.parameters.camera.fsp)", "RC6306", "fsp"),
        ("print(self.parameters.motors[0].speed)", "RC6306", "speed"),
        ("for m in self.parameters.motors:\n    print(m.speed)", "RC6306", "speed"),
        ("print([m.speed for m in self.parameters.motors])", "RC6306", "speed"),
        ("print(self.parameters.offsets['a'].speed)", "RC6306", "speed"),
        ("self.parameters.set('sped', 3)", "RC6306", "sped"),
        ("self.parameters.set('motors[0].velo', 1)", "RC6306", "motors[0].velo"),
        ("self.parameters.change({'speed': 3, 'camera.fsp': 4})", "RC6306", "camera.fsp"),
        ("self.parameters.device = 'x'", "RC6307", "device"),
        ("self.parameters.set('device', 'x')", "RC6307", "device"),
        ("self.parameters.change({'camera.lens': 'x', 'camera.fps': 3})", "RC6307", "camera.lens"),
        ("self.parameters.camera.fps = 5", "RC6320", "fps"),
        ("self.parameters.motors[0].vel = 1.5", "RC6320", "vel"),
        ("self.parameters.now.speed = 5", "RC6320", "speed"),
        ("self.parameters.speed = 0", "RC6308", "0"),
        ("self.parameters.speed = 'fast'", "RC6308", "'fast'"),
        ("self.parameters.set('motors[0].vel', -1.5)", "RC6308", "-1.5"),
        ("print(RoboCompMouth.Pos)", "RC6314", "Pos"),
        ("print(RoboCompMouth.Shape.oval)", "RC6315", "oval"),
        ("print(self.lgo)", "RC6316", "lgo"),
        ("from generated.interfaces import RoboCompNose", "RC6313", "RoboCompNose"),
        ("self.mouth = self.mouth_proxy\nself.mouth.shut()", "RC6302", "shut"),
        ("self.mouth = None\nself.mouth = self.mouth_proxy\nself.mouth.shut()", "RC6302", "shut"),
        ("self.go = self.mouth_proxy.move\nself.go(1)", "RC6304", "go"),
        ("print(self.mouth_proxy.move(other, True).gap)", "RC6325", "gap"),
        ("pose, age = self.mouth_proxy.where(1, 2)", "RC6304", "where"),
        ("pose = RoboCompMouth.Pose()\npose.openning = 3.5", "RC6325", "openning"),
        ("for pose in self.path:\n    pass\nself.path = self.mouth_proxy.way()\nprint(self.path[0].gap)", "RC6325", "gap"),
        ("for pose in self.mouth_proxy.way():\n    print(pose.gap)", "RC6325", "gap"),
        ("pose = self.mouth_proxy.where()\nprint(pose.opening)", "RC6326", "opening"),
        ("pose, age, more = self.mouth_proxy.where()", "RC6326", "where"),
        ("ok, pose = self.mouth_proxy.move(other, True)", "RC6326", "move"),
        ("done, pose = self.mouth_proxy.close()", "RC6326", "close"),
        ("if self.parameters.speed == 500: pass", "RC6327", "500"),
        ("if 'fast' != self.parameters.speed: pass", "RC6327", "'fast'"),
        ("if self.parameters.mode in ('slow', 'fasst'): pass", "RC6327", "'fasst'"),
        ("mode = self.parameters.mode\nif mode == 'fasst': pass", "RC6327", "'fasst'"),
        ("self.mode = self.parameters.mode\nif self.mode == 'fasst': pass", "RC6327", "'fasst'"),
        ("match self.parameters.mode:\n    case 'slow' | 'fasst': pass", "RC6327", "'fasst'"),
        ("if RoboCompMouth.Pose().shape == 'round': pass", "RC6327", "'round'"),
        ("self.mouth_proxy.move('x', True)", "RC6328", "'x'"),
        ("self.mouth_proxy.move(other, 'yes')", "RC6328", "'yes'"),
        ("self.news_proxy.told(3)", "RC6328", "3"),
        ("print(self.parameters['speed'])", "RC6330", "speed"),
        ("print(RoboCompMouth.Pose()['opening'])", "RC6330", "opening"),
        ("print(RoboCompMouth.Shape['wide'])", "RC6330", "wide"),
        ("print(self.mouth_proxy.way()['first'])", "RC6330", "first"),
        ("print(self.mouth_proxy.way().size())", "RC6325", "size"),
        ("way = self.mouth_proxy.way()\nprint(way.opening)", "RC6325", "opening"),
        ("if RoboCompMouth.Pose().shape == 1: pass", "RC6327", "1"),
        ("self.mouth_proxy.closeAsync().reslt()", "RC6325", "reslt"),
        ("RoboCompMouth.Pose(None)", "RC6328", "None"),
        ("self.mouth_proxy.close(3)", "RC6304", "close"),
        ("pose = RoboCompMouth.Pose()\nself.mouth_proxy.where(pose)", "RC6304", "where"),
        ("far = 2 * self.way\nself.way = 3\nself.mouth_proxy.close(far)", "RC6304", "close"),
        ("self.mouth_proxy.close([1])", "RC6304", "close"),
        ("self.mouth_proxy.move((1, 2), True)", "RC6328", "(1, 2)"),
        ("self.mouth_proxy.move(target=3, fast=True)", "RC6328", "3"),
        ("self.mouth_proxy.move(RoboCompMouth.Shape.wide, True)", "RC6328", "RoboCompMouth.Shape.wide"),
        ("self.mouth_proxy.move(self.parameters.device, True)", "RC6328", "self.parameters.device"),
        ("pose, age = self.mouth_proxy.where(), 1\nself.news_proxy.told(float(age))", "RC6328", "float(age)"),
        ("self.news_proxy.told(self.mouth_proxy.move(other, True))", "RC6328", "self.mouth_proxy.move(other, True)"),
        ("RoboCompMouth.Pose('wide')", "RC6328", "'wide'"),
        ("pose = RoboCompMouth.Pose()\npose.shape = 1", "RC6328", "1"),
        ("print(self.parameters.speed())", "RC6334", "speed"),
        ("print(self.parameters.motors[0].vel())", "RC6334", "vel"),
        ("print(self.parameters.now().speed)", "RC6334", "now"),
        ("print(self.mouth_proxy.move(other, True).opening())", "RC6334", "opening"),
        ("self.log.warnning('x')", "RC6325", "warnning"),
        ("path = RoboCompMouth.Path()", "RC6314", "Path"),
        ("self.setPeriod('x')", "RC6308", "'x'"),
        ("self.setPeriod(0)", "RC6308", "0"),
        ("self.setPeriod()", "RC6304", "setPeriod"),
        ("print(self.getPeriod(3))", "RC6304", "getPeriod"),
        ("self.mayTake('long')", "RC6328", "'long'"),
        ("self.killYourSelf", "RC6323", "killYourSelf"),
        ("self.compute", "RC6323", "compute"),
        ("self.events.start", "RC6323", "start"),
        ("with self.mutex():\n    pass", "RC6334", "mutex"),
        ("self.mutex.lock()", "RC6325", "lock"),
        ("self.log('x')", "RC6334", "log"),
        ("print(RoboCompMouth.Shape.wide())", "RC6334", "wide"),
        ("print(RoboCompMouth.Shape('wide'))", "RC6334", "Shape"),
        ("print(RoboCompMouth.Shape(1))", "RC6334", "Shape"),
        ("print(self.parameters.motors[0][0])", "RC6330", "0"),
        ("print(self.parameters.motors[0][path])", "RC6330", "path"),
        ("print(self.parameters.camera[1])", "RC6330", "1"),
        ("print(self.parameters[0])", "RC6330", "0"),
        ("print(self.parameters.speed[0])", "RC6330", "0"),
        ("print(self.parameters.device['tty'])", "RC6330", "tty"),
        ("print(self.mouth_proxy.move(other, True)[0])", "RC6330", "0"),
        ("print(self.parameters.offsets.left)", "RC6325", "left"),
        ("print(self.parameters.offsets.left.vel)", "RC6325", "left"),
        ("print(self.parameters.offsets.get('a').velo)", "RC6306", "velo"),
        ("for name, motor in self.parameters.offsets.items():\n    print(motor.velo)", "RC6306", "velo"),
        ("print([motor.velo for motor in self.parameters.offsets.values()])", "RC6306", "velo"),
        ("print(self.parameters.device.uper())", "RC6325", "uper"),
        ("print(self.parameters.speed.value)", "RC6325", "value"),
        ("print(self.parameters.motors.append(other))", "RC6325", "append"),
        ("pose, age = self.mouth_proxy.where()\nprint(pose.gap)", "RC6325", "gap"),
        ("[pose, age] = self.mouth_proxy.where()\nprint(age.anything)", "RC6325", "anything"),
        ("pose, age = self.mouth_proxy.where()\nself.mouth_proxy.move(age, True)", "RC6328", "age"),
        ("self.mouth_proxy.move(self.mouth_proxy.where(), True)", "RC6328", "self.mouth_proxy.where()"),
        ("self.mouth_proxy.moveAsync(other)", "RC6304", "moveAsync"),
        ("print(self.mouth_proxy.moveAsync(other, True).result().gap)", "RC6325", "gap"),
        ("self.parameters.change({'speed': 'x'})", "RC6308", "'x'"),
        ("raise RoboCompMouth.Blocked('a', 2)", "RC6304", "Blocked"),
        ("raise RoboCompMouth.Blocked(reason='a')", "RC6305", "reason"),
        ("raise RoboCompMouth.Blocked(3)", "RC6328", "3"),
        ("for word in self.parameters.words:\n    if word == 3: pass", "RC6327", "3"),
        ("self.events.begin()", "RC6310", "begin"),
        ("print(self.statemachine.is_in('quiet'))", "RC6310", "quiet"),
    ],
)  # fmt: skip
def test_what_is_reported(link: Link, body: str, code: str, text: str) -> None:
    assert found(link(component("python", MACHINE)), worker(body)) == [(code, text)]


@pytest.mark.parametrize(
    "body",
    [
        "self.mouth_proxy.close()\nself.mouth_proxy.move(other, True)\nself.mouth_proxy.move(other, fast=True, context={})",
        "self.mouth_proxy.move(other, True, {})\nself.mouth_proxy.moveAsync(other, True).result()\nself.mouth_proxy.begin_close()",
        "self.mouth_proxy.ice_ping()\nself.mouth_proxy.ice_oneway().close()\nself.news_proxy.told('x')",
        "where = {'a': 'b'}\nself.mouth_proxy.close(where)\nself.mouth_proxy.close(other)\nself.mouth_proxy.close(None)",
        "self.mouth_proxy.close(dict(a='b'))\nself.mouth_proxy.close(other | {})\nself.mouth_proxy.close(self.parameters.offsets)",
        "self.mouth_proxy.move(None, 1)\nself.mouth_proxy.move(RoboCompMouth.Pose(1.5), not other)",
        "pose = RoboCompMouth.Pose()\npose.shape = RoboCompMouth.Shape.wide\npose.opening = 2",
        "self.log.exception('x')\nself.log.extra = 1\nself.log.getChild('a').info('x')",
        "dict = other\nself.mouth_proxy.move(dict(), True)",
        "self.mouth_proxy.move(*[1, True])\nself.mouth_proxy.move(**{})",
        "pose, age = self.mouth_proxy.where()\nboth = self.mouth_proxy.where()\nprint(both[0].opening, both.count(1))",
        "pose, *rest = self.mouth_proxy.where()\nprint(pose.gap)",
        "self.mouth = self.mouth_proxy\nself.mouth = Fake()\nself.mouth.anything()",
        "self.other.mouth = Fake()\nself.mouth = self.mouth_proxy\nself.mouth.anything()",
        "pose = RoboCompMouth.Pose()\npose.stamp = 3\nprint(pose.stamp, pose.opening, pose.__class__)",
        "pose = RoboCompMouth.Pose()\npose = None\nprint(pose.gap)",
        "print(self.mouth_proxy.way()[1:].copy(), self.parameters.motors[1:].copy(), self.mouth_proxy.way().index(1))",
        "for name in self.parameters.offsets:\n    print(name.upper())",
        "print([key.upper() for key in self.parameters.offsets], self.parameters.mode.upper())",
        "if self.parameters.mode == 'fast' or self.parameters.mode == '' or self.parameters.mode == other: pass",
        "if self.parameters.device == 'anything' or self.parameters.speed in (1, 2): pass",
        "match self.parameters.mode:\n    case 'slow': pass\n    case _: pass",
        "try:\n    self.mouth_proxy.close()\nexcept Ice.Exception as error:\n    print(error.anything)",
        "self.own_proxy = 1\nprint(self.own_proxy)",
        "self.mouth_proxy = Fake()\nself.mouth_proxy.anything()",
        "setattr(self, name, 1)\nprint(self.anything, self.a_proxy)",
        "self.__dict__.update(a=1)\nprint(self.a)",
        "vars(self)['a'] = 1\nprint(self.a)",
        "if hasattr(self, 'more_proxy'):\n    self.more_proxy.go()",
        "getattr(self.mouth_proxy, 'shut')()\nself.mouth_proxy.shut()",
        "loadUi('a.ui', self)\nprint(self.button)",
        "try:\n    self.mouth_proxy.shut()\nexcept AttributeError:\n    pass",
        "try:\n    self.mouth_proxy.move(1)\nexcept (TypeError, OSError):\n    pass",
        "with contextlib.suppress(AttributeError):\n    self.mouth_proxy.shut()",
        "if False:\n    self.mouth_proxy.shut()",
        "self = other\nself.mouth_proxy.shut()",
        "mouth = self.mouth_proxy\nmouth = other\nmouth.shut()",
        "for mouth in (self.mouth_proxy, other):\n    mouth.shut()",
        "def f(mouth=self.mouth_proxy):\n    mouth.shut()",
        "global mouth\nmouth = self.mouth_proxy\nmouth.shut()",
        "RoboCompMouth = other\nRoboCompMouth.Anything()",
        "print(RoboCompMouth.WIDEST, RoboCompMouth.MouthPrx, RoboCompMouth.Ear, RoboCompMouth.Shape.valueOf(1))",
        "print(RoboCompMouth.Pose(), RoboCompMouth.Pose(1), RoboCompMouth.Pose(opening=1, shape=RoboCompMouth.Shape.wide))",
        "print(self.parameters.motors[0].vel, self.parameters.camera.fps, self.parameters.period.compute)",
        "print(len(self.parameters.motors), self.parameters.offsets.items(), self.parameters.device.upper())",
        "self.parameters.camera.fps\nself.parameters.set('camera.fps', 3)\nself.parameters.set(path, 3)",
        "self.parameters.set('offsets.a.vel', 1)\nself.parameters.set('speed', None)\nself.parameters.set('motors.0.vel', 2)",
        "self.parameters.speed = 400\nself.parameters.speed += 1\nself.parameters.speed = speed",
        "self.parameters.listen(self.on_change)\nself.on_change = None",
        "self.events.start()\nself.events.stop(3)\nprint(self.statemachine.states, self.statemachine.is_in('talking'))",
        "print(self.log, self.mutex, self.communicator, self.getPeriod(), self._own, self.Ear_hear, self.sm_silent)",
        "class Other:\n    def f(self):\n        return self.anything\nprint(Other())",
        "self.setPeriod(100)\nself.setPeriod(other)\nself.setPeriod(period=20)\nself.setPeriod = other\nself.mayTake(2.5)",
        "with self.mutex:\n    self.mutex.acquire()\n    self.mutex.release()\n    call = self.getPeriod",
        "print(self.parameters.motors[-1].vel, self.parameters.device[0], self.parameters.offsets[path].vel)",
        "print(self.parameters.offsets.keys(), len(self.parameters.offsets), self.parameters.speed.bit_length())",
        "print(self.parameters.motors.index(other), self.parameters.words[0].title(), 'a' in self.parameters.words)",
        "left, right = self.parameters.offsets\nprint(left.title(), right.anything)",
        "(a, b), c = other\npose, age = self.mouth_proxy.where()\nage += 1\nprint(pose.opening, age.real, a.any, c.any)",
        "pose, *rest = self.mouth_proxy.where()\nfirst, second = self.mouth_proxy.way()\nprint(first.opening, rest.any)",
        "pose = RoboCompMouth.Pose()\npose.opening = other\nprint(pose.opening.item(), pose.shape.value)",
        "for pose in self.mouth_proxy.way():\n    print(pose.opening.real)\nfor key, value in other.items():\n    print(value.gap)",
        "future = self.mouth_proxy.moveAsync(other, True)\nprint(future.result().opening, future.done())",
        "self.mouth_proxy.moveAsync(other, True, {}).add_done_callback(print)",
        "raise RoboCompMouth.Blocked\nraise RoboCompMouth.Blocked('a')\nraise RoboCompMouth.Blocked(why=other)",
        "print('self.moth_proxy.close()')  # self.moth_proxy.close()",
    ],
)
def test_what_is_right_or_too_dynamic_to_know(link: Link, body: str) -> None:
    assert found(link(component("python", MACHINE)), worker(body)) == []


@pytest.mark.parametrize(
    "text",
    [
        "class SpecificWorker(GenericWorker, Foreign):\n    def compute(self):\n        self.a_proxy.go()\n",
        "class SpecificWorker(GenericWorker, metaclass=Meta):\n    def compute(self):\n        self.a_proxy.go()\n",
        "@decorated\nclass SpecificWorker(GenericWorker):\n    def compute(self):\n        self.a_proxy.go()\n",
        "class Mixin:\n    a_proxy = None\n\nclass SpecificWorker(Mixin, GenericWorker):\n    def compute(self):\n        self.a_proxy.go()\n",
        "class SpecificWorker(GenericWorker):\n    @property\n    def a_proxy(self):\n        return 1\n    def f(self):\n        self.a_proxy.go()\n",
        "class SpecificWorker(GenericWorker):\n    def __getattr__(self, name):\n        return 1\n    def f(self):\n        self.a_proxy.go()\n",
        "class SpecificWorker(GenericWorker):\n    @staticmethod\n    def f(self):\n        self.a_proxy.go()\n",
        "class Other:\n    def compute(self):\n        self.a_proxy.go()\n",
        "print 'Python 2'\nclass SpecificWorker(GenericWorker):\n    def f(self):\n        self.a_proxy.go()\n",
        "\x00",
        "",
    ],
)
def test_classes_that_are_not_known(link: Link, text: str) -> None:
    assert found(link(component("python")), {"specificworker.py": HEAD + text}) == []


@pytest.mark.parametrize("data", ["x = " + "1 + " * 5000 + "1", "x = " + "[" * 80 + "]" * 80, "x = a" + ".b" * 5000])
def test_deep_data_is_no_traceback(link: Link, data: str) -> None:
    files = worker("self.mouth_proxy.shut()", f"{data}\n")
    assert found(link(component("python")), files) in ([], [("RC6302", "shut")])


def test_a_secret_is_not_quoted(link: Link) -> None:
    documents = component("python")
    documents["x.pdsl.yaml"] += "  pin: {type: int, range: [1, 9], secret: true, optional: true, editable: true}\n"
    assert found(link(documents), worker("self.parameters.pin = 1234567")) == []


def test_all_files_that_the_worker_imports_are_read(link: Link) -> None:
    linked = link(component("python"))
    base = "\n\nclass Base(GenericWorker):\n    def helper(self):\n        self.mouth_proxy.shut()\n        self.later.go()\n"
    main = "from base import Base\n\n\nclass SpecificWorker(Base):\n    def compute(self):\n        self.later = 1\n"
    files = {"specificworker.py": main, "base.py": HEAD + base, "unused.py": "def f(:\n"}
    assert found(linked, files) == [("RC6302", "shut")]


def test_a_syntax_error_is_the_only_report(link: Link) -> None:
    files = worker("self.moth_proxy.close()\nif True")
    assert found(link(component("python")), files) == [("RC6317", "")]


@pytest.mark.parametrize(
    "body",
    ["print(1)\n   print(2)", "print(1)\n\tprint(2)", "f(a=1, 2)", "f() = 1", "break", "f(a=1, a=2)", "lambda a, a: 1"],
)
def test_syntax_errors_of_every_version_of_python(link: Link, body: str) -> None:
    files = worker("pass")
    files["specificworker.py"] += "        " + body.replace("\n", "\n        ") + "\n"
    assert [code for code, _ in found(link(component("python")), files)] == ["RC6317"]


@pytest.mark.parametrize("body", ["print 'Python 2'", "try: pass\n        except A, e: pass", "return"])
def test_syntax_of_other_versions_of_python(link: Link, body: str) -> None:
    files = worker("pass")
    files["specificworker.py"] += f"        {body}\n"
    assert found(link(component("python")), files) == []


@pytest.mark.parametrize(
    ("head", "reported"), [("from __future__ import annotations\n", []), ("", [("RC6314", "Path")])]
)
def test_a_sequence_has_no_class_but_in_annotations(link: Link, head: str, reported: list[tuple[str, str]]) -> None:
    text = head + HEAD + CLASS + "    def go(self, path: RoboCompMouth.Path) -> None:\n        pass\n"
    assert found(link(component("python")), {"specificworker.py": text}) == reported


@pytest.mark.parametrize(
    ("method", "code"),
    [("Ear_haer", "RC6312"), ("Ear_", "RC6312"), ("sm_silnet", "RC6311"), ("sm_help", ""), ("Nose_x", "")],
)
def test_methods_that_nobody_calls(link: Link, method: str, code: str) -> None:
    linked = link(component("python", MACHINE))
    text = HEAD + CLASS + f"    def {method}(self):\n        pass\n"
    assert found(linked, {"specificworker.py": text}) == ([(code, method)] if code else [])
    used = text + f"\n    def compute(self):\n        self.{method}()\n"
    assert found(linked, {"specificworker.py": used}) == []


ROBOCOMP = """\
from genericworker import *
import interfaces as ifaces


class SpecificWorker(GenericWorker):
    def __init__(self, proxy_map, configData, startup_check=False):
        super().__init__(proxy_map)
        {in_init}

    def setParams(self, params):
        {in_params}
        return True
"""


@pytest.mark.parametrize(
    ("in_init", "in_params", "reported"),
    [
        ("pass", "self.a = params['spede']", [("RC6309", "spede")]),
        ("self.a = configData['camera']['fsp']", "pass", [("RC6309", "fsp")]),
        ("self.a = configData['camera']['fps'] + configData['Period']['Compute']", "pass", []),
        ("pass", "self.a = params['speed'] + params['flat'] + params['Mouth.Endpoints'] + params['MouthProxy']", []),
        ("pass", "self.a = params['spede'] if 'spede' in params else 1", []),
        ("pass", "self.a = params.get('spede', 1)", []),
        ("pass", "self.a = params[name]", []),
        ("pass", "params['own'] = 1", []),
        ("self.button.clicked.connect(self.x)", "self.mouth_proxy.shut()", [("RC6302", "shut")]),
        ("self.nose_proxy = proxy_map['NoseProxy']", "self.nose_proxy.smell()", []),
        ("self.nose_proxy.smell()", "pass", [("RC6301", "nose_proxy")]),
        ("ifaces.RoboCompMouth.Pose(1)", "ifaces.Path([ifaces.RoboCompMouth.Pos()])", [("RC6314", "Pos")]),
        ("RoboCompMouth.Shape.oval", "Pose(1)", [("RC6315", "oval")]),
        ("ifaces.RoboCompNose.A()", "pass", [("RC6313", "RoboCompNose")]),
        ("pass", "self.params = params\n        self.a = self.params['spede']", [("RC6309", "spede")]),
        (
            "self.a = self.config['speed']",
            "self.config = params\n        self.a = self.config['fast']",
            [("RC6309", "fast")],
        ),
        ("pass", "self.a = params['mode'] == 'fasst'", [("RC6327", "'fasst'")]),
        ("self.a = configData['mode'] == 'fast' or configData['speed'] == '12'", "pass", []),
    ],
)
def test_code_for_robocomps_own_tool(link: Link, in_init: str, in_params: str, reported: list[tuple[str, str]]) -> None:
    linked = link(component("python", "compatibility: robocomp\n"))
    left = {"genericworker.py": "class GenericWorker: pass\n", "interfaces.py": "x = 1\n"}
    files = {"specificworker.py": ROBOCOMP.format(in_init=in_init, in_params=in_params), **left}
    assert found(linked, files, ("flat",)) == reported


@pytest.mark.parametrize(
    ("old", "new", "code", "text"),
    [
        ("pass  # here", "mouth_proxy.close()", "RC6321", "mouth_proxy"),
        ("pass  # here", "print(parameters.speed)", "RC6321", "parameters"),
        ("pass  # here", "print(lambda: log.info('ä'), news_proxy)", "RC6321", "log"),
        ("def compute(self)", "def compute()", "RC6322", "compute"),
        ("pass  # here", "self.mouth_proxy.close", "RC6323", "close"),
        ("pass  # here", "self.news_proxy.told", "RC6323", "told"),
        ("generated.genericworker", "generated.genericworkr", "RC6324", "genericworkr"),
        ("generated.genericworker", "generated.params", "RC6324", "params"),
        ("import GenericWorker", "import GenericWorkr as GenericWorker", "RC6324", "GenericWorkr"),
        ("pass  # here", "print(distence)", "RC6331", "distence"),
        ("pass  # here", "slef.mouth_proxy.close()", "RC6331", "slef"),
        ("pass  # here", "print(RoboCompMouth.Pose())", "RC6331", "RoboCompMouth"),
        ("pass  # here", "pass\n\n    def compute(self):\n        pass", "RC6332", "compute"),
        ("pass  # here", "pass\n\n    def __init__(self):\n        self.a = 1", "RC6333", "__init__"),
    ],
)
def test_slips(link: Link, old: str, new: str, code: str, text: str) -> None:
    reported = found(link(component("python")), {"specificworker.py": SLIPS.replace(old, new)})
    assert (code, text) in reported and {one for one, _ in reported} == {code}


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("class", "mouth_proxy = log = parameters = None\n\n\nclass"),
        ("class", "from helper import *\n\n\nclass"),
        ("class", "import log\n\n\nclass"),
        ("pass  # here", "for log in ():\n            log.info('x')"),
        ("pass  # here", "print(lambda mouth_proxy: mouth_proxy.close())"),
        ("pass  # here", "globals()['log'] = 1; log.info('x')"),
        ("def compute(self)", "@staticmethod\n    def compute()"),
        ("def compute(self)", "def compute(*all_of_them)"),
        ("pass  # here", "f = self.mouth_proxy.close; self.mouth_proxy; print(self.mouth_proxy.close)"),
        ("import GenericWorker", "import GenericWorker, Ice"),
        (
            "pass  # here",
            "global distance\n        distance = 3\n        print(distance, __file__, len(()), [x for x in ()])",
        ),
        ("pass  # here", "try:\n            print(unicode)\n        except NameError:\n            pass"),
        ("pass  # here", "later: Unknown = 3\n        print(later)"),
        ("pass  # here", "pass\n\n    def __init__(self, *a):\n        GenericWorker.__init__(self, *a)"),
        ("class", "from generated.runtime.kinds import Kind\n\n\nclass"),
        ("class", "from generated.interfaces import RoboCompMouth\n\n\nclass"),
        ("pass  # here", "self.parameters.speed = 3; self.speed = 4; self.speed"),
    ],
)
def test_no_slips(link: Link, old: str, new: str) -> None:
    assert found(link(component("python")), {"specificworker.py": SLIPS.replace(old, new, 1)}) == []


@pytest.mark.parametrize(
    ("body", "hint"),
    [
        ("time.sleep(1)", "write `import time`"),
        ("print(Path('a'))", "write `from pathlib import Path`"),
        ("print(GenericWorkr)", "did you mean 'GenericWorker'?"),
        ("print(token)", ""),
    ],
)
def test_the_import_that_a_name_lacks(link: Link, body: str, hint: str) -> None:
    linked = link(component("python"))
    part = linked.component.language.target.part("usage")
    offer = part.offer(linked)
    usage = part.read({"specificworker.py": SLIPS.replace("pass  # here", body)}, linked, offer)
    assert [one.hint for one in judge(linked, usage, offer)] == [hint]


def test_every_attribute_of_the_worker_is_known(link: Link) -> None:
    """What the run time's classes define, as their source says it."""
    templates = "robocomp_yaml/languages/python/templates"
    for path in ("runtime/worker.py", "qt/worker.py"):
        tree = ast.parse((ROOT / templates / path).read_text(encoding="utf-8"))
        (class_,) = (node for node in tree.body if isinstance(node, ast.ClassDef) and node.name.endswith("Worker"))
        methods = {node.name for node in class_.body if isinstance(node, ast.FunctionDef)}
        stored = {
            node.attr
            for node in ast.walk(class_)
            if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store)
        }
        assert {name for name in methods | stored if not name.startswith("_")} <= WORKER_ATTRIBUTES


def test_a_parameter_is_no_attribute_of_the_worker(link: Link) -> None:
    text = SLIPS.replace("pass  # here", "self.parameters.speed = self.speed + 3")
    assert found(link(component("python")), {"specificworker.py": text}) == [("RC6316", "speed")]


SLIPS = """\
from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def compute(self):
        pass  # here

    def Ear_hear(self, text):
        self.log.info(text)
"""


@pytest.mark.parametrize("call", ["self.mouth_proxy.clseAsync()", "self.mouth_proxy.begin()"])
def test_asynchronous_variants_are_those_of_the_methods(link: Link, call: str) -> None:
    name = call.partition("(")[0].rpartition(".")[2]
    reported = found(link(component("python")), {"specificworker.py": SLIPS.replace("pass  # here", call)})
    assert reported == [("RC6302", name)]
    right = SLIPS.replace("pass  # here", "self.mouth_proxy.closeAsync().result(); self.mouth_proxy.begin_close()")
    assert found(link(component("python")), {"specificworker.py": right}) == []
