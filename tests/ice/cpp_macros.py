"""Asks the compiler which macros the headers of generated C++ define, and which names are in no namespace.

`make macros` adds them to robocomp_yaml/languages/cpp/. Names in it stay: other versions of compilers and libraries have
other names.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TABLE = ROOT / "robocomp_yaml" / "languages" / "cpp" / "macros.py"
GLOBALS = TABLE.with_name("globals.py")
FAMILIES = ("GL_", "QT_", "Q_")
SETS = {"ALWAYS": "in every component", "SINCE_20": "with C++20 and later", "QT": "where there is a dialog"}
_HEAD = """\
\"\"\"Names of the macros that the headers of generated C++ define: nothing else in C++ can have them.

Made by `make macros`, which adds what the compiler at hand knows. Do not edit: change tests/ice/cpp_macros.py.
\"\"\"

from __future__ import annotations"""
_FOOT = """\
# Of Qt and OpenGL, which have thousands.
FAMILIES = {families}

EVER = ALWAYS | SINCE_20 | QT


def is_macro(name: str, standard: int, has_dialog: bool) -> bool:
    return (
        name in ALWAYS
        or (standard >= 20 and name in SINCE_20)
        or (has_dialog and (name in QT or name.startswith(FAMILIES)))
    )"""
_GLOBALS_HEAD = """\
\"\"\"Names of the C library's functions, types and variables, which are in no namespace: nothing in C++ can have them.

Made by `make macros`, which adds what the compiler at hand knows. Do not edit: change tests/ice/cpp_macros.py.
\"\"\"

from __future__ import annotations"""
SUFFIXES = ("", "f", "l", "f32", "f32x", "f64", "f64x", "f128")
_GLOBALS_FOOT = f"""
_SUFFIXES = {SUFFIXES}  # of the types of numbers
GLOBALS = _OTHERS.union(f"{{name}}{{suffix}}" for name in _FUNCTIONS for suffix in _SUFFIXES)
""".replace("'", '"')
_SLICE = "module M { struct S { int a; }; exception E { S s; }; interface I { S f(out int a) throws E; }; };\n"
_INCLUDE = re.compile(r"^#include <(?!Q|\{|genericworker|boost/)([^>]+)>", re.MULTILINE)


def found() -> dict[str, set[str]]:
    """The macros of this machine, by the sets of the table; without `QT` if Qt is not installed."""
    with tempfile.TemporaryDirectory() as folder:
        include = headers(Path(folder))
        always = _macros(include, 17)
        sets = {"ALWAYS": always, "SINCE_20": (_macros(include, 20) | _macros(include, 23)) - always}
        qt = next(iter(sorted(Path("/usr/include").glob("*/qt[56]/QtWidgets"))), None)
        if qt is not None:
            folders = [qt.parent, *(qt.parent / name for name in ("QtCore", "QtGui", "QtWidgets"))]
            flags = ["-fPIC", *(f"-I{path}" for path in folders)]
            sets["QT"] = _macros([*include, "QtCore", "QtWidgets", "QApplication"], 17, *flags) - always
        return sets


def detected_globals() -> set[str]:
    """The names of this machine that a namespace cannot have: each word of the headers is tried, except for known macros
    and keywords."""
    sys.path.insert(0, str(ROOT))
    from robocomp_yaml.languages.cpp import KEYWORDS
    from robocomp_yaml.languages.cpp.macros import EVER

    with tempfile.TemporaryDirectory() as folder:
        source = "".join(f"#include <{header}>\n" for header in headers(Path(folder)))
    names: set[str] = set()
    for standard in (17, 20):
        words = set(re.findall(r"\b[A-Za-z]\w*", _preprocessed(source, standard, "-P"))) - KEYWORDS - EVER
        words = {word for word in words if _can_be_named(word)}
        asked = "".join(f'#line 1 "@{word}"\nnamespace {word} {{ struct Of; }}\n' for word in sorted(words))
        flags = [f"-std=c++{standard}", "-DICE_CPP11_MAPPING", "-fsyntax-only", "-fmax-errors=0"]
        said = subprocess.run(
            ["g++", *flags, "-x", "c++", "-"], input=source + asked, capture_output=True, text=True
        ).stderr
        names |= set(re.findall(r"^@(\w+):\d+:\d+: error", said, re.MULTILINE))
    return names


def headers(folder: Path) -> list[str]:
    """Includes of the fixed sources and of slice2cpp's code."""
    (folder / "M.ice").write_text(_SLICE)
    subprocess.run(["slice2cpp", "--output-dir", str(folder), "M.ice"], cwd=folder, check=True)
    sources = sorted(path for path in (TABLE.parent / "templates").rglob("*") if path.is_file())
    texts = [path.read_text(encoding="utf-8") for path in sources]
    texts += [(folder / name).read_text() for name in ("M.h", "M.cpp")]
    names = {name for text in texts for name in _INCLUDE.findall(text)} - {"M.h"}
    of_run_time = ("machine/", "qt/", "robocomp/", "runtime/")
    names = {name for name in names if not name.startswith(of_run_time) and not name.endswith(".ice.h")}
    ours = {"IceUtil/PushDisableWarnings.h", "IceUtil/PopDisableWarnings.h", "IceUtil/UndefSysMacros.h"}
    alone = {"cxxabi.h"}  # of errors.cpp, which includes no interface
    return [*sorted(names - ours - alone), "IceUtil/UndefSysMacros.h"]


def _macros(headers: list[str], standard: int, *flags: str) -> set[str]:
    """The macros that an interface can name, and that do not expand to themselves."""
    source = "".join(f"#include <{header}>\n" for header in headers)
    listed = _preprocessed(source, standard, "-dM", *flags)
    names = set(re.findall(r"^#define (\w+)", listed, re.MULTILINE))
    names = {name for name in names if _can_be_named(name)}
    asked = source + "".join(f'\n@"{name}" {name} @\n' for name in sorted(names))
    expanded = re.findall(r'@"(\w+)"\s+([^@]*?)\s*@', _preprocessed(asked, standard, "-P", *flags))
    with_arguments = set(re.findall(r"^#define (\w+)\(", listed, re.MULTILINE))
    return names - ({name for name, text in expanded if name == text} - with_arguments)


def _preprocessed(source: str, standard: int, *flags: str) -> str:
    """With the macros that a component's build defines: for Ice, and for CMake's Release."""
    command = ["g++", f"-std=c++{standard}", "-DICE_CPP11_MAPPING", "-DNDEBUG", "-O2", "-E", *flags, "-x", "c++", "-"]
    return subprocess.run(command, input=source, capture_output=True, text=True, check=True).stdout


def _can_be_named(name: str) -> bool:
    """Slice allows underscores only between other characters, and reserves `ice…`; some families are large."""
    return all(name.split("_")) and not name.lower().startswith("ice") and not name.startswith(FAMILIES)


def table(sets: dict[str, set[str]]) -> str:
    """The module, with these sets."""
    parts = [_HEAD, *(_listed(name, sets[name], f"  # {when}") for name, when in SETS.items())]
    parts.append(_FOOT.replace("{families}", str(FAMILIES).replace("'", '"')))
    return "\n\n".join(parts) + "\n"


def globals_table(names: set[str]) -> str:
    """The module globals.py: mathematical functions are listed once for all of their types."""
    functions = {name for name in names if all(f"{name}{suffix}" in names for suffix in SUFFIXES)}
    others = names - {f"{name}{suffix}" for name in functions for suffix in SUFFIXES}
    parts = [f"{_GLOBALS_HEAD}\n", _listed("_FUNCTIONS", functions, "  # of mathematics"), _listed("_OTHERS", others)]
    return "\n".join(parts) + _GLOBALS_FOOT


def _listed(name: str, names: set[str], comment: str = "") -> str:
    words = textwrap.fill(" ".join(sorted(names)) + '""".split()', 112, break_long_words=False, break_on_hyphens=False)
    return f'{name} = frozenset({comment}\n    """{textwrap.indent(words, "    ").lstrip()}\n)'


def main() -> None:
    sys.path.insert(0, str(ROOT))
    known: dict[str, set[str]] = {name: set() for name in SETS}
    if TABLE.is_file():
        from robocomp_yaml.languages.cpp import macros as cpp_macros

        known = {name: set(getattr(cpp_macros, name)) for name in SETS}
    for name, macros in found().items():
        known[name] |= macros
    known["SINCE_20"] -= known["ALWAYS"]
    known["QT"] -= known["ALWAYS"]
    TABLE.write_text(table(known), encoding="utf-8")  # before it is imported below
    names = detected_globals()
    if GLOBALS.is_file():
        from robocomp_yaml.languages.cpp import globals as cpp_globals

        names |= cpp_globals.GLOBALS
    GLOBALS.write_text(globals_table(names), encoding="utf-8")


if __name__ == "__main__":
    main()
