"""RC61xx: what keeps a document from being compiled."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code

_LENIENT = "lint: {RC2101: warning, RC1101: warning}\n"
_SPEECH = "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      reset:\n"
_COMPONENT = "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n"

UNRESOLVED = Code(
    "RC6101",
    "error",
    "{name} is not compiled: what it imports could not be found or has errors",
    "The workspace lowers unresolved imports to warnings, so that `check` can pass while interfaces are still being "
    "collected; but nothing can be generated from an interface that is not there.",
    {"rcyaml.yaml": _LENIENT, "speech.cdsl.yaml": _COMPONENT},
    {"rcyaml.yaml": _LENIENT, "speech/speech.cdsl.yaml": _COMPONENT, "speech/Speech.idsl.yaml": _SPEECH},
    "compile .",
)
