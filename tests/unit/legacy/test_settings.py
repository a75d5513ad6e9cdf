"""Flat configs as documents of parameters and values: each case is one rule, with the documents that it implies."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml import api
from robocomp_yaml.api.migrating import Migration
from robocomp_yaml.commands.migrate import _table
from robocomp_yaml.diag.diagnostic import ERROR
from robocomp_yaml.diag.render.text import render
from robocomp_yaml.legacy.settings.corrections import CorrectionError, read_corrections
from robocomp_yaml.legacy.settings.plan import Corrections

Golden = Callable[[str, Mapping[str, str]], None]

SPEECH = "module RoboCompSpeech { interface Speech { void say(string text); }; interface News { void told(string text); }; };\n"
CDSL = (
    'import "Speech.idsl";\nComponent SpeechComp { Communications { implements Speech; requires Speech; '
    "publishes News; }; language python; };\n"
)

CASES: dict[str, tuple[str, ...]] = {
    "rows count from zero or from one": (
        "M0 = a,1,true\nM1 = b,2,false\nJoint_1 = x, 0.5\nJoint_2 = y, 1.5\nJoint_3 = z, 2\n",
    ),
    "rows whose numbers have gaps carry their number": ("Cam3 = front,640\nCam17 = back,320\nOther = 1\n",),
    "numbers with gaps are not rows if another key starts the same": ("Cam3 = front,640\nCam17 = back,320\nCamera = 1\n",),
    "a leading zero of a key is kept": ("M00 = a,1\nM01 = b,2\n",),
    "rows of different lengths are texts": ("Row0 = a,1\nRow1 = b,2,3\n",),
    "a longer row in another config has optional columns": ("M0 = a,1\nM1 = b,2\n", "M0 = a,1,5\n"),
    "configs that disagree about columns keep texts": ("# name,most\nM0 = a,1\n", "# most,title,third\nM0 = 1,b,c\n"),
    "the comment above names the columns": ("# name (its name),min angle (rad),max\nM0 = a,1,2\nM1 = b,1,2\n",),
    "a comment with a label names the columns": ("# Motors: name, id, speed\nMotor0 = a,1,2.5\nMotor1 = b,2,3\n",),
    "well-known rows have their usual columns": ("Motor0 = a,1,1,0,1,0,2.5\nMotor1 = b,2,-1,0,1,0,2.5\n",),
    "prose above rows names no columns": ("# this is for the two\nM0 = a,1,2,3,4\nM1 = b,1,2,3,4\n",),
    "a comment far above names nothing": ("# name,most\n" + "\n" * 30 + "M0 = a,1\nM1 = b,2\n",),
    "a column that is named twice gets a number": ("# x,y,x\nM0 = 1,2,3\nM1 = 1,2,3\n",),
    "blanks behind commas are kept": ("M0 = a, 1, 2\nM1 = b, 3, 4\nN0 = a,1\nN1 = b,2\n",),
    "ranges": ("ID:0-10 = 100 # size\nID:11-20 = 200 # size\nOther:1-2 = 5\n",),
    "a range with commas is not a range": ("ID:0-10 = 100,5\n",),
    "fields with the same numbers are one list": ("rx_0 = 1\nry_0 = 2\nrx_1 = 3.5\nry_1 = 4\n",),
    "a count names the list of fields": ("num_cameras = 1\nname_0 = front\nwidth_0 = 640\n",),
    "the first three of many fields name the list": (
        "a0 = 1\nb0 = 2\nc0 = 3\nd0 = 4\na1 = 1\nb1 = 2\nc1 = 3\nd1 = 4\n",
    ),
    "a count is for its own group": (
        "num_cams = 1\ncam.name0 = a\ncam.size0 = 1\ncam.num_eyes = 1\n", "num_cams = 1\ncam.name0 = a\ncam.size0 = 2\n",
    ),
    "comments above the first field belong to the record": (
        "# the first\nx0 = 1 # ahead\ny0 = 2\n# the second\nx1 = 1\n# its y\ny1 = 2\n",
    ),
    "commas in brackets do not separate names": ("# name (short, please), size (m, cm)\nM0 = a,1\nM1 = b,2\n",),
    "records of the same shape share a struct only with the same name": (
        "Left0 = a,1\nLeft1 = b,2\nRight0 = a,1\nRight1 = b,2\ng.Left0 = a,1\ng.Left1 = b,1\n",
    ),
    "a list in one config and a text in another": ("A = a,b,c\nM0 = a,1\nM1 = b,2\n", "A = {x}\nM0 = x\n"),
    "a single field is not a list of records": ("name_0 = front\nwidth = 640\n",),
    "fields in groups remain in them": ("cams.x0 = 1\ncams.y0 = 2\ncams.x1 = 3\ncams.y1 = 4\n",),
    "lists": (
        "Names = a,b,c\nPairs = a,1;b,2\nEnded = a;b;\nTwo = a,b\nComma = 0,5\nPath = /a b, c\nUrl = http://a,b,c\n"
        "Empty = ,\nSpaced = a, b, c\n",
    ),
    "a list in one config is a list in all": ("Names = a,b,c\n", "Names = a\n", "Names =\n"),
    "plain values": (
        "Ba = true\nBb = False\nBc = on\nIa = 0\nIb = -5\nIc = 2147483647\nId = 2147483648\nIe = 9223372036854775808\n"
        "Fa = 1.\nFb = .5\nFc = 1e5\nFd = 1e39\nFe = 1e400\nZa = 007\nZb = -0\nZc = +3\nTa = 1.2.3\nTb = 0x1F\n",
    ),
    "the smallest type that fits all configs": (
        "A = 1\nB = 1\nC = true\nD = 3000000000\nE = 1\nF = x\n", "A = 1.5\nB = x\nC = 1\nD = 0.5\nE = 3000000000\nF = y\n",
    ),
    "a parameter that is missing in one config is optional": ("A = 1\nB = x\nC =\n", "A = 2\n", "A = 3\nB = \n"),
    "names that are not legal in code": ("a-b = 1\na.b-c = 2\n2d = 3\nclass = 4\na_b = 5\n",),
    "a parameter and a group with the same name": ("a = 1\na.b = 2\na.c = 3\n",),
    "groups": ("Arm.Left.x = 1\nArm.Left.y = 2\nArm.name = a\n",),
    "periods": ("Period = 50\nPeriod.Compute = 20\nx = 1\n",),
    "connections and properties of Ice": (
        "Speech.Endpoints = tcp -p 10001\nSpeechProxy = speech:tcp -h localhost -p 10002\nCamProxy = cam:tcp -p 3\n"
        "viewer = viewer:tcp -p 4\nTopicManager.Proxy = IceStorm/TopicManager:default -p 9999\nNews = News\n"
        "NewsTopic = Daily\nIce.Warn.Connections = 0\nIceStorm.Trace = 1\n"
        "InnerModelPath = a.xml\nSpeech = other\n",
    ),
    "flat TOML is detected by its keys": (
        "Endpoints.Speech = tcp -p 10001\nProxies.Speech = speech:tcp -p 2\nProxies.SpeechPrefix = robot1\n"
        "Proxies.TopicManager = IceStorm/TopicManager:default -p 9999\nIce.Warn.Connections = 0\nArm.n = 1\nx = a b\n",
    ),
    "settings that are not valid in documents remain properties": (
        "Speech.Endpoints = nothing\nSpeech.Endpoints.x = 1\nIce = 1\nIce. = 2\n.Endpoints = tcp\nProxy = a:tcp -p 1\n"
        "a..b = 1\n.c = 2\nd. = 3\nx y = 4\nImplicit.x = \n" + "a" + ".b" * 30 + " = 5\nk{i} = 6\nsize = 7\nm.size = 8\nm.0 = 9\n",
    ),
    "references are kept": ("key = ${env:KEY}\nother = ${file:a}\n",),
}  # fmt: skip


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("rule", CASES)
def test_flat_configs(rule: str, golden: Golden) -> None:
    names = ("config", "config_a", "config_b")
    files = {f"speech/etc/{name}": text for name, text in zip(names, CASES[rule], strict=False)}
    write_tree(Path(), {"interfaces/Speech.idsl": SPEECH, "speech/speech.cdsl": CDSL, **files})
    golden(f"settings/{rule.replace(' ', '-')}", migrated())


def migrated(corrections: Corrections = Corrections()) -> dict[str, str]:
    """Return the documents of parameters and values, and what is reported of configs. Nothing is written; `check` has
    nothing against what would be."""
    migration = Migration(["."], None, (), guesses=corrections)
    lines = [*map(str, render(migration.diagnostics, None, False)), *_table(migration.run)]
    told = "".join(f"{line}\n" for line in lines if "config" in line or "guessed" in line)
    documents = dict(planned(migration))
    checked = api.load(overlay={os.path.abspath(path): text for path, text in documents.items()}).check()
    assert not [one for one in checked if one.severity == ERROR or one.code == "RC0062"]
    own = [path for path in sorted(documents) if path.endswith(("pdsl.yaml", "config.yaml"))]
    return {"said.txt": told, **{os.path.basename(path): documents[path].partition("\n")[2] for path in own}}


def planned(migration: Migration) -> Iterator[tuple[str, str]]:
    """Yield the path in the working folder and the text of each file that would be written."""
    for root in migration.run.roots.values():
        yield from ((root.root.shown(output.path), output.text) for output in root.outputs)


TOML = """\
# at the top
Title = "it"
n = 5
list = [1, 2.5]
texts = ["a", "b"]
on = true

[Endpoints]
Speech = "tcp -p 10001"  # here
[Proxies]
Speech = "speech:tcp -p 2"
TopicManager = "IceStorm/TopicManager:default -p 9999"
NewsPrefix = "robot1"
[Ice]
Warn.Connections = 0
[Arm]
name = "left"
joints = [{name = "a", most = 1.5}, {name = "b", most = 2}]
"""


def test_a_config_in_toml(golden: Golden) -> None:
    files = {"speech/etc/config.toml": TOML}
    write_tree(Path(), {"interfaces/Speech.idsl": SPEECH, "speech/speech.cdsl": CDSL, **files})
    golden("settings/toml", migrated())


RULES = "names: {M: [name, most]}\ntypes: {A: float, B.c: string}\ntext: [Zip]\n"


def test_corrections_of_the_user(golden: Golden) -> None:
    config = "M0 = a,1\nM1 = b,2\nN0 = a,1\nN1 = b,2\nA = 1\nB.c = 5\nZip = 1,2,3\n"
    files = {"speech/etc/config": config, "rules.yaml": RULES}
    write_tree(Path(), {"interfaces/Speech.idsl": SPEECH, "speech/speech.cdsl": CDSL, **files})
    golden("settings/corrected", migrated(read_corrections(["N=title,count"], "rules.yaml")))


@pytest.mark.parametrize(
    ("names", "rules", "problem"),
    [
        ("M", None, "--names requires KEY=a,b,c, not 'M'"),
        ("=a,b", None, "--names requires KEY=a,b,c, not '=a,b'"),
        ("M=a,2d", None, "--names M must be a list of names, which consist of letters, digits and underscores"),
        ("M=a,,b", None, "--names M must be a list of names, which consist of letters, digits and underscores"),
        ("M=a,b,a", None, "--names M has the same name twice"),
        ("", "- a\n", "rules.yaml is not a YAML mapping with the keys names, types and text"),
        ("", "a: [\n", "rules.yaml is not a YAML mapping with the keys names, types and text: "),
        ("", "nmes: {}\n", "rules.yaml has the unknown key 'nmes'; the keys are names, types and text"),
        ("", "names: [a]\n", "rules.yaml: names must be a mapping of keys"),
        ("", "names: {M: a}\n", "rules.yaml: M must be a list of names, which consist of letters, digits and underscores"),
        ("", "names: {M: [a, a]}\n", "rules.yaml: M has the same name twice"),
        ("", "types: {A: integer}\n", "rules.yaml: A cannot have the type 'integer'; the types are bool, int, long, float, double, string"),
        ("", "text: Zip\n", "rules.yaml: text must be a list of keys"),
    ],
)  # fmt: skip
def test_invalid_corrections(names: str, rules: str | None, problem: str) -> None:
    Path("rules.yaml").write_text(rules or "")
    with pytest.raises(CorrectionError) as raised:
        read_corrections([names] if names else [], None if names else "rules.yaml")
    assert str(raised.value).startswith(problem)


def test_declared_parameters_are_used_as_they_are(golden: Golden) -> None:
    declared = "component: speech.cdsl.yaml\nparameters:\n  A: float\n  B: {group: {c: {type: string}}}\n  L: {list: int, default: []}\n"
    config = "A = 1\nB.c = 5\nD = 7\nM0 = a,1\nM1 = b,2\nL = 1,2,3\n"
    cdsl = "component: SpeechComp\nlanguage: python\n"
    write_tree(
        Path(), {"speech/speech.cdsl.yaml": cdsl, "speech/speech.pdsl.yaml": declared, "speech/etc/config": config}
    )
    golden("settings/declared", migrated())


def test_configs_without_a_component_have_separate_parameters(golden: Golden) -> None:
    files = {"a/side.conf": "A = 1\n", "a/config.new": "B = 2\n", "a/side": "C = 3\n", "b/etc/config": "D = 4\n"}
    write_tree(Path(), files)
    texts = {path.replace("/", "-"): text.partition("\n")[2] for path, text in planned(Migration(["."], None, ()))}
    golden("settings/alone", texts)


def test_too_few_names_are_ignored() -> None:
    write_tree(Path(), {"speech/etc/config": "M0 = a,1\nM1 = b,2\n"})
    said = [one.message for one in Migration(["."], None, (), guesses=read_corrections(["M=name"], None)).diagnostics]
    assert any("M… has 2 columns, but --names has 1; the columns are named f1, f2" in message for message in said)
