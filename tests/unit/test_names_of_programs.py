"""Each name of a program is found where it is defined and where it is used, at the exact text."""

from __future__ import annotations

import pytest

from in_memory import ROOT, analysed
from robocomp_yaml.diag.span import Span
from robocomp_yaml.naming.analysis import names_of
from robocomp_yaml.naming.names import DefinedName, Names

# A name between « and » is defined or used under the number behind it: the first of each number is the definition.
MARKED = {
    "interfaces/Pose.idsl.yaml": (
        "module: «RoboCompPose»1\n"
        "types:\n  «Pose»2: {struct: {x: float}}\n  «Path»3: {sequence: «Pose»2}\n  «Mode»18: {enum: [«slow»19, fast]}\n"
        "exceptions: {«Lost»4: {struct: {at: «Pose»2, mode: {type: «Mode»18, default: «slow»19}}}}\n"
    ),
    "interfaces/Speech.idsl.yaml": (
        "module: «RoboCompSpeech»5\nimports: [«Pose»1]\n"
        "interfaces:\n  «Speech»6: {methods: {«say»7: {in: {at: «Pose»1.«Pose»2}, returns: «RoboCompPose»1.«Path»3, throws: [«Pose»1.«Lost»4]}}}\n"
        "topics: {«Heard»8: {methods: {«word»9: {in: {at: '«Pose»1.«Pose»2'}}}}}\n"
    ),
    "speech/speech.cdsl.yaml": (
        "component: «SpeechComp»10\nlanguage: python\nimports: [../interfaces/Speech]\n"
        "implements: [«Speech»6]\npublishes: [{«Mine»20: «Speech»5.«Heard»8}]\n"
        "statemachine:\n  initial: «idle»21\n  final: «over»22\n  events: [t_«idle»21_to_«busy»23, back]\n"
        "  states: {«idle»21: , «busy»23: }\n  transitions:\n    «idle»21: «busy»23\n"
        "    «busy»23: [{to: «over»22, if: \"In('«busy»23') and ready\"}, {to: [«idle»21], event: back}]\n"
    ),
    "speech/speech.pdsl.yaml": (
        "component: speech.cdsl.yaml\ntypes:\n  «Voice»11: {enum: [low, high]}\n  «Wheel»24: {struct: {«speed»25: float}}\n"
        "parameters:\n  «rows»33: {list: «Wheel»24, default: []}\n"
        "  «voice»12: {type: «Voice»11, default: low}\n  «camera»13: {group: {«width»14: {type: int, default: 1}}}\n"
        "  «wheels»26: {list: «Wheel»24, default: [{«speed»25: 1}]}\n"
        "constraints:\n  - «camera»13.«width»14 < 7\n  - all(w.«speed»25 < «camera»13.«width»14 + 3 for w in «wheels»26)\n"
        "legacy:\n  «camera»13.«width»14: Width\n  «wheels»26: {key: 'W{i}', columns: [«speed»25]}\n"
        "  «rows»33: {fields: {«speed»25: 'r_{i}'}}\n"
    ),
    "speech/etc/config.yaml": (
        "component: ../speech.cdsl.yaml\nparameters: {«camera»13: {«width»14: 3}, «wheels»26: [{«speed»25: 2}]}\n"
        "endpoints: {«Speech»6: tcp -p 10000}\n"
    ),
    "ear/ear.cdsl.yaml": "component: EarComp\nlanguage: python\nimports: [../interfaces/Speech]\nrequires: [{«Left»27: «Speech»6}]\nsubscribes: [«Heard»8]\n",
    "ear/ear.pdsl.yaml": "component: ear.cdsl.yaml\nparameters: {«gain»28: {type: int, default: 1}}\n",
    "ear/etc/config": "# of the user\n«Left»27Proxy=«speech»6:tcp -p 10000\n«gain»28 = 3\n«Heard»8Topic.Endpoints = tcp\nother=1\n",
    "robot.ddsl.yaml": (
        "deployment: Robot\nhosts: {«left»15: 10.0.0.2}\nservices: {«storm»16: {icestorm: {host: «left»15}}}\ncomponents:\n"
        "  «mouth»17: {component: «speech»10, host: «left»15, topics: {«Mine»20: a/b}, set: {«voice»12: high, «camera»13.«width»14: 2, '«wheels»26[0].«speed»25': 1}, after: [«storm»16]}\n"
        "  ear: {component: ear, host: «left»15, connect: {«Left»27: «mouth»17.«Speech»6}, after: [«mouth»17], ports: {«Heard»8: 11500}}\n"
        "  'many{i}': {component: speech, instances: 2, host: «left»15, ports: {«Speech»6: 11000}, after: [«mouth»17]}\n"
        "  «alias»29: {process: «mouth»17}\n"
        "groups:\n  «both»30: {components: [«mouth»17, ear]}\n"
        "  «shop»31: {components: ['many{i}'], expose: {Voice: {member: many0.«Speech»6, allow: [«say»7]}}}\n"
    ),
    "whole.ddsl.yaml": (
        "deployment: Whole\nhosts: {left: 10.0.0.2}\nservices: {storm: {icestorm: }}\ncomponents:\n  ear: {component: ear, host: left, connect: {«Left»27: «robot»32.«mouth»17.«Speech»6}}\n"
        "groups: {«robot»32: {include: robot.ddsl.yaml}}\n"
    ),
    "test.mock.yaml": "interfaces: {«Speech»6: {methods: {«say»7: {returns: []}}}}\ntopics: {«Heard»8: {messages: [{«word»9: {at: {x: 1}}}]}}\n",
}  # fmt: skip


def key(span: Span) -> tuple[str, int, int, int]:
    return span.file, span.line, span.column, span.end_column


def _without_marks() -> tuple[dict[str, str], dict[str, list[tuple[str, int, int, int]]]]:
    """The documents, and for each number the places: file, line, columns."""
    texts: dict[str, str] = {}
    places: dict[str, list[tuple[str, int, int, int]]] = {}
    for file, marked in MARKED.items():
        plain = ""
        rest = marked
        while "«" in rest:
            before, _, rest = rest.partition("«")
            word, _, rest = rest.partition("»")
            number = rest[: len(rest) - len(rest.lstrip("0123456789"))]
            rest = rest[len(number) :]
            plain += before
            line, column = plain.count("\n") + 1, len(plain) - plain.rfind("\n")
            places.setdefault(number, []).append((f"{ROOT}/{file}", line, column, column + len(word)))
            plain += word
        texts[file] = plain + rest
    return texts, places


TEXTS, PLACES = _without_marks()


@pytest.fixture(scope="module")
def names() -> Names:
    analysis = analysed(TEXTS)
    assert {one.code for one in analysis.diagnostics} <= {"RC4210"}  # two IceStorms
    return names_of(analysis)


@pytest.mark.parametrize("number", PLACES)
def test_a_name_is_found_wherever_it_is(names: Names, number: str) -> None:
    places = PLACES[number]
    found: list[DefinedName] = []
    for file, line, start, end in places:
        for column in (start, (start + end) // 2, end):
            at = names.at(file, line, column)
            assert at is not None, (file, line, column)
            assert (at[0].line, at[0].column, at[0].end_column) == (line, start, end)
            found.append(at[1])
    assert len({one.key for one in found}) == 1
    span = found[0].span
    assert (span.file, span.line, span.column, span.end_column) in places
    uses = {(one.file, one.line, one.column, one.end_column) for one in names.uses.get(found[0].key, ())}
    assert uses | {key(span)} >= set(places)
    named = {place for place in uses if place not in {key(one) for one in names.paths}}
    assert named <= set(places)  # what is renamed is nothing else


def test_what_is_no_name_is_none(names: Names) -> None:
    assert names.at(f"{ROOT}/robot.ddsl.yaml", 1, 3) is None  # a key
    assert names.at(f"{ROOT}/nothing.yaml", 1, 1) is None


def test_the_names_of_a_document_are_in_its_order(names: Names) -> None:
    found = names.in_document(f"{ROOT}/interfaces/Speech.idsl.yaml")
    assert [one.name for one in found] == ["RoboCompSpeech", "Speech", "say", "at", "Heard", "word", "at"]
    assert found[2].says == "Speech.say(at: Pose.Pose) → RoboCompPose.Path" and found[2].inside == found[1].key
