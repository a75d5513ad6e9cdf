"""CDSL files as documents."""

from __future__ import annotations

from pathlib import Path

import pytest
from test_idsl import expected, migrated, warnings


def test_every_clause(tmp_path: Path) -> None:
    assert migrated(
        tmp_path,
        """
        import "/robocomp/interfaces/IDSLs/Speech.idsl";
        import "../../..//interfaces/IDSLs/Mouth.idsl";
        import "AGGLPlanner";
        /** Says things. */
        Component SpeechComp
        {
            gui Qt (QMainWindow);
            Communications
            {
                requires Mouth, Camera, Mouth;
                implements Speech;
                publishes SpeechEvents;
                requires Laser;
                subscribesTo Asr;
            };
            RoboCompClasses { "/Classes/rcdraw/rcdraw.cpp"; rapplication; };
            RoboCompModules { ipp; "opencv"; };
            LANGUAGE Cpp11;
            options DSR, agmagent;
            stateMachine "speech.smdsl" visual;
            useQt qt4;
            worker isThread;
        };
    """,
        "speech.cdsl",
    ) == expected("""
        component: SpeechComp
        doc: Says things.
        language: cpp
        imports: [Speech, Mouth, AGGLPlanner]
        implements: [Speech]
        requires: [Mouth, Camera, {Mouth1: Mouth}, Laser]
        publishes: [SpeechEvents]
        subscribes: [Asr]
        statemachine: speech.scxml
        gui: {toolkit: qt, base: QMainWindow}
        options: [dsr, agmagent]
        uses:
          sources: [Classes/rcdraw/rcdraw.cpp]
          classes: [rapplication]
          libraries: [{link: ipp}, {link: opencv}]
        x-legacy-visual: "true"
        x-legacy-use-qt: qt4
        x-legacy-worker: isThread
    """)


def test_comments_keep_their_position(tmp_path: Path) -> None:
    assert migrated(
        tmp_path,
        """
        // Licence
        import "A.idsl"; // a
        Component C { // the component
            Communications {
                // what it calls
                requires A, // first
                         A; // both
                // nothing else
            };
            language python; // of course
            // options agmagent;
            RoboCompModules {
                // OpenCV;
                ipp; // fast
                // the rest
            };
            RoboCompClasses { // qlog;
            };
        };
    """,
        "c.cdsl",
    ) == expected("""
        # Licence
        component: C  # the component
        language: python  # of course
        imports:
          - A  # a
        # what it calls
        requires:  # both
          - A  # first
          - {A1: A}
          # nothing else
        # options agmagent;
        uses:
          libraries:
            # OpenCV;
            - {link: ipp}  # fast
            # the rest
        # qlog;
    """)


@pytest.mark.parametrize(("listed", "written"), [
    ("A, A, A", "[A, {A1: A}, {A2: A}]"),
    ("A, A1, A", "[A, A1, {A2: A}]"),
    ("A, A, A1", "[A, {A2: A}, A1]"),
    ("A (ice), B", "[A, B]"),
    ("A (ros)", "[{A: {interface: A, x-middleware: ros}}]"),
    ("IMU, ImplementsX, Requires1", "[IMU, ImplementsX, Requires1]"),
])  # fmt: skip
def test_lists_keep_order_and_multiplicity(tmp_path: Path, listed: str, written: str) -> None:
    text = migrated(tmp_path, f"Component C {{ Communications {{ requires {listed}; }}; language cpp; }};", "c.cdsl")
    assert f"requires: {written}\n" in text


@pytest.mark.parametrize(("source", "said"), [
    ("Component C { Communications { requires A\n implements B; }; language cpp; };", ["1:41 a ';' is missing here"]),
    ("Component C { Communications { requires A,\n }; language cpp; };",
     ["1:42 nothing follows the last ',' of this list", "1:42 a ';' is missing here"]),
    ("Component C { language cpp; };\nnvidia", ["2:1 'nvidia' follows the component, and is kept as a comment"]),
    ("Component C { language Cpp//Cpp11//python;\n };", ["1:26 a ';' is missing here"]),
    ("Component C { gui Qt(QWidget//QDialog);\n language cpp; };",
     ["1:28 a ')' is missing here", "1:28 a ';' is missing here"]),
    ("Component C { language cpp; useQt qt4; };",
     ["1:29 'qt4' has no effect any more; it is kept as `x-legacy-use-qt`"]),
    ("Component C { Communications { requires A(ros); }; language cpp; };",
     ["1:41 'A' uses ROS, but components use Ice; kept as `x-middleware: ros`"]),
    ("Component C { language cpp; ; };", ["1:29 a superfluous ';' is omitted"]),
])  # fmt: skip
def test_faults_of_real_files_are_repaired(tmp_path: Path, source: str, said: list[str]) -> None:
    assert migrated(tmp_path, source, "c.cdsl").startswith("component: C\nlanguage: cpp")
    assert warnings(tmp_path, source, "c.cdsl") == said


OURS = "from generated.genericworker import GenericWorker\n"


@pytest.mark.parametrize(("code", "requires"), [
    ("jointmotor0_proxy->stop(); jointmotor1_proxy->stop();", "[{JointMotor0: JointMotor}, {JointMotor1: JointMotor}, Arm]"),
    ("jointmotor_proxy->stop(); jointmotor1_proxy->stop(); arm0_proxy;", "[JointMotor, {JointMotor1: JointMotor}, Arm]"),
])  # fmt: skip
def test_ports_are_counted_as_the_code_counts_them(tmp_path: Path, code: str, requires: str) -> None:
    """The oldest tool counted from 0, also in the configuration: `JointMotor0Proxy`."""
    (tmp_path / "src").mkdir()
    (tmp_path / "src/specificworker.cpp").write_text(f"void SpecificWorker::compute() {{ {code} }}\n")
    source = "Component A { Communications { requires JointMotor, JointMotor, Arm; }; language cpp; };"
    assert f"requires: {requires}\n" in migrated(tmp_path, source, "a.cdsl")


@pytest.mark.parametrize(
    ("file", "code", "is_for_robocomp"),
    [
        ("specificworker.py", "import sys\nfrom genericworker import *\n", True),
        ("specificworker.py", OURS, False),
        ("specificworker.py", b"# \xe9\xff\nfrom genericworker import *\n", True),
        ("specificworker.h", "SpecificWorker(TuplePrx tprx, bool startup_check);\n", True),
        ("specificworker.h", "SpecificWorker(MapPrx& mprx, bool startup_check);\n", True),
        ("specificworker.h", "class SpecificWorker : public GenericWorker {};\n", False),
        ("specificworker.cpp", "SpecificWorker::SpecificWorker(MapPrx& mprx)\n", True),
        ("specificworker.cpp", '#include "specificworker.h"\n', False),
    ],
)
def test_code_for_robocomps_own_generator(tmp_path: Path, file: str, code: str | bytes, is_for_robocomp: bool) -> None:
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / file).write_bytes(code if isinstance(code, bytes) else code.encode())
    document = migrated(tmp_path, "Component A { Communications {}; language python; };", "a.cdsl")
    assert ("compatibility: robocomp" in document) == is_for_robocomp
