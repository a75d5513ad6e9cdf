"""RC1xxx, interfaces: what a schema cannot say about an IDSL document."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.diagnostic import ERROR, WARNING

_TYPES = "module: RoboCompTypes\ntypes:\n  Pose: {struct: {x: float}}\n"
_MAP = "module: RoboCompMap\nimports: [Types]\ntypes:\n  Path: {sequence: Types.Pose}\n"

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
