"""Texts that mean something to one of the languages that rcyaml writes, or to nobody."""

from __future__ import annotations

STRINGS: tuple[str, ...] = (
    "", " ", "  both  ", '"', "'", "'''", '"""', 'a"b', "it's", "\\", "\\\\", "\\n", '\\"', "end\\", "a\nb", "\n", "a\n\nb\n", "a\r\nb",
    "a\rb", "\t", "a\tb", "\0", "a\0b", "\x1b[31mred\x1b[0m", "\x1b]0;title\x07", "\x07", "\x08", "\x7f", "\x85", "\u2028", "a\u2029b",
    "\u202eevil", "\u2066x\u2069", "\u200b", "\ufeff", "\ufffd", "\uffff", "\U0001f916", "e\u0301", "ñandú", "\ud800", "\udcff",
    "$", "$HOME", "${HOME}", "$(touch x)", "`touch x`", "$$", "$(", "%", "%s", "%%", "%n %i", "%{x}", "{}", "{0}", "{x}", "{{", "}}",
    "{{ 7*7 }}", "{% raw %}", "{# x #}", "{config}", "{i}", "#", "# comment", "#{x}", "a # b", "#include <x>", "//", "// x\\", "/*", "*/",
    "/* x */", "*/ int evil; /*", "??/", "*)", "--", "-->", "<!--", "<b>", "</a>", "&", "&amp;", "&#0;", "]]>", "<![CDATA[", "<?x ?>",
    '"/><evil/>', "a: b", ": ", "- a", "? x", "| ", "> ", "&anchor", "*alias", "!!python/object:os.system", "!x", "@x", "%YAML 1.2",
    "---", "...", "null", "~", "true", "yes", "no", "0", "007", "0x1F", "1e3", ".nan", "-.inf", "12:30", "1_000", "2026-11-22", "<<",
    "=", "a=b", ";", "a;b", ",", "a, b", "[x]", "[section]", "x]", "{a: b}", "|", "||", "&&", "; rm -rf x", "| tee x", "> x", "!", "!!",
    "~root", "*", "?", "--help", "-x", "--Ice.Config=x", "/etc/passwd", "../../x", "C:\\x", "file:///etc/passwd", "http://a:b@c/",
    "x" * 300, "word " * 80, "a" * 5000, "\\u0041", "\\x41", "\\101", "\\N{BULLET}", "__import__('os')", "import os", "raise Evil",
    'f"{x}"', 'R"(x)"', ')"', 'u8"x"', "L'x'", "#define x", "#pragma once", "__FILE__", "@property", "def f(): pass", "pass", "class",
    "module", "interface", "sequence<int> X;", '["cpp:type:x"]', "::", "graph TD", "end", "subgraph x", "A --> B", "a|b", "[[x]]", "<br>",
    '"];evil [label="', "label", "\\l", "\\G", "%%{init}%%", "#quot;", "ExecStartPre=/bin/evil", "[Service]", "a\nExecStartPre=/bin/evil",
    "a\\\nb", "x\n[Service]\nUser=root", "\\ ", "\\=", "\\#", "a\\ b", " lead", "trail ", "Ice.Trace.Network=9\n", "a\nX.Endpoints=tcp",
    "${env:HOME}", '"true"', '"a text"', "endif()", "message(FATAL_ERROR x)", ")", "( ", "$ENV{HOME}", "$<1:x>", "[=[", "]=]", "@X@",
)  # fmt: skip
