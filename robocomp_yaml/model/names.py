"""Names in code: what a language reserves gets an underscore. Accessor generators and the checks go by this."""

from __future__ import annotations

from keyword import kwlist

from robocomp_yaml.model.cpp_macros import EVER

# The languages' own words, the members that the generated accessors have themselves, and what headers of C++ take.
PYTHON = frozenset(kwlist) | {"change", "composite", "listen", "mro", "now", "plain", "self", "set"}
CPP_KEYWORDS = frozenset(
    """alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t char8_t class
    co_await co_return co_yield compl concept const const_cast consteval constexpr constinit continue decltype
    default delete do double dynamic_cast else enum explicit export extern false float for friend goto if inline int
    long mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public register
    reinterpret_cast requires return short signed sizeof static static_assert static_cast struct switch template
    this thread_local throw true try typedef typeid typename union unsigned using virtual void volatile wchar_t
    while xor xor_eq""".split()
)
CPP = CPP_KEYWORDS | EVER | {"change", "listen", "now", "set", "stderr", "stdin", "stdout"}
LANGUAGES = {"Python": PYTHON, "C++": CPP}


def in_code(name: str, language: str) -> str:
    """The name as code of a language spells it."""
    return f"{name}_" if name in LANGUAGES[language] else name


def is_identifier(name: str) -> bool:
    return name.isascii() and name.isidentifier() and not name.startswith("__")
