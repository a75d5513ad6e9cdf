"""RC33xx: values of parameters, their layers, and what Ice's properties can hold."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code, Files
from robocomp_yaml.diag.diagnostic import ERROR, WARNING

_CDSL = "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n"
_IDSL = "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      reset:\n"
_PDSL = (
    "component: speech.cdsl.yaml\ntypes:\n"
    "  Motor: {struct: {name: string, min: {type: float, default: 0}, max: float}}\n"
    "parameters:\n  volume: {type: int, range: [0, 100], default: 50, unit: percent}\n"
    "  device: {type: string, pattern: '/dev/.+', optional: true}\n  motors: {list: Motor, size: [0, 4], default: []}\n"
    "  ids: {list: int, unique: true, default: []}\nconstraints:\n"
    "  - {that: 'all(m.min < m.max for m in motors)', else: a motor's min must be below its max}\n"
)


def _values(text: str, pdsl: str = _PDSL, **more: str) -> Files:
    """Values beside a component with parameters."""
    return {
        "etc/config.yaml": "component: ../speech.cdsl.yaml\n" + text, "speech.cdsl.yaml": _CDSL,
        "speech.pdsl.yaml": pdsl, "Speech.idsl.yaml": _IDSL,
        **{f"etc/{name}.config.yaml": content for name, content in more.items()},
    }


_RIGHT = _values("parameters:\n  volume: 70\n")

UNKNOWN_PARAMETER = Code(
    "RC3301",
    ERROR,
    "there is no parameter '{path}'",
    "Values can be given to the parameters that the component's PDSL defines, and to nothing else.",
    _values("parameters:\n  volumen: 70\n"),
    _RIGHT,
)
WRONG_TYPE = Code(
    "RC3302",
    ERROR,
    "{path} must be {wanted}, and is {found}",
    "A value must have its parameter's type. Text in quotes is no number, and true and false are no numbers; 1.0 is a "
    "whole number.",
    _values('parameters:\n  volume: "70"\n'),
    _RIGHT,
)
OUT_OF_RANGE = Code(
    "RC3303",
    ERROR,
    "{path} is {value}, and must be {wanted}",
    "The PDSL limits what a parameter can be.",
    _values("parameters:\n  volume: 170\n"),
    _RIGHT,
)
NO_MATCH = Code(
    "RC3304",
    ERROR,
    "{path} is {value}, and must match {pattern}",
    "The whole text must match the pattern that the PDSL gives.",
    _values("parameters:\n  device: ttyUSB0\n"),
    _values("parameters:\n  device: /dev/ttyUSB0\n"),
)
WRONG_SIZE = Code(
    "RC3305",
    ERROR,
    "{path} has {count}, and must have {wanted}",
    "The PDSL limits how many entries a list or map can have.",
    _values("parameters:\n  motors:\n" + "".join(f"    - {{name: m{n}, max: 1}}\n" for n in range(5))),
    _values("parameters:\n  motors:\n    - {name: m0, max: 1}\n"),
)
NOT_UNIQUE = Code(
    "RC3306",
    ERROR,
    "{path} holds {value} twice",
    "The PDSL says that the entries of this list are `unique`.",
    _values("parameters:\n  ids: [1, 2, 1]\n"),
    _values("parameters:\n  ids: [1, 2, 3]\n"),
)
MISSING = Code(
    "RC3307",
    ERROR,
    "{path} has no value, and no default",
    "A parameter without `default` and without `optional` needs a value, here or in a layer that `extends` names.",
    _values("parameters:\n  motors:\n    - {name: m0}\n"),
    _values("parameters:\n  motors:\n    - {name: m0, max: 1}\n"),
)
CONSTRAINT = Code(
    "RC3308",
    ERROR,
    "{message}",
    "The PDSL's `constraints` say what must hold between parameters.",
    _values("parameters:\n  motors:\n    - {name: m0, min: 2, max: 1}\n"),
    _values("parameters:\n  motors:\n    - {name: m0, min: 0, max: 1}\n"),
    says=("{message} (as the constraint says under `message:`, or the constraint itself)",),
)
BAD_REFERENCE = Code(
    "RC3309",
    ERROR,
    "{path} {problem}",
    "`{env: NAME}` takes a value from the environment when the component starts, and `{file: PATH}` from a file. "
    "They can stand where one number, text or truth value stands.",
    _values("parameters:\n  volume: {env: 7UP}\n"),
    _values("parameters:\n  volume: {env: SPEECH_VOLUME}\n"),
    says=(
        "{path} names no variable of the environment",
        "{path} has '{key}' beside 'env'",
    ),
)
NOT_FOR_ICE = Code(
    "RC3310",
    ERROR,
    "{path} cannot be a property of Ice: {problem}",
    "`etc/config` holds Ice properties: one line each, without line ends in the value, and never empty. A row of a "
    "`legacy:` spelling cannot hold its own separator either.",
    _values('parameters:\n  device: "/dev/tty\\nUSB0"\n', _PDSL.replace("pattern: '/dev/.+', ", "")),
    _values('parameters:\n  device: "/dev/ttyUSB0"\n', _PDSL.replace("pattern: '/dev/.+', ", "")),
    says=(
        "{path} cannot be a property of Ice: it holds a line end",
        "{path} cannot be a property of Ice: its row would be empty",
        "{path} cannot be a property of Ice: another value is this property already",
    ),
)
_SECRET = "component: speech.cdsl.yaml\nparameters: {password: string}\n"
OPEN_SECRET = Code(
    "RC3311",
    WARNING,
    "this is secret, and others can read {file}",
    "A password or a token that stands in a document is read by whoever can read the document, and often goes into a "
    "repository with it. Give the value where it is used: `{env: NAME}` takes it from the environment when the "
    "component starts, and `{file: PATH}` from a file. Or let nobody but the owner read the document: then what is "
    "made of it is for the owner alone, too. Parameters are secret that say `secret: true`, or whose names say so; in "
    "a URL the password is.",
    _values("parameters:\n  password: hunter2\n", _SECRET),
    _values("parameters:\n  password: {env: PASSWORD}\n", _SECRET),
)
NO_LAYER = Code(
    "RC3321",
    ERROR,
    "there is no values document '{name}'",
    "`extends:` names documents by their paths, relative to this one.",
    _values("extends: [robot.config.yaml]\n"),
    _values("extends: [robot.config.yaml]\n", robot="parameters:\n  volume: 70\n"),
)
LAYER_CYCLE = Code(
    "RC3322",
    ERROR,
    "'{name}' extends this document in turn",
    "Layers build on each other from the general to the special; in a circle none would come first.",
    _values("extends: [robot.config.yaml]\n", robot="extends: [config.yaml]\n"),
    _values("extends: [robot.config.yaml]\n", robot="parameters:\n  volume: 70\n"),
)
NO_COMPONENT = Code(
    "RC3323",
    WARNING,
    "these values belong to no component, and are not checked",
    "`component:` names the component (or its PDSL), here or in a document that this one extends. A layer that another "
    "document extends needs none.",
    {"robot.config.yaml": "parameters:\n  volume: 70\n"},
    {"robot.config.yaml": "component: speech.cdsl.yaml\nparameters:\n  volume: 70\n", "speech.cdsl.yaml": _CDSL,
     "speech.pdsl.yaml": _PDSL, "Speech.idsl.yaml": _IDSL},
)
UNKNOWN_PORT = Code(
    "RC3324",
    WARNING,
    "component {component} has no {what} called '{name}'",
    "What is set for an interface or topic that the component does not have is most often misspelled; it is written to "
    "`etc/config` nevertheless.",
    _values("endpoints:\n  Speach: tcp -p 10001\n"),
    _values("endpoints:\n  Speech: tcp -p 10001\n"),
)
OTHER_COMPONENT = Code(
    "RC3325",
    WARNING,
    "'{name}' holds values of {other}, and these are of {own}",
    "A document's values are judged by the parameters of its own component, and with them those of what it extends. "
    "What several components share stands in a layer that names no component.",
    _values("extends: [robot.config.yaml]\n", robot="component: mouth.cdsl.yaml\nparameters:\n  volume: 70\n") | {
        "etc/mouth.cdsl.yaml": "component: MouthComp\nlanguage: python\n",
        "etc/mouth.pdsl.yaml": "component: mouth.cdsl.yaml\nparameters: {volume: {type: int, default: 1}}\n",
    },
    _values("extends: [robot.config.yaml]\n", robot="parameters:\n  volume: 70\n"),
)
