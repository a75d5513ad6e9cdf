"""RC6xxx: emitting. What keeps a file from being written, and what a user should know about one that was."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code

_SPEECH = "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      reset:\n"
_DOCUMENTS = {
    "interfaces/Speech.idsl.yaml": _SPEECH,
    "rcyaml.yaml": "interfaces: [interfaces/]\n",
    "speech/speech.cdsl.yaml": (
        "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n"
    ),
}
_OTHER = "component: OtherComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n"
_OURS = '{{"version": 1, "files": {{"slice/Speech.ice": {{"hash": "{}", "owners": ["speech.cdsl.yaml"]}}}}}}\n'

APART = "give each component a folder of its own, and each interface document a name of its own"
USERS_PLACES = "what is yours belongs in src/ and etc/"

NOT_OURS = Code(
    "RC6001",
    "error",
    "'{path}' is there already, and rcyaml did not write it",
    "rcyaml overwrites only what it put there itself, written or merged, and knows that from `.rcyaml/manifest.json`. "
    "A file with the very text that would be written is taken over without a word; any other is yours until you say "
    "otherwise. With `--adopt` rcyaml writes its own and keeps yours as `.orig`.",
    {**_DOCUMENTS, "speech/slice/Speech.ice": "module Mine {};\n"},
    _DOCUMENTS,
    "compile .",
)
OUTSIDE = Code(
    "RC6002",
    "error",
    "'{path}' would be written outside the output folder: {reason}",
    "What rcyaml writes stays below the output folder, whatever links there are. Remove the link, or give the folder "
    "that it leads to with `-o`.",
    {**_DOCUMENTS, "speech/generated": "-> ../elsewhere", "elsewhere": None},
    _DOCUMENTS,
    "compile .",
)
CONTESTED = Code(
    "RC6003",
    "error",
    "{path} would be written for {one} and for {other}, with different contents",
    "Two documents cannot own one file. Interfaces are written to one folder under their documents' names: rename one, "
    "or compile them with different `-o`. A component has a folder of its own.",
    {"a/Speech.idsl.yaml": _SPEECH, "b/Speech.idsl.yaml": _SPEECH.replace("reset", "stop")},
    {"a/Speech.idsl.yaml": _SPEECH, "b/Mouth.idsl.yaml": _SPEECH.replace("Speech", "Mouth")},
    "compile . -o out",
)
EDITED = Code(
    "RC6004",
    "warning",
    "someone edited the generated file '{path}': {what}",
    "Generated files are written anew by each compile; what is yours goes to `src/` and `etc/`. So that no line is "
    "lost, the edited file is kept beside the new one.",
    {**_DOCUMENTS, "speech/slice/Speech.ice": "// mine\n", "speech/.rcyaml/manifest.json": _OURS.format("0" * 32)},
    _DOCUMENTS,
    "compile .",
)
CANNOT_WRITE = Code(
    "RC6005",
    "error",
    "cannot write '{path}': {reason}",
    "The operating system refused, or something that is no file stands in the way. All that belongs to this run of "
    "`compile` was left as it was.",
    {**_DOCUMENTS, "speech/generated": "a file where a folder must be\n"},
    _DOCUMENTS,
    "compile .",
)
BAD_MANIFEST = Code(
    "RC6006",
    "error",
    "cannot use this manifest: {reason}",
    "The manifest says which files rcyaml wrote, and so may change. Without it rcyaml touches nothing in this folder. "
    "Take it back from your version control; or delete it: files that are as they would be written are then taken "
    "over, and any other is reported.",
    {**_DOCUMENTS, "speech/.rcyaml/manifest.json": '{"version": 1, "files": {'},
    _DOCUMENTS,
    "compile .",
)
INTERRUPTED = Code(
    "RC6007",
    "warning",
    "an earlier compile was interrupted here: {what}",
    "rcyaml was stopped while it moved its files into place (a kill, a power cut). It keeps a journal, and the next "
    "compile puts the folder back as it was before it goes on. Look whether the files you edited since are all right.",
    {**_DOCUMENTS, "speech/.rcyaml/journal.json": '{"marks": [], "folders": []}\n'},
    _DOCUMENTS,
    "compile .",
)
PORT_CLASH = Code(
    "RC6008",
    "warning",
    "port {port} of {name} is that of {other}, too",
    "Two programs of one machine cannot listen at one port: the second one will not start. rcyaml chooses different "
    "default ports for the components of a workspace, but an `etc/config` is yours, and may have been copied. "
    "Components that never run on one machine may share a port: set the severity of this code in `rcyaml.yaml`.",
    {
        **_DOCUMENTS,
        "other/other.cdsl.yaml": _OTHER,
        "other/etc/config": "Speech.Endpoints=tcp -p 12000\n",
        "speech/etc/config": "Speech.Endpoints=tcp -p 12000\n",
    },
    {
        **_DOCUMENTS,
        "other/other.cdsl.yaml": _OTHER,
        "other/etc/config": "Speech.Endpoints=tcp -p 12000\n",
        "speech/etc/config": "Speech.Endpoints=tcp -p 12001\n",
    },
)
CHANGED = Code(
    "RC6010",
    "error",
    "'{path}' holds changes of yours, and its values document would have it rewritten",
    "rcyaml writes a component's first `etc/config` once; with `etc/config.yaml` it comes from there, and every "
    "compile rewrites it. As long as nobody changed the file, it is simply renewed. Entries of your own that the "
    "document does not give would be lost, so nothing is written: bring them into `etc/config.yaml` (`rcyaml config "
    "new` does so when it writes that document), or let `--adopt` rewrite the file, which keeps yours as `.orig`.",
    {
        "speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\n",
        "etc/config": "period.compute=7\n",
        "etc/config.yaml": "component: ../speech.cdsl.yaml\nparameters: {}\n",
        ".rcyaml/manifest.json": _OURS.format("0" * 32).replace("slice/Speech.ice", "etc/config").replace(
            '"owners"', '"once": true, "owners"'
        ),
    },
    {
        "speech.cdsl.yaml": "component: SpeechComp\nlanguage: python\n",
        "etc/config.yaml": "component: ../speech.cdsl.yaml\nparameters: {period: {compute: 7}}\n",
    },
    "compile .",
)
