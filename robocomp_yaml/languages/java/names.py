"""Names in Java: how Ice's mapping changes a Slice name, and which names the generated files use."""

from __future__ import annotations

from robocomp_yaml.emit.lowering.ports import PortSpelling
from robocomp_yaml.languages.java import KEYWORDS, OBJECT_METHODS
from robocomp_yaml.link.program import LinkedModule

PACKAGE = "slice"
"""The Java package of all Slice modules: a package of its own, so that a module cannot hide another package."""

# Ice 3.7's mapping puts an underscore before these.
ICE_ESCAPES = (KEYWORDS - {"_"}) | OBJECT_METHODS | {"checkedCast", "uncheckedCast"}

# Types that the generated class Parameters uses: a nested type of the same name would hide them.
TYPES = KEYWORDS | frozenset(
    """Boolean Constraint Data Double Exception Expressions Float Integer Kind List Live Long Map Member Named Object
    Optional Override Parameters Spelling Store String Table Values com generated java permits record sealed slice var
    yield""".split()
)
# Methods of the generated class Parameters.
METHODS = KEYWORDS | OBJECT_METHODS | frozenset(("change", "listen", "now", "set", "table"))

_PACKAGES = frozenset(("com", "java", PACKAGE))
_WORKER = frozenset(("communicator", "log", "mutex", "parameters"))


def ice_name(name: str) -> str:
    """The name that Ice gives to a module, type, member, operation or parameter."""
    return f"_{name}" if name in ICE_ESCAPES else name


def parameter(name: str) -> str:
    """A parameter of the worker's methods: it must not hide the packages that are named in them."""
    return f"{name}_" if name in _PACKAGES else ice_name(name)


def qualified(scope: LinkedModule, name: str) -> str:
    """A definition as generated code refers to it."""
    return f"{PACKAGE}.{ice_name(scope.module.name)}.{ice_name(name)}"


def proxy(scope: LinkedModule, interface: str) -> str:
    """The class of an interface's proxies; with its suffix, the name is no keyword."""
    return f"{PACKAGE}.{ice_name(scope.module.name)}.{interface}Prx"


PORTS = PortSpelling(taken=_WORKER, published=("{name}_pubproxy",), called=ice_name)
