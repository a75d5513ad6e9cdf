"""Shell: a component that does something every period, and speaks with nobody."""

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
