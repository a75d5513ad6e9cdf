"""C++: components that CMake builds, with Ice 3.7 alone."""

from __future__ import annotations

from robocomp_yaml.languages.cpp.macros import EVER
from robocomp_yaml.languages.record import CAPABILITIES, TargetLanguage

KEYWORDS = frozenset(
    """alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t char8_t class
    co_await co_return co_yield compl concept const const_cast consteval constexpr constinit continue decltype
    default delete do double dynamic_cast else enum explicit export extern false float for friend goto if inline int
    long mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public register
    reinterpret_cast requires return short signed sizeof static static_assert static_cast struct switch template
    this thread_local throw true try typedef typeid typename union unsigned using virtual void volatile wchar_t
    while xor xor_eq""".split()
)

LANGUAGE = TargetLanguage(
    name="cpp",
    title="C++",
    package=__name__,
    description="C++ with CMake",
    has=frozenset(CAPABILITIES),
    datamodels=("null",),
    standards=(17, 20, 23),
    keywords=KEYWORDS,
    taken=EVER,
    members=frozenset(("change", "listen", "now", "set", "stderr", "stdin", "stdout")),
    states="generated/component.cmake",
    runtime=("cmake", "machine", "qt", "robocomp", "runtime"),
    made_of={
        "CMakeLists.txt": (),
        "generated": (".cpp", ".h", ".cmake", ".ice", "CMakeLists.txt"),
        "src": (
            ".c",
            ".cc",
            ".cmake",
            ".cpp",
            ".cxx",
            ".h",
            ".hh",
            ".hpp",
            ".hxx",
            ".inl",
            ".ipp",
            ".qrc",
            ".tpp",
            ".ui",
        ),
        "slice": (".ice",),
    },
    build=(("cmake", "-S", "{folder}", "-B", "{folder}/build"), ("cmake", "--build", "{folder}/build")),
    suffixes=("h", "hpp", "cpp"),
    has_usage=True,
    has_building=True,
    has_checks=True,
    warns_others=True,
    has_tls=True,
)
