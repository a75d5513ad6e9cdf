"""What is reported about the use of the worker in Java: all that is certain, and nothing else."""

from __future__ import annotations

import pytest

from judged_code import Link, component, found


def worker(body: str, more: str = "", imports: str = "", extends: str = "GenericWorker") -> dict[str, str]:
    return {
        "SpecificWorker.java": (
            f"import generated.GenericWorker;\n{imports}\n\npublic class SpecificWorker extends {extends} {{\n"
            f"    private int turns = 0;\n\n    @Override\n    public void compute() throws Exception {{\n        {body}\n"
            f"    }}\n\n    @Override\n    public void Ear_hear(String text) {{\n    }}\n    {more}\n}}\n"
        )
    }


@pytest.mark.parametrize(
    ("body", "code", "text"),
    [
        ("moth_proxy.close();", "RC6301", "moth_proxy"),
        ("this.moth_proxy.close();", "RC6301", "moth_proxy"),
        ("SpecificWorker.this.moth_proxy.close();", "RC6301", "moth_proxy"),
        ("if (moth_proxy != null) turns++;", "RC6301", "moth_proxy"),
        ("run(() -> moth_proxy.close());", "RC6301", "moth_proxy"),
        ("run(new Runnable() { public void run() { SpecificWorker.this.moth_proxy.close(); } });", "RC6301", "moth_proxy"),
        ("news_proxy.told(\"a\");", "RC6301", "news_proxy"),
        ("mouthProxy.close();", "RC6301", "mouthProxy"),
        ("this.mouth_prx.close();", "RC6301", "mouth_prx"),
        ("mouth_proxy.shutAsync();", "RC6302", "shutAsync"),
        ("mouth_proxy.shut();", "RC6302", "shut"),
        ("this.mouth_proxy.shut();", "RC6302", "shut"),
        ("var x = (mouth_proxy).shut();", "RC6302", "shut"),
        ("run(mouth_proxy::shut);", "RC6302", "shut"),
        ("try { mouth_proxy.shut(); } catch (com.zeroc.Ice.LocalException e) { }", "RC6302", "shut"),
        ("switch (turns) { case 1 -> mouth_proxy.shut(); default -> { } }", "RC6302", "shut"),
        ("log.info(\"ä\" + mouth_proxy.shut());", "RC6302", "shut"),
        ("var mouth = mouth_proxy; mouth.shut();", "RC6302", "shut"),
        ("slice.RoboCompMouth.MouthPrx mouth = mouth_proxy; run(() -> mouth.shut());", "RC6302", "shut"),
        ("var mouth = mouth_proxy; var other = mouth; other.shut();", "RC6302", "shut"),
        ("var p = new slice.RoboCompMouth.Pose(1);", "RC6304", "Pose"),
        ("slice.RoboCompMouth.Pose p = make(), q = p; q.gap = 3;", "RC6325", "gap"),
        ("for (slice.RoboCompMouth.Pose p : all) use(p.gap);", "RC6325", "gap"),
        ("for (var p : mouth_proxy.way()) use(p.gap);", "RC6325", "gap"),
        ("var way = mouth_proxy.way(); use(way[0].gap);", "RC6325", "gap"),
        ("use(mouth_proxy.move(pose, true).gap);", "RC6325", "gap"),
        ("if (parameters.mode().equals(\"fasst\")) turns++;", "RC6327", "\"fasst\""),
        ("if (\"fasst\".equalsIgnoreCase(parameters.mode())) turns++;", "RC6327", "\"fasst\""),
        ("String mode = parameters.mode(); if (mode.equals(\"fasst\")) turns++;", "RC6327", "\"fasst\""),
        ("switch (parameters.mode()) { case \"fast\", \"fasst\" -> turns++; default -> { } }", "RC6327", "\"fasst\""),
        ("if (parameters.speed() != 500) turns++;", "RC6327", "500"),
        ("mouth_proxy.move(pose, \"yes\");", "RC6328", "\"yes\""),
        ("news_pubproxy.told(3);", "RC6328", "3"),
        ("news_pubproxy.tell(\"a\");", "RC6303", "tell"),
        ("mouth_proxy.move(pose);", "RC6304", "move"),
        ("mouth_proxy.move(f(1, 2), g, h, 4);", "RC6304", "move"),
        ("mouth_proxy.where(pose, age);", "RC6304", "where"),
        ("int s = parameters.sped();", "RC6306", "sped"),
        ("int s = parameters.now().sped;", "RC6306", "sped"),
        ("int s = parameters.camera().fsp;", "RC6306", "fsp"),
        ("float s = parameters.motors().get(0).speed;", "RC6306", "speed"),
        ("float s = parameters.offsets().get(\"a\").speed;", "RC6306", "speed"),
        ("for (var motor : parameters.motors()) use(motor.speed);", "RC6306", "speed"),
        ("for (Parameters.Motor motor : parameters.motors()) use(motor.speed);", "RC6306", "speed"),
        ("var now = parameters.now(); use(now.motors.get(0).speed);", "RC6306", "speed"),
        ("parameters.set(\"motors[0].velo\", 1);", "RC6306", "motors[0].velo"),
        ("parameters.change(Map.of(\"speed\", 3, \"sped\", 4));", "RC6306", "sped"),
        ("parameters.setSpede(3);", "RC6306", "setSpede"),
        ("parameters.setDevice(\"x\");", "RC6307", "setDevice"),
        ("parameters.setCameraLens(\"x\");", "RC6307", "setCameraLens"),
        ("parameters.setSpeed(0);", "RC6308", "0"),
        ("parameters.setSpeed(-5);", "RC6308", "-5"),
        ("parameters.setSpeed(\"fast\");", "RC6308", "\"fast\""),
        ("if (parameters.speed > 3) return;", "RC6323", "speed"),
        ("parameters.setSpeed(4_000);", "RC6308", "4_000"),
        ("parameters.set(\"motors[0].vel\", 2.5f);", "RC6308", "2.5f"),
        ("parameters.speed(1);", "RC6304", "speed"),
        ("slice.RoboCompMouth.Pos p;", "RC6314", "Pos"),
        ("var p = new slice.RoboCompMouth.Pos();", "RC6314", "Pos"),
        ("java.util.List<slice.RoboCompMouth.Pos> p;", "RC6314", "Pos"),
        ("var s = slice.RoboCompMouth.Shape.oval;", "RC6315", "oval"),
        ("slice.RoboCompNose.Nose n;", "RC6313", "RoboCompNose"),
    ],
)  # fmt: skip
def test_what_is_reported(link: Link, body: str, code: str, text: str) -> None:
    assert found(link(component("java")), worker(body)) == [(code, text)]


@pytest.mark.parametrize(
    ("imports", "body", "code", "text"),
    [
        ("import slice.RoboCompMouth.Shape;", "var s = Shape.oval;", "RC6315", "oval"),
        ("import slice.RoboCompMouth.*;", "if (s == Shape.oval) return;", "RC6315", "oval"),
        ("import slice.RoboCompMouth.Pos;", "turns++;", "RC6314", "Pos"),
        ("import slice.RoboCompMoth.Pose;", "turns++;", "RC6313", "RoboCompMoth"),
        ("import slice.RoboCompMoth.*;", "turns++;", "RC6313", "RoboCompMoth"),
        ("import static slice.RoboCompMouth.Shape.oval;", "turns++;", "RC6315", "oval"),
    ],
)
def test_imports(link: Link, imports: str, body: str, code: str, text: str) -> None:
    assert found(link(component("java")), worker(body, imports=imports)) == [(code, text)]


@pytest.mark.parametrize(
    ("body", "more"),
    [
        ("mouth_proxy.close(); mouth_proxy.move(pose, true); mouth_proxy.move(pose, true, context);", ""),
        ("var r = mouth_proxy.where(); use(r.pose, r.age); mouth_proxy.moveAsync(pose, true).get();", ""),
        ("mouth_proxy.ice_ping(); mouth_proxy.toString(); mouth_proxy = null; mouth_proxy.ice_timeout(3).close();", ""),
        ("other.mouth_proxy.shut(); other.moth_proxy.close(); other().mouth_proxy.shut();", ""),
        ("var moth_proxy = make(); moth_proxy.close();", ""),
        ("MouthPrx mouthPrx = make(); mouthPrx.close(); MouthPrx.checkedCast(x); slice.RoboCompMouth.MouthPrx p;", ""),
        ("getProxy().close(); setProxy(x); other.mouthProxy.close(); mouthProxy(); aProxy.close();", "void mouthProxy() { }"),
        ("for (var moth_proxy : all) moth_proxy.close();", ""),
        ("run(moth_proxy -> moth_proxy.close());", ""),
        ("var p = new slice.RoboCompMouth.Pose(); var q = new slice.RoboCompMouth.Pose(1, s); p.opening = q.clone().gap;", ""),
        ("slice.RoboCompMouth.Pose[] all = make(); use(all.length, all.clone()); use(mouth_proxy.way().length);", ""),
        ("slice.RoboCompMouth.Pose p = make(); run(new Base() { Other p; void f() { p.gap(); } });", ""),
        ("var p = new slice.RoboCompMouth.Pose() { int gap; }; use(p.gap);", ""),
        ("if (parameters.mode().equals(\"fast\") || parameters.mode().equals(\"\") || parameters.speed() == 3) turns++;", ""),
        ("switch (parameters.mode()) { case \"fast\": turns++; break; default: }", ""),
        ("run((moth_proxy, b) -> moth_proxy.close());", ""),
        ("if (o instanceof MouthPrx moth_proxy) moth_proxy.close();", ""),
        ("try (var moth_proxy = open()) { moth_proxy.close(); }", ""),
        ("moth_proxy.close();", "private MouthPrx moth_proxy;"),
        ("turns++;", "private void f(MouthPrx moth_proxy) { moth_proxy.close(); }"),
        ("moth_proxy();", "private void moth_proxy() { }"),
        ("// moth_proxy.close();\n        /* mouth_proxy.shut(); */ String s = \"moth_proxy.close()\";", ""),
        ("turns++;", "static class Other extends Base { void f() { mouth_proxy.shut(); this.moth_proxy.shut(); } }"),
        ("run(new Base() { public void run() { mouth_proxy.shut(); this.moth_proxy.close(); } });", ""),
        ("mouth_proxy.shut(;", ""),
        ("int s = parameters.speed() + parameters.camera().fps; use(parameters.motors().get(0).vel);", ""),
        ("for (var m : parameters.motors()) use(m.name, m.vel); int n = parameters.motors().size();", ""),
        ("for (var e : parameters.offsets().entrySet()) use(e.getKey(), e.getValue().anything);", ""),
        ("parameters.setSpeed(3); parameters.setSpeed(x); parameters.setCameraFps(3); parameters.set(path, 3);", ""),
        ("parameters.set(\"offsets.a.vel\", 1); parameters.change(java.util.Map.of(\"speed\", 5, \"camera.fps\", 9));", ""),
        ("parameters.listen(change -> use(change.paths())); parameters.change(changes()); use(parameters.hashCode());", ""),
        ("var now = parameters.now(); use(now.speed, now.motors.get(0).vel, now.camera.fps, now.motors.stream());", ""),
        ("var m = mouth_proxy; { var x = 1; } run(() -> { for (var m : all) m.shut(); });", ""),
        ("var mouth = convert(mouth_proxy); mouth.shut();", ""),
        ("slice.RoboCompMouth.Pose p = new slice.RoboCompMouth.Pose(1, slice.RoboCompMouth.Shape.round);", ""),
        ("slice.RoboCompMouth.Mouth.WhereResult r; slice.RoboCompMouth.PathHelper h; use(slice.RoboCompMouth.WIDEST.value);", ""),
        ("for (var s : slice.RoboCompMouth.Shape.values()) use(s.name(), slice.RoboCompMouth.Shape.valueOf(1).ordinal());", ""),
        ("slice.RoboCompCommonBehavior.State s;", ""),
        ("int slice = 3; use(slice.RoboCompNose);", ""),
    ],
)  # fmt: skip
def test_what_is_right_or_too_dynamic_to_know(link: Link, body: str, more: str) -> None:
    assert found(link(component("java")), worker(body, more)) == []


@pytest.mark.parametrize("imports", ["import slice.RoboCompMouth.*;", "import slice.RoboCompMouth.Shape;"])
def test_types_of_the_user_hide_those_of_the_slice(link: Link, imports: str) -> None:
    files = {**worker("use(Shape.oval);", imports=imports), "Shape.java": "public class Shape { static int oval; }\n"}
    assert found(link(component("java")), files) == []


def test_a_class_of_something_else_is_not_judged(link: Link) -> None:
    body = "moth_proxy.close(); mouth_proxy.shut();"
    assert found(link(component("java")), worker(body, extends="Other")) == []


def test_a_class_between_is_followed(link: Link) -> None:
    base = (
        "import generated.GenericWorker;\n"
        "abstract class Base extends GenericWorker { void f() { mouth_proxy.shut(); } }\n"
    )
    files = {**worker("mouth_proxy.close();", extends="Base"), "parts/Base.java": base}
    assert found(link(component("java")), files) == [("RC6302", "shut")]


@pytest.mark.parametrize(("method", "code"), [("Ear_haer", "RC6312"), ("Nose_x", ""), ("help", "")])
def test_methods_that_nobody_calls(link: Link, method: str, code: str) -> None:
    linked = link(component("java"))
    files = worker("turns++;", f'void {method}() {{ log.info("{method}()"); }}  // {method}')
    assert set(found(linked, files)) == ({(code, method)} if code else set())
    assert found(linked, worker(f"{method}();", f"void {method}() {{ }}")) == []
