"""RC206x: what a component's language does not have."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code

_HEAD = "component: SpeechComp\nlanguage: "

def _interface(struct: str) -> dict[str, str]:
    kind, name = struct.split()
    return {"Tape.idsl.yaml": f"module: RoboCompTape\ntypes: {{{name}: {{{kind}: {{length: int}}}}}}\n"}


NOT_AVAILABLE = Code(
    "RC2060",
    "error",
    "`{key}:` is not available in {language}",
    "Not every language has all that a component can have: a standard is chosen for C++ alone, and some languages have "
    "no state machines, windows or libraries. [The table of languages](languages.md) says which has what. What would "
    "have no effect is refused, since a component that lacks half of what its document says is found out on the robot.",
    {"speech.cdsl.yaml": f"{_HEAD}{{name: python, standard: 20}}\n"},
    {"speech.cdsl.yaml": f"{_HEAD}{{name: cpp, standard: 20}}\n"},
)
IMPOSSIBLE_NAME = Code(
    "RC2061",
    "error",
    "in {language}, no {kind} can be called '{name}'",
    "Ice's mapping to a language escapes the language's reserved words, but not all names that its own code needs, nor "
    "words that the language reserved later, such as `record` in Java. It is an error where a component in that "
    "language needs the interface, and nothing elsewhere.",
    {**_interface("struct record"), "tape.cdsl.yaml": "component: TapeComp\nlanguage: java\nimports: [Tape]\n"},
    {**_interface("struct recording"), "tape.cdsl.yaml": "component: TapeComp\nlanguage: java\nimports: [Tape]\n"},
)
NOT_MERGED = Code(
    "RC2062",
    "warning",
    "{path} stays as it is: merging is not available in {language}",
    "`rcyaml compile --merge` brings your class up to date with its interfaces in languages whose code it reads. In "
    "the others nothing of yours is touched; the build names the methods that the class lacks.",
    {
        "tape.cdsl.yaml": "component: TapeComp\nlanguage: java\nperiod: 20 ms\n",
        "src/SpecificWorker.java": "public class SpecificWorker extends generated.GenericWorker {\n}\n",
    },
    {"tape.cdsl.yaml": "component: TapeComp\nlanguage: java\nperiod: 20 ms\n"},
    "compile . --merge",
)
