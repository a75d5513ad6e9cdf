"""SCXML: elements at wrong places, their diagnostics, and the model of a machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import pytest

from in_memory import ROOT, analysed, outline, said

CDSL = "component: Door\nlanguage: python\nstatemachine: door.scxml\n"


@pytest.mark.parametrize(
    ("body", "root", "code", "at", "message", "hint"),
    [
        ("<state id='a' initial='b' src='x'/>", '', 'RC2208', 'src', "<state> has no attribute 'src'", 'it has id, initial'),
        ("<state id='a' ID='b'/>", '', 'RC2208', 'ID', "<state> has no attribute 'ID'", "'id' is already present"),
        ("<state id='a'><sate/></state>", '', 'RC2207', '<sate', '<state> cannot contain <sate>', 'did you mean <state>?'),
        ("<state id='a'><scxml/></state>", '', 'RC2207', '<scxml', '<state> cannot contain <scxml>', 'it may contain onentry, onexit, transition, state, parallel, history, datamodel, invoke, initial, final'),
        ("<state id='a'>hello there</state>", '', 'RC2214', '<state', "<state> contains the text 'hello', but it cannot contain text", ''),
        ("<final id='a'><transition/></final>", '', 'RC2207', '<transition', '<final> cannot contain <transition>', 'it may contain onentry, onexit, donedata'),
        ("<state id='a'><onentry><rais event='x'/></onentry></state>", '', 'RC2207', '<rais', '<onentry> cannot contain <rais>', 'did you mean <raise>?'),
        ("<state id='a'><onentry><raise event=' '/></onentry></state>", '', 'RC2209', '<raise', "<raise> has no attribute 'event', which is required", ''),
        ("<state id='a'><onentry><raise event='x'><log/></raise></onentry></state>", '', 'RC2207', '<log', '<raise> cannot contain <log>', ''),
        ("<state id='a'><initial/><state id='b'/></state>", '', 'RC2212', '<initial', '<initial> must contain exactly one <transition>', ''),
        ("<state id='a'><initial><transition target='b'/></initial><initial><transition target='b'/></initial><state id='b'/></state>", '', 'RC2213', '<initial', '<state> contains a second <initial>', ''),
        ("<state id='a'><history id='h'/></state>", '', 'RC2212', '<history', '<history> must contain exactly one <transition>', ''),
        ("<state id='a'><history id='h' type='full'><transition target='b'/></history><state id='b'/></state>", '', 'RC2211', 'full', "'full' is not a value of 'type'", 'write shallow or deep'),
        ("<state id='a'><transition event='x' target='a' type='inner'/></state>", '', 'RC2211', 'inner', "'inner' is not a value of 'type'", "did you mean 'internal'?"),
        ("<state id='a'><onentry><send event='x' eventexpr='y'/></onentry></state>", '', 'RC2210', 'y', "'event' and 'eventexpr' exclude each other", ''),
        ("<state id='a'><onentry><send event='x' delay='5 minutes'/></onentry></state>", '', 'RC2211', '5 minutes', "'5 minutes' is not a value of 'delay'", 'write 100ms or 1.5s'),
        ("<state id='a'><onentry><send event='x' delay='5'/></onentry></state>", '', 'RC2211', '5', "'5' is not a value of 'delay'", 'write 100ms or 1.5s'),
        ("<state id='a'><onentry><send event='x' target='#_internal' delay='1s'/></onentry></state>", '', 'RC2211', '1s', "'1s' is not a value of 'delay'", 'an event to #_internal is sent at once: remove the delay, or the target'),
        ("<state id='a'><onentry><send event='x'><content>1</content><content>2</content></send></onentry></state>", '', 'RC2213', '<content', '<send> contains a second <content>', ''),
        ("<state id='a'><onentry><send event='x'><param name='n' expr='1'/><content>2</content></send></onentry></state>", '', 'RC2210', '<content', "'param' and 'content' exclude each other", ''),
        ("<state id='a'><onentry><cancel/></onentry></state>", '', 'RC2209', '<cancel', "<cancel> has no attribute 'sendid' or 'sendidexpr', which is required", ''),
        ("<state id='a'><onentry><cancel sendid='a' sendidexpr='b'/></onentry></state>", '', 'RC2210', 'b', "'sendid' and 'sendidexpr' exclude each other", ''),
        ('<datamodel/><datamodel/><state id="a"/>', '', 'RC2213', '<datamodel', '<scxml> contains a second <datamodel>', ''),
        ('<datamodel><data/></datamodel><state id="a"/>', '', 'RC2209', '<data', "<data> has no attribute 'id', which is required", ''),
        ('<datamodel><data id=\'x\' src=\'y\' expr=\'1\'/></datamodel><state id="a"/>', '', 'RC2210', '1', "'src' and 'expr' exclude each other", ''),
        ('<datamodel><data id=\'x\' src=\'y\'/></datamodel><state id="a"/>', '', 'RC2215', 'y', "'y' cannot be included: the file does not exist", ''),
        ("<state id='a'><onentry><if><log/></if></onentry></state>", '', 'RC2209', '<if', "<if> has no attribute 'cond', which is required", ''),
        ("<state id='a'><onentry><if cond='1'><elseif/></if></onentry></state>", '', 'RC2209', '<elseif', "<elseif> has no attribute 'cond', which is required", ''),
        ("<state id='a'><onentry><foreach array='x'/></onentry></state>", '', 'RC2209', '<foreach', "<foreach> has no attribute 'item', which is required", ''),
        ("<state id='a'><onentry><assign expr='1'/></onentry></state>", '', 'RC2209', '<assign', "<assign> has no attribute 'location', which is required", ''),
        ("<final id='a'><donedata><param name='x'/></donedata></final>", '', 'RC2209', '<param', "<param> has no attribute 'expr' or 'location', which is required", ''),
        ("<final id='a'><donedata><param name='x' expr='1' location='y'/></donedata></final>", '', 'RC2210', 'y', "'expr' and 'location' exclude each other", ''),
        ("<state id='a'><invoke type='scxml' typeexpr='1'/></state>", '', 'RC2210', '1', "'type' and 'typeexpr' exclude each other", ''),
        ("<state id='a'><invoke autoforward='yes'/></state>", '', 'RC2211', 'yes', "'yes' is not a value of 'autoforward'", 'write true or false'),
        ("<state id='a'><invoke><finalize/><finalize/></invoke></state>", '', 'RC2213', '<finalize', '<invoke> contains a second <finalize>', ''),
        ("<state id='a'><onentry><script src='x.py'/></onentry></state>", '', 'RC2215', 'x.py', "'x.py' cannot be included: the file does not exist", ''),
        ("<state id='a'><onentry><script src='../x.py'/></onentry></state>", '', 'RC2215', '../x.py', "'../x.py' cannot be included: it is not below the document's folder", ''),
        ("<state id='a'><onentry><script src='http://x'/></onentry></state>", '', 'RC2215', 'http://x', "'http://x' cannot be included: only files can be included", ''),
        ("<state id='a'><onentry><log label='x' expr='1 +'/></onentry></state>", '', 'RC2219', '1 +', 'the value is not Python: invalid syntax', ''),
        ('<state id="a"/>', 'version="2.0" initial="a"', 'RC2211', '2.0', "'2.0' is not a value of 'version'", 'write 1.0'),
        ('<state id="a"/>', 'version="1.0" initial="a" binding="never"', 'RC2211', 'never', "'never' is not a value of 'binding'", 'write early or late'),
        ('<state id="a"/>', 'version="1.0" initial="a" speed="fast"', 'RC2208', 'speed', "<scxml> has no attribute 'speed'", 'it has initial, name, version, datamodel, binding'),
    ],
)  # fmt: skip
def test_wrong_scxml(body: str, root: str, code: str, at: str, message: str, hint: str) -> None:
    root = root or 'version="1.0" initial="a" datamodel="python"'
    text = f'<scxml xmlns="http://www.w3.org/2005/07/scxml" {root}>{body}</scxml>\n'
    found = said({"door.cdsl.yaml": CDSL, "door.scxml": text})
    assert (code, at, message, hint) in [one[:4] for one in found]
    assert len([one for one in found if one.code == code]) == 1


def test_elements_of_other_namespaces_are_ignored() -> None:
    text = """<scxml xmlns="http://www.w3.org/2005/07/scxml" xmlns:x="urn:x" version="1.0" initial="a" x:zoom="2">
      <state id="a" x:colour="red"><x:note>about <x:b/></x:note></state></scxml>"""
    assert not said({"door.cdsl.yaml": CDSL, "door.scxml": text})


SCXML = """<scxml xmlns="http://www.w3.org/2005/07/scxml" xmlns:r="urn:robocomp:statemachine" version="1.0" name="Door" initial="a" datamodel="python" binding="late" r:events="knock ring">
  <script>start()</script>
  <datamodel><data id="n" expr="1"/><data id="t">some text</data><data id="none"/><data id="f" src="data.txt"/></datamodel>
  <state id="a" initial="b">
    <datamodel><data id="inner" expr="n + 1"/></datamodel>
    <onentry><raise event="up"/><log label="here" expr="n"/></onentry>
    <onentry><script>more()</script></onentry>
    <onexit><cancel sendid="nap"/><cancel sendidexpr="t"/></onexit>
    <transition event="up down.*" cond=" n &gt; 1 " target="c" type="internal"><assign location="n" expr="n + 1"/></transition>
    <transition event="knock" target="p"/>
    <state id="b">
      <onentry>
        <if cond="n == 1"><log label="one"/><elseif cond="n == 2"/><log label="two"/><else/><log label="many"/></if>
        <foreach array="[1, 2]" item="i" index="k"><script>each(i)</script></foreach>
        <assign location="t">new text</assign>
        <script src="code.py"/>
      </onentry>
      <transition event="ring" target="h"/>
    </state>
    <history id="h" type="deep"><transition target="b"/></history>
    <history id="s"><transition target="b"><log label="back"/></transition></history>
  </state>
  <parallel id="p">
    <state id="l"><initial><transition target="l1"><log label="in"/></transition></initial><state id="l1"><transition event="ring" target="s"/></state></state>
    <state id="r"/>
    <transition event="done.state.p" target="a"/>
  </parallel>
  <state id="c">
    <onentry>
      <send event="tired" target="#_parent" delay="1.5s" id="nap" namelist="n t"><param name="x" expr="n"/><param name="y" location="t"/></send>
      <send eventexpr="t" targetexpr="'#_parent'" typeexpr="'scxml'" delayexpr="'2s'" idlocation="n"><content expr="n"/></send>
      <send event="text"><content>plain <b xmlns="">bold</b></content></send>
    </onentry>
    <invoke type="scxml" src="inner.scxml" id="child" autoforward="true" namelist="n"><finalize><log label="fin"/></finalize></invoke>
    <invoke srcexpr="t" idlocation="t"><param name="x" expr="1"/></invoke>
    <invoke><content><scxml version="1.0" initial="z"><final id="z"/></scxml></content></invoke>
    <transition event="end" target="f"/>
  </state>
  <final id="f"><donedata><param name="result" expr="n"/></donedata></final>
</scxml>
"""
FILES = {
    "door.cdsl.yaml": CDSL,
    "door.scxml": SCXML,
    "code.py": "from_file()\n",
    "data.txt": "[1]\n",
    "inner.scxml": '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" initial="y"><final id="y"/></scxml>\n',
}


def test_the_model_of_a_machine(golden: Callable[[str, Mapping[str, str]], None]) -> None:
    program = analysed(FILES).program
    machine = program.components[f"{ROOT}/door.cdsl.yaml"].machine
    golden("read/scxml", {"machine.txt": "\n".join(outline("machine", machine, FILES)) + "\n"})
