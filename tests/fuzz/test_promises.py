"""What SECURITY.md promises: `check`, `compile` and `migrate` run nothing that documents say, and write nothing outside,
whatever a workspace holds that somebody else made."""

from __future__ import annotations

import json
import os
import re
import stat
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from conftest import ROOT, Tree, read_tree, write_tree
from robocomp_yaml.diag.codes import table
from robocomp_yaml.legacy import grammar, reading
from robocomp_yaml.link import deployment_documents
from robocomp_yaml.parameters.patterns import pattern
from robocomp_yaml.parameters.resolution import resolve as parameters
from robocomp_yaml.parameters.specification import expression
from robocomp_yaml.source import composed, syntax, text, xml

SPEECH = "module: RoboCompSpeech\ninterfaces: {Speech: {methods: {say: {in: {text: string}}}}}\n"
COMPONENT = "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n"
ROBOT: Tree = {"rcyaml.yaml": "interfaces: [.]\n", "Speech.idsl.yaml": SPEECH, "speech/speech.cdsl.yaml": COMPONENT}
VICTIM: Tree = {
    "settings.json": "{}\n", "mine.py": "print('mine')\n", "generated/main.py": "mine\n", "etc/config": "mine = 1\n",
    "arm.cdsl.yaml": "component: ArmComp\nlanguage: python\n", "schemas/idsl.schema.json": "mine\n", "other.idsl.yaml": SPEECH,
}  # fmt: skip
EVIL = "open('EXECUTED', 'w').write('x')"
PYTHON = "import os\nopen(os.path.join(os.path.dirname(__file__), 'EXECUTED'), 'w').write('x')\n"
JOURNAL = {
    "marks": [
        {
            "path": "../victim/mine.py",
            "new": "",
            "old": "../victim/.rcyaml-1-1.old",
            "orig": "",
            "hash": "",
            "created": True,
        }
    ],
    "folders": ["../victim/etc"],
}
MANIFEST = {"version": 1, "files": {name: {"hash": "0", "owners": ["gone.cdsl.yaml"]} for name in
                                    ("../victim/mine.py", "/etc/hostname", "speech/../../victim/mine.py")}}  # fmt: skip
SMALL_CPP = COMPONENT.replace("python", "cpp")
HOSTILE: dict[str, Tree] = {
    "a YAML tag": {"x.idsl.yaml": f"module: !!python/object/apply:os.system [{EVIL!r}]\n"},
    "a template in texts": {**ROBOT, "Speech.idsl.yaml": SPEECH + "doc: \"{{ ''.__class__.__mro__ }} {% include '/etc/passwd' %}\"\n"},
    "modules beside the documents": {**ROBOT, **dict.fromkeys((
        "yaml.py", "click.py", "jinja2.py", "robocomp_yaml.py", "sitecustomize.py", "conftest.py", "setup.py", "speech/Ice.py",
    ), PYTHON)},
    "code in a parameter": {**ROBOT, "speech/speech.pdsl.yaml": (
        "component: speech.cdsl.yaml\nparameters: {a: {type: int, default: 1}}\n"
        f"constraints: [\"__import__('os').system('touch EXECUTED')\", \"{EVIL}\", \"a.__class__\"]\n"
    )},
    "a script in a state machine": {**ROBOT, "speech/m.scxml": (
        '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" initial="a"><script src="evil.js"/><state id="a"><onentry>'
        f'<script>{EVIL}</script><assign location="x" expr="__import__(\'os\')"/><invoke type="http" src="http://x"/></onentry>'
        '<transition cond="system(\'x\')" target="a"/></state></scxml>'
    ), "speech/speech.cdsl.yaml": COMPONENT + "statemachine: m.scxml\n"},
    "an external entity": {"m.scxml": '<!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/passwd">]><scxml>&e;</scxml>',
                           "c.cdsl.yaml": "component: C\nlanguage: python\nstatemachine: m.scxml\n"},
    "CMake's own words": {**ROBOT, "speech/speech.cdsl.yaml": SMALL_CPP + (
        'uses: {libraries: [{cmake: OpenCV, doc: "x\\nexecute_process(COMMAND touch EXECUTED)"}, {link: "m)\\nexecute_process("}],'
        ' sources: [../../victim/mine.py]}\n'
    )},
    "slice goes elsewhere": {**ROBOT, "rcyaml.yaml": "interfaces: [.]\noutput: {slice: ../victim}\n"},
    "slice goes to an absolute path": {**ROBOT, "rcyaml.yaml": "interfaces: [.]\noutput: {slice: VICTIM}\n"},
    "slice goes through a link": {**ROBOT, "rcyaml.yaml": "interfaces: [.]\noutput: {slice: out}\n", "out": "-> ../victim"},
    "a link in the place of slice": {**ROBOT, "slice": "-> ../victim"},
    "a link in the place of generated": {**ROBOT, "speech/generated": "-> ../../victim/generated"},
    "a link in the place of a generated file": {**ROBOT, "speech/etc/config": "-> ../../../victim/etc/config"},
    "a link in the place of the state": {**ROBOT, ".rcyaml": "-> ../victim", "speech/.rcyaml": "-> ../../victim"},
    "a link in the place of the schemas": {**ROBOT, ".rcyaml/schemas": "-> ../../victim/schemas"},
    "a link in the place of a schema": {**ROBOT, ".rcyaml/schemas/idsl.schema.json": "-> ../../../victim/settings.json"},
    "a link in the place of the editor's settings": {**ROBOT, ".vscode": "-> ../victim"},
    "a component that is a link": {**ROBOT, "arm": "-> ../victim", "r.ddsl.yaml": "deployment: R\ncomponents: {arm: {component: arm/arm.cdsl.yaml}}\n"},
    "a component elsewhere": {**ROBOT, "r.ddsl.yaml": "deployment: R\ncomponents: {arm: {component: ../victim/arm.cdsl.yaml}}\n"},
    "parameters of a component elsewhere": {**ROBOT, "x.pdsl.yaml": "component: ../victim/arm.cdsl.yaml\nparameters: {a: int}\n"},
    "values of a component elsewhere": {**ROBOT, "x.config.yaml": "component: ../victim/arm.cdsl.yaml\nparameters: {}\n"},
    "an interface elsewhere": {**ROBOT, "speech/speech.cdsl.yaml": COMPONENT.replace("[Speech]", "[../../victim/other]", 1)},
    "names with paths": {**ROBOT, "a.idsl.yaml": "module: ../../victim/mine\n", "b.cdsl.yaml": "component: ../victim/x\nlanguage: python\n",
                         "c.config.yaml": "component: speech/speech.cdsl.yaml\nlegacy: {file: ..}\n"},
    "a legacy file above": {**ROBOT, "speech/etc/config.yaml": "component: ../speech.cdsl.yaml\nlegacy: {file: ..}\n"},
    "a journal of a commit that never was": {**ROBOT, **{f"{folder}.rcyaml/journal.{end}": json.dumps(JOURNAL)
                                                         for folder in ("", "slice/", "speech/") for end in ("json", "done")}},
    "a manifest of files that are not ours": {**ROBOT, **{f"{folder}.rcyaml/{name}": json.dumps(MANIFEST)
                                                          for folder in ("", "slice/", "speech/") for name in ("manifest.json", "migrated.json")}},
    "legacy files with code": {
        "a.xml": '<!DOCTYPE r [<!ENTITY e SYSTEM "file:///etc/passwd">]><rcmanager><node alias="&e;"/></rcmanager>',
        "b.xml": '<rcmanager><node alias="x" endpoint="x:tcp -p 1"><upCommand command="$(touch EXECUTED); `touch EXECUTED`"/>'
                 '<workingDir path="../victim"/><configFile path="../victim/etc/config"/></node></rcmanager>',
        "c/etc/config": "a = $(touch EXECUTED)\nb = ${env:HOME}\n",
        "d.cdsl": 'import "../victim/other.idsl";\nComponent X { Communications { implements Speech; }; language python; statemachine "../victim/m.smdsl"; };\n',
        "m.smdsl": "../../victim/x{\n states a;\n initial_state a;\n};\n", "link.idsl": "-> ../victim/mine.py", "folder": "-> ../victim",
    },
    "a link in the place of a document": {
        "Speech.idsl": "module M\n{\n interface Speech { void say(); };\n};\n", "Speech.idsl.yaml": "-> ../victim/mine.py",
        ".rcyaml/migrated.json": "-> ../../victim/settings.json",
    },
}  # fmt: skip
COMMANDS = ("check .", "migrate .", "compile .", "graph . --as svg", "compile .")


def watched(lines: tuple[str, ...], robot: Path) -> dict[str, Any]:
    """What runs of rcyaml did, in the folder of somebody's robot, with an environment that has everything there."""
    report = robot.parent / "report.json"
    environment = {
        **os.environ, "HOME": str(robot.parent / "home"), "XDG_CACHE_HOME": str(robot.parent / "cache"), "WATCHED": str(report),
        "PYTHONDONTWRITEBYTECODE": "1", "TMPDIR": str(robot.parent / "tmp"),
    }  # fmt: skip
    script = str(Path(__file__).with_name("watched.py"))
    done = subprocess.run(
        [sys.executable, script, *lines], cwd=robot, env=environment, capture_output=True, text=True, timeout=120
    )
    assert report.is_file(), done.stderr
    found: dict[str, Any] = json.loads(report.read_text())
    report.unlink()
    assert set(found["codes"]) <= {0, 1, 2, None} and len(found["codes"]) == len(lines), done.stderr
    return found


@pytest.mark.parametrize("name", HOSTILE)
def test_nothing_is_run_and_nothing_is_written_outside(name: str, tmp_path: Path) -> None:
    for folder in ("home", "cache", "tmp"):
        (tmp_path / folder).mkdir()
    victim = write_tree(tmp_path / "victim", VICTIM)
    robot = tmp_path / "robot"
    robot.mkdir()
    write_tree(robot, {path: text.replace("VICTIM", str(victim)) if isinstance(text, str) else text
                       for path, text in HOSTILE[name].items()})  # fmt: skip
    mine = [str(robot), str(tmp_path / "cache" / "rcyaml")]
    did = watched(COMMANDS, robot)
    assert did["started"] == []
    outside = [path for path in did["written"] if not any(path == own or path.startswith(f"{own}/") for own in mine)]
    assert outside == []
    assert [path for path in did["modules"] if path.startswith(str(tmp_path))] == []
    assert read_tree(victim) == VICTIM
    assert not list(tmp_path.rglob("EXECUTED"))
    assert [*(tmp_path / "home").iterdir(), *(tmp_path / "tmp").iterdir()] == []


READ_ALONG = (
    "speech/etc/config", "speech/src/specificworker.py", "speech/.rcyaml/manifest.json", "speech/generated/main.py",
    "slice/.rcyaml/manifest.json", ".rcyaml/migrated.json", ".vscode/settings.json", ".rcyaml/schemas/idsl.schema.json",
    "old/src/specificworker.cpp", "old/src/specificworker.py",
)  # fmt: skip


@pytest.mark.parametrize("how", ["pipe", "endless", "socket"])
def test_what_never_ends_is_not_waited_for(how: str, tmp_path: Path) -> None:
    robot = write_tree(tmp_path / "robot", {**ROBOT, "old/old.cdsl": "Component Old { language Python; };\n"})
    for name in READ_ALONG:
        (robot / name).parent.mkdir(parents=True, exist_ok=True)
        if how == "pipe":
            os.mkfifo(robot / name)
        elif how == "endless":
            (robot / name).symlink_to("/dev/zero")
        else:
            os.mknod(robot / name, stat.S_IFSOCK | 0o600)
    (tmp_path / "tmp").mkdir()
    did = watched(("check .", "migrate .", "compile .", "config new speech", "graph ."), robot)
    assert did["started"] == []


def test_the_watch_sees(tmp_path: Path) -> None:
    """A write outside would be found: that of the templates' cache is."""
    robot = write_tree(tmp_path / "robot", ROBOT)
    (tmp_path / "tmp").mkdir()
    did = watched(("compile .",), robot)
    assert any(path.startswith(str(tmp_path / "cache" / "rcyaml")) for path in did["written"])
    assert any(path.startswith(str(robot / "speech" / "generated")) for path in did["written"])


LIMITS = {
    "a document": text.MAX_DOCUMENT >> 20, "a legacy file": reading.MAX_SOURCE >> 20, "one text in a document": text.MAX_SCALAR >> 20,
    "nesting of YAML": syntax.MAX_DEPTH, "nesting of XML": xml.MAX_DEPTH, "nesting of a legacy file": grammar.MAX_DEPTH,
    "values that aliases repeat": composed.MAX_ALIASED, "elements of an XML file": xml.MAX_ELEMENTS,
    "attributes of one element of XML": xml.MAX_ATTRIBUTES,
    "plain values of a component's parameters": parameters.MAX_VALUES, "types inside of types": parameters.MAX_DEPTH,
    "a constraint": expression.MAX_LENGTH, "nesting of a constraint": expression.MAX_DEPTH, "a count in a `pattern:`": pattern.MAX_COUNT,
    "sum of all counts of a `pattern:`": pattern.MAX_SIZE,
    "processes of a deployment": deployment_documents.MAX_INSTANCES,
    "nested includes": deployment_documents.MAX_DEPTH,
}  # fmt: skip


def test_the_limits_are_those_that_are_told() -> None:
    page = (ROOT / "SECURITY.md").read_text(encoding="utf-8")
    told = re.findall(r"^\| ([^|]+) \| ([0-9][0-9,]*)[^|]* \| (RC\d{4}|rejected) \|$", page, re.MULTILINE)
    assert {what: int(number.replace(",", "")) for what, number, _ in told} == LIMITS
    assert {code for _, _, code in told if code != "rejected"} <= set(table())
