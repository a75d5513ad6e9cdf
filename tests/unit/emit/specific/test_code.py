"""Reading the user's code."""

from __future__ import annotations

import pytest

from robocomp_yaml.emit.specific.code import SourceCode
from robocomp_yaml.emit.specific.reading import read

PYTHON = '''"""Mine."""
from generated.interfaces import RoboCompArm, RoboCompLeg as Leg
import math

class Other:
    def compute(self): pass

if math:
    class SpecificWorker(GenericWorker, mixins.Speaker):
        """Übungen"""

        # Says it.
        @logged
        def Speech_say(self, text: str, /, loud=False, *more, voice: str, **rest) -> bool:
            """Says."""
            return True
            # and that is all

        async def Speech_wait(self): ...
        if math.pi > 3:
            def Speech_stop(self, *, at, now=True): pass
        Speech_sing = Speech_wait
'''

CPP = """#pragma once
#include "genericworker.h"
#  include <vector>

namespace mine {
class SpecificWorker; // this one is only named
}

class SpecificWorker final : public GenericWorker, private mine::Speaker
{
    Q_OBJECT
public:
    explicit SpecificWorker(int a);
    /// Says it.
    bool Speech_say(const std::string & text,
                    RoboCompSpeech::Voices /* voices */, int times = 1) override;
    auto Speech_wait(float) -> std::vector<int>;
    int inlined() const { return 1; }
public slots:
    std::vector<int>& list();
#ifdef LOUD
    void Speech_shout();
#endif
signals:
    void done();
private:
    int count_{0};
    void (*callback_)(int);
};

inline bool SpecificWorker::Speech_say(const std::string& text, RoboCompSpeech::Voices, int)
{
    return text.empty();
}
"""


def code(path: str, text: str) -> SourceCode:
    found = read(path, text)
    assert found is not None
    return found


def test_a_python_class() -> None:
    found = code("src/specificworker.py", PYTHON)
    say, wait, stop, sing = found.members
    assert [m.name for m in found.members] == ["Speech_say", "Speech_wait", "Speech_stop", "Speech_sing"]
    assert found.location and (found.location.line, found.location.column, found.location.end_column) == (9, 11, 25)
    assert found.bases == ("GenericWorker", "mixins.Speaker")
    assert say.signature and say.signature.parameters == ("text : str", "loud = False")
    assert (say.signature.least, say.signature.most, say.signature.returns) == (2, None, "bool"), "voice is required"
    assert stop.nested and stop.signature and (stop.signature.least, stop.signature.most) == (1, 0)
    assert sing.signature is None
    assert found.text_of(say).startswith("        # Says it.\n        @logged\n")
    assert found.text_of(say).endswith("# and that is all\n")
    assert found.text_of(wait) == "        async def Speech_wait(self): ...\n"
    assert [one.line for one in found.imports] == [
        "from generated.interfaces import RoboCompArm\n",
        "from generated.interfaces import RoboCompLeg as Leg\n",
    ]
    assert found.import_end == 3 and found.faults == 0


def test_a_cpp_class() -> None:
    found = code("src/specificworker.h", CPP)
    assert [m.name for m in found.members] == [
        "SpecificWorker",
        "Speech_say",
        "Speech_wait",
        "inlined",
        "list",
        "Speech_shout",
        "done",
    ]
    _, say, wait, inlined, list_, shout, _ = found.members
    assert found.location and found.location.line == 9 and found.lines[found.body_end] == "};\n"
    assert found.bases == ("GenericWorker", "mine::Speaker")
    assert say.signature and say.signature.names == ("text", "", "times")
    assert say.signature.parameters == ("const std :: string &", "RoboCompSpeech :: Voices", "int")
    assert (say.signature.least, say.signature.most, say.signature.returns) == (2, 3, "bool")
    assert wait.signature and wait.signature.returns == "std :: vector < int >"
    assert list_.signature and list_.signature.returns == "std :: vector < int >&"
    assert (say.has_body, inlined.has_body, shout.nested) == (False, True, True)
    assert [(m.name, m.location.line) for m in found.definitions] == [("Speech_say", 31)]
    assert found.import_end == 3 and found.faults == 0


def test_includes_behind_an_include_guard() -> None:
    code = read(
        "a.h", "#ifndef A_H\n#define A_H\n#include <vector>\n#ifdef X\n#include <x.h>\n#endif\nint a;\n#endif\n"
    )
    assert code is not None
    assert [one.key for one in code.imports] == ["<vector>"] and code.import_end == 3


@pytest.mark.parametrize("path", ["a.py", "a.h", "a.cpp"])
@pytest.mark.parametrize("text", ["", "\n", "\0", "(" * 3000, "class SpecificWorker", "ü\r\n\f\x1c", "}{" * 50])
def test_any_text_can_be_read(path: str, text: str) -> None:
    assert "".join(code(path, text).lines) == text


def test_syntax_errors_are_counted() -> None:
    assert code("a.py", "def f(:\n    pass\n").faults
    assert code("a.cpp", "void f( {\n").faults
    assert code("a.cpp", "void f() {}\n").faults == 0


def test_other_files_are_not_code() -> None:
    assert read("CMakeLists.txt", "project(x)\n") is None
