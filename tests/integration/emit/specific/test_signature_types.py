"""Types in the signatures of the user's methods: what is surely another type is reported, no other spelling is."""

from __future__ import annotations

import pytest

from conftest import write_tree
from robocomp_yaml.emit.specific.compare import compare
from robocomp_yaml.languages.cpp import code as cpp
from robocomp_yaml.languages.python import code as python
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.pipeline import analyse

ARM = """
module: RoboCompArm
imports: [Base]
types:
  Joint: {struct: {name: string, angle: float}}
  Joints: {sequence: Joint}
  Goals: {map: {key: string, value: Joint}}
  Image: {sequence: byte}
  Grid: {sequence: Image}
  Mode: {enum: [slow, fast]}
interfaces:
  Arm: {methods: {go: }}
"""
BASE = "module: RoboCompBase\ntypes: {Pose: {struct: {x: float}}, Joint: {struct: {a: int}}}\n"
COMP = "component: ArmComp\nlanguage: cpp\nimports: [Arm]\nimplements: [Arm]\n"


@pytest.fixture(scope="module")
def linked(tmp_path_factory: pytest.TempPathFactory) -> LinkedComponent:
    tree = {"Arm.idsl.yaml": ARM, "Base.idsl.yaml": BASE, "arm.cdsl.yaml": COMP}
    (found,) = analyse([str(write_tree(tmp_path_factory.mktemp("types"), tree))]).program.components.values()
    return found


def differ(linked: LinkedComponent, language: str, yours: str, expected: str, *, converts: bool = False) -> bool:
    """Whether a method with a signature is outdated, if the skeleton has the other one."""
    part, path = (cpp, "a.h") if language == "cpp" else (python, "a.py")
    ends = ("class SpecificWorker\n{\n%s\n};\n", ";") if language == "cpp" else ("class SpecificWorker:\n%s\n", ": ...")
    own, _, mine = yours.rpartition("\n")
    new, code = (part.read(path, ends[0] % f"    {text}{ends[1]}") for text in (expected, mine))
    types = part.SignatureTypes(linked, [own], converts=converts)
    return bool(compare([new], {}, [code], differ=types.differ).outdated)


EQUAL_CPP = [
    ("void f(const RoboCompArm::Joint& j)", "void f(Joint j)"),
    ("void f(const RoboCompArm::Joint& j)", "void f(const ::RoboCompArm::Joint &joint)"),
    ("void f(const RoboCompArm::Joint& j)", "void f(struct RoboCompArm::Joint const& j)"),
    ("void f(const RoboCompArm::Mode& j)", "namespace RA = RoboCompArm;\nvoid f(RA::Mode m)"),
    ("void f(const RoboCompArm::Mode& j)", "using M = RoboCompArm::Mode;\nvoid f(M m)"),
    ("void f(const RoboCompArm::Mode& j)", "typedef RoboCompArm::Mode Joint;\nvoid f(Joint m)"),
    ("void f(const RoboCompArm::Joints& j)", "void f(const std::vector<RoboCompArm::Joint>& j)"),
    ("void f(const RoboCompArm::Joints& j)", "void f(vector <Joint> j)"),
    ("void f(const RoboCompArm::Grid& g)", "void f(const std::vector<std::vector<unsigned char>>& g)"),
    ("void f(const RoboCompArm::Grid& g)", "void f(std::vector<Ice::ByteSeq> g)"),
    ("void f(const RoboCompArm::Image& g)", "void f(const std::vector<std::uint8_t>& g)"),
    ("void f(const RoboCompArm::Goals& g)", "void f(const std::map<std::string, RoboCompArm::Joint>& g)"),
    ("void f(const RoboCompArm::Goals& g)", "void f(std::map<std::string, RoboCompArm::Joint, std::less<>> g)"),
    ("void f(const std::string& s)", "void f(std::string s = {})"),
    ("void f(const std::string& s)", "void f(std::string_view s)"),
    ("void f(const std::string& s)", "void f(QString s)"),
    ("void f(long long int n)", "void f(Ice::Long n)"),
    ("void f(long long int n)", "void f(std::int64_t n)"),
    ("void f(short n, int m)", "void f(Ice::Short n, int32_t)"),
    ("void f(float x, float y)", "void f(float right, float x)"),
    ("void f(float x)", "using real = double;\nvoid f(real x)"),
    ("void f(float x)", "void f(auto x)"),
    ("RoboCompArm::Joint f()", "auto f() -> RoboCompArm::Joint"),
    ("RoboCompArm::Joint f()", "auto f()"),
    ("RoboCompArm::Joints f()", "std::vector<RoboCompArm::Joint> f()"),
    ("void f(const RoboCompArm::Joint& j)", "void f(const T& j)"),
    ("void f(RoboCompBase::Pose& p)", "void f(Base::Pose& p)"),
]
OTHER_CPP = [
    ("void f(const RoboCompArm::Joint& j)", "void f(const RoboCompBase::Pose& j)"),
    ("void f(const RoboCompArm::Joint& j)", "void f(const RoboCompBase::Joint& j)"),
    ("void f(const RoboCompArm::Joint& j)", "void f(const RoboCompArm::Knee& j)"),  # which it was once
    ("void f(const RoboCompArm::Joint& j)", "void f(RoboCompArm::Mode j)"),
    ("void f(const RoboCompArm::Joints& j)", "void f(const RoboCompArm::Joint& j)"),
    ("void f(const RoboCompArm::Joints& j)", "void f(const std::vector<RoboCompBase::Pose>& j)"),
    ("void f(const RoboCompArm::Joints& j)", "void f(std::vector<int> j)"),
    ("void f(const RoboCompArm::Goals& j)", "void f(const RoboCompArm::Joints& j)"),
    ("void f(const RoboCompArm::Goals& j)", "void f(const std::map<int, RoboCompArm::Joint>& j)"),
    ("void f(float x)", "void f(double x)"),
    ("void f(float x, float y)", "void f(float y, float x)"),
    ("void f(float x)", "void f(const std::string& x)"),
    ("void f(int n)", "void f(RoboCompArm::Mode n)"),
    ("void f(int n)", "void f(long long n)"),
    ("void f(Ice::Byte n)", "void f(int n)"),
    ("float f()", "void f()"),
    ("void f()", "bool f()"),
    ("RoboCompArm::Joint f()", "auto f() -> RoboCompArm::Mode"),
]
EQUAL_PYTHON = [
    ("def f(self, j: RoboCompArm.Joint)", "def f(self, j)"),
    ("def f(self, j: RoboCompArm.Joint)", 'def f(self, j: "RoboCompArm.Joint")'),
    ("def f(self, j: RoboCompArm.Joint)", "def f(self, j: ifaces.RoboCompArm.Joint)"),
    ("def f(self, j: RoboCompArm.Joint)", "def f(self, j: RoboCompArm.Joint | None)"),
    ("def f(self, j: RoboCompArm.Joint)", "def f(self, j: Optional[RoboCompArm.Joint] = None)"),
    ("def f(self, j: RoboCompArm.Joint)", "from x import Knee as Joint\ndef f(self, j: Joint)"),
    ("def f(self, j: RoboCompArm.Mode)", "Pose = RoboCompArm.Mode\ndef f(self, j: Pose)"),
    ("def f(self, j: RoboCompArm.Mode)", "import generated.interfaces as g\ndef f(self, j: g.RoboCompArm.Mode)"),
    ("def f(self, j: list[RoboCompArm.Joint])", "def f(self, j: list)"),
    ("def f(self, j: list[RoboCompArm.Joint])", "def f(self, j: typing.Sequence[RoboCompArm.Joint])"),
    ("def f(self, j: list[RoboCompArm.Joint])", "def f(self, j: ifaces.RoboCompArm.Joints)"),
    ("def f(self, j: list[RoboCompArm.Joint])", "def f(self, j: List[Any])"),
    ("def f(self, j: bytes)", "def f(self, j: np.ndarray)"),
    ("def f(self, j: bytes)", "def f(self, j: list[int])"),
    ("def f(self, x: int)", "def f(self, x: float)"),
    ("def f(self, x: int)", "def f(self, x: object)"),
    ("def f(self) -> float", "def f(self) -> int"),
    ("def f(self) -> float", "def f(self)"),
    ("def f(self) -> None", "def f(self) -> bool"),
    ("def f(self) -> tuple[int, str]", "def f(self) -> tuple"),
    ("def f(self) -> tuple[int, str]", "def f(self) -> tuple[int, ...]"),
    ("def f(self, j: dict[str, RoboCompArm.Joint])", "def f(self, j: Mapping[str, RoboCompArm.Joint])"),
]
OTHER_PYTHON = [
    ("def f(self, j: RoboCompArm.Joint)", "def f(self, j: RoboCompBase.Pose)"),
    ("def f(self, j: RoboCompArm.Joint)", "def f(self, j: RoboCompBase.Joint)"),
    ("def f(self, j: RoboCompArm.Joint)", "def f(self, j: RoboCompArm.Knee)"),
    ("def f(self, j: RoboCompArm.Joint)", "def f(self, j: str)"),
    ("def f(self, j: RoboCompArm.Joint)", "def f(self, j: RoboCompArm.Mode | None)"),
    ("def f(self, x: str)", "def f(self, x: int = 3)"),
    ("def f(self, x: float)", "def f(self, x: int)"),
    ("def f(self, x: int)", "def f(self, x: Iterable[int])"),
    ("def f(self, j: list[RoboCompArm.Joint])", "def f(self, j: RoboCompArm.Joint)"),
    ("def f(self, j: list[RoboCompArm.Joint])", "def f(self, j: list[int])"),
    ("def f(self, j: dict[str, RoboCompArm.Joint])", "def f(self, j: dict[int, RoboCompArm.Joint])"),
    ("def f(self) -> int", "def f(self) -> float"),
    ("def f(self) -> int", "def f(self) -> None"),
    ("def f(self) -> tuple[int, str]", "def f(self) -> tuple[int, str, bool]"),
    ("def f(self) -> tuple[int, str]", "def f(self) -> int"),
    ("def f(self) -> RoboCompArm.Mode", "def f(self) -> int"),
]


@pytest.mark.parametrize(
    ("language", "expected", "yours"),
    [("cpp", *pair) for pair in EQUAL_CPP] + [("python", *pair) for pair in EQUAL_PYTHON],
)
def test_another_spelling_is_accepted(linked: LinkedComponent, language: str, expected: str, yours: str) -> None:
    assert not differ(linked, language, yours, expected)


@pytest.mark.parametrize(
    ("language", "expected", "yours"),
    [("cpp", *pair) for pair in OTHER_CPP] + [("python", *pair) for pair in OTHER_PYTHON],
)
def test_another_type_is_reported(linked: LinkedComponent, language: str, expected: str, yours: str) -> None:
    assert differ(linked, language, yours, expected)


@pytest.mark.parametrize(("expected", "yours", "is_other"), [
    ("void f(float x)", "void f(double x)", False),
    ("void f()", "bool f()", False),
    ("void f(const RoboCompArm::Joint& j)", "void f(RoboCompArm::Mode j)", True),
    ("void f(const RoboCompArm::Joints& j)", "void f(RoboCompArm::Joint j)", True),
])  # fmt: skip
def test_the_worker_of_robocomps_tool_converts(
    linked: LinkedComponent, expected: str, yours: str, *, is_other: bool
) -> None:
    assert differ(linked, "cpp", yours, expected, converts=True) == is_other
