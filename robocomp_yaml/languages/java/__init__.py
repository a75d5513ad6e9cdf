"""Java: components that a script builds with the JDK, from Java 17 on, and that need Ice 3.7 for Java."""

from __future__ import annotations

from robocomp_yaml.languages.record import MERGING, PARAMETERS, PERIOD, PORTS, TargetLanguage

KEYWORDS = frozenset(
    """_ abstract assert boolean break byte case catch char class const continue default do double else enum extends
    false final finally float for goto if implements import instanceof int interface long native new null package
    private protected public return short static strictfp super switch synchronized this throw throws transient true
    try void volatile while""".split()
)
OBJECT_METHODS = frozenset("clone equals finalize getClass hashCode notify notifyAll toString wait".split())

LANGUAGE = TargetLanguage(
    name="java",
    title="Java",
    package=__name__,
    description="Java 17, with the JDK alone",
    has=frozenset((*PORTS, PARAMETERS, PERIOD, MERGING)),
    keywords=KEYWORDS,
    members=frozenset(("change", "listen", "now", "set")),
    states="generated/Main.java",
    runtime=("runtime",),
    build=(("{folder}/generated/build",),),
    loaded={"build": (".jar",)},
    made_of={"generated": (".java", ".sh", "build", "start"), "src": (".java",), "slice": (".ice",), "lib": (".jar",)},
    suffixes=("java",),
    has_usage=True,
    has_tls=True,
    has_checks=True,
)
