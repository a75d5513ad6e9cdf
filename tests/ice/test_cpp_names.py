"""Odd names: every name that IDSL and Slice accept becomes C++ that compiles without warnings, runs and answers."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from components import build
from cpp_programs import FAST, Program, cmake, locked, needs_cpp
from processes import Ports, Start
from robocomp_yaml.languages.cpp.names import ICE_ESCAPES, ice_name

SLICE = set("bool class const double enum false float int long module short struct true void".split())
# Words of C++, present and past, and names that Ice's code or generated code uses.
OTHERS = """
    char8_t co_await co_return co_yield concept consteval constinit final import module override
    begin checkedCast clear cb context current current_ data describe end ex exc identity name operation response
    result sent size std this uncheckedCast value runtime robocomp worker worker_ servant services connections
    log mutex communicator compute initialize connect run stop start getPeriod setPeriod killYourSelf
    SpecificWorker GenericWorker unionServant proxy shared_ptr string_view vector set map function linux unix
""".split()
# The interface of the test below is called `union`, which its methods cannot be.
NAMES = sorted(name for name in {*ICE_ESCAPES, *OTHERS} - SLICE - {"union"} if not name.endswith("_"))


@pytest.mark.skipif(
    shutil.which("slice2cpp") is None, reason="slice2cpp is not installed (Debian: zeroc-ice-compilers)"
)
def test_what_ice_escapes(tmp_path: Path) -> None:
    names = sorted({*ICE_ESCAPES, *OTHERS})
    members = "".join(f"int \\{name};\n" for name in names if not name.endswith("_"))
    (tmp_path / "K.ice").write_text(f'[["underscore"]]\nmodule M {{ struct S {{\n{members}}}; }};\n')
    subprocess.run(["slice2cpp", "K.ice"], cwd=tmp_path, check=True)
    assert set(re.findall(r"\b_cpp_(\w+);", (tmp_path / "K.h").read_text())) == ICE_ESCAPES


METHODS = "".join(f"      {name}: {{in: {{{name}: int, x: string}}, returns: string}}\n" for name in NAMES)
DOCUMENTS = {
    "Odd.idsl.yaml": f"""\
module: namespace
types:
  and: {{enum: [or, not, xor]}}
  operator: {{struct: {{while: int, for: and, text: {{type: string, default: "a \\\\ and \\" in it"}}}}}}
  template: {{sequence: operator}}
  auto: {{map: {{key: string, value: and}}}}
exceptions:
  typename: {{struct: {{try: operator}}}}
interfaces:
  union:
    methods:
      all: {{in: {{{", ".join(f"{name}: int" for name in NAMES)}}}, returns: int}}
{METHODS}
  volatile:
    methods:
      given: {{in: {{log: and, mutex: template}}, out: {{this: operator, using: auto}}, returns: and, throws: [typename]}}
topics:
  goto:
    methods:
      if: {{in: {{goto: operator}}}}
""",
    # In a folder with a header's name, as a file with a header's name.
    "string.idsl.yaml": "module: RoboCompString\nimports: [Odd]\ntypes:\n  time: {struct: {of: Odd.operator}}\n",
    "odd/odd.cdsl.yaml": """\
component: test
doc: |
  Odd, with a backslash \\
  and */ more /* of it
language: cpp
imports: [Odd, string]
implements: [union, volatile]
requires:
  - {this: {interface: union, absent: ignore}}
  - {delete: {interface: volatile, absent: ignore}}
publishes: [goto]
subscribes: [goto]
""",
    "rcyaml.yaml": "lint: {RC1006: off}\n",  # words that are odd in Python
}

BODIES = "".join(
    f"std::string SpecificWorker::union_{name}(int number, const std::string& x)\n{{\n"
    f'    return "{name} " + std::to_string(number) + " " + x;\n}}\n'
    for name in NAMES
)
CALLS = "".join(
    f'    said = this_proxy->{ice_name(name)}(7, "n");\n    complain(said == "{name} 7 n", "{name}: " + said);\n'
    for name in NAMES
)
WORKER = f"""
#include "specificworker.h"

#include <iostream>

using namespace _cpp_namespace;

namespace
{{
void complain(bool isRight, const std::string& text)
{{
    if (!isRight)
    {{
        std::cout << "wrong: " << text << std::endl;
    }}
}}
}}

void SpecificWorker::initialize() {{}}

void SpecificWorker::compute()
{{
    std::string said;
{CALLS}
    complain(this_proxy->all({", ".join(map(str, range(len(NAMES))))}) == {sum(range(len(NAMES)))}, "all");
    _cpp_operator given;
    _cpp_auto keyed;
    complain(delete_proxy->given(_cpp_and::_cpp_or, {{{{}}, {{}}}}, given, keyed) == _cpp_and::_cpp_not, "given");
    complain(given._cpp_while == 2 && keyed.at("a") == _cpp_and::_cpp_xor, "outs");
    try
    {{
        delete_proxy->given(_cpp_and::_cpp_or, {{}}, given, keyed);
    }}
    catch (const _cpp_typename& thrown)
    {{
        complain(thrown._cpp_try.text == "a \\\\ and \\" in it", thrown._cpp_try.text);
        goto_pubproxy->_cpp_if(given);
    }}
    setPeriod(60000);
}}

int SpecificWorker::union_all({", ".join("int" for _ in NAMES)})
{{
    return {sum(range(len(NAMES)))};
}}

_cpp_and SpecificWorker::volatile_given(_cpp_and, const _cpp_template& several, _cpp_operator& first, _cpp_auto& second)
{{
    if (several.empty())
    {{
        throw _cpp_typename(_cpp_operator());
    }}
    first = {{}};
    first._cpp_while = static_cast<int>(several.size());
    second["a"] = _cpp_and::_cpp_xor;
    return _cpp_and::_cpp_not;
}}

void SpecificWorker::goto_if(const _cpp_operator& given)
{{
    std::cout << "gone " << given._cpp_while << std::endl;
}}

{BODIES}
"""


@pytest.mark.slow
@needs_cpp
def test_odd_names(tmp_path: Path, start: Start, free_port: Ports, icestorm: object) -> None:
    """The skeleton compiles; so does a worker that calls itself through a proxy named `this`."""
    odd = Program("test", build(DOCUMENTS, tmp_path)["test"].root)
    source = odd.root / "src" / "specificworker.cpp"
    (odd.root / "src" / "skeleton.cpp").write_text(source.read_text().replace("SpecificWorker::", "Skeleton::"))
    header = (odd.root / "src" / "specificworker.h").read_text().replace("class SpecificWorker", "class Skeleton")
    (odd.root / "src" / "skeleton.h").write_text(header)
    skeleton = odd.root / "src" / "skeleton.cpp"
    skeleton.write_text(skeleton.read_text().replace('"specificworker.h"', '"skeleton.h"'))
    source.write_text(WORKER)
    with locked(tmp_path / "lock"):
        cmake(odd.root, *FAST)
    endpoint = f"tcp -h 127.0.0.1 -p {free_port()}"
    manager = icestorm.manager  # type: ignore[attr-defined]
    other = f"tcp -h 127.0.0.1 -p {free_port()}"
    properties = {"union.Endpoints": endpoint, "volatile.Endpoints": other, "TopicManager.Proxy": manager}
    properties.update(thisProxy=f"union:{endpoint}", deleteProxy=f"volatile:{other}")
    running = start(odd.command(tmp_path, properties)).wait_for("gone 2\n")
    assert "wrong" not in running.output and "ERROR" not in running.output
    assert running.stop() == 0
