"""RC2xxx: components."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code

_SPEECH = "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n      say: {in: {text: string}}\n"
_ASK = (
    "module: RoboCompSpeech\ninterfaces:\n  Speech:\n    methods:\n"
    "      say: {in: {text: string}}\n      isBusy: {returns: bool}\n"
)
_MOUTH = "module: RoboCompMouth\ninterfaces:\n  Mouth:\n    methods:\n      open:\n"
_HEAD = "component: SpeechComp\nlanguage: python\n"


def _component(text: str, **others: str) -> dict[str, str | bytes | None]:
    """A component beside the modules Speech and Mouth."""
    modules = {"Speech.idsl.yaml": _SPEECH, "Mouth.idsl.yaml": _MOUTH}
    return {"speech.cdsl.yaml": _HEAD + text, **modules, **{f"{name}.idsl.yaml": t for name, t in others.items()}}


_RIGHT = _component("imports: [Speech, Mouth]\nimplements: [Speech]\nrequires: [Mouth]\n")

UNRESOLVED_IMPORT = Code(
    "RC2101",
    "error",
    "there is no interface file '{name}' to import",
    "A component imports interfaces by the name of their file without `.idsl.yaml`, or by a relative path. They are "
    "looked for beside the component, in the workspace's `interfaces:` folders, in the folders given with `-I`, and in "
    "those of the environment variable RCYAML_PATH. What the file might have defined is not reported again.",
    _component("imports: [Speach]\nimplements: [Speech]\n"),
    _RIGHT,
)
IMPORT_CASE = Code(
    "RC2102",
    "warning",
    "the file is called '{found}', not '{name}'",
    "The import is found only because upper and lower case were ignored, as legacy tools did. Other tools, and other "
    "file systems, will not find it.",
    _component("imports: [speech]\nimplements: [Speech]\n"),
    _RIGHT,
)
DUPLICATE_IMPORT = Code(
    "RC2103",
    "warning",
    "'{name}' is imported twice",
    "One import is enough.",
    _component("imports: [Speech, Speech]\nimplements: [Speech]\n"),
    _RIGHT,
)
UNKNOWN_INTERFACE = Code(
    "RC2003",
    "error",
    "component {component} {verb} interface '{name}', which no imported module defines",
    "Each interface that a component names must stand in a module that it imports. The interface's name is the one in "
    "the module, which may differ from the file's.",
    _component("imports: [Speech, Mouth]\nrequires: [Mouht]\n"),
    _RIGHT,
)
AMBIGUOUS_INTERFACE = Code(
    "RC2004",
    "error",
    "interface '{name}' is defined by more than one imported module",
    "Two imported modules define an interface of this name, and nothing says which one is meant. Put the module's "
    "name before it, as in `RoboCompSpeech.Speech`.",
    _component("imports: [Speech, Other]\nimplements: [Speech]\n",
               Other="module: RoboCompOther\ninterfaces:\n  Speech:\n    methods:\n      tell:\n"),
    _component("imports: [Speech, Other]\nimplements: [RoboCompSpeech.Speech]\n",
               Other="module: RoboCompOther\ninterfaces:\n  Speech:\n    methods:\n      tell:\n"),
)
DUPLICATE_PORT = Code(
    "RC2005",
    "error",
    "'{name}' stands twice under `{list}`",
    "Each entry of a list needs a name of its own: the name of its proxy, servant or topic in code and in the "
    "configuration. A second entry of the same interface gets one by `{Name: Interface}`.",
    _component("imports: [Mouth]\nrequires: [Mouth, Mouth]\n"),
    _component("imports: [Mouth]\nrequires: [Mouth, {Mouth1: Mouth}]\n"),
)
ACCESSOR_CLASH = Code(
    "RC2006",
    "error",
    "'{name}' and '{other}' would both be called '{accessor}' in code",
    "Code reaches a proxy by its name in lower case and `_proxy`, so two names that differ only in case would share an "
    "accessor.",
    _component("imports: [Mouth]\nrequires: [Mouth, {mouth: Mouth}]\n"),
    _component("imports: [Mouth]\nrequires: [Mouth, {Mouth1: Mouth}]\n"),
)
PARTLY_PUBLISHED = Code(
    "RC2007",
    "warning",
    "'{name}' is an interface, and as a topic offers only its methods without results; it lacks {methods}",
    "What is published goes one way: a method that returns something, has `out` parameters or throws cannot be called "
    "through a topic. An entry of `topics:` makes sure that all of its methods can.",
    _component("imports: [Speech]\npublishes: [Speech]\n", Speech=_ASK),
    _component("imports: [Speech]\npublishes: [Speech]\n"),
)
TOPIC_IMPLEMENTED = Code(
    "RC2008",
    "warning",
    "'{name}' is a topic: it is meant to be published and subscribed, not {done}",
    "An entry of `topics:` is sent to whoever subscribes. It can be called directly too, but an entry of `interfaces:` "
    "says so.",
    _component("imports: [Events]\nimplements: [Events]\n",
               Events="module: RoboCompEvents\ntopics:\n  Events:\n    methods:\n      said:\n"),
    _component("imports: [Events]\npublishes: [Events]\n",
               Events="module: RoboCompEvents\ntopics:\n  Events:\n    methods:\n      said:\n"),
)
COMMON_BEHAVIOR = Code(
    "RC2009",
    "warning",
    "every component implements CommonBehavior without being asked",
    "The generic part serves RoboComp's CommonBehavior (period, parameters, state, …). Your own implementation of it "
    "would never be called.",
    _component("imports: [CommonBehavior]\nimplements: [CommonBehavior]\n",
               CommonBehavior="module: RoboCompCommonBehavior\ninterfaces:\n  CommonBehavior:\n    methods:\n"
               "      getPeriod: {returns: int, idempotent: true}\n"),
    _RIGHT,
)
SAME_FOLDER = Code(
    "RC2010",
    "warning",
    "{name} and {other} are two components in one folder",
    "A component's generated and own code live beside its document, in `generated/` and `src/`; two components of one "
    "folder cannot both be compiled there.",
    {**_RIGHT, "other.cdsl.yaml": "component: OtherComp\nlanguage: python\n"},
    {**_RIGHT, "other/other.cdsl.yaml": "component: OtherComp\nlanguage: python\n"},
)
SAME_NAME = Code(
    "RC2011",
    "error",
    "{name} is the name of another component of this workspace, too ({other})",
    "A component's name is that of its program, its ports are chosen by it, and logs, deployments and `rcyaml config` "
    "know it by that. Two of one name are most often a folder that was copied, in which `component:` still has the old "
    "name. The same component in two languages is no mistake, nor are two workspaces (each with an `rcyaml.yaml` of "
    "its own). Where you mean it, set the severity of this code in `rcyaml.yaml`.",
    {"rcyaml.yaml": "", "speech/speech.cdsl.yaml": _HEAD, "speech2/speech.cdsl.yaml": _HEAD},
    {"rcyaml.yaml": "", "speech/speech.cdsl.yaml": _HEAD,
     "speech2/speech.cdsl.yaml": _HEAD.replace("SpeechComp", "SpeechComp2")},
)
