"""Names in C++: how Ice's C++11 mapping changes a Slice name, and how clashes are resolved."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from robocomp_yaml.emit.lowering.names import NameAllocator
from robocomp_yaml.emit.lowering.ports import PortSpelling
from robocomp_yaml.languages.cpp import KEYWORDS
from robocomp_yaml.languages.cpp.macros import EVER
from robocomp_yaml.link.program import LinkedModule

# Ice 3.7's mapping puts `_cpp_` before these.
ICE_ESCAPES = frozenset(
    "alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t class compl const "
    "const_cast constexpr continue decltype default delete do double dynamic_cast else enum explicit export extern "
    "false float for friend goto if inline int long mutable namespace new noexcept not not_eq nullptr operator or "
    "or_eq private protected public register reinterpret_cast requires return short signed sizeof static static_assert "
    "static_cast struct switch template this thread_local throw true try typedef typeid typename union unsigned using "
    "virtual void volatile wchar_t while xor xor_eq".split()
)
# And later keywords, which the mapping does not escape: components may use a later standard. And macros.
_KEYWORDS = ICE_ESCAPES | KEYWORDS | EVER


def ice_name(name: str) -> str:
    """The name that Ice gives to a type, member, operation or parameter."""
    return f"_cpp_{name}" if name in ICE_ESCAPES else name


def qualified(scope: LinkedModule, name: str) -> str:
    """A definition as generated code refers to it."""
    return f"{ice_name(scope.module.name)}::{ice_name(name)}"


def proxy(scope: LinkedModule, interface: str) -> str:
    """The class of an interface's proxies; with its suffix, the name is no keyword."""
    return f"{ice_name(scope.module.name)}::{interface}Prx"


def parameter(name: str) -> str:
    return f"{name}_" if name in _KEYWORDS else name


PORTS = PortSpelling(
    taken=frozenset(("parameters",)) | _KEYWORDS,
    published=("{name}_pubproxy",),
    called=ice_name,
)


def older_names(proxies: Collection[str]) -> Iterator[tuple[str, str]]:
    """The names that older versions of RoboComp's tool gave to proxies, with those of today. They named the proxy of a
    publisher like that of a server, and counted proxies of one interface from 0."""
    taken = set(proxies)
    for now in proxies:
        stem = now.removesuffix("_pubproxy").removesuffix("_proxy")
        candidates = [f"{stem}_proxy"] if now.endswith("_pubproxy") else []
        if f"{stem}1_proxy" in taken:
            candidates.append(f"{stem}0_proxy")
        for name in candidates:
            if name not in taken:
                taken.add(name)
                yield name, now


def names(taken: Iterable[str] = ()) -> NameAllocator:
    """Names that are not keywords or macros of C++ either."""
    return NameAllocator((*taken, *_KEYWORDS))
