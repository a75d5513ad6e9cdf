"""RC4xxx: deployments, their documents and what these name."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code

Tree = dict[str, "str | bytes | None"]

_SPEECH = (
    "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      say: {in: {text: string}}\n"
    "  Mouth:\n    methods:\n      open:\n"
)
_DOCUMENTS: Tree = {
    "Speech.idsl.yaml": _SPEECH,
    "speech/speech.cdsl.yaml": (
        "component: SpeechComp\nlanguage: python\nimports: [../Speech]\nimplements: [Speech]\nrequires: [Mouth]\n"
    ),
    "speech/bin/SpeechComp": "-> /bin/true",
    "mouth/mouth.cdsl.yaml": "component: MouthComp\nlanguage: python\nimports: [../Speech]\nimplements: [Mouth]\n",
    "mouth/bin/MouthComp": "-> /bin/true",
}
_HEAD = "deployment: Head\n"
_SPEAKS = "  speech: {component: speech}\n"
_MOVES = "  mouth: {component: mouth}\n"
_BOTH = f"components:\n{_SPEAKS}{_MOVES}"


def deployed(text: str = _BOTH, **others: str) -> Tree:
    """A deployment beside the components SpeechComp, which requires Mouth, and MouthComp, which implements it."""
    more = {f"{name}.ddsl.yaml": other for name, other in others.items()}
    return {"head.ddsl.yaml": _HEAD + text, **_DOCUMENTS, **more}


_RIGHT = deployed()
_CHECK = "check head.ddsl.yaml"

DUPLICATE_NAME = Code(
    "RC4001",
    "error",
    "'{name}' names two things of this deployment",
    "Components, services and groups share one name space, with those of the documents that `include: […]` lists, and "
    "with the instances that an entry with `instances:` gives. An include with a name keeps its own: "
    "`include: {left: arm.ddsl.yaml}` gives `left.elbow`.",
    deployed(_BOTH + "groups:\n  mouth: {components: [speech]}\n"),
    deployed(_BOTH + "groups:\n  face: {components: [speech, mouth]}\n"),
    _CHECK,
)
UNKNOWN_HOST = Code(
    "RC4002",
    "error",
    "there is no host '{name}'",
    "Every `host:` is a name of the document's own `hosts:`, which says where that machine is.",
    deployed("hosts: {onboard: 10.0.0.2}\n" + _BOTH.replace("h}", "h, host: onbord}")),
    deployed("hosts: {onboard: 10.0.0.2}\n" + _BOTH.replace("h}", "h, host: onboard}")),
    _CHECK,
)
NO_HOST = Code(
    "RC4003",
    "error",
    "'{name}' does not say on which host it runs",
    "With several hosts, each entry and service names its own. With one host, or none, all run there. A group that "
    "includes a deployment may name the host of all that it includes.",
    deployed("hosts: {onboard: 10.0.0.2, head: 10.0.0.3}\n" + _BOTH),
    deployed("hosts: {onboard: 10.0.0.2, head: 10.0.0.3}\n" + _BOTH.replace("h}", "h, host: head}")),
    _CHECK,
)
HOST_DIFFERS = Code(
    "RC4004",
    "error",
    "host '{name}' is {address} in {document}, and {other} elsewhere in this deployment",
    "A host's name means the same machine in a deployment and in all that it includes.",
    deployed(
        "hosts: {head: 10.0.0.2}\n" + "components:\n" + _MOVES + "include: [arm.ddsl.yaml]\n",
        arm="deployment: Arm\nhosts: {head: 10.0.0.9}\ncomponents:\n  elbow: {component: mouth}\n",
    ),
    deployed(
        "hosts: {head: 10.0.0.2}\n" + "components:\n" + _MOVES + "include: {arm: arm.ddsl.yaml}\n",
        arm="deployment: Arm\nhosts: {head: 10.0.0.2}\ncomponents:\n  elbow: {component: mouth}\n",
    ),
    _CHECK,
)
UNKNOWN_NAME = Code(
    "RC4005",
    "error",
    "{where} names '{name}', which is not there",
    "Under `after:`, `process:` and in groups stand names of entries, services and groups of the same document, or of "
    "what it includes: `arm.elbow` is the entry `elbow` of the include `arm`.",
    deployed("components:\n  speech: {component: speech, after: [mouht]}\n" + _MOVES),
    deployed("components:\n  speech: {component: speech, after: [mouth]}\n" + _MOVES),
    _CHECK,
)
NOT_A_PROCESS = Code(
    "RC4006",
    "error",
    "'{name}' is {what}, and no process that could have a second name",
    "`process:` names an entry that is started: a component or a program.",
    deployed("components:\n" + _MOVES + "  a: {process: b, endpoints: {Speech: tcp -p 10009}}\n"
             "  b: {process: mouth, endpoints: {Speech: tcp -p 10008}}\n"),
    deployed("components:\n" + _MOVES + "  b: {process: mouth, endpoints: {Speech: tcp -p 10008}}\n"),
    _CHECK,
)
UNKNOWN_PORT = Code(
    "RC4007",
    "error",
    "component {component} has no {what} '{name}'",
    "The keys of `connect:` are the names under a component's `requires:`, those of `topics:` the names under "
    "`publishes:` and `subscribes:`, those of `ports:` and `endpoints:` what it serves: `implements:`, `subscribes:` "
    "and CommonBehavior.",
    deployed("components:\n  speech: {component: speech, connect: {Muoth: mouth}}\n" + _MOVES),
    deployed("components:\n  speech: {component: speech, connect: {Mouth: mouth}}\n" + _MOVES),
    _CHECK,
)
NO_INDEX = Code(
    "RC4008",
    "error",
    "'{name}' has instances, and no {{i}} in its name to tell them by",
    "Each instance needs a name of its own: `{i}` in the name of the entry counts them, from 0.",
    deployed("components:\n" + _SPEAKS + "  mouth: {component: mouth, instances: 1}\n"),
    deployed("components:\n  speech: {component: speech, connect: {Mouth: mouth0}}\n"
             "  mouth{i}: {component: mouth, instances: 1}\n"),
    _CHECK,
)
STRAY_INDEX = Code(
    "RC4009",
    "error",
    "'{name}' counts with {{i}}, but does not say how many instances there are",
    "`{i}` stands for the number of an instance; the key `instances:` says how many there are.",
    deployed("components:\n" + _SPEAKS + "  mouth{i}: {component: mouth}\n"),
    deployed("components:\n" + _SPEAKS + "  mouth{i}: {component: mouth, instances: 1}\n"),
    _CHECK,
)
NOT_SERVED = Code(
    "RC4010",
    "error",
    "no member of the group '{group}' serves '{name}'",
    "A group offers what its members implement: every entry of `implements:` of the document under `as:`, and every "
    "name under `expose:`.",
    deployed(_BOTH + "groups:\n  face: {components: [speech], as: mouth/mouth.cdsl.yaml}\n"),
    deployed(_BOTH + "groups:\n  face: {components: [speech, mouth], as: mouth/mouth.cdsl.yaml}\n"),
    _CHECK,
)
SEVERAL_SERVE = Code(
    "RC4011",
    "error",
    "several members of the group '{group}' serve '{name}': {members}",
    "Those outside of the group see one interface; `expose:` says which member serves it.",
    deployed("components:\n" + _MOVES + "  other: {component: mouth}\n"
             "groups:\n  face: {components: [mouth, other], as: mouth/mouth.cdsl.yaml}\n"),
    deployed("components:\n" + _MOVES + "  other: {component: mouth}\n"
             "groups:\n  face: {components: [mouth, other], as: mouth/mouth.cdsl.yaml, expose: {Mouth: mouth}}\n"),
    _CHECK,
)
UNKNOWN_METHOD = Code(
    "RC4012",
    "error",
    "interface '{interface}' has no method '{name}'",
    "`allow:` lists methods of the exposed interface: those that may be called from outside of the group.",
    deployed(_BOTH + "groups:\n  face: {components: [speech, mouth], "
             "expose: {Speech: {member: speech, allow: [tell]}}}\n"),
    deployed(_BOTH + "groups:\n  face: {components: [speech, mouth], "
             "expose: {Speech: {member: speech, allow: [say]}}}\n"),
    _CHECK,
)
GROUP_CYCLE = Code(
    "RC4013",
    "error",
    "the group '{name}' contains itself",
    "A group may have other groups as members, but not, by whatever way, itself.",
    deployed(_BOTH + "groups:\n  face: {components: [speech, head]}\n  head: {components: [face, mouth]}\n"),
    deployed(_BOTH + "groups:\n  face: {components: [speech]}\n  head: {components: [face, mouth]}\n"),
    _CHECK,
)
BAD_PATTERN = Code(
    "RC4014",
    "error",
    "'{pattern}' is no regular expression: {problem}",
    "`ready: {log: …}` is a regular expression of Python: brackets and signs such as `( [ { * + ? . | ^ $` have a "
    "meaning of their own, and stand for themselves behind a backslash.",
    deployed("components:\n" + _MOVES + "  laser: {program: sleep, args: [1], ready: {log: \"ready (\"}}\n"),
    deployed("components:\n" + _MOVES + "  laser: {program: sleep, args: [1], ready: {log: 'ready \\('}}\n"),
    _CHECK,
    says=(
        "'{pattern}' is no regular expression: {what_Python_says}",
    ),
)
CONFIG_AS_PROGRAM = Code(
    "RC4017",
    "error",
    "'{text}' cannot be what is started: {{config}} is a configuration's path, which only arguments can have",
    "In an argument, `{config}` stands for the path of the configuration that is derived for the process. What is "
    "started is a program; one that reads its configuration as a script gets it as an argument.",
    deployed("components:\n" + _MOVES + "  laser: {program: '{config}', config: mouth/etc/config}\n")
    | {"mouth/etc/config": "Mouth.Speed=1\n"},
    deployed("components:\n" + _MOVES + "  laser: {program: sh, args: ['{config}'], config: etc/config}\n")
    | {"etc/config": "Mouth.Speed=1\n"},
    _CHECK,
)
NO_COMPONENT = Code(
    "RC4101",
    "error",
    "there is no component at '{path}'",
    "`component:` and `as:` are a path from the deployment's document to a component's document, or to the folder that "
    "it stands in.",
    deployed("components:\n  speech: {component: speach}\n" + _MOVES),
    _RIGHT,
    _CHECK,
)
SEVERAL_COMPONENTS = Code(
    "RC4102",
    "error",
    "there are several components in '{path}'",
    "A folder stands for the one component in it; where there are several, name the document.",
    {**_RIGHT, "mouth/other.cdsl.yaml": "component: OtherComp\nlanguage: python\n"},
    {**deployed(_BOTH.replace("component: mouth", "component: mouth/mouth.cdsl.yaml")),
     "mouth/other.cdsl.yaml": "component: OtherComp\nlanguage: python\n"},
    _CHECK,
)
NO_CONFIG = Code(
    "RC4103",
    "error",
    "there is no configuration '{path}': no {places}",
    "`config:` is a path from the component's folder (of a program: from where it runs), else from the deployment's "
    "document: a values document, or a flat file, which is passed on as it is.",
    deployed(_BOTH.replace("mouth}", "mouth, config: etc/config}")),
    {**deployed(_BOTH.replace("mouth}", "mouth, config: etc/config}")), "mouth/etc/config": "Mouth.Speed=1\n"},
    _CHECK,
)
OTHER_VALUES = Code(
    "RC4104",
    "error",
    "these are the values of {other}, and this is {component}",
    "A values document says which component it is for; it cannot be the configuration of another one.",
    {**deployed(_BOTH.replace("mouth}", "mouth, config: ../speech/my.config.yaml}")),
     "speech/my.config.yaml": "component: speech.cdsl.yaml\nparameters: {}\n"},
    {**deployed(_BOTH.replace("speech}", "speech, config: my.config.yaml}")),
     "speech/my.config.yaml": "component: speech.cdsl.yaml\nparameters: {}\n"},
    _CHECK,
)
NO_INCLUDE = Code(
    "RC4105",
    "error",
    "there is no deployment '{path}' to include",
    "An include is a path from this document to another deployment's document, `NAME.ddsl.yaml`.",
    deployed(_BOTH + "include: [amr.ddsl.yaml]\n", arm="deployment: Arm\n"),
    deployed(_BOTH + "include: [arm.ddsl.yaml]\n", arm="deployment: Arm\n"),
    _CHECK,
)
INCLUDE_CYCLE = Code(
    "RC4106",
    "error",
    "'{path}' includes this document: {cycle}",
    "A deployment cannot, by whatever way, include itself.",
    deployed(_BOTH + "include: {arm: arm.ddsl.yaml}\n", arm="deployment: Arm\ninclude: {head: head.ddsl.yaml}\n"),
    deployed(_BOTH + "include: {arm: arm.ddsl.yaml}\n", arm="deployment: Arm\n"),
    _CHECK,
)
INCLUDED_TWICE = Code(
    "RC4107",
    "error",
    "'{path}' is included twice in one name space",
    "What `include: […]` lists counts as if it stood in this document, so it can stand there once. The same deployment "
    "twice needs two names: `include: {left: arm.ddsl.yaml, right: arm.ddsl.yaml}`.",
    deployed(_BOTH + "include: [arm.ddsl.yaml, arm.ddsl.yaml]\n", arm="deployment: Arm\n"),
    deployed(_BOTH + "include: {left: arm.ddsl.yaml, right: arm.ddsl.yaml}\n", arm="deployment: Arm\n"),
    _CHECK,
)
TOO_LARGE = Code(
    "RC4108",
    "error",
    "this deployment {problem}",
    "Instances and includes multiply: two includes of a document that has two of its own, and so on, soon ask for more "
    "processes than there are machines for. Such a document is not looked at further.",
    deployed(_BOTH + "  mouth{i}: {component: mouth, instances: 10000}\n"),
    _RIGHT,
    _CHECK,
    says=(
        "this deployment comes to {number} processes, and {most} are the most",
        "this deployment has includes inside of each other {number} deep, and {most} are the most",
    ),
)
