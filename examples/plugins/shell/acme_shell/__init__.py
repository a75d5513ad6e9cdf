"""Shell: components with a period, and without interfaces."""

from robocomp_yaml.api.plugins import TargetLanguage

LANGUAGE = TargetLanguage(
    name="shell",
    title="Shell",
    package=__name__,
    description="a script of a POSIX shell",
    has=frozenset(("period",)),
    keywords=frozenset("case do done elif else esac fi for if in then until while".split()),
    loaded={"src": (".sh",)},
    comment="#",
)
