"""IDSL and Slice files as documents: the text with all comments."""

from __future__ import annotations

import textwrap
from pathlib import Path

import pytest

from robocomp_yaml.legacy import document
from robocomp_yaml.legacy.convert import convert
from robocomp_yaml.legacy.draft import ComponentDraft, ModuleDraft


def migrated(folder: Path, text: str, name: str = "X.idsl") -> str:
    """Return the document of a legacy text, without its first line."""
    path = folder / name
    path.write_text(textwrap.dedent(text).lstrip("\n"), encoding="utf-8")
    result = convert(str(path))
    assert isinstance(result.draft, ModuleDraft | ComponentDraft), result.diagnostics
    return document.text(result.draft.document, result.draft.around)


def warnings(folder: Path, text: str, name: str = "X.idsl") -> list[str]:
    path = folder / name
    path.write_text(textwrap.dedent(text).lstrip("\n"), encoding="utf-8")
    return [f"{d.span.line}:{d.span.column} {d.message}" for d in convert(str(path)).diagnostics]


def expected(text: str) -> str:
    return textwrap.dedent(text).lstrip("\n")


def test_every_construct(tmp_path: Path) -> None:
    assert migrated(
        tmp_path,
        """
        import "/robocomp/interfaces/IDSLs/CommonTypes.idsl";
        module RoboCompSpeech
        {
            const int maxVolume = 100;
            enum Language { spanish, english = 5 };
            enum Mood { calm, loud };
            struct Utterance { string text; float speed = 1.0; Language language = english; };
            sequence<Utterance> Utterances;
            dictionary < string,CommonTypes::Pose > Places;
            exception HardwareFailed { string what; };
            exception Nothing { };
            interface Speech
            {
                bool say(string text, bool overwrite) throws HardwareFailed, Nothing;
                idempotent bool isBusy();
                void status(out int volume, out Utterances queue);
                void reset();
            };
            interface Empty { };
        };
    """,
    ) == expected("""
        module: RoboCompSpeech
        imports: [CommonTypes]
        constants:
          maxVolume: {type: int, value: 100}
        types:
          Language: {enum: {spanish: null, english: 5}}
          Mood: {enum: [calm, loud]}
          Utterance:
            struct: {text: string, speed: {type: float, default: 1.0}, language: {type: Language, default: english}}
          Utterances: {sequence: Utterance}
          Places: {map: {key: string, value: CommonTypes.Pose}}
        exceptions:
          HardwareFailed: {struct: {what: string}}
          Nothing:
        interfaces:
          Speech:
            methods:
              say: {in: {text: string, overwrite: bool}, returns: bool, throws: [HardwareFailed, Nothing]}
              isBusy: {returns: bool, idempotent: true}
              status: {out: {volume: int, queue: Utterances}}
              reset:
          Empty: {}
    """)


def test_comments_keep_their_position(tmp_path: Path) -> None:
    assert migrated(
        tmp_path,
        """
        // Licence: GPL
        // Somebody, 2015

        import "A.idsl"; // for the pose

        /* what follows
         * is old
         */
        module M { // the module
            // first

            // second
            struct S { // in radians
                float pos;  // rads
                /* in ms */ int stamp;
                int a; /* of a */ int b;
                // int c;
            };
            enum E { one, // the first
                     two /* the second */ };
            interface I
            {
                void f(int a, // of the left arm
                       out int b);
                // void g();
            }; // end of I
            // the end
        }; // end of M
        // really
    """,
    ) == expected("""
        # Licence: GPL
        # Somebody, 2015

        # what follows
        # is old
        module: M  # the module
        imports:
          - A  # for the pose
        types:
          # first

          # second
          S:  # in radians
            struct:
              pos: float  # rads
              # in ms
              stamp: int
              a: int  # of a
              b: int
              # int c;
          E:
            enum:
              - one  # the first
              - two  # the second
        interfaces:
          I:
            methods:
              f:
                in:
                  a: int  # of the left arm
                out: {b: int}
              # void g();
              # end of I
        # the end
        # end of M
        # really
    """)


def test_doc_comments_become_doc(tmp_path: Path) -> None:
    assert migrated(
        tmp_path,
        """
        /** \\namespace RoboCompM
         *@brief Name space of M.
         */
        module RoboCompM {
            /** \\struct S
             *@brief A state: where it is
             */
            struct S {
                /// In m.
                float x;
                float y; ///< In m, too.
                float z; /// And this.
                ///
                float t;
            };
            /// One line
            /// and another.
            enum E {
                /// The first.
                one,
                two
            };
            //// no doc
            /***** nor this *****/
            interface I {
                /**
                 * Says it.
                 *
                 *   - indented
                 */
                void say(/** What. */ string text);
            };
        };
    """,
    ) == expected("""
        module: RoboCompM
        doc: Name space of M.
        types:
          S:
            doc: "A state: where it is"
            struct:
              x: {type: float, doc: In m.}
              y: {type: float, doc: "In m, too."}
              z: {type: float, doc: And this.}
              t: float
          E:
            doc: |
              One line
              and another.
            enum: {one: {doc: The first.}, two: null}
        interfaces:
          # no doc
          # nor this
          I:
            methods:
              say:
                doc: |
                  Says it.

                    - indented
                in: {text: {type: string, doc: What.}}
    """)


def test_long_methods_are_in_block_style(tmp_path: Path) -> None:
    text = migrated(
        tmp_path,
        """
        module M { interface I {
            RoboCompOther::AVeryLongTypeName aMethodWithALongName(RoboCompOther::AnotherTypeName first, string second)
                throws FirstOfAll, SecondOfAll;
        }; };
    """,
    )
    assert text.endswith(
        "      aMethodWithALongName:\n"
        "        in: {first: RoboCompOther.AnotherTypeName, second: string}\n"
        "        returns: RoboCompOther.AVeryLongTypeName\n"
        "        throws: [FirstOfAll, SecondOfAll]\n"
    )
    assert max(map(len, text.splitlines())) <= 120


def test_an_overload_is_renamed(tmp_path: Path) -> None:
    source = """
        module M { interface I {
            void f(int a);
            void f(string a);
            void F_2();
            void f(float a);
        }; };
    """
    text = migrated(tmp_path, source)
    assert "      f_3: {x-legacy-name: f, in: {a: string}}\n" in text
    assert "      f_4: {x-legacy-name: f, in: {a: float}}\n" in text
    assert warnings(tmp_path, source) == [
        "3:10 the second method 'f' is renamed to 'f_3'",
        "5:10 the second method 'f' is renamed to 'f_4'",
    ]


@pytest.mark.parametrize(("literal", "written"), [
    ("0x1F", "0x1F"), ("017", "0o17"), ("-5", "-5"), ("1.5f", "1.5"), (".9", ".9"), ("2000.", "2000."),
    ("true", "true"), ("Mood::calm", "calm"), ('"a\\"b"', 'a"b'), ('"\\"b"', "'\"b'"), ('"on"', "on"), ('"12"', '"12"'),
    ('"\\x41\\n"', '"A\\n"'), ('""', '""'),
])  # fmt: skip
def test_defaults_keep_their_spelling(tmp_path: Path, literal: str, written: str) -> None:
    text = migrated(tmp_path, f"module M {{ struct S {{ Any a = {literal}; }}; }};")
    assert f"default: {written}}}" in text


@pytest.mark.parametrize(("source", "said"), [
    ("module M {\n struct S { i\n\tint y; };\n};", "2:13 the word 'i' before the type has no meaning and is omitted"),
    ("module M { };\n#endif\n", "2:1 '#endif' has no matching directive and is omitted"),
    ("module M { struct S { int a;; }; };", "1:29 a superfluous ';' is omitted"),
    ("module M { interface I; };", "1:12 the forward declaration of interface 'I' is omitted, because the order in YAML is free"),
    ('import "A.idsl";\nimport "b/A.ice";\nmodule M { };', "2:8 'A' is imported already"),
    ("module M { interface I { void f(out int a, int b); }; };",
     "1:31 the 'out' parameters of 'f' are moved behind the others, as Slice requires"),
    ('module M { ["cpp:const"] struct S { int a; }; };', "1:12 metadata [\"cpp:const\"] is kept as a comment: it has no effect"),
    ("#if 1\nmodule M { };\n#endif\n", "1:1 IDSL has no conditions, so that '#if 1' is lost; its content is kept"),
])  # fmt: skip
def test_faults_of_real_files_are_repaired(tmp_path: Path, source: str, said: str) -> None:
    assert migrated(tmp_path, source).startswith("module: M\n")
    assert warnings(tmp_path, source)[0] == said


def test_metadata_stays_as_comments(tmp_path: Path) -> None:
    source = """
        module M {
            ["cpp:comparable"]
            struct A { int x; };  // one
            [["cpp:header-ext:hh"]] interface I { ["amd"] void f(["cpp:array"] A a); };
        };
    """
    assert migrated(tmp_path, source) == expected("""
        module: M
        types:
          # ["cpp:comparable"]
          A: {struct: {x: int}}  # one
        interfaces:
          # [["cpp:header-ext:hh"]]
          I:
            methods:
              # ["amd"]
              f:
                in:
                  # ["cpp:array"]
                  a: A
    """)
    assert len(warnings(tmp_path, source)) == 4


def test_guards_and_includes_of_slice_files(tmp_path: Path) -> None:
    source = """
        #ifndef M_ICE
        #define M_ICE
        #pragma once
        #include <Other.ice>
        #include "some/Third.ice" // here
        module M { struct S { int a; }; };
        #endif // M_ICE
    """
    assert migrated(tmp_path, source, "M.ice") == expected("""
        module: M
        imports:
          - Other
          - Third  # here
        types:
          S: {struct: {a: int}}
        # M_ICE
    """)
    assert warnings(tmp_path, source, "M.ice") == []


def test_the_content_decides_the_format(tmp_path: Path) -> None:
    assert migrated(tmp_path, "module M { };", "noSuffix") == "module: M\n"
    assert migrated(tmp_path, "Component C { language cpp; };", "c.idsl").startswith("component: C\n")
    said = warnings(tmp_path, "Component C { language cpp; };", "c.idsl")
    assert said == ["1:1 the suffix is of the format IDSL, but the content is CDSL"]
