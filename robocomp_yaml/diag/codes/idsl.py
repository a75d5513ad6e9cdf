"""RC1xxx, interfaces: what a schema cannot say about an IDSL document."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.diagnostic import ERROR, WARNING


def _types(types: str) -> dict[str, str | bytes | None]:
    return {"Map.idsl.yaml": f"module: RoboCompMap\ntypes:\n{types}"}


def _methods(methods: str, more: str = "") -> dict[str, str | bytes | None]:
    return {"Map.idsl.yaml": f"module: RoboCompMap\n{more}interfaces:\n  Map:\n    methods:\n{methods}"}


RESERVED_WORD = Code(
    "RC1001",
    ERROR,
    "no {kind} can be called '{name}', a reserved word of Slice",
    why="Interfaces are compiled to Ice's Slice, which keeps these words, spelled exactly so, for itself: bool byte "
    "class const dictionary double enum exception extends false float idempotent implements int interface local "
    "LocalObject long module Object optional out sequence short string struct throws true Value void. Words that "
    "Python or C++ reserve are allowed.",
    wrong=_types("  Page: {struct: {local: string}}\n"),
    right=_types("  Page: {struct: {lambda: string}}\n"),
)

ILLEGAL_NAME = Code(
    "RC1002",
    ERROR,
    "no {kind} can be called '{name}': {reason}",
    why="Slice allows underscores only between other characters, one at a time, and leaves to Ice the names that "
    "start with `ice` in whatever case, or end in `Helper`, `Holder`, `Prx` or `Ptr`.",
    wrong=_types("  Page: {struct: {_first: string}}\n"),
    right=_types("  Page: {struct: {first_line: string}}\n"),
)

DUPLICATE_NAME = Code(
    "RC1003",
    ERROR,
    "{owner} has two {kinds} called '{name}'",
    why="All that a module defines shares one set of names, whatever it is: a type and an interface cannot be called "
    "the same. Likewise the parameters of a method, in and out together, the enumerators of an enum, and the members "
    "of a struct.",
    wrong=_methods("      find: {in: {goal: string}, out: {goal: float}}\n"),
    right=_methods("      find: {in: {goal: string}, out: {distance: float}}\n"),
)

CASE_CLASH = Code(
    "RC1004",
    ERROR,
    "{owner} has the {kinds} '{other}' and '{name}', which differ only in case",
    why="Slice has targets that do not tell upper from lower case, so it refuses names that differ in nothing else.",
    wrong=_types("  Size: {struct: {w: float, W: float}}\n"),
    right=_types("  Size: {struct: {width: float, weight: float}}\n"),
)

NAME_OF_OUTER = Code(
    "RC1005",
    ERROR,
    "the {kind} '{name}' is called as its {outer}, {outer_name}",
    why="In Slice, nothing that a module defines may have the module's name, and no method that of its interface, in "
    "whatever case: in C++ and other languages such a method would be a constructor.",
    wrong=_methods("      map: {returns: string}\n"),
    right=_methods("      getMap: {returns: string}\n"),
)

PYTHON_WORD = Code(
    "RC1006",
    WARNING,
    "Ice does not escape the {kind} '{name}' in Python",
    why="Ice's mappings escape the reserved words of their languages: a member `lambda` is `_lambda` in Python. Ice "
    "3.7 forgets False, True, as, async, await, nonlocal and with, and for methods staticmethod. Components that "
    "rcyaml generates escape them too, by an underscore before; other Python programs cannot load the interface.",
    wrong=_methods("      find: {in: {with: string}}\n"),
    right=_methods("      find: {in: {lambda: string}}\n"),
)

CPP_NAME = Code(
    "RC1026",
    WARNING,
    "the C++ that Ice makes of the {kind} '{name}' does not compile",
    why="In C++, a member cannot have the name of the exception that holds it (with Ice's older mapping, nor that of "
    "its struct), and a method not that of a type that its interface uses, spelled exactly so. A parameter (or a "
    "member of an exception) hides the type of its name from those behind it, as in `in: {Pose: int, target: Pose}`. "
    "What a method gives back becomes a struct called as the method, `MoveResult` for `move`, if it is more than one "
    "thing, and then no output is called as the type of one. Slice, and Python, take them all: it is an error where a "
    "component in C++ needs the module, a warning elsewhere and in documents that were migrated.",
    wrong=_types("  Text: {struct: {Text: string}}\n"),
    right=_types("  Text: {struct: {text: string}}\n"),
)

CPP_MACRO = Code(
    "RC1027",
    WARNING,
    "in C++, no {kind} can be called '{name}': the headers that it includes have a macro of this name",
    why="Before C++ is compiled, each `EOF`, `NULL`, `errno`, `M_PI` or `assert(…)` is replaced by what the system's "
    "headers say it is, wherever it stands: as the name of a type, a member, an enumerator, a method or a parameter it "
    "does not compile, or not wherever it is used. Case counts: `eof` is free. Slice, and Python, take them: it is an "
    "error where a component in C++ needs the module, a warning elsewhere and in documents that were migrated. Some "
    "macros are there from C++20 on, and some with Qt, where a component has a dialog.",
    wrong=_types("  Result: {enum: [OK, EAGAIN]}\n"),
    right=_types("  Result: {enum: [OK, again]}\n"),
)

CPP_GLOBAL = Code(
    "RC1028",
    WARNING,
    "in C++, no module can be called '{name}': {owner} has this name",
    why="A module becomes a namespace of C++, which stands beside what the system's headers declare (`time`, `log`, "
    "`index`, `link`, `remove`) and the classes of the component (`SpecificWorker`). Case counts: `Time` is free. "
    "Slice, and Python, take them: it is an error where a component in C++ needs the module, a warning elsewhere and "
    "in documents that were migrated.",
    wrong={"Clock.idsl.yaml": "module: clock\ntypes:\n  Moment: {struct: {seconds: double}}\n"},
    right={"Clock.idsl.yaml": "module: RoboCompClock\ntypes:\n  Moment: {struct: {seconds: double}}\n"},
)

UNKNOWN_TYPE = Code(
    "RC1010",
    ERROR,
    "there is no type called '{name}'",
    why="A type is a basic one (bool, byte, short, int, long, float, double, string), one of the document's `types:`, "
    "or a type of an imported module, written behind the module's name: `CommonTypes.Pose`. Sequences and maps have "
    "names of their own, given under `types:`.",
    wrong=_types("  Path: {sequence: Pose}\n"),
    right=_types("  Path: {sequence: Pose}\n  Pose: {struct: {x: float, y: float}}\n"),
)

UNKNOWN_EXCEPTION = Code(
    "RC1011",
    ERROR,
    "there is no exception called '{name}'",
    why="A method throws exceptions that the document defines under `exceptions:`, or those of an imported module, "
    "written behind the module's name.",
    wrong=_methods("      load: {throws: [NotFound]}\n"),
    right=_methods("      load: {throws: [NotFound]}\n", "exceptions:\n  NotFound: {struct: {what: string}}\n"),
)

NOT_A_TYPE = Code(
    "RC1012",
    ERROR,
    "'{name}' is not a type, but the name of this: {kind}",
    why="Members, elements and parameters hold values. Interfaces, topics, exceptions and constants are not types of "
    "values.",
    wrong=_methods("      load: {in: {from: Map}}\n"),
    right=_methods("      load: {in: {from: string}}\n"),
)

NOT_AN_EXCEPTION = Code(
    "RC1013",
    ERROR,
    "'{name}' is not an exception, but the name of this: {kind}",
    why="Only what stands under `exceptions:` can be thrown.",
    wrong=_methods("      load: {throws: [NotFound]}\n", "types:\n  NotFound: {struct: {what: string}}\n"),
    right=_methods("      load: {throws: [NotFound]}\n", "exceptions:\n  NotFound: {struct: {what: string}}\n"),
)

THROWN_TWICE = Code(
    "RC1014",
    ERROR,
    "{method} throws '{name}' twice",
    why="Each exception that a method may throw is listed once; Slice refuses a second mention.",
    wrong=_methods("      load: {throws: [NotFound, NotFound]}\n", "exceptions: {NotFound: {}}\n"),
    right=_methods("      load: {throws: [NotFound]}\n", "exceptions: {NotFound: {}}\n"),
)

VALUE_CYCLE = Code(
    "RC1015",
    ERROR,
    "the {kind} '{name}' contains itself: {cycle}",
    why="A value that holds another of its own kind has no end, and Slice has no way to say it, not even through a "
    "sequence or a map. A tree is sent as a list of nodes that name each other.",
    wrong=_types("  Place: {struct: {name: string, near: Places}}\n  Places: {sequence: Place}\n"),
    right=_types("  Place: {struct: {name: string, near: Names}}\n  Names: {sequence: string}\n"),
)

MAP_KEY = Code(
    "RC1016",
    ERROR,
    "'{type}' cannot be the key of a map: {reason}",
    why="Keys must compare exactly, in every language: bool, byte, short, int, long, string, enums, and structs of "
    "these.",
    wrong=_types("  Heights: {map: {key: float, value: int}}\n"),
    right=_types("  Heights: {map: {key: int, value: float}}\n"),
)

SEQUENCE_KEY = Code(
    "RC1017",
    WARNING,
    "'{type}' holds a sequence, and is the key of a map",
    why="Slice still takes sequences as keys, or as parts of keys, and says that it will not for ever; a Python list "
    "cannot be the key of a dictionary.",
    wrong=_types("  Cell: {sequence: int}\n  Grid: {map: {key: Cell, value: float}}\n"),
    right=_types("  Cell: {struct: {row: int, column: int}}\n  Grid: {map: {key: Cell, value: float}}\n"),
)

EMPTY_TYPE = Code(
    "RC1018",
    ERROR,
    "the {kind} '{name}' has no {parts}",
    why="Slice refuses structs without members and enums without enumerators. Exceptions and interfaces can be "
    "empty.",
    wrong=_types("  Marker: {struct: {}}\n"),
    right=_types("  Marker: {struct: {id: int}}\n"),
)

ENUM_NUMBER_TWICE = Code(
    "RC1019",
    ERROR,
    "the enumerators '{other}' and '{name}' both have the number {number}",
    why="The number of an enumerator is what is sent. One without a number has one more than the one before it.",
    wrong=_types("  Side: {enum: {left: 1, front: 0, right: }}\n"),
    right=_types("  Side: {enum: {left: 1, front: 0, right: 2}}\n"),
)

ENUM_NUMBER = Code(
    "RC1020",
    ERROR,
    "the enumerator '{name}' has the number {number}, which is not from 0 to {largest}",
    why="The numbers of enumerators are from 0 to 2147483647. One without a number has one more than the one before "
    "it.",
    wrong=_types("  Side: {enum: {left: 2147483647, right: }}\n"),
    right=_types("  Side: {enum: {left: 2147483647, right: 0}}\n"),
)

CONSTANT_TYPE = Code(
    "RC1021",
    ERROR,
    "a constant cannot be of the type '{type}'",
    why="Constants are of a basic type, or of an enum.",
    wrong={"Map.idsl.yaml": "module: RoboCompMap\nconstants:\n  home: {type: Pose, value: 0}\n"
           "types:\n  Pose: {struct: {x: float}}\n"},
    right={"Map.idsl.yaml": "module: RoboCompMap\nconstants:\n  homeX: {type: float, value: 0}\n"},
)

DEFAULT_TYPE = Code(
    "RC1022",
    ERROR,
    "a member of the type '{type}' can have no default",
    why="Members of a basic type, or of an enum, may have a default. A struct's members have defaults of their own; "
    "sequences and maps start empty.",
    wrong=_types("  Names: {sequence: string}\n  Page: {struct: {names: {type: Names, default: none}}}\n"),
    right=_types("  Names: {sequence: string}\n  Page: {struct: {names: Names}}\n"),
)

MISFIT = Code(
    "RC1023",
    ERROR,
    "{value} does not fit the type {type}: {reason}",
    why="The value of a constant, or the default of a member, is of its type: bool is true or false; byte is from 0 "
    "to 255; short, int and long are integers of 16, 32 and 64 bits; float and double are finite numbers; string is "
    "text, in quotes where YAML would read something else; an enum's value is the name of an enumerator.",
    wrong=_types("  Motor: {struct: {speed: {type: byte, default: 300}}}\n"),
    right=_types("  Motor: {struct: {speed: {type: byte, default: 255}}}\n"),
)

NUMBER = Code(
    "RC1025",
    WARNING,
    "Ice does not carry {value} as it is: {reason}",
    why="Into the Python and C++ that it generates, Ice 3.7 writes six digits of a constant or default that has a "
    "fraction, and behind a float without a point it puts `.0F`: 1e-7 becomes 1e-07.0F, which is no C++. On the wire, "
    "numbers are whole.",
    wrong=_types("  Circle: {struct: {turn: {type: double, default: 6.283185307179586}}}\n"),
    right=_types("  Circle: {struct: {turn: {type: double, default: 6.28319}}}\n"),
)

FILE_NAME = Code(
    "RC1024",
    ERROR,
    "no Slice file can be called '{name}'",
    why="A document's name becomes that of its Slice file, which the Slice compilers, C++ and Python must be able to "
    "name.",
    wrong={"My Map.idsl.yaml": "module: RoboCompMap\n"},
    right={"MyMap.idsl.yaml": "module: RoboCompMap\n"},
)

_TYPES = "module: RoboCompTypes\ntypes:\n  Pose: {struct: {x: float}}\n"
_MAP = "module: RoboCompMap\nimports: [Types]\ntypes:\n  Path: {sequence: RoboCompTypes.Pose}\n"

UNRESOLVED_IMPORT = Code(
    "RC1101",
    ERROR,
    "there is no interface document called '{name}'",
    why="An import is the name of an IDSL document without its suffix (`CommonTypes` is `CommonTypes.idsl.yaml`), or "
    "a relative path to one. It is looked for beside the document, then in the folders under `interfaces:` of the "
    "workspace's `rcyaml.yaml`, then in `-I` and `RCYAML_PATH`. What the missing document might have defined is not "
    "reported again.",
    wrong={"Map.idsl.yaml": _MAP},
    right={"Map.idsl.yaml": _MAP, "Types.idsl.yaml": _TYPES},
)

IMPORT_CYCLE = Code(
    "RC1102",
    ERROR,
    "these documents import each other: {cycle}",
    why="A module is compiled after those that it imports, so imports may not form a circle. Move what both need to a "
    "third document.",
    wrong={
        "A.idsl.yaml": "module: RoboCompA\nimports: [B]\n",
        "B.idsl.yaml": "module: RoboCompB\nimports: [A]\n",
    },
    right={
        "A.idsl.yaml": "module: RoboCompA\nimports: [Common]\n",
        "B.idsl.yaml": "module: RoboCompB\nimports: [Common]\n",
        "Common.idsl.yaml": "module: RoboCompCommon\n",
    },
)

IMPORT_CASE = Code(
    "RC1103",
    WARNING,
    "the import '{name}' is spelled '{found}' on disk",
    why="File names differ by case on Linux, so another machine may find a different document, or none. Write the "
    "import exactly as the document is called.",
    wrong={"Map.idsl.yaml": _MAP, "types.idsl.yaml": _TYPES},
    right={"Map.idsl.yaml": _MAP, "Types.idsl.yaml": _TYPES},
)

DUPLICATE_IMPORT = Code(
    "RC1104",
    WARNING,
    "'{name}' is imported already",
    why="A document is imported once, and a module knows its own names without importing itself. The second entry "
    "does nothing: remove it.",
    wrong={"Map.idsl.yaml": _MAP.replace("[Types]", "[Types, Types]"), "Types.idsl.yaml": _TYPES},
    right={"Map.idsl.yaml": _MAP, "Types.idsl.yaml": _TYPES},
)

_LASER = "module: RoboCompLaser\ntypes:\n  Scan: {sequence: float}\n"

REDEFINED = Code(
    "RC1105",
    ERROR,
    "'{name}' of module {module} is defined twice, by {one} and by {two}",
    why="Documents may share a module, but whoever imports them, directly or not, must find each name once.",
    wrong={
        "Laser.idsl.yaml": _LASER,
        "Laser2.idsl.yaml": _LASER,
        "Map.idsl.yaml": "module: RoboCompMap\nimports: [Laser, Laser2]\n",
    },
    right={
        "Laser.idsl.yaml": _LASER,
        "Laser2.idsl.yaml": _LASER,
        "Map.idsl.yaml": "module: RoboCompMap\nimports: [Laser]\n",
    },
)

MODULE_CASE = Code(
    "RC1106",
    ERROR,
    "the modules '{name}' and '{second}' meet here, and differ only in case",
    why="Slice takes names that differ only in case for the same name, and refuses the second.",
    wrong={
        "Laser.idsl.yaml": _LASER,
        "Laser2.idsl.yaml": "module: RobocompLaser\n",
        "Map.idsl.yaml": "module: RoboCompMap\nimports: [Laser, Laser2]\n",
    },
    right={
        "Laser.idsl.yaml": _LASER,
        "Laser2.idsl.yaml": "module: RoboCompLaser\n",
        "Map.idsl.yaml": "module: RoboCompMap\nimports: [Laser, Laser2]\n",
    },
)

SAME_FILE = Code(
    "RC1107",
    ERROR,
    "{one} and {two} would both become {file}",
    why="Slice files are found by name, in one folder, and on some machines without regard to case. Two documents "
    "that are needed together must differ in the letters and digits of their names.",
    wrong={
        "Laser.idsl.yaml": _LASER,
        "old/Laser.idsl.yaml": "module: RoboCompOldLaser\n",
        "Map.idsl.yaml": "module: RoboCompMap\nimports: [Laser, old/Laser]\n",
    },
    right={
        "Laser.idsl.yaml": _LASER,
        "old/OldLaser.idsl.yaml": "module: RoboCompOldLaser\n",
        "Map.idsl.yaml": "module: RoboCompMap\nimports: [Laser, old/OldLaser]\n",
    },
)
