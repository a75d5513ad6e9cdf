"""Seeds of every legacy format: a small robot of our own, the examples of diagnostics, and the corpus where it is."""

from __future__ import annotations

from functools import cache

from conftest import CORPUS, Tree
from documents_of_rows import LARGE, LEGACY_FILES

ROBOT: Tree = {
    "interfaces/Mouth.idsl": (
        'import "Types.idsl";\n/* The mouth. */\nmodule RoboCompMouth\n{\n\tenum Lips { open, shut = 4 };\n'
        "\tsequence<float> Angles;\n\tdictionary<string, Angles> Poses;\n\tstruct Pose { float width; string name; };\n"
        "\texception Stuck { string what; };\n\tinterface Mouth\n\t{\n\t\t/// Moves it.\n"
        "\t\tidempotent Pose move(Pose to, out Poses all) throws Stuck;\n\t\tvoid close();\n\t};\n};\n"
    ),
    "interfaces/Types.ice": "module RoboCompTypes\n{\n  struct Point { double x; double y; };\n  const int most = 3;\n};\n",
    "mouth/mouth.cdsl": (
        'import "Mouth.idsl";\nComponent MouthComp\n{\n    Communications\n    {\n        implements Mouth;\n'
        "        requires Mouth;\n        publishes Mouth;\n        subscribesTo Mouth;\n    };\n    language Cpp11;\n"
        '    gui Qt(QWidget);\n    options dsr;\n    statemachine "mouth.smdsl";\n};\n'
    ),
    "mouth/mouth.smdsl": (
        "/* --- the mouth --- */\nMouthMachine{\n    states opens, shuts;\n    initial_state initialize;\n"
        "    end_state finalize;\n    transitions{\n        initialize => opens;\n        opens => opens, shuts;\n"
        "        shuts => finalize;\n    };\n};\n\n:opens {\n    states wide;\n    initial_state narrow;\n"
        "    transitions{ narrow => wide; };\n};\n"
    ),
    "mouth/etc/config": (
        "# Endpoints\nCommonBehavior.Endpoints=tcp -p 10002\nMouth.Endpoints=tcp -p 10003\n\n# Proxies\n"
        "MouthProxy = mouth:tcp -h localhost -p 10003\nTopicManager.Proxy=IceStorm/TopicManager:default -p 9999\n"
        "# name, id, zero\nMotor0 = left,1,0.5\nMotor1 = right,2,-0.5  # the other\nDevice = /dev/ttyUSB0\n"
        "rx_0 = 1\nry_0 = 2\nrx_1 = 3\nry_1 = 4\nnum_motors = 2\nGains = 1,0,0;0,1,0;\nID:0-10 = 100\nIce.Warn.Connections=0\n"
        'Period = 100\nquoted = "a text"\nempty =\nGroup.a = true\nGroup.b = 007\nHost = robot, 10\n'
    ),
    "flat/etc/config": (
        'Endpoints.Mouth = "tcp -p 10003"\nProxies.Mouth = "mouth:tcp -p 10003"\nPeriod.Compute = 100\n'
        'Agent.id = 3\nname = "robot"\nlist = 1,2,3\nMotor0 = a,1\nMotor1 = b,2\n'
    ),
    "toml/etc/config.toml": (
        'Period = {Compute = 100}\n[Endpoints]\nMouth = "tcp -p 10003"\n[Group]\nvalues = [1, 2.5, 3]\nname = "x"\n'
        'motors = [{name = "a", id = 1}, {name = "b", id = 2}]\n'
    ),
    "old/speech.pdsl": 'ComponentParams Speech{\n  volume int 5 0:10;\n  device string "a" ;\n}\n',
    "old/speech.pconf": 'import "speech.pdsl";\nConfigFile Speech{\n  volume = 3\n}\n',
    "java/thing.jcdsl": (
        'import "Mouth.idsl";\nComponent ThingComp\n{\n    Communications\n    {\n        implements Mouth;\n    };\n'
        "    language Java;\n};\n"
    ),
    "head.xml": (
        '<?xml version="1.0"?>\n<rcmanager>\n  <generalInformation>\n    <editor path="kate" />\n  </generalInformation>\n'
        '  <node alias="mouth" endpoint="mouth:tcp -p 10003">\n    <dependence alias="laser" />\n'
        '    <workingDir path="/home/robocomp/mouth" />\n    <upCommand command="bin/MouthComp --Ice.Config=etc/config" />\n'
        '    <downCommand command="killall MouthComp" />\n    <configFile path="etc/config" />\n'
        '    <xpos value="1" />\n    <ypos value="2" />\n    <radius value="10" />\n    <color value="#aabbcc" />\n  </node>\n'
        '  <node alias="laser" endpoint="laser:tcp -p 10004">\n    <workingDir path="." />\n'
        '    <upCommand command="rcis simulation.xml" />\n  </node>\n</rcmanager>\n'
    ),
}


@cache
def seeds() -> list[Tree]:
    """Trees of one or a few legacy files."""
    found: list[Tree] = [ROBOT, *({name: text} for name, text in ROBOT.items()), *LEGACY_FILES]
    return [files for files in found if any(text is not None for text in files.values())]


@cache
def of_corpus() -> list[Tree]:
    """Each small file of the corpus by itself."""
    found: list[Tree] = []
    for path in sorted(CORPUS.rglob("*")) if CORPUS.is_dir() else ():
        if path.is_file() and path.stat().st_size < LARGE:
            found.append({str(path.relative_to(CORPUS)): path.read_bytes()})
    return found
