"""RC31xx, RC32xx: parameters, and how documents of parameters, components and values belong together."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code, Files
from robocomp_yaml.diag.diagnostic import ERROR, WARNING

_CDSL = "component: SpeechComp\nlanguage: python\n"


def _pdsl(text: str) -> Files:
    """A document of parameters beside its component."""
    return {"speech.pdsl.yaml": "component: speech.cdsl.yaml\n" + text, "speech.cdsl.yaml": _CDSL}


_RIGHT = _pdsl("parameters:\n  volume: {type: int, range: [0, 100], default: 50}\n")

NO_TYPE = Code(
    "RC3101",
    ERROR,
    "{what} '{name}' does not say what it is",
    "A parameter or member has a `type`, or is a `list` or a `map` (a parameter can also be a `group`). A type is an "
    "`enum`, a `struct`, or a `type`, `list` or `map` with its limits.",
    _pdsl("parameters:\n  volume: {range: [0, 100], default: 50}\n"),
    _RIGHT,
)
TWO_TYPES = Code(
    "RC3102",
    ERROR,
    "{what} '{name}' cannot be {kinds} at once",
    "One of `type`, `list`, `map`, `group`, `enum` and `struct` says what it is; the others would contradict it.",
    _pdsl("parameters:\n  volume: {type: int, list: int}\n"),
    _RIGHT,
)
UNKNOWN_TYPE = Code(
    "RC3103",
    ERROR,
    "there is no type '{name}'",
    "Types are `bool`, `int`, `long`, `float`, `double` and `string`, and those that the document defines under "
    "`types:`.",
    _pdsl("parameters:\n  volume: {type: integer, default: 50}\n"),
    _RIGHT,
)
RECURSIVE_TYPE = Code(
    "RC3104",
    ERROR,
    "type '{name}' holds itself: {cycle}",
    "A value of such a type could never be written down: each would have to hold another one.",
    _pdsl("types:\n  Node: {struct: {next: Node}}\nparameters:\n  first: Node\n"),
    _pdsl("types:\n  Node: {struct: {next: string}}\nparameters:\n  first: Node\n"),
)
TOO_LARGE = Code(
    "RC3105",
    ERROR,
    "'{name}' has more than {limit} {what}",
    "Types that hold types grow fast. Documents are written and read by people; a limit keeps a mistake from taking "
    "the machine's memory.",
    _pdsl("types:\n" + "".join(f"  T{n}: {{struct: {{a: T{n + 1}, b: T{n + 1}}}}}\n" for n in range(14))
          + "  T14: {type: int}\nparameters:\n  all: T0\n"),
    _RIGHT,
)
BASIC_NAME = Code(
    "RC3106",
    ERROR,
    "'{name}' is the name of a basic type",
    "A type of the document's own with a basic type's name would hide it.",
    _pdsl("types:\n  int: {type: long}\nparameters:\n  volume: int\n"),
    _RIGHT,
)
UNUSED_TYPE = Code(
    "RC3107",
    WARNING,
    "type '{name}' is used nowhere",
    "A type that nothing uses is most often left over, or misspelled where it was meant.",
    _pdsl("types:\n  Mode: {enum: [slow, fast]}\nparameters:\n  volume: {type: int, default: 50}\n"),
    _pdsl("types:\n  Mode: {enum: [slow, fast]}\nparameters:\n  mode: {type: Mode, default: slow}\n"),
)
LIMIT_MISFIT = Code(
    "RC3108",
    ERROR,
    "'{key}' {problem}",
    "`range` limits numbers and enums, `values` numbers, text and enums, `pattern` text, `size` lists and maps, "
    "`unique` lists of plain values; `unit` says what a number counts. Others would do nothing.",
    _pdsl("parameters:\n  device: {type: string, range: [0, 1], default: x}\n"),
    _pdsl("parameters:\n  device: {type: string, pattern: '[a-z]+', default: x}\n"),
    says=(
        "'{key}' says nothing about a value that is {kind}",
        "'{key}' needs numbers, not '{found}'",
        "'{key}' of whole numbers has whole limits",
        "'{key}' has either '{one}' or '{other}', not both",
        "'{key}' has no limit",
        "'{key}' names '{name}', which is no enumerator of {enum}",
        "'{key}' stands at the type already",
        "'{key}' is for values; give it to what the group holds",
        "'{key}' is for lists of plain values",
    ),
)
EMPTY_LIMIT = Code(
    "RC3109",
    ERROR,
    "nothing fits: {problem}",
    "A range whose start lies above its end, or limits that exclude each other, allow no value at all.",
    _pdsl("parameters:\n  volume: {type: int, range: [100, 0]}\n"),
    _RIGHT,
    says=(
        "nothing fits: no number is {range}",
        "nothing fits: none of the values of its type is {range}",
        "nothing fits: no enumerator of {enum} lies in this range",
        "nothing fits: at least {least} and at most {most} entries",
        "nothing fits: {number} entries, all different, of only {count} values",
    ),
)
UNREACHABLE = Code(
    "RC3110",
    ERROR,
    "{problem}",
    "A limit that lies outside of what the type or another limit allows can never be reached; most often a digit too "
    "many, or a limit that was changed in one place only.",
    _pdsl("parameters:\n  volume: {type: int, range: [0, 100], values: [50, 200]}\n"),
    _pdsl("parameters:\n  volume: {type: int, range: [0, 100], values: [50, 100]}\n"),
    says=(
        "{number} cannot be reached: {type} goes from {least} to {most}",
        "'{value}' is not {kind}",
        "'{value}' stands twice",
        "'{value}' is none of the values of its type",
        "'{value}' lies outside of the range",
        "'{value}' does not match the pattern",
        "the enumerator '{name}' stands twice",
    ),
)
BAD_PATTERN = Code(
    "RC3111",
    ERROR,
    "this pattern cannot be used: {problem}",
    "A pattern must mean the same to the editor, to Python and to C++: literals, `.`, classes `[a-z]`, `\\d \\w \\s`, "
    "groups, `|` and the counts `* + ? {2,5}`. It always matches the whole text.",
    _pdsl("parameters:\n  device: {type: string, pattern: '(?=/dev/).*', default: /dev/x}\n"),
    _pdsl("parameters:\n  device: {type: string, pattern: '/dev/.*', default: /dev/x}\n"),
    says=(
        "this pattern cannot be used: this '(' has no ')'",
        "this pattern cannot be used: look-around, names and flags of groups are not known to every engine",
        "this pattern cannot be used: '{character}' does not mean the same to every engine",
        "this pattern cannot be used: '{character}' has nothing before it to repeat",
        "this pattern cannot be used: {why}",
    ),
)
DEFAULT_AND_OPTIONAL = Code(
    "RC3112",
    ERROR,
    "'{name}' has a default and is optional",
    "What has a default always has a value, so it cannot be without one. Leave one of the two out.",
    _pdsl("parameters:\n  camera: {type: string, default: zed, optional: true}\n"),
    _pdsl("parameters:\n  camera: {type: string, optional: true}\n"),
)
BAD_DEFAULT = Code(
    "RC3113",
    ERROR,
    "the default of {problem}",
    "A default is a value like any other: it must fit the type, and all limits.",
    _pdsl("parameters:\n  volume: {type: int, range: [0, 100], default: 150, unit: percent}\n"),
    _RIGHT,
    says=(
        "the default of {name} is {value}, and must be {wanted}",
        "the default of {name} gives a value to something else: {what}",
        "the default of {name} comes from the environment",
    ),
)
NO_IDENTIFIER = Code(
    "RC3114",
    ERROR,
    "'{name}' cannot be a name in code",
    "A name in code has letters, digits and underscores, and starts with no digit. `as:` gives the name in code; the "
    "values and the properties keep the key.",
    _pdsl("parameters:\n  2d: {type: bool, default: true}\n"),
    _pdsl("parameters:\n  2d: {type: bool, default: true, as: view2d}\n"),
)
CODE_CLASH = Code(
    "RC3115",
    ERROR,
    "'{name}' and '{other}' are both called '{code}' in {language}",
    "Reserved words of a language get an underscore, so two names may meet there. `as:` gives one of them another name "
    "in code.",
    _pdsl("parameters:\n  class: {type: int, default: 1}\n  class_: {type: int, default: 2}\n"),
    _pdsl("parameters:\n  class: {type: int, default: 1, as: kind}\n  class_: {type: int, default: 2}\n"),
)
PROPERTY_CLASH = Code(
    "RC3116",
    ERROR,
    "'{name}' and {other} are both the property '{property}'",
    "Each value is a property of its own in `etc/config`. Names of adapters and proxies are properties too.",
    _pdsl("parameters:\n  volume: {type: int, default: 1}\n  level: {type: int, default: 2}\n"
          "legacy:\n  level: volume\n"),
    _pdsl("parameters:\n  volume: {type: int, default: 1}\n  level: {type: int, default: 2}\n"),
)
PROPERTY_PREFIX = Code(
    "RC3117",
    WARNING,
    "the properties of '{name}' start like those of {other}",
    "Ice takes properties that start with an adapter's or proxy's name for settings of its own, and warns of each that "
    "it does not know. Another name, or one under `legacy:`, keeps the log quiet.",
    {"speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters:\n  Speech: {group: {volume: {type: int, default: 1}}"
     "}\n",
     "speech.cdsl.yaml": _CDSL + "imports: [Speech]\nimplements: [Speech]\n",
     "Speech.idsl.yaml": "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      reset:\n"},
    {"speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters:\n  voice: {group: {volume: {type: int, default: 1}}}"
     "\n",
     "speech.cdsl.yaml": _CDSL + "imports: [Speech]\nimplements: [Speech]\n",
     "Speech.idsl.yaml": "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      reset:\n"},
)
PERIOD = Code(
    "RC3118",
    ERROR,
    "{problem}",
    "Every component has the parameters `period.compute` and `period.emergency`, whole numbers of milliseconds. A "
    "document may give them limits and defaults of its own, under a group called `period`.",
    _pdsl("parameters:\n  period: {type: int, default: 100}\n"),
    _pdsl("parameters:\n  period: {group: {compute: {type: int, range: [10, 500], default: 100}}}\n"),
    says=(
        "'period' is the group of the worker's periods",
        "'period.{name}' is a whole number of milliseconds: int",
        "the component's 'period:' says {number} ms",
    ),
)
BAD_EXPRESSION = Code(
    "RC3119",
    ERROR,
    "{problem}",
    "A constraint is an expression over the parameters: comparisons, `+ - * / %`, `and`, `or`, `not`, `in`, and the "
    "functions `len min max abs sum all any unique has keys values`, some with `for NAME in LIST`. Each operand must "
    "have a type that fits.",
    _pdsl("parameters: {low: {type: int, default: 1}, high: {type: int, default: 2}}\nconstraints: ['low < hihg']\n"),
    _pdsl("parameters: {low: {type: int, default: 1}, high: {type: int, default: 2}}\nconstraints: ['low < high']\n"),
    says=(
        "there is no parameter '{name}'",
        "there is no function '{name}'",
        "'{operator}' needs {wanted} here, and this is {found}",
        "'{operator}' cannot compare {one} with {other}",
        "{function}() needs {wanted} here, and this is {found}",
        "a constraint is true or false, and this is {found}",
        "this is no expression",
    ),
)
DEFAULTS_BREAK = Code(
    "RC3120",
    ERROR,
    "the defaults break this constraint: {message}",
    "With nothing but defaults the component could not start.",
    _pdsl("parameters: {low: {type: int, default: 3}, high: {type: int, default: 2}}\nconstraints: ['low < high']\n"),
    _pdsl("parameters: {low: {type: int, default: 1}, high: {type: int, default: 2}}\nconstraints: ['low < high']\n"),
)
BAD_SPELLING = Code(
    "RC3121",
    ERROR,
    "the legacy spelling of '{path}' {problem}",
    "`legacy:` says how the properties of `etc/config` spell a parameter. A plain value has the name of its property; "
    "a list needs rows (`key` with `{i}`, and `columns` for records), `fields`, or `separators`.",
    _pdsl("parameters:\n  volume: {type: int, default: 1}\nlegacy:\n  volum: Speech.Volume\n"),
    _pdsl("parameters:\n  volume: {type: int, default: 1}\nlegacy:\n  volume: Speech.Volume\n"),
    says=(
        "the legacy spelling of '{path}' names no parameter",
        "the legacy spelling of '{path}' has neither 'key' nor 'fields'",
        "the legacy spelling of '{path}' is for rows, and the parameter is one plain value",
    ),
)
SECRET_DEFAULT = Code(
    "RC3125",
    ERROR,
    "'{name}' is secret, and has a default",
    "A default stands in a document that many read, and in generated code. What is `secret` is given where it is "
    "known: as `{env: NAME}` or `{file: PATH}`, or in a values document that only its owner can read.",
    _pdsl("parameters:\n  pin: {type: int, secret: true, default: 4711}\n"),
    _pdsl("parameters:\n  pin: {type: int, secret: true, optional: true}\n"),
)
SECRET_MISFIT = Code(
    "RC3126",
    ERROR,
    "'{name}' cannot be secret as a whole: it is {words}",
    "`secret: true` is for plain values, and for lists of them, whose entries are all secret then. In a group or a "
    "struct each member says it for itself.",
    _pdsl("parameters:\n  mail: {group: {user: string, key: string}, secret: true}\n"),
    _pdsl("parameters:\n  mail: {group: {user: string, key: {type: string, secret: true}}}\n"),
)
NO_COMPONENT = Code(
    "RC3201",
    ERROR,
    "there is no component document '{name}'",
    "`component:` is a path, relative to this document, to the component's `.cdsl.yaml` (or to a `.pdsl.yaml`, for "
    "values without one).",
    {"speech.pdsl.yaml": "component: speach.cdsl.yaml\nparameters: {}\n", "speech.cdsl.yaml": _CDSL},
    {"speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters: {}\n", "speech.cdsl.yaml": _CDSL},
)
NO_PARAMETERS = Code(
    "RC3202",
    ERROR,
    "there is no parameters document '{name}'",
    "`parameters:` of a component is a path, relative to its document, to a `.pdsl.yaml`.",
    {"speech.cdsl.yaml": _CDSL + "parameters: speach.pdsl.yaml\n"},
    {"speech.cdsl.yaml": _CDSL + "parameters: speech.pdsl.yaml\n", "speech.pdsl.yaml": "parameters: {}\n"},
)
DISAGREEMENT = Code(
    "RC3203",
    ERROR,
    "component {component} has other parameters: {other}",
    "A component names its parameters' document, the document names its component, or both; then they must agree.",
    {"speech.cdsl.yaml": _CDSL + "parameters: speech.pdsl.yaml\n", "speech.pdsl.yaml": "parameters: {}\n",
     "other.pdsl.yaml": "component: speech.cdsl.yaml\nparameters: {}\n"},
    {"speech.cdsl.yaml": _CDSL + "parameters: speech.pdsl.yaml\n",
     "speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters: {}\n"},
)
NAMED = Code(
    "RC3204",
    ERROR,
    "'{name}' is a component's name, and `component:` takes the path of its document",
    "Two components of a workspace's folders may be called alike, so parameters and values name theirs by the path of "
    "its `.cdsl.yaml`, relative to this document. A plain name in a `.pdsl.yaml` stands for a component that has no "
    "document (yet); where one of that name has its document in another folder, this is a warning.",
    {"speech.pdsl.yaml": "component: SpeechComp\nparameters: {}\n", "speech.cdsl.yaml": _CDSL},
    {"speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters: {}\n", "speech.cdsl.yaml": _CDSL},
)
NOT_BESIDE = Code(
    "RC3205",
    ERROR,
    "component {component} does not know these parameters: they stand in another folder",
    "A component has the parameters of the document that it names under `parameters:`, or else of one beside it that "
    "names it. One of another folder would be found by some commands (`check .`) and by others not.",
    {"speech/speech.cdsl.yaml": _CDSL,
     "shared/speech.pdsl.yaml": "component: ../speech/speech.cdsl.yaml\nparameters: {}\n"},
    {"speech/speech.cdsl.yaml": _CDSL + "parameters: ../shared/speech.pdsl.yaml\n",
     "shared/speech.pdsl.yaml": "component: ../speech/speech.cdsl.yaml\nparameters: {}\n"},
)
UNCLAIMED = Code(
    "RC3206",
    WARNING,
    "component {component} has no parameters, and these name no component",
    "Parameters belong to a component that they name under `component:`, or that names them under `parameters:`. "
    "Standing beside it is not enough: a document of parameters may be shared.",
    {"speech.pdsl.yaml": "parameters:\n  volume: {type: int, default: 50}\n", "speech.cdsl.yaml": _CDSL},
    {"speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters:\n  volume: {type: int, default: 50}\n",
     "speech.cdsl.yaml": _CDSL},
)
MISPLACED = Code(
    "RC3207",
    ERROR,
    "these values stand in the folder of {component}, and are for {other}",
    "`etc/config.yaml` is what the component of its folder is configured from. Most often it was copied together with "
    "the folder, and names the component that it was copied from. Values of another component belong beside that one, "
    "or into a document of another name.",
    {"speech/speech.cdsl.yaml": _CDSL, "other/other.cdsl.yaml": "component: OtherComp\nlanguage: python\n",
     "other/etc/config.yaml": "component: ../../speech/speech.cdsl.yaml\nparameters: {}\n"},
    {"speech/speech.cdsl.yaml": _CDSL, "other/other.cdsl.yaml": "component: OtherComp\nlanguage: python\n",
     "other/etc/config.yaml": "component: ../other.cdsl.yaml\nparameters: {}\n"},
)
