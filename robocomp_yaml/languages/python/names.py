"""Names in Python: how Ice's mapping changes a Slice name, and how clashes are resolved."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from robocomp_yaml.emit.lowering.ports import PortSpelling
from robocomp_yaml.semantics.slice_names import NOT_ESCAPED

# Ice 3.7's mapping puts an underscore before these. The keywords that it does not escape are escaped when the generated
# component loads its Slice (templates/runtime/keywords.py).
ICE_ESCAPES = frozenset(
    "None and assert break class continue def del elif else except exec finally for from global if import in is lambda "
    "not or pass print raise return self try while yield".split()
)
_PROXY_METHODS = frozenset(("checkedCast", "uncheckedCast"))
_KEYWORDS = ICE_ESCAPES.union(NOT_ESCAPED)

# Attributes of every worker: accessors and methods of the same name are renamed.
WORKER_ATTRIBUTES = frozenset(
    "communicator compute getPeriod initialize initializeGui killYourSelf log mayTake mutex parameters runInGui "
    "runInWorker setPeriod ui window".split()
)

# Names that the generated files use beside the Slice modules.
_TAKEN = frozenset(
    "COMPONENT Component Context Events GenericWorker Implemented MACHINE MODELS MachineWorker Method Parameters "
    "Published Required SpecificWorker Subscribed "
    "Worker annotations bool bytes dict float int list load main str super tuple".split()
)


def ice_name(name: str) -> str:
    """The name that Ice gives to an operation of a servant or to a module."""
    return f"_{name}" if name in ICE_ESCAPES else name


def python_name(name: str) -> str:
    """The attribute or variable for a name."""
    return f"_{name}" if name in _KEYWORDS else name


def proxy_method(name: str) -> str:
    """An operation in the proxy."""
    return f"_{name}" if name in _PROXY_METHODS else python_name(name)


def module_variable(name: str) -> str:
    """The variable that holds a Slice module in a generated file."""
    return f"_{name}" if name in _TAKEN else python_name(name)


def parameters(names: Iterable[str], modules: Iterable[str]) -> Iterator[str]:
    """The parameters of a method in a file that uses these module variables."""
    hidden = {"self", *modules}
    for name in names:
        yield f"_{name}" if name in hidden else python_name(name)


PORTS = PortSpelling(
    taken=WORKER_ATTRIBUTES,
    published=("{name}_proxy", "{name}_pubproxy"),
    called=proxy_method,
    property="`{name}`",
)
