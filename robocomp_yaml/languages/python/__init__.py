"""Python: components that run as they stand, with Python 3.9 and Ice 3.7 alone."""

from __future__ import annotations

from keyword import kwlist

from robocomp_yaml.languages import record
from robocomp_yaml.languages.record import CAPABILITIES, TargetLanguage

_IGNORED = frozenset((record.SOURCES, record.CLASSES, record.CMAKE, record.PKG_CONFIG, record.LINK))

LANGUAGE = TargetLanguage(
    name="python",
    title="Python",
    package=__name__,
    description="Python 3",
    has=frozenset(CAPABILITIES) - _IGNORED - {record.STANDARD},
    ignored=_IGNORED,
    datamodels=("null", "python"),
    keywords=frozenset(kwlist),
    members=frozenset(("change", "composite", "listen", "mro", "now", "plain", "self", "set")),
    states="generated/component.py",
    runtime=(
        "machine",
        "qt",
        "robocomp",
        "runtime",
        "robocomp_yaml.semantics",
        "typings/Ice",
        "typings/IcePy",
        "typings/IceStorm",
    ),
    runtime_root="generated",
    loaded={"src": (".py", ".ui"), "generated": (".py",), "slice": (".ice",)},
    made_of={"generated": (".py",), "src": (".py", ".ui"), "slice": (".ice",)},
    has_usage=True,
    has_checker=True,
    has_building=True,
    suffixes=("py",),
    comment="#",
    has_tls=True,
)
