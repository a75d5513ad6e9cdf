"""Linked deployments: instances, values, hosts, includes, names and groups."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml.link.deployments import LinkedDeployment, LinkedInstance
from robocomp_yaml.pipeline import analyse

DOCUMENTS = {
    "Speech.idsl.yaml": (
        "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      say: {in: {text: string}}\n"
        "  Mouth:\n    methods:\n      open:\n"
    ),
    "speech/speech.cdsl.yaml": (
        "component: SpeechComp\nlanguage: python\nimports: [../Speech]\nimplements: [Speech]\nrequires: [Mouth]\n"
    ),
    "speech/bin/SpeechComp": "-> /bin/true",
    "mouth/mouth.cdsl.yaml": (
        "component: MouthComp\nlanguage: python\nimports: [../Speech]\nimplements: [Mouth]\n"
        "parameters: mouth.pdsl.yaml\n"
    ),
    "mouth/mouth.pdsl.yaml": (
        "parameters:\n  number: {type: int, default: 0}\n  id: {type: string, optional: true}\n"
        "  lips: {list: int, default: [1, 2]}\n"
    ),
    "mouth/bin/MouthComp": "-> /bin/true",
    "mouth/etc/config.yaml": "component: ../mouth.cdsl.yaml\nparameters: {number: 7}\n",
}
ARM = "deployment: Arm\ncomponents:\n  elbow: {component: mouth}\n  hand: {component: speech, after: [elbow]}\n"
Link = Callable[..., LinkedDeployment]


@pytest.fixture
def link(tmp_path: Path) -> Link:
    """Writes a deployment beside the components, and links it without diagnostics."""

    def of(text: str, **others: str) -> LinkedDeployment:
        more = {f"{name}.ddsl.yaml": other for name, other in others.items()}
        write_tree(tmp_path, {**DOCUMENTS, "head.ddsl.yaml": f"deployment: Head\n{text}", **more})
        analysis = analyse([str(tmp_path / "head.ddsl.yaml")])
        assert [d.message for d in analysis.diagnostics] == []
        return next(d for d in analysis.program.deployments.values() if d.deployment.name == "Head")

    return of


def test_a_component_has_its_document_values_and_folder(link: Link, tmp_path: Path) -> None:
    linked = link("components:\n  mouth: {component: mouth}\n  speech: {component: speech/speech.cdsl.yaml}\n")
    mouth, speech = linked.instances.values()
    assert mouth.component is not None and mouth.component.component.name == "MouthComp"
    assert mouth.values is not None and mouth.values.document.path == str(tmp_path / "mouth/etc/config.yaml")
    assert mouth.folder == str(tmp_path / "mouth")
    assert speech.values is None and speech.flat == ""
    assert mouth.host is None and linked.hosts == {}


def test_a_configuration_is_in_the_components_folder_or_beside_the_deployment(link: Link, tmp_path: Path) -> None:
    write_tree(
        tmp_path,
        {
            "mouth/here.config.yaml": "parameters: {number: 1}\n",
            "here.config.yaml": "parameters: {number: 2}\n",
            "there.config.yaml": "parameters: {number: 3}\n",
            "flat": "number=4\n",
        },
    )
    linked = link(
        "components:\n  speech: {component: speech}\n  a: {component: mouth, config: here.config.yaml}\n"
        "groups: {first: {components: [a, speech], expose: {Mouth: a}}}\n"
        "include: [others.ddsl.yaml]\n",
        others="deployment: Others\ncomponents:\n  b: {component: mouth, config: there.config.yaml}\n"
        "  c: {component: mouth, config: flat}\n",
    )
    assert [i.values.document.path for i in linked.instances.values() if i.values] == [
        str(tmp_path / "mouth/here.config.yaml"),
        str(tmp_path / "there.config.yaml"),
    ]
    assert linked.instances["c"].flat == str(tmp_path / "flat")


def test_the_number_of_an_instance_is_in_every_text(link: Link) -> None:
    linked = link(
        'components:\n  mouth{i}:\n    component: mouth\n    instances: 3\n    args: ["--n={i}"]\n'
        '    env: {N: "{i}"}\n    set: {number: {i}, id: "{i}", "lips[0]": {i}}\n'
        '    ready: {log: "mouth {i} ready"}\n'
        '  speech{i}: {component: speech, instances: 2, connect: {Mouth: "mouth{i}"}, after: ["mouth{i}"]}\n'
        'groups: {mouths: {components: ["mouth{i}"]}}\n'
    )
    assert list(linked.instances) == ["mouth0", "mouth1", "mouth2", "speech0", "speech1"]
    last = linked.instances["mouth2"]
    assert (last.number, last.entry.args[0].text, last.entry.env[0].value) == (2, "--n=2", "2")
    assert last.entry.settings is not None and last.entry.settings.data == {"number": 2, "id": "2", "lips[0]": 2}
    assert last.entry.ready is not None and last.entry.ready.log == "mouth 2 ready"
    assert linked.instances["speech1"].after == (linked.instances["mouth1"],)
    assert linked.instances["speech1"].entry.connect[0].text == "mouth1"
    assert [member.name for member in linked.groups["mouths"].members] == ["mouth0", "mouth1", "mouth2"]


def test_entries_of_an_unnamed_include_are_the_documents_own(link: Link) -> None:
    linked = link(
        "components:\n  voice: {component: speech, after: [hand, arm]}\n"
        "groups: {arm: {components: [elbow]}}\ninclude: [arm.ddsl.yaml]\n",
        arm=ARM,
    )
    assert list(linked.instances) == ["voice", "elbow", "hand"]
    assert [x.name for x in linked.instances["voice"].after] == ["hand", "elbow"]
    assert [document.name for document in linked.documents] == ["Head", "Arm"]


def test_a_named_include_is_a_group_with_a_scope(link: Link) -> None:
    linked = link(
        "components:\n  elbow: {component: mouth}\n  voice: {component: speech, connect: {Mouth: elbow}, "
        "after: [left.hand, right]}\ninclude: {left: arm.ddsl.yaml, right: arm.ddsl.yaml}\n",
        arm=ARM,
    )
    assert list(linked.instances) == ["elbow", "voice", "left.elbow", "left.hand", "right.elbow", "right.hand"]
    assert [x.name for x in linked.instances["left.hand"].after] == ["left.elbow"]
    assert [x.name for x in linked.instances["voice"].after] == ["left.hand", "right.elbow", "right.hand"]
    assert [m.name for m in linked.groups["left"].members] == ["left.elbow", "left.hand"]
    assert linked.instances["left.elbow"].document.name == "Arm"
    assert linked.instances["left.elbow"].entry.span.file.endswith("arm.ddsl.yaml")


def test_includes_of_includes(link: Link) -> None:
    body = "deployment: Body\ninclude: {arm: arm.ddsl.yaml}\ncomponents: {heart: {program: beat, after: [arm.hand]}}\n"
    linked = link("include: {body: body.ddsl.yaml}\n", body=body, arm=ARM)
    assert list(linked.instances) == ["body.heart", "body.arm.elbow", "body.arm.hand"]
    assert linked.instances["body.heart"].after == (linked.instances["body.arm.hand"],)
    assert linked.find("body.arm.elbow.Mouth", "") == ((linked.instances["body.arm.elbow"],), "Mouth")
    assert linked.find("arm.elbow", "body.") == ((linked.instances["body.arm.elbow"],), "")


def test_a_single_host_is_the_default(link: Link) -> None:
    linked = link(
        "hosts: {onboard: 10.0.0.2}\nservices: {storm: {icestorm: }}\ncomponents:\n  m: {component: mouth}\n"
        "include: {arm: arm.ddsl.yaml}\n",
        arm=ARM,
    )
    assert {str(i.host and i.host.name) for i in linked.instances.values()} == {"onboard"}
    assert linked.storms["storm"].host is linked.hosts["onboard"]


def test_the_host_of_a_group_is_that_of_its_include(link: Link) -> None:
    linked = link(
        "hosts: {a: 10.0.0.2, b: {address: 10.0.0.3, user: me}}\n"
        "groups: {left: {include: arm.ddsl.yaml, host: a}, right: {include: arm.ddsl.yaml, host: b}}\n",
        arm=ARM,
    )
    assert {name: i.host.name for name, i in linked.instances.items() if i.host} == {
        "left.elbow": "a",
        "left.hand": "a",
        "right.elbow": "b",
        "right.hand": "b",
    }


def test_a_second_name_refers_to_the_process(link: Link) -> None:
    linked = link(
        "components:\n  base: {process: laser, endpoints: {Base: tcp -p 10004}}\n"
        "  laser: {program: sleep, args: [1], endpoints: {Laser: tcp -p 10003}}\n"
    )
    assert linked.instances["base"].process is linked.instances["laser"]


def served(linked: LinkedDeployment, group: str) -> list[tuple[str, str, str]]:
    return [(s.name, s.instance.name, s.adapter) for s in linked.groups[group].serves]


TWO = "components:\n  speech: {component: speech, connect: {Mouth: mouth}}\n  mouth: {component: mouth}\n"


def test_a_group_acts_as_a_component(link: Link) -> None:
    linked = link(TWO + "groups: {face: {components: [speech, mouth], as: speech}}\n")
    group = linked.groups["face"]
    assert group.is_closed and served(linked, "face") == [("Speech", "speech", "Speech")]
    assert [s.name for s in group.offers()] == ["Speech"]


def test_expose_chooses_and_renames(link: Link) -> None:
    linked = link(
        TWO + "  other: {component: mouth}\n"
        "groups: {face: {components: [speech, mouth, other], expose: {Lips: other.Mouth, Mouth: mouth}}}\n"
    )
    assert served(linked, "face") == [("Lips", "other", "Mouth"), ("Mouth", "mouth", "Mouth")]


def test_a_group_that_exposes_nothing_is_open(link: Link) -> None:
    linked = link(TWO + "groups: {face: {components: [speech, mouth]}}\n")
    assert not linked.groups["face"].is_closed
    assert [(s.name, s.instance.name) for s in linked.groups["face"].offers()] == [
        ("Speech", "speech"),
        ("Mouth", "mouth"),
    ]


def test_groups_contain_groups(link: Link) -> None:
    linked = link(TWO + "groups: {face: {components: [speech]}, head: {components: [face, mouth]}}\n")
    assert {m.name for m in linked.groups["head"].members} == {"speech", "mouth"}
    assert {g.name for g in linked.instances["speech"].groups} == {"face", "head"}


def test_an_included_group_exposes_its_members_by_their_own_names(link: Link) -> None:
    linked = link("groups: {arm: {include: arm.ddsl.yaml, expose: {Mouth: elbow}}}\n", arm=ARM)
    assert served(linked, "arm") == [("Mouth", "arm.elbow", "Mouth")]


def test_outside_processes_connect_to_a_closed_group_only_as_a_whole(link: Link) -> None:
    linked = link(
        TWO + "  watch: {program: sleep, args: [1]}\ngroups: {face: {components: [speech, mouth], as: speech}}\n"
    )
    watch, speech = linked.instances["watch"], linked.instances["speech"]
    face, mouth = linked.groups["face"], linked.instances["mouth"]
    assert linked.closed_groups_of(mouth, watch) == [face]
    assert linked.closed_groups_of(mouth, speech) == [] == linked.closed_groups_of(face, watch)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("speech", "speech"),
        ("mouth3", None),
        ("arm.elbow", "arm.elbow"),
        ("arm.mouth", None),
        ("elbow", None),
    ],
)
def test_names_are_resolved_in_their_scope(link: Link, text: str, found: str | None) -> None:
    linked = link("components:\n  speech: {component: speech}\ninclude: {arm: arm.ddsl.yaml}\n", arm=ARM)
    targets, behind = linked.find(text, "")
    names = [target.name for target in targets if isinstance(target, LinkedInstance) and not behind]
    assert names == ([found] if found else [])


def test_included_deployments_are_marked(link: Link, tmp_path: Path) -> None:
    link("include: {arm: arm.ddsl.yaml}\n", arm=ARM)
    program = analyse([str(tmp_path)]).program
    assert {d.deployment.name: d.is_included for d in program.deployments.values()} == {"Head": False, "Arm": True}


def test_requirements_of_an_include_with_a_duplicate_name_are_not_reported(tmp_path: Path) -> None:
    write_tree(
        tmp_path,
        {
            "arm.ddsl.yaml": "deployment: Arm\ncomponents: {elbow: {component: elbow}}\n",
            "elbow/elbow.cdsl.yaml": "component: ElbowComp\nlanguage: python\nimports: [../Mouth]\nrequires: [Mouth]\n",
            "Mouth.idsl.yaml": "module: RoboCompMouth\ninterfaces: {Mouth: {methods: {open: }}}\n",
            "head.ddsl.yaml": "deployment: Head\ninclude: {arm: arm.ddsl.yaml}\n"
            "components: {arm: {program: sleep, args: [1]}}\n",
        },
    )
    assert [found.code for found in analyse([str(tmp_path / "head.ddsl.yaml")]).diagnostics] == ["RC4001"]


def test_values_without_a_component_are_for_several_components(link: Link, tmp_path: Path) -> None:
    write_tree(tmp_path, {
        "other/other.cdsl.yaml": "component: OtherComp\nlanguage: python\nparameters: other.pdsl.yaml\n",
        "other/other.pdsl.yaml": "parameters:\n  number: {type: int, default: 1}\n",
        "other/bin/OtherComp": "-> /bin/true",
        "both.config.yaml": "parameters: {number: 5}\n",
    })  # fmt: skip
    linked = link(
        "components:\n  a: {component: mouth, config: both.config.yaml}\n"
        "  b: {component: other, config: both.config.yaml}\n"
    )
    for instance in linked.instances.values():
        assert instance.values is not None and instance.component is not None
        assert instance.values.parameters is instance.component.parameters


def test_set_completes_a_configuration(link: Link, tmp_path: Path) -> None:
    write_tree(tmp_path, {
        "other/other.cdsl.yaml": "component: OtherComp\nlanguage: python\nparameters: other.pdsl.yaml\n",
        "other/other.pdsl.yaml": "parameters: {number: int, id: string}\n", "other/bin/OtherComp": "-> /bin/true",
        "other/some.config.yaml": "component: other.cdsl.yaml\nparameters: {number: 5}\n",
    })  # fmt: skip
    link("components:\n  a: {component: other, config: some.config.yaml, set: {id: x}}\n")
