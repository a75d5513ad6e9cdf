"""Patterns of texts: which texts match, and what is refused, since engines read it differently."""

from __future__ import annotations

import json

import pytest

from in_memory import analysed, pdsl, refused


def documents(pattern: str) -> dict[str, str]:
    quoted = "'" + pattern.replace("'", "''") + "'"
    return {
        **pdsl(""),
        "c.pdsl.yaml": f"component: c.cdsl.yaml\nparameters:\n  a: {{type: string, pattern: {quoted}}}\n",
    }


@pytest.mark.parametrize(
    ("pattern", "rest", "problem"),
    [
        ('a)b', ')b', "a ')' has no '(' before it"),
        ('(a', '(a', "this '(' has no ')'"),
        ('a(b(c)', '(b(c)', "this '(' has no ')'"),
        ('[a', '[a', "this '[' has no ']'"),
        ('[]', '[]', 'a class of characters is empty'),
        ('[^]', '[^]', 'a class of characters is empty'),
        ('[a[b]', '[b]', "inside a class, '[' needs a backslash: '\\['"),
        ('[b-a]', '-a]', 'a range of characters must go up, from one character to another'),
        ('[a-\\d]', '-\\d]', 'a range of characters must go up, from one character to another'),
        ('[a\\', '\\', 'a backslash ends the pattern'),
        ('a\\', '\\', 'a backslash ends the pattern'),
        ('a\\b', '\\b', "'\\b' does not mean the same in every engine"),
        ('\\1', '\\1', "'\\1' does not mean the same in every engine"),
        ('\\p', '\\p', "'\\p' does not mean the same in every engine"),
        ('\\é', '\\é', "'\\é' does not mean the same in every engine"),
        ('*a', '*a', "'*' has nothing before it to repeat"),
        ('a|+', '+', "'+' has nothing before it to repeat"),
        ('?', '?', "'?' has nothing before it to repeat"),
        ('a^b', '^b', "'^' is not supported inside a pattern, which always matches the whole text"),
        ('a$b', '$b', "'$' is not supported inside a pattern, which always matches the whole text"),
        ('^^a', '^a', "'^' is not supported inside a pattern, which always matches the whole text"),
        ('a$$', '$$', "'$' is not supported inside a pattern, which always matches the whole text"),
        ('{2}', '{2}', "'{' needs a backslash: '\\{'"),
        ('a}', '}', "'}' needs a backslash: '\\}'"),
        ('a]', ']', "']' needs a backslash: '\\]'"),
        ('a{2', '{2', 'a count is written {2}, {2,} or {2,5}'),
        ('a{}', '{}', 'a count is written {2}, {2,} or {2,5}'),
        ('a{,3}', '{,3}', 'a count is written {2}, {2,} or {2,5}'),
        ('a{3,2}', '{3,2}', 'a count must go up, to at most 1000'),
        ('a{1001}', '{1001}', 'a count must go up, to at most 1000'),
        ('a{1,1001}', '{1,1001}', 'a count must go up, to at most 1000'),
        ('a**', '*', 'a count after a count needs a group around the first'),
        ('a*{2}', '{2}', 'a count after a count needs a group around the first'),
        ('a+?', '?', "a lazy count has no effect where the whole text must match; remove the '?'"),
        ('a??', '?', "a lazy count has no effect where the whole text must match; remove the '?'"),
        ('a{2}?', '?', "a lazy count has no effect where the whole text must match; remove the '?'"),
        ('(?=a)', '(?=a)', 'look-around, named groups and flags are not supported by every engine'),
        ('(?P<n>a)', '(?P<n>a)', 'look-around, named groups and flags are not supported by every engine'),
        ('(?i)a', '(?i)a', 'look-around, named groups and flags are not supported by every engine'),
        ('((((((((((((((((((((((a))))))))))))))))))))))', '((a))))))))))))))))))))))', 'groups are nested more than 20 levels deep'),
        ('([a-z]{1000}){6}', '([a-z]{1000}){6}', 'its counts add up to more than 5000 characters'),
    ],
)  # fmt: skip
def test_what_is_refused_where_it_stands(pattern: str, rest: str, problem: str) -> None:
    (found,) = analysed(documents(pattern), "c.pdsl.yaml").diagnostics
    at = found.span.column - 1 - len("  a: {type: string, pattern: '")
    assert (found.code, pattern[at:], found.message) == ("RC3111", rest, f"this pattern cannot be used: {problem}")


@pytest.mark.parametrize(
    ("pattern", "matching", "others"),
    [
        ("abc", ["abc"], ["ab", "abcd", "xabc", "ABC"]),
        ("^abc$", ["abc"], ["^abc$", "abc\n"]),
        (r"abc\$", ["abc$"], ["abc"]),
        (r"abc\\$", ["abc\\"], ["abc", "abc\\$"]),
        ("a|bc|", ["a", "bc", ""], ["abc", "ac"]),
        ("(a|b)c", ["ac", "bc"], ["a", "c"]),
        ("(?:a|b)c", ["ac"], ["?:ac"]),
        ("a*b+c?", ["b", "aabbc"], ["a", "bcc"]),
        ("a{2}", ["aa"], ["a", "aaa"]),
        ("a{2,}", ["aa", "aaaa"], ["a"]),
        ("a{1,3}", ["a", "aaa"], ["", "aaaa"]),
        ("a{0}b", ["b"], ["ab"]),
        (".", ["a", "é", "☃"], ["", "\n", "\r", "ab"]),
        (r"\d\D", ["1a", "9 "], ["a1", "11", "٣a"]),
        (r"\w\W", ["_-", "z "], ["-_", "é-"]),
        (r"\s\S", [" a", "\ta"], ["a ", "\u00a0a"]),
        (r"\t\.\*\\", ["\t.*\\"], ["ta*\\"]),
        ("[abc-]", ["a", "-"], ["d", "ab"]),
        ("[a-cx]", ["a", "b", "c", "x"], ["d", "-"]),
        ("[^a-c]", ["d", "-", "\n"], ["a", "b", ""]),
        (r"[\d\s.]", ["1", " ", "."], ["a", "d"]),
        (r"[\]\[\\]", ["]", "[", "\\"], ["a"]),
        ("[+--]", ["+", ",", "-"], ["."]),
        ("[-a]", ["-", "a"], ["b"]),
        ("[a^]", ["a", "^"], ["b"]),
        ("(((((((((((((((((((a)))))))))))))))))))", ["a"], ["b"]),
        ("a{1000}", ["a" * 1000], ["a" * 999]),
    ],
)
def test_what_matches_the_whole_of_a_text(pattern: str, matching: list[str], others: list[str]) -> None:
    written = documents(pattern)
    assert not analysed(written, "c.pdsl.yaml").diagnostics
    found = [text for text in (*matching, *others) if not _refused(written, text)]
    assert found == matching


def _refused(written: dict[str, str], text: str) -> bool:
    """As a pattern refuses it; that Ice's properties cannot hold some texts is another matter."""
    return any("must match" in message for message in refused(written, f"a: {json.dumps(text)}"))
