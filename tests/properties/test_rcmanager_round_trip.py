"""Any manager of RCManager's, to a deployment and back, says the same; no text makes it stumble."""

from __future__ import annotations

import tempfile
from pathlib import Path
from xml.sax.saxutils import quoteattr

from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

from rcmanager_facts import facts
from robocomp_yaml.cli import group
from robocomp_yaml.emit.exports import export
from robocomp_yaml.pipeline import analyse

TEXTS = st.text(st.characters(codec="utf-8", exclude_categories=("Cc", "Cs", "Cn", "Co")), max_size=12)
NUMBERS = st.one_of(st.floats(-400, 400).map(lambda value: f"{value:.10f}"), st.integers(-300, 300).map(str))
ALIASES = st.lists(st.text("abcXYZ019 -._é", min_size=1, max_size=8).filter(str.strip), min_size=1, max_size=6,
                   unique_by=str.strip)  # fmt: skip
HOSTS = st.sampled_from(["localhost", "localhost", "10.0.0.2", "robot.local"])
WORDS = st.lists(st.sampled_from(["-f", "100", "etc/config", "--Ice.Config=/etc/x.conf", "a=b", "x.py"]), max_size=3)


@st.composite
def managers(draw: st.DrawFn) -> str:
    lines = ["<rcmanager>"]
    if draw(st.booleans()):
        lines.append(f' <generalInformation><editor path={quoteattr(draw(TEXTS))} dock="false"/></generalInformation>')
    aliases = draw(ALIASES | st.just(list("abcdef")))
    for number, alias in enumerate(aliases):
        host, port = draw(HOSTS), 10000 + number
        endpoint = draw(st.sampled_from([
            f"laser:tcp -h {host} -p {port}", f"rgbd:tcp -p {port}", f"RCIS:tcp -h {host} -p {port}",
            f"acpi: tcp -p {port}", "", "nonsense", f"IceStorm/TopicManager:default -h {host} -p {port}",
        ]))  # fmt: skip
        lines.append(f" <node alias={quoteattr(alias)} endpoint={quoteattr(endpoint)}>")
        for other in draw(st.lists(st.sampled_from([*aliases, "nobody"]), max_size=3, unique=True)):
            if other != alias:
                lines.append(f"  <dependence alias={quoteattr(other)}/>")
        program = draw(st.sampled_from(["rcis", "./bin/x", "/opt/y", "python src/x.py"]))
        command = " ".join([program, *draw(WORDS)])
        remote = f"rcremote {host} {draw(st.sampled_from(['tab', number]))} /opt"
        command = draw(st.sampled_from(
            ["", command, f" {command}  ", f"{remote}/a {command}", f"{remote}/b/ {command} | tee log"]
        ))  # fmt: skip
        lines.append(f"  <workingDir path={quoteattr(draw(st.sampled_from(['/opt/a', '/opt/a/', '/home'])))}/>")
        lines.append(f"  <upCommand command={quoteattr(command)}/>")
        kill = draw(
            st.sampled_from(["killall -9 rcis", "killall -9 x", "pkill -9 -f x.py", f"ssh ann@{host} killall -9 y"])
        )
        lines.append(f"  <downCommand command={quoteattr(draw(TEXTS | st.just(kill)))}/>")
        config = draw(
            st.sampled_from(["", "etc/config", "/etc/x.conf", "kate /etc/x.conf", "rcremote h t /opt/a kate w"])
        )
        lines += [f"  <configFile path={quoteattr(config)}/>"] if draw(st.integers(0, 9)) else []
        lines += [f'  <{name} value="{draw(NUMBERS)}"/>' for name in ("xpos", "ypos", "radius")]
        lines += [f"  <color value={quoteattr(draw(TEXTS))}/>"] if draw(st.booleans()) else []
        lines.append(" </node>")
    return "\n".join([*lines, "</rcmanager>"]) + "\n"


@settings(max_examples=40, deadline=None)
@given(managers())
def test_there_and_back(text: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "robot.xml"
        source.write_text(text, encoding="utf-8")
        result = CliRunner().invoke(group, ["migrate", str(source)])
        assert result.exit_code == 0, result.output
        document = source.with_suffix(".ddsl.yaml")
        network = analyse([str(document)]).networks[str(document.resolve())]
        (back,) = export(network, "rcmanager").values()
        written, told = facts(text.encode()), facts(back.encode())
        assert told[0] == written[0]
        assert told[1] == written[1] or not written[1]


@settings(max_examples=60, deadline=None)
@given(managers(), st.data())
def test_a_broken_one_is_refused_or_read(text: str, data: st.DataObject) -> None:
    at = data.draw(st.integers(0, len(text)))
    odd = data.draw(st.sampled_from(["", "<", ">", '"', "&x;", "&", "<!--", "]]>", "\x07"]))
    broken = text[:at] + odd + text[at + 1 :]
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "robot.xml"
        source.write_text(broken, encoding="utf-8")
        result = CliRunner().invoke(group, ["migrate", str(source)])
        assert result.exception is None or isinstance(result.exception, SystemExit), result.output
