"""RC5xxx: what `rcyaml migrate` says about a legacy file and about what it wrote."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.diagnostic import ERROR, NOTE, WARNING

_IDSL = "module RoboCompSpeech\n{\n    interface Speech\n    {\n        bool say(string text);\n    };\n};\n"
_CDSL = (
    'import "Speech.idsl";\n\nComponent SpeechComp\n{\n    Communications\n    {\n        implements Speech;\n    };\n'
    "    language python;\n};\n"
)
_RIGHT = {"Speech.idsl": _IDSL}
_BOTH = {"Speech.idsl": _IDSL, "speech.cdsl": _CDSL}
_MIGRATE = "migrate ."


def _idsl(old: str, new: str) -> dict[str, str | bytes | None]:
    return {"Speech.idsl": _IDSL.replace(old, new)}


def _cdsl(old: str, new: str) -> dict[str, str | bytes | None]:
    return {"Speech.idsl": _IDSL, "speech.cdsl": _CDSL.replace(old, new)}


UNKNOWN_FORMAT = Code(
    "RC5001", ERROR, "this is none of the formats that can be migrated: {formats}",
    "A legacy file is known by what it holds: an interface file by `module NAME {`, a component by `Component NAME {`. "
    "The suffix helps only where the content is broken.",
    {"notes": "Remember the milk.\n"}, {"notes": _IDSL}, "migrate notes",
)  # fmt: skip
EMPTY = Code(
    "RC5002", ERROR, "there is {what} in this file, so there is nothing to migrate",
    "A file that is empty, or that holds only comments, describes no interface and no component.",
    {"Speech.idsl": "// to be written\n"}, _RIGHT, _MIGRATE,
)  # fmt: skip
SYNTAX = Code(
    "RC5003", ERROR, "{problem}",
    "The file does not follow its format's grammar here. All such places of a file are reported at once, one for each "
    "statement. Faults that are frequent in real files and have one possible meaning are repaired instead (RC5005).",
    _idsl("text);", "text)"), _RIGHT, _MIGRATE,
    says=(
        "expected {words} after '{word}', found '{found}'",
        "'{found}' cannot stand here",
        "a ';' is missing after '{word}'",
        "a '}}' is missing",
        "this {what} is never closed",
        "this is no TOML: {why}",
    ),
)  # fmt: skip
REFUSED = Code(
    "RC5004", ERROR, "{reason}",
    "Slice can say more than IDSL, and what IDSL cannot say would be lost or changed. Somebody who knows what the file "
    "is meant to say has to change it first.",
    _idsl("interface Speech", "interface Speech extends Sound"), _RIGHT, _MIGRATE,
    says=(
        "interfaces and exceptions cannot extend others in IDSL; repeat what they inherit",
        "IDSL has no {what}",
        "a module cannot stand inside of another in IDSL; give it a file of its own",
        "a sequence or dictionary inside of another type needs a name of its own, defined before",
    ),
)  # fmt: skip
REPAIRED = Code(
    "RC5005", WARNING, "{what}",
    "The file is not quite right here, as older tools let pass. What is meant is plain, so the document says it, and "
    "the line counts as repaired in the ledger (`--report`).",
    {"Speech.idsl": _IDSL + "#endif\n"}, _RIGHT, _MIGRATE,
    says=(
        "a ';' too many is left out",
        "'{text}' closes nothing and is left out",
        "the word '{text}' before the type means nothing and is left out",
        "'{text}' is imported already",
        "{what} is left out",
        "{what} is taken as {meaning}",
    ),
)  # fmt: skip
LOST = Code(
    "RC5006", WARNING, "{what}",
    "This line has no counterpart in the document, and what it asked for does not happen any more. The ledger counts "
    "it as lost, and `--strict` makes a loss an error.",
    _idsl("    interface", '    ["cpp:const"] interface'), _RIGHT, _MIGRATE,
    says=(
        "the metadata {text} has no place in IDSL",
        "the condition '{text}' has no place in IDSL; what it encloses is taken",
        "{what} has no place in {kind}",
    ),
)  # fmt: skip
OVERLOAD = Code(
    "RC5007", WARNING, "the second method '{name}' is now called '{new}'",
    "Slice and IDSL have no overloading: each method of an interface needs a name of its own. The legacy name is kept "
    "under `x-legacy-name`. Callers of this method have to use the new one.",
    _idsl("text);", "text);\n        bool say(string text, int volume);"), _RIGHT, _MIGRATE,
)  # fmt: skip
IMPORT_CASE = Code(
    "RC5008", WARNING, "the file is called '{found}', not '{name}'; the document imports '{found}'",
    "Legacy tools found a file although upper and lower case differed. The document uses the name that the file has.",
    _cdsl("Speech.idsl", "speech.idsl"), _BOTH, _MIGRATE,
)  # fmt: skip
IMPORT_UNKNOWN = Code(
    "RC5009", WARNING, "there is no interface file '{name}' among the files migrated, nor beside them",
    "The import is kept by its name. Migrate the file too, or put its document into a folder that the workspace's "
    "`interfaces:` names; until then the component cannot be compiled.",
    _cdsl("Speech.idsl", "Mouth.idsl"), _BOTH, _MIGRATE,
)  # fmt: skip
UNKNOWN_TYPE = Code(
    "RC5010", WARNING, "{problem}",
    "The legacy generator never looked what a name refers to, so such faults stayed unseen until the Slice compiler "
    "refused its output. `rcyaml check` reports the same at the document's line.",
    _idsl("string text", "Utterance text"), _RIGHT, _MIGRATE,
    says=(
        "module {module} defines no '{name}'",
        "module {module} is not imported, so '{name}' is unknown",
    ),
)  # fmt: skip
LATIN_1 = Code(
    "RC5011", WARNING, "this is not UTF-8 (the byte {byte} cannot stand here), so it is read as Latin-1",
    "Old editors wrote Latin-1. The document is UTF-8; look whether its accents are right.",
    {"Speech.idsl": b"// Se\xf1al\n" + _IDSL.encode()}, _RIGHT, _MIGRATE,
)  # fmt: skip
OTHER_FORMAT = Code(
    "RC5012", WARNING, "the name says {said}, but this is {found}",
    "The content decides what a file is; a wrong suffix is most often the trace of a copy.",
    {"speech.idsl": _CDSL.replace('import "Speech.idsl";\n', "").replace("implements Speech;", "")}, _RIGHT, _MIGRATE,
)  # fmt: skip
DUPLICATE = Code(
    "RC5013", ERROR, "'{name}' stands here a second time",
    "Of two things with one name, only one could be in the document, and nobody can say which one is meant.",
    _idsl("string text", "string text, int text"), _RIGHT, _MIGRATE,
)  # fmt: skip
BAD_NAME = Code(
    "RC5014", ERROR, "'{name}' cannot be a name",
    "Names end up in Slice and in program code: they consist of the letters A to Z, digits and underscores, and do not "
    "start with a digit.",
    _idsl("string text", "string señal"), _RIGHT, _MIGRATE,
)  # fmt: skip
UNKNOWN_VALUE = Code(
    "RC5015", ERROR, "there is no {what} '{value}'",
    "A component's language is `python` or `cpp` (`cpp11`), its graphical interface `Qt` with a `QWidget`, a "
    "`QMainWindow` or a `QDialog`.",
    _cdsl("language python", "language N++"), _BOTH, _MIGRATE,
)  # fmt: skip
NO_LANGUAGE = Code(
    "RC5016", ERROR, "component {name} does not say its language",
    "Without `language`, nobody knows what to compile the component to. Add `language python;` or `language cpp;`.",
    _cdsl("    language python;\n", ""), _BOTH, _MIGRATE,
)  # fmt: skip
NO_PLACE = Code(
    "RC5017", WARNING, "'{what}' means nothing any more; it is kept as `{key}`",
    "Clauses of the first generators chose a version of Qt, or threads, that a component now has or does not have by "
    "itself. The document keeps what they said under a key that nothing reads.",
    _cdsl("language python;", "language python;\n    useQt qt4;"), _BOTH, _MIGRATE,
)  # fmt: skip
MIDDLEWARE = Code(
    "RC5018", WARNING, "'{name}' is to speak ROS, but components speak Ice; kept as `x-middleware: ros`",
    "The legacy grammar let an interface be marked `(ros)`. A compiled component serves and calls it over Ice.",
    _cdsl("implements Speech", "implements Speech (ros)"), _BOTH, _MIGRATE,
)  # fmt: skip
STATE_MACHINE = Code(
    "RC5019", WARNING, "the state machine '{legacy}' is not migrated with the component; it has to be at '{path}'",
    "A component's document names its state machine as an SCXML file. An `.smdsl` file of the same run becomes one; "
    "any other has to be put there.",
    _cdsl("language python;", 'language python;\n    statemachine "speech.smdsl";'), _BOTH, _MIGRATE,
)  # fmt: skip
MEETING = Code(
    "RC5020", WARNING, "{other} becomes {path} already, so this one becomes {own}",
    "Two files would become the same document. The one that comes first (by format, then by name) gets the short name.",
    {"a/Speech.idsl": _IDSL, "b/Speech.idsl": _IDSL.replace("say", "tell")},
    {"a/Speech.idsl": _IDSL, "b/Mouth.idsl": _IDSL.replace("Speech", "Mouth")},
    "migrate -o out a b",
)  # fmt: skip
TAKEN = Code(
    "RC5021", ERROR, "{path} is there already, and `migrate` did not write it",
    "A file that was not written by `migrate` is never overwritten. Move it away, or migrate to another folder (`-o`).",
    {**_RIGHT, "Speech.idsl.yaml": "module: RoboCompSpeech\n"}, _RIGHT, _MIGRATE,
)  # fmt: skip
EDITED = Code(
    "RC5022", WARNING, "{path} was changed since it was written; it is kept as it is",
    "The legacy file says something new, but so does the document, by your hand. `--diff` shows what `migrate` would "
    "write, `--force` writes it.",
    {
        **_RIGHT, "Speech.idsl.yaml": "module: RoboCompSpeech\n",
        ".rcyaml/migrated.json": '{"files": {"Speech.idsl.yaml": "0"}}\n',
    }, _RIGHT, _MIGRATE,
)  # fmt: skip
NOT_WRITTEN = Code(
    "RC5023", ERROR, "{path} cannot be written: {reason}",
    "The document could not be put in its place. Nothing is half-written: each file is as it was, or as it shall be.",
    {**_RIGHT, "Speech.idsl.yaml": None}, _RIGHT, _MIGRATE,
)  # fmt: skip
NOTHING_FOUND = Code(
    "RC5024", ERROR, "there is no legacy file in this folder",
    "The folder, and the folders below it, hold no file with a suffix that can be migrated.",
    {"empty": None}, _RIGHT, _MIGRATE,
)  # fmt: skip
PREFERRED = Code(
    "RC5025", NOTE, "skipped: it was made from {other}, which is migrated",
    "A Slice file beside an IDSL file of the same name is what the legacy generator made of it.",
    {**_RIGHT, "Speech.ice": _IDSL}, _RIGHT, _MIGRATE,
)  # fmt: skip
NOT_SEARCHED = Code(
    "RC5026", WARNING, "'{name}' is migrated to {folder}, where the workspace does not look for imports",
    "A document finds its imports beside itself, and in the folders that `interfaces:` of the workspace's "
    "`rcyaml.yaml` names. `migrate` writes that file for a folder that is in no workspace, but never changes yours.",
    {"rcyaml.yaml": "doc: mine\n", "interfaces/Speech.idsl": _IDSL, "speech/speech.cdsl": _CDSL},
    {"rcyaml.yaml": "interfaces: [interfaces]\n", "interfaces/Speech.idsl": _IDSL, "speech/speech.cdsl": _CDSL},
    _MIGRATE,
)  # fmt: skip
_SPEECH: dict[str, str | bytes | None] = {**_RIGHT, "speech/speech.cdsl": _CDSL}
_COLUMNS = "# Motor: name, id, zero\nMotor0 = left,1,0.5\nMotor1 = right,2,0.4\n"
OWN_COMPONENT = Code(
    "RC5027", WARNING,
    "there is no component in this folder or the one above, so this config is one of its own, {name}",
    "A config belongs to the component (`.cdsl`) in its folder, or in the folder above. Where there is none, its "
    "parameters (`.pdsl.yaml`) stand beside it, and nobody knows which of its connections are used.",
    {"speech.conf": "Device = /dev/ttyUSB0\n"}, {**_SPEECH, "speech/etc/config": "Device = /dev/ttyUSB0\n"}, _MIGRATE,
)  # fmt: skip
GUESSED = Code(
    "RC5028", NOTE, "guessed for {name}: {what}",
    "A flat config does not say what its texts mean. The parameters (`.pdsl.yaml`) mark what was guessed with "
    "`rcyaml: guessed`. `--names KEY=a,b,c` and `--rules FILE` say it better, for a whole repository.",
    {**_SPEECH, "speech/etc/config": _COLUMNS}, {**_SPEECH, "speech/etc/config": "Motors = 2\n"}, _MIGRATE,
)  # fmt: skip
UNNAMED = Code(
    "RC5029", WARNING, "guessed for {name}: {what}",
    "Each row holds several values, and no comment above the rows has as many names. Give them with "
    "`--names KEY=a,b,c`, KEY being what the rows are called, without their number.",
    {**_SPEECH, "speech/etc/config": "Motor0 = left,1,0.5,7\n"}, {**_SPEECH, "speech/etc/config": "Motors = 2\n"},
    _MIGRATE,
)  # fmt: skip
NO_PDSL = Code(
    "RC5030", WARNING, "there is no parameter file '{name}' among the files migrated",
    "Values of 2011 (`.pconf`) say whose they are by importing a `.pdsl`. Without it, the document's `component:` "
    "names a document that is not there.",
    {"speech.pconf": 'import "speech.pdsl";\nConfigFile Speech{\n  volume = 3\n}\n'},
    {
        "speech.pconf": 'import "speech.pdsl";\nConfigFile Speech{\n  volume = 3\n}\n',
        "speech.pdsl": "ComponentParams Speech{\n  volume int 5 0:10;\n}\n",
    }, _MIGRATE,
)  # fmt: skip
NOT_ACCEPTED = Code(
    "RC5039", WARNING, "`check` will refuse {path}, line {line}: {reason}",
    "The document says what the legacy file says, and that is not right: older tools let it pass, or never looked. "
    "Mend the legacy file and migrate it again, or mend the document.",
    {**_RIGHT, "mouth.idsl": "module RoboCompMouth { interface Mouth { void __init__(); }; };\n"}, _RIGHT, _MIGRATE,
)  # fmt: skip
_OLDER = "component: SpeechComp\nlanguage: python\nimports: [Speech]\nsubscribesTo: [Speech]  # all of it\n"
_NEWER = _OLDER.replace("subscribesTo", "subscribes")
UPGRADED = Code(
    "RC5031", NOTE, "{what}",
    "Our own documents change too, if rarely. `migrate` brings older ones up to date in their place: it changes the "
    "word that is spelled differently now, and nothing else.",
    {**_RIGHT, "speech.cdsl.yaml": _OLDER}, {**_RIGHT, "speech.cdsl.yaml": _NEWER}, _MIGRATE,
    says=("'{old}' is now '{new}': {why}",),
)  # fmt: skip
BOTH_KEYS = Code(
    "RC5032", ERROR, "'{old}' is called '{new}' now, and stands here beside it",
    "An older document would be brought up to date, but it has the old key and the new one. Make one of the two.",
    {**_RIGHT, "speech.cdsl.yaml": _OLDER + "subscribes: []\n"}, {**_RIGHT, "speech.cdsl.yaml": _NEWER}, _MIGRATE,
)  # fmt: skip
