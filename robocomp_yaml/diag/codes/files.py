"""RC0xxx: files, YAML's syntax, and the shape of documents."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code, Files, Repeated

_GOOD = {"Speech.idsl.yaml": "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      reset:\n"}


def _wrong(text: str | bytes | Repeated) -> Files:
    return {"Speech.idsl.yaml": text}


UNREADABLE = Code(
    "RC0001",
    "error",
    "cannot read this file: {reason}",
    "The file is there, but its text cannot be had: it may be a folder, a link that leads nowhere, or closed to you.",
    {"Speech.idsl.yaml": "-> nowhere.idsl.yaml"},
    _GOOD,
)
NOT_UTF8 = Code(
    "RC0002",
    "error",
    "this is not UTF-8 text: the byte {byte} cannot stand here",
    "Documents are UTF-8, with or without a byte order mark. A file from an old editor may be Latin-1; "
    "`iconv -f latin1 -t utf8 FILE` converts it.",
    _wrong(b"module: RoboCompSpeech\ndoc: La se\xf1al.\n"),
    _GOOD,
)
BINARY = Code(
    "RC0003",
    "error",
    "this is not a text file: it holds the control character {byte}",
    "A YAML document is text; control characters other than tab and the line ends cannot stand in it.",
    _wrong(b"module: Robo\x00Comp\n"),
    _GOOD,
)
TOO_LARGE = Code(
    "RC0004",
    "error",
    "{what} is {size}, more than the {limit} that a document may have",
    "Documents are written and read by people. A limit keeps a mistake, such as a data file under a document's name, "
    "from taking the machine's memory.",
    _wrong(Repeated("doc: '", "a", 1 << 20, "b'\n")),
    _GOOD,
)
UNKNOWN_KIND = Code(
    "RC0005",
    "error",
    "'{name}' is not the name of a document: it must end in {kinds}",
    "The name says what a document is: NAME.KIND.yaml, where KIND is `idsl` (interfaces), `cdsl` (a component), `pdsl` "
    "(a component's parameters), `ddsl` (a deployment) or `config` (values of parameters).",
    {"Speech.yaml": "module: RoboCompSpeech\n"},
    _GOOD,
    "check *",
)
NOTHING_FOUND = Code(
    "RC0006",
    "error",
    "there is no document in this folder",
    "The folder, and the folders below it, hold no file whose name ends in `.idsl.yaml`, `.cdsl.yaml`, "
    "`.pdsl.yaml`, `.ddsl.yaml` or `.config.yaml`. What is legacy, `rcyaml migrate` makes into such documents.",
    {"empty": None},
    _GOOD,
)
SYNTAX = Code(
    "RC0101",
    "error",
    "{problem}",
    "The text is not YAML. The usual causes are a missing blank after a colon, a tab in the indentation, a quote or a "
    "bracket that is not closed, and lines that do not line up.",
    _wrong("module: RoboCompSpeech\ninterfaces: {Speech: {}\n"),
    _GOOD,
    says=(
        "this is not YAML: {what}",
        "a '}}' or a ',' is missing before this",
        "a value is missing here",
        "a ':' makes a mapping here, where none can stand",
        "this line has no ':' after its key",
        "this line does not line up with the lines before it",
        "this line belongs to no list entry",
        "a tab stands where only blanks can indent",
        "{found} cannot start a value here",
        "this quoted text is never closed",
        "no anchor (&name) of this name stands before this alias",
    ),
)
EMPTY = Code(
    "RC0102",
    "error",
    "the document is empty",
    "A document without content says nothing. `rcyaml new` writes one to start from.",
    _wrong("# only a comment\n"),
    _GOOD,
)
DUPLICATE_KEY = Code(
    "RC0103",
    "error",
    "the key '{key}' stands twice in this mapping",
    "Of two equal keys one would silently win, and nobody can say which one was meant.",
    _wrong("module: RoboCompSpeech\nmodule: RoboCompMouth\n"),
    _GOOD,
)
SEVERAL_DOCUMENTS = Code(
    "RC0104",
    "error",
    "a second document starts here",
    "A file holds one document. `---` may stand only before it.",
    _wrong("module: RoboCompSpeech\n---\nmodule: RoboCompMouth\n"),
    _GOOD,
)
ALIASES = Code(
    "RC0105",
    "error",
    "{problem}",
    "An alias (`*name`) repeats what an anchor (`&name`) marked. Aliases of aliases can make a small text enormous, "
    "so their total is bounded, and an alias cannot stand inside of what it repeats.",
    _wrong("module: &a [*a]\n"),
    _GOOD,
    says=(
        "an alias stands inside of what it repeats",
        "aliases of this anchor make the document too large: more than {limit}",
    ),
)
TOO_DEEP = Code(
    "RC0106",
    "error",
    "this is nested more than {limit} levels deep",
    "No construct of the languages needs more than a dozen levels; deeper nesting is a mistake or an attack.",
    _wrong("module: " + "[" * 120 + "]" * 120 + "\n"),
    _GOOD,
)
LEADING_ZEROS = Code(
    "RC0107",
    "error",
    "{lexeme} is a number with leading zeros",
    "YAML 1.1 read such a number in base eight and YAML 1.2 reads it in base ten; a serial number would lose its "
    "zeros. Quotes make it text; without the zeros it is a number.",
    _wrong("module: RoboCompSpeech\nconstants:\n  serial: {type: string, value: 0495}\n"),
    {"Speech.idsl.yaml": 'module: RoboCompSpeech\nconstants:\n  serial: {type: string, value: "0495"}\n'},
)
KEY_COLON = Code(
    "RC0108",
    "error",
    "a blank is missing after the colon in '{key}'",
    "Inside `{}` a colon separates a key from its value only when a blank follows it.",
    _wrong("module: RoboCompSpeech\ntypes:\n  Words: {sequence:string}\n"),
    {"Speech.idsl.yaml": "module: RoboCompSpeech\ntypes:\n  Words: {sequence: string}\n"},
)
TAG = Code(
    "RC0109",
    "error",
    "the tag {tag} has no meaning here",
    "Documents are plain YAML 1.2: text, numbers, booleans, lists and mappings, without tags.",
    _wrong("module: !!python/object RoboCompSpeech\n"),
    _GOOD,
)
KEY_TYPE = Code(
    "RC0110",
    "error",
    "a key must be plain text, not {what}",
    "Keys name things; a list, a mapping or nothing cannot.",
    _wrong("module: RoboCompSpeech\ninterfaces:\n  [Speech, Mouth]: {}\n"),
    _GOOD,
)
NOT_A_MAPPING = Code(
    "RC0201",
    "error",
    "a document is a mapping of keys to values, and this is {what}",
    "The top of each document is a mapping: `module: …` or `component: …` and what belongs to it.",
    _wrong("- module: RoboCompSpeech\n"),
    _GOOD,
)
UNKNOWN_KEY = Code(
    "RC0202",
    "error",
    "there is no key '{key}' {where}",
    "Every key has a meaning, and a key that has none is most often misspelled. Keys that start with `x-` are free for "
    "your own use.",
    _wrong("module: RoboCompSpeech\ninterface:\n  Speech:\n    methods:\n      reset:\n"),
    _GOOD,
)
MISSING_KEY = Code(
    "RC0203",
    "error",
    "the key '{key}' is missing {where}",
    "Some keys cannot be left out, since nothing else could say what they say.",
    _wrong("interfaces:\n  Speech:\n    methods:\n      reset:\n"),
    _GOOD,
)
WRONG_SHAPE = Code(
    "RC0204",
    "error",
    "{problem}",
    "A value has another type or form than its key takes. `rcyaml schema KIND`, or an editor that knows the schemas, "
    "shows what each key takes.",
    _wrong("module: [RoboCompSpeech]\n"),
    _GOOD,
    says=(
        "{key}: is {what}",
        "'{value}' is no value: {why}",
        "the values cannot be completed: `rcyaml check` says what is wrong with their parameters",
    ),
)
WRONG_NAME = Code(
    "RC0205",
    "error",
    "'{name}' cannot be a name",
    "A name starts with a letter or an underscore and goes on with letters, digits and underscores.",
    _wrong("module: ../../etc/Speech\n"),
    _GOOD,
)
NO_KIND = Code(
    "RC0206",
    "error",
    "type '{name}' does not say what it is",
    "A type is a `struct`, an `enum`, a `sequence` or a `map`.",
    _wrong("module: RoboCompSpeech\ntypes:\n  Words: {doc: Some words.}\n"),
    {"Speech.idsl.yaml": "module: RoboCompSpeech\ntypes:\n  Words: {sequence: string}\n"},
)
TWO_KINDS = Code(
    "RC0207",
    "error",
    "type '{name}' cannot be {kinds} at once",
    "A type is one of `struct`, `enum`, `sequence` and `map`.",
    _wrong("module: RoboCompSpeech\ntypes:\n  Words: {sequence: string, enum: [one, two]}\n"),
    {"Speech.idsl.yaml": "module: RoboCompSpeech\ntypes:\n  Words: {sequence: string}\n"},
)
IMPOSSIBLE = Code(
    "RC0209",
    "error",
    "'{key}' cannot hold {what} ({character})",
    "Paths, programs, names, endpoints and the like are one line of text: they end up in units, scripts, property "
    "files and command lines, where a line break would begin another line. They hold no control characters either "
    "(U+0000 to U+001F, U+007F to U+009F, the line separators U+2028 and U+2029). Arguments and variables of the "
    "environment may hold anything but a NUL, which no program can be given.",
    _wrong('imports: ["Common\\nTypes"]\nmodule: RoboCompSpeech\n'),
    {"Speech.idsl.yaml": "imports: [CommonTypes]\nmodule: RoboCompSpeech\n",
     "CommonTypes.idsl.yaml": "module: CommonTypes\n"},
)
NAME_TOO_LONG = Code(
    "RC0210",
    "error",
    "'{name}' is too long a name: a file is called after it, and its name may have {limit} bytes at most",
    "A component's executable, and what builds it, are called after the component. Names of files have up to 255 "
    "bytes; some are taken by what is put behind the component's name, such as `_autogen`.",
    {"a.cdsl.yaml": f"component: {'A' * 250}\nlanguage: python\n"},
    {"a.cdsl.yaml": f"component: {'A' * 200}\nlanguage: python\n"},
)
BAD_ICE_TEXT = Code(
    "RC0208",
    "error",
    "'{text}' is no {what} of Ice: {problem}",
    "Under `endpoints:`, `proxies:` and `topics: manager:` of a values document stand texts that Ice reads when the "
    "component starts; what it would refuse then is refused here. Protocols of its plug-ins (ssl, wss, bt) count as "
    "known. In a document that `rcyaml migrate` wrote this is a warning, since the file that it was made of said so.",
    {"etc/config.yaml": "component: ../a.cdsl.yaml\nendpoints: {CommonBehavior: tcp -q 10001}\n",
     "a.cdsl.yaml": "component: A\nlanguage: python\n"},
    {"etc/config.yaml": "component: ../a.cdsl.yaml\nendpoints: {CommonBehavior: tcp -p 10001}\n",
     "a.cdsl.yaml": "component: A\nlanguage: python\n"},
    says=("'{text}' is no endpoint of Ice: {reason}", "'{text}' is no proxy of Ice: {reason}"),
)
WORKSPACE_SETTING = Code(
    "RC0301",
    "warning",
    "{problem}",
    "A setting of the workspace that has no effect is most often misspelled, or names what is no longer there.",
    {"rcyaml.yaml": "interfaces: [nowhere]\n", **_GOOD},
    {"rcyaml.yaml": "interfaces: [interfaces]\n", "interfaces": None, **_GOOD},
    says=(
        "there is no folder '{folder}'",
        "no diagnostic is called {code}",
        "'{value}' is no severity",
    ),
)
