"""RC23xx: `uses:`, what a component's own code needs."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code

_CPP = "component: SpeechComp\nlanguage: cpp\n"
_PYTHON = "component: SpeechComp\nlanguage: python\n"


def _uses(head: str, uses: str) -> dict[str, str]:
    return {"speech.cdsl.yaml": f"{head}uses: {{{uses}}}\n"}


TWO_PLACES = Code(
    "RC2301",
    "error",
    "a library comes from one place, and this entry names {places}",
    "Each entry of `libraries:` is one library, found in one way: by CMake's `find_package`, by pkg-config, by its "
    "name for the linker, or by pip. Two that are needed are two entries.",
    _uses(_CPP, "libraries: [{cmake: OpenCV, pkg-config: eigen3}]"),
    _uses(_CPP, "libraries: [{cmake: OpenCV}, {pkg-config: eigen3}]"),
)
VERSION = Code(
    "RC2302",
    "error",
    "`{version}` is for pip: {kind} compares plain numbers, with >=, <=, ==, > or <",
    "Versions of CMake packages and pkg-config modules are numbers and dots. A library that is named to the linker "
    "has no version that could be looked at.",
    _uses(_CPP, "libraries: [{cmake: OpenCV, version: \"~=4.1\"}]"),
    _uses(_CPP, "libraries: [{cmake: OpenCV, version: \">=4.1, <5\"}]"),
)
OTHER_LANGUAGE = Code(
    "RC2303",
    "warning",
    "a component in {language} does not build anything: `{key}` has no effect",
    "Sources, shared classes and libraries of CMake, pkg-config or the linker are for components in C++. A component "
    "in Python imports modules: its own from `src/`, those of others through pip.",
    _uses(_PYTHON, "libraries: [{cmake: OpenCV}]"),
    _uses(_PYTHON, "libraries: [{pip: opencv-python}]"),
)
NOT_INSTALLED = Code(
    "RC2304",
    "warning",
    "{what} is not installed here{why}",
    "`rcyaml check --environment` asks CMake, pkg-config, the linker and the Python that runs rcyaml for what the "
    "documents name. On another machine it may be there.",
    _uses(_PYTHON, "libraries: [{pip: no-such-package-of-anyone}]"),
    _uses(_PYTHON, "libraries: [{pip: click, version: \">=8\"}]"),
    "check . --environment",
    says=("{what} is not installed here", "{what} is not installed here: {reason}"),
)
NO_SOURCE = Code(
    "RC2305",
    "warning",
    "there is no {what} '{path}' beside the document or in the workspace",
    "`sources:` are files and `classes:` folders of your own repository, looked for beside the document and in the "
    "folder of `rcyaml.yaml`; classes also in its `classes/`. The build cannot do without.",
    _uses(_CPP, "sources: [classes/rcdraw.cpp]"),
    {**_uses(_CPP, "sources: [classes/rcdraw.cpp]"), "classes/rcdraw.cpp": "int answer() { return 42; }\n"},
    "check . --environment",
)
