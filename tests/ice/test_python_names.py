"""Odd names: every name that IDSL and Slice accept becomes Python that imports, runs and answers."""

from __future__ import annotations

import keyword

import pytest

from components import Build
from processes import Ports, Start

KEYWORDS = [word for word in keyword.kwlist if word != "class"]
ICE = ["print", "exec", "checkedCast", "uncheckedCast", "staticmethod"]
ATTRIBUTES = "compute initialize period log mutex communicator getPeriod setPeriod killYourSelf proxy".split()
BUILTINS = "c self cls current context list dict str id type super property match case result worker".split()
NAMES = [*KEYWORDS, *ICE, *ATTRIBUTES, *BUILTINS]

# Words that rcyaml warns of, because other Python programs may not be able to load the interface.
ALLOWED = {"rcyaml.yaml": "lint: {RC1006: off}\n"}

METHODS = "\n".join(f"      {name}: {{in: {{{name}: int, x: string}}, returns: string}}" for name in NAMES)
ODD = {
    **ALLOWED,
    "Odd.idsl.yaml": f"""\
module: RoboCompOdd
interfaces:
  Odd:
    methods:
      all: {{in: {{{", ".join(f"{name}: int" for name in NAMES)}}}, returns: int}}
{METHODS}
""",
    "s/s.cdsl.yaml": "component: Server\nlanguage: python\nimports: [Odd]\nimplements: [Odd]\n",
    "c/c.cdsl.yaml": "component: Caller\nlanguage: python\nimports: [Odd]\nrequires: [Odd]\n",
}
SERVER = f"""
from generated.genericworker import GenericWorker

class SpecificWorker(GenericWorker):
    def Odd_all(self, *numbers):
        return sum(numbers)

for name in {NAMES!r}:
    setattr(SpecificWorker, f"Odd_{{name}}", lambda self, n, x, name=name: f"{{name}} {{n}} {{x}}")
"""
CALLER = f"""
from generated.genericworker import GenericWorker

class SpecificWorker(GenericWorker):
    def initialize(self):
        assert self.odd_proxy.all(*range({len(NAMES)})) == {sum(range(len(NAMES)))}
        for name in {NAMES!r}:
            method = getattr(self.odd_proxy, "_" + name, None) or getattr(self.odd_proxy, name)
            answer = method(7, "ñ")
            assert answer == f"{{name}} 7 ñ", (name, answer)
        print("all answered")
"""


def test_methods_and_parameters(build: Build, start: Start, free_port: Ports) -> None:
    """Names of keywords, builtins, of Ice, and of the worker's attributes."""
    endpoint = f"tcp -h 127.0.0.1 -p {free_port()}"
    built = build(ODD)
    server = built["Server"].configure({"Odd.Endpoints": endpoint})
    caller = built["Caller"].configure({"OddProxy": f"odd:{endpoint}"})
    skeleton = start([*server.command, "--startup-check"])
    assert skeleton.exit_code() == 0, skeleton.output
    (server.root / "src" / "specificworker.py").write_text(SERVER)
    (caller.root / "src" / "specificworker.py").write_text(CALLER)
    start(server.command).wait_for("Server is running")
    start(caller.command).wait_for("all answered")


# A module in which everything has an odd name.
TYPES = """\
module: {module}
types:
  {enum}: {{enum: ["{first}", "{second}"]}}
  {struct}: {{struct: {{{first}: int, {second}: "{enum}", text: {{type: string, default: "as 'True' with"}}}}}}
  Many: {{sequence: {struct}}}
  Keyed: {{map: {{key: {struct}, value: "{enum}"}}}}
  Raw: {{sequence: byte}}
exceptions:
  {exception}: {{struct: {{{first}: string, {second}: bool}}}}
constants:
  yes: {{type: bool, value: true}}
interfaces:
  {interface}:
    doc: As is, with "quotes" and 'a lone one, async.
    methods:
      {first}:
        in: {{{first}: {struct}, b: Many}}
        returns: "{enum}"
        out: {{self: {struct}, keyed: Keyed, {second}: bool, bytes: Raw}}
        throws: [{exception}]
topics:
  {topic}:
    methods:
      {second}: {{in: {{{first}: {struct}, {second}: Keyed}}}}
"""
ECHO = """
from generated.component import COMPONENT
from generated.genericworker import GenericWorker
from generated.interfaces import {module} as module

Skeleton = __import__("skeleton").SpecificWorker
first, second = "{first}", "{second}"

def answer(self, value, several):
    if not several:
        raise module.{exception}("thrown", True)
    Skeleton.{interface_}_{first_}(self, value, several)
    return module.{enum}.{second}, value, {{value: module.{enum}.{first}}}, True, b"raw"

class SpecificWorker(Skeleton):
    {interface_}_{first_} = answer

    def compute(self):
        if hasattr(self, "done"):
            return
        self.done = True
        value = module.{struct}({first}=5, {second}=module.{enum}.{second})
        proxy = self.{accessor}
        result, same, keyed, flag, raw = proxy.{first}(value, [value])
        print("answer", result, same == value, keyed[value], flag, raw)
        try:
            proxy.{first}(value, [])
        except module.{exception} as error:
            print("thrown", error.{first}, error.{second}, error.ice_id())
        print("default", Skeleton.{interface_}_{first_}(self, value, [])[1].text)
"""


def python(name: str) -> str:
    """The names that Ice's mapping gives."""
    return f"_{name}" if keyword.iskeyword(name) or name == "print" else name


@pytest.mark.parametrize(
    "names",
    [
        "module=def enum=lambda struct=None exception=raise interface=pass topic=del first=in second=is",
        "module=as enum=True struct=nonlocal exception=await interface=with topic=async first=False second=print",
        "module=str enum=list struct=GenericWorker exception=Context interface=Worker topic=Method first=load second=x",
        "module=signal enum=time struct=log exception=Exceptions interface=logging topic=os first=name second=value",
        "module=generated enum=Set struct=P exception=Bad interface=Component topic=Required first=a second=valueOf",
    ],
    ids=["keywords", "forgotten keywords", "names in the generated files", "modules of Python", "our own package"],
)
def test_types_modules_and_interfaces(build: Build, start: Start, free_port: Ports, names: str) -> None:
    words = dict(pair.split("=") for pair in names.split())
    name = words["interface"]
    built = build(
        {
            **ALLOWED,
            "Odd.idsl.yaml": TYPES.format(**words),
            "o/o.cdsl.yaml": "component: Odd\nlanguage: python\nimports: [Odd]\n"
            f"implements: [{name}]\nrequires: [{name}]\n",
        }
    )["Odd"]
    endpoint = f"tcp -h 127.0.0.1 -p {free_port()}"
    built.configure({f"{name}.Endpoints": endpoint, f"{name}Proxy": f"{name.lower()}:{endpoint}"})
    assert start([*built.command, "--startup-check"]).exit_code() == 0
    source = built.root / "src"
    (source / "specificworker.py").rename(source / "skeleton.py")
    spelled = {key: python(word) for key, word in words.items()}
    spelled["module"] = "_str" if words["module"] == "str" else spelled["module"]
    worker = ECHO.format(**spelled, interface_=name, first_=words["first"], accessor=f"{name.lower()}_proxy")
    (source / "specificworker.py").write_text(worker)
    running = start(built.command).wait_for("default as 'True' with\n")
    assert f"answer {words['second']} True {words['first']} True b'raw'\n" in running.output
    assert f"thrown thrown True ::{words['module']}::{words['exception']}\n" in running.output
