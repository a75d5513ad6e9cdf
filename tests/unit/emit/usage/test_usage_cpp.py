"""What is reported about the use of the worker in C++: all that is certain, and nothing else."""

from __future__ import annotations

import pytest

from judged_code import MACHINE, Link, component, found

HEADER = """\
#ifndef SPECIFICWORKER_H
#define SPECIFICWORKER_H
#include "genericworker.h"

class SpecificWorker : public GenericWorker
{
Q_OBJECT
public slots:
    void compute();
    void Ear_hear(const std::string& text);
private:
    int turns = 0;
    RoboCompMouth::Pose last;
    RoboCompMouth::Path path{};
    RoboCompMouth::MouthPrxPtr mouth;
    std::shared_ptr<RoboCompMouth::MouthPrx> shared;
};
#endif
"""


def worker(body: str, more: str = "", header: str = HEADER) -> dict[str, str]:
    source = f'#include "specificworker.h"\n{more}\nvoid SpecificWorker::compute()\n{{\n    {body}\n}}\n'
    return {"specificworker.h": header, "specificworker.cpp": source}


@pytest.mark.parametrize(
    ("body", "code", "text"),
    [
        ("moth_proxy->close();", "RC6301", "moth_proxy"),
        ("this->moth_proxy->close();", "RC6301", "moth_proxy"),
        ("if (moth_proxy) turns++;", "RC6301", "moth_proxy"),
        ("run([this] { moth_proxy->close(); });", "RC6301", "moth_proxy"),
        ("news_proxy->told(1);", "RC6301", "news_proxy"),
        ("mouthproxy->close();", "RC6301", "mouthproxy"),
        ("this->mouth_prx->close();", "RC6301", "mouth_prx"),
        ("mouthProxy->close();", "RC6301", "mouthProxy"),
        ("RoboCompMouth::MouthPrxPtr mouth = convert(mouth_proxy); mouth->shut();", "RC6302", "shut"),
        ("std::shared_ptr<RoboCompMouth::MouthPrx> mouth; mouth->shut();", "RC6302", "shut"),
        ("auto look = [](const RoboCompMouth::MouthPrxPtr& mouth) { mouth->shut(); };", "RC6302", "shut"),
        ("auto mouth = Ice::uncheckedCast<RoboCompMouth::MouthPrx>(x); mouth->shut();", "RC6302", "shut"),
        ("Ice::checkedCast<RoboCompMouth::MouthPrx>(x)->shut();", "RC6302", "shut"),
        ("(*mouth_proxy).shut();", "RC6302", "shut"),
        ("auto& mouth = *mouth_proxy; mouth.shut();", "RC6302", "shut"),
        ("mouth_proxy.get()->shut();", "RC6302", "shut"),
        ("mouth_proxy.close();", "RC6325", "close"),
        ("if (this->mouth_proxy.move(a, b)) turns++;", "RC6325", "move"),
        ("run([mouth = mouth_proxy] { mouth->shut(); });", "RC6302", "shut"),
        ("run([&mouth = mouth_proxy]() { mouth->move(1); });", "RC6304", "move"),
        ("std::vector<RoboCompMouth::Pose> all; all[0].gap = 1;", "RC6325", "gap"),
        ("std::vector<RoboCompMouth::Pose> all; all.at(0).gap = 1;", "RC6325", "gap"),
        ("std::vector<RoboCompMouth::Pose> all(3); use(all.back().gap);", "RC6325", "gap"),
        ("std::vector<RoboCompMouth::Pose> all; for (auto& one : all) use(one.gap);", "RC6325", "gap"),
        ("mouth_proxy->way().front().gap;", "RC6325", "gap"),
        ("mouth_proxy->shutAsync();", "RC6302", "shutAsync"),
        ("mouth_proxy->shut();", "RC6302", "shut"),
        ("this->mouth_proxy->shut();", "RC6302", "shut"),
        ("auto x = (mouth_proxy)->shut();", "RC6302", "shut"),
        ("try { mouth_proxy->shut(); } catch (const Ice::Exception& e) { }", "RC6302", "shut"),
        ("std::cout << \"ä\" << mouth_proxy->shut();", "RC6302", "shut"),
        ("news_pubproxy->tell(1);", "RC6303", "tell"),
        ("mouth_proxy->move(pose);", "RC6304", "move"),
        ("mouth_proxy->move(f(1, 2), g<int, int>(), h, 4);", "RC6304", "move"),
        ("mouth_proxy->where();", "RC6304", "where"),
        ("auto s = parameters.sped();", "RC6306", "sped"),
        ("auto s = parameters.now()->sped;", "RC6306", "sped"),
        ("auto s = parameters.camera()->fsp;", "RC6306", "fsp"),
        ("auto s = parameters.motors()[0].speed;", "RC6306", "speed"),
        ("const auto now = parameters.now(); std::cout << now->sped;", "RC6306", "sped"),
        ("for (const auto& motor : parameters.motors()) std::cout << motor.speed;", "RC6306", "speed"),
        ("auto& p = parameters; p.setSpeed(0);", "RC6308", "0"),
        ("auto mouth = mouth_proxy; run([mouth] { mouth->shut(); });", "RC6302", "shut"),
        ("auto motor = parameters.motors()[0]; use(motor.speed);", "RC6306", "speed"),
        ("parameters.set(\"motors[0].velo\", 1);", "RC6306", "motors[0].velo"),
        ("parameters.setSpede(3);", "RC6306", "setSpede"),
        ("parameters.setDevice(\"x\");", "RC6307", "setDevice"),
        ("parameters.setCameraLens(\"x\");", "RC6307", "setCameraLens"),
        ("parameters.setSpeed(0);", "RC6308", "0"),
        ("parameters.setSpeed(-5);", "RC6308", "-5"),
        ("parameters.setSpeed(\"fast\");", "RC6308", "\"fast\""),
        ("if (parameters.speed > 3) return;", "RC6323", "speed"),
        ("parameters.set(\"motors[0].vel\", 2.5);", "RC6308", "2.5"),
        ("parameters.speed(1);", "RC6304", "speed"),
        ("RoboCompMouth::Pos p;", "RC6314", "Pos"),
        ("std::vector<RoboCompMouth::Pos> p;", "RC6314", "Pos"),
        ("auto s = ::RoboCompMouth::Shape::oval;", "RC6315", "oval"),
        ("if (s == RoboCompMouth::Shape::oval) return;", "RC6315", "oval"),
        ("auto s = RoboCompMouth::round;", "RC6314", "round"),
        ("auto mouth{mouth_proxy}; mouth->shut();", "RC6302", "shut"),
        ("RoboCompMouth::MouthPrxPtr mouth = mouth_proxy; mouth->shut();", "RC6302", "shut"),
        ("const auto& mouth = mouth_proxy; auto other = mouth; other->shut();", "RC6302", "shut"),
        ("RoboCompMouth::Pose pose; pose.gap = 3;", "RC6325", "gap"),
        ("RoboCompMouth::Pose a{}, b; auto c = b; use(c.gap);", "RC6325", "gap"),
        ("const RoboCompMouth::Path& path = make(); use(path[0].gap);", "RC6325", "gap"),
        ("for (const RoboCompMouth::Pose& pose : all) use(pose.gap);", "RC6325", "gap"),
        ("auto way = mouth_proxy->way(); for (const auto& pose : way) use(pose.gap);", "RC6325", "gap"),
        ("use(mouth_proxy->move(pose, true).gap);", "RC6325", "gap"),
        ("if (parameters.mode() == \"fasst\") turns++;", "RC6327", "\"fasst\""),
        ("const std::string mode = parameters.mode(); if (\"fasst\" != mode) turns++;", "RC6327", "\"fasst\""),
        ("if (parameters.now()->speed == 500) turns++;", "RC6327", "500"),
        ("mouth_proxy->move(pose, \"yes\");", "RC6328", "\"yes\""),
        ("news_pubproxy->told(3);", "RC6328", "3"),
        ("auto s = parameters[\"speed\"];", "RC6330", "speed"),
        ("last.gap = 3;", "RC6325", "gap"),
        ("this->last.gap = 3;", "RC6325", "gap"),
        ("auto other = last; use(other.gap);", "RC6325", "gap"),
        ("for (const auto& pose : path) use(pose.gap);", "RC6325", "gap"),
        ("if (last.opening == \"wide\") turns++;", "RC6327", "\"wide\""),
        ("mouth->shut();", "RC6302", "shut"),
        ("shared->move(pose);", "RC6304", "move"),
        ("mouth_porxy->close();", "RC6301", "mouth_porxy"),
        ("this->moth_prox->close();", "RC6301", "moth_prox"),
        ("auto pose = RoboCompMouth::Pose(); pose.gap = 3;", "RC6325", "gap"),
        ("auto pose = RoboCompMouth::Pose{1}; use(pose.gap);", "RC6325", "gap"),
        ("std::shared_ptr<RoboCompMouth::MouthPrx> other = mouth_proxy; other->shut();", "RC6302", "shut"),
        ("try { go(); } catch (const RoboCompMouth::Blocked& error) { use(error.wy); }", "RC6325", "wy"),
        ("parameters.change([](auto& values) { values.sped = 3; });", "RC6306", "sped"),
        ("this->parameters.change([this](parameters::Values& v) { v.motors[0].velo = 3; });", "RC6306", "velo"),
        ("parameters::Values copy; use(parameters.sped());", "RC6306", "sped"),
        ("events.begin();", "RC6310", "begin"),
        ("if (statemachine.isIn(\"quiet\")) return;", "RC6310", "quiet"),
    ],
)  # fmt: skip
def test_what_is_reported(link: Link, body: str, code: str, text: str) -> None:
    assert found(link(component("cpp", MACHINE)), worker(body)) == [(code, text)]


@pytest.mark.parametrize(
    ("body", "more"),
    [
        ("mouth_proxy->close(); mouth_proxy->move(pose, true); mouth_proxy->move(pose, true, context);", ""),
        ("mouth_proxy->where(pose, age); mouth_proxy->moveAsync(pose, true).get(); news_pubproxy->told(\"x\");", ""),
        ("mouth_proxy->ice_ping(); mouth_proxy.get(); mouth_proxy.reset(); mouth_proxy = nullptr; *mouth_proxy;", ""),
        ("other->mouth_proxy->shut(); other.moth_proxy->close();", ""),
        ("auto moth_proxy = make(); moth_proxy->close();", ""),
        ("auto mouthPrx = MouthPrx::checkedCast(x); mouthPrx->close(); std::shared_ptr<RoboCompMouth::MouthPrx> p;", ""),
        ("getProxy()->close(); setProxy(x); other->mouthProxy->close(); aProxy->close();", ""),
        ("for (auto& moth_proxy : all) moth_proxy->close();", ""),
        ("auto [moth_proxy, b] = all; moth_proxy->close();", ""),
        ("moth_proxy->close();", "static std::shared_ptr<X> moth_proxy;"),
        ("moth_proxy->close();", "#define moth_proxy mouth_proxy"),
        ("moth_proxy->close();", '#include "../../classes/elsewhere.h"'),
        ("int mouth_proxy = 3; mouth_proxy->shut();", ""),
        ("run([mouth_proxy = make()] { mouth_proxy->shut(); });", ""),
        ("CALL(mouth_proxy->shut())", "#define CALL(x)"),
        ("mouth_proxy->move(BOTH);", "#define BOTH pose, true"),
        ("mouth_proxy->move(given...);", ""),
        ("\n#ifdef OLD\n    mouth_proxy->shut();\n#endif\n", ""),
        ("\n#if 0\n    moth_proxy->shut();\n#endif\n", ""),
        ("// moth_proxy->close();\n    /* mouth_proxy->shut(); */ std::string s = \"moth_proxy->close()\";", ""),
        ("turns++;", "template <typename T> void f(T mouth_proxy) { mouth_proxy->shut(); }"),
        ("turns++;", "void Other::f() { mouth_proxy->shut(); moth_proxy->shut(); }"),
        ("turns++;", "void f() { moth_proxy->shut(); }"),
        ("mouth_proxy->shut(;", ""),
        ("auto s = parameters.speed() + parameters.motors()[0].vel + parameters.camera()->fps;", ""),
        ("for (const auto& m : parameters.motors()) use(m); auto n = parameters.motors().size();", ""),
        ("parameters.setSpeed(3); parameters.setSpeed(x); parameters.setCameraFps(3); parameters.set(path, 3);", ""),
        ("parameters.set(\"offsets.a.vel\", 1); parameters.change([](auto& values) { values.speed = 3; });", ""),
        ("auto now = parameters.now(); use(now->speed, now->motors[0].vel, now->camera.fps);", ""),
        ("auto mouth = mouth_proxy; { auto mouth = other; mouth->shut(); }", ""),
        ("auto mouth = convert(mouth_proxy); mouth->shut(); auto p = mouth_proxy.get(); p->close();", ""),
        ("for (auto motor : parameters.motors()) { use(motor.vel); } f([](auto motor) { motor.speed; });", ""),
        ("events.start(); events.stop({{\"a\", \"b\"}}); statemachine.isIn(\"talking\"); statemachine.states();", ""),
        ("RoboCompMouth::Pose p{1, RoboCompMouth::Shape::round}; RoboCompMouth::Path q; f(RoboCompMouth::WIDEST);", ""),
        ("std::shared_ptr<RoboCompMouth::MouthPrx> m; RoboCompMouth::Mouth::WhereResult r; RoboCompNose::X x;", ""),
        ("other::RoboCompMouth::Anything x; using namespace RoboCompMouth; RoboCompMouth::operator==(a, b);", ""),
        ("RoboCompMouth::Own x;", "namespace RoboCompMouth { struct Own {}; }"),
        ("// RoboCompMouth::Pos\n", ""),
        ("RoboCompMouth::Pose p; p.opening = 3; p.ice_tuple(); auto* q = &p; q->gap; std::swap(p, r);", ""),
        ("RoboCompMouth::Pose p; { Other p; p.gap = 3; }", ""),
        ("RoboCompMouth::Pose* p = make(); p->gap; RoboCompMouth::Shape s; use(s);", ""),
        ("(*mouth_proxy).close(); auto& mouth = *mouth_proxy; mouth.close(); auto copy = mouth_proxy; copy->close();", ""),
        ("Other mouth_proxy; mouth_proxy.close(); other.mouth_proxy.close();", ""),
        ("mouth_proxy.get()->close(); mouth_proxy.reset(); auto* raw = mouth_proxy.get(); raw->close();", ""),
        ("auto n = *mouth_proxy == *shared; use(*mouth_proxy); mouth_proxy.use_count();", ""),
        ("run([mouth = mouth_proxy, other = this] { mouth->close(); other->compute(); });", ""),
        ("run([mouth = make(mouth_proxy)] { mouth->shut(); });", ""),
        ("std::vector<RoboCompMouth::Pose> all; all.push_back({}); all.at(0).opening = 1; all.size(); all.data()->opening;", ""),
        ("std::vector<RoboCompMouth::Pose*> all; all[0]->gap = 1;", ""),
        ("std::map<int, RoboCompMouth::Pose> all; all.begin()->second.opening; all[0].opening;", ""),
        ("std::vector<std::pair<int, RoboCompMouth::Pose>> all; all[0].second.opening = all[0].gap;", ""),
        ("std::unique_ptr<RoboCompMouth::MouthPrx> x; x->shut(); std::vector<RoboCompMouth::MouthPrxPtr> all; all[0]->close();", ""),
        ("std::vector<RoboCompMouth::Pose>::iterator it; it->gap; std::vector<RoboCompMouth::Pose>* all; (*all)[0].gap;", ""),
        ("auto mouth = dynamic_cast<RoboCompMouth::MouthPrx*>(x); mouth->shut();", ""),
        ("auto x = Ice::uncheckedCast<RoboCompMouth::MouthPrx>(y); x->close(); x->ice_ping();", ""),
        ("RoboCompMouth::Path q; q.size(); q.front().opening; for (auto& p : q) use(p.opening);", ""),
        ("for (const auto& [name, motor] : parameters.offsets()) use(name); for (auto& e : parameters.offsets()) e.second;", ""),
        ("if (parameters.mode() == \"fast\" || parameters.mode() == \"\" || parameters.speed() == 3) turns++;", ""),
        ("std::string mode = parameters.mode(); mode.append(\"x\"); if (mode == \"fast\") turns++;", ""),
        ("std::shared_ptr<Other> mouth = convert(mouth_proxy); mouth->shut();", ""),
        ("std::vector<int> parameters; parameters.push_back(1);", ""),
        ("last.opening = 3; this->last.shape = RoboCompMouth::Shape::round; use(path.size(), path[0].opening);", ""),
        ("other.last.gap = 3; other->last.gap = 3; mouth->close(); shared->ice_ping(); mouth = nullptr;", ""),
        ("Other last; last.gap = 3;", ""),
        ("parameters.change([](auto& v) { v.speed = 3; v.motors.push_back({}); v.camera.fps = 5; });", ""),
        ("parameters.change([](auto& v) { Other v; v.sped = 3; }); parameters.change(function);", ""),
        ("auto mouth_porxy = make(); mouth_porxy->close(); mouth_proxies->close(); youth_axis->close();", ""),
        ("try { go(); } catch (const RoboCompMouth::Blocked& e) { use(e.why, e.what(), e.ice_id()); }", ""),
        ("RoboCompMouth::Pose pose = RoboCompMouth::Pose(); pose.opening = 3; auto p = make(pose).gap;", ""),
        ("f([](auto last) { last.gap; });", ""),
        ("turns++;", "void Other::f() { last.gap = 3; }"),
        ("turns++;", "struct Other { Something last; void f() { last.gap = 3; } };"),
    ],
)  # fmt: skip
def test_what_is_right_or_too_dynamic_to_know(link: Link, body: str, more: str) -> None:
    assert found(link(component("cpp", MACHINE)), worker(body, more)) == []


@pytest.mark.parametrize(
    "header",
    [
        HEADER.replace("public GenericWorker", "public GenericWorker, public Other"),
        HEADER.replace("public GenericWorker", "public Base<int>"),
        HEADER.replace("class SpecificWorker", "class OtherWorker"),
        HEADER.replace("int turns = 0;", "int turns = 0; std::shared_ptr<X> moth_proxy, mouth_proxy;"),
        "",
    ],
)
def test_classes_that_are_not_known(link: Link, header: str) -> None:
    assert found(link(component("cpp")), worker("moth_proxy->close(); mouth_proxy->shut();", header=header)) == []


def test_a_class_between_is_followed(link: Link) -> None:
    base = (
        "#include <genericworker.h>\nclass Base : public GenericWorker\n{\n    void f() { mouth_proxy->shut(); }\n};\n"
    )
    header = HEADER.replace("public GenericWorker", "public Base").replace("genericworker.h", "base.h")
    files = {**worker("mouth_proxy->close();", header=header), "base.h": base}
    assert found(link(component("cpp")), files) == [("RC6302", "shut")]


@pytest.mark.parametrize(
    ("method", "code"), [("Ear_haer", "RC6312"), ("sm_silnet", "RC6311"), ("sm_help", ""), ("Nose_x", "")]
)
def test_methods_that_nobody_calls(link: Link, method: str, code: str) -> None:
    linked = link(component("cpp", MACHINE))
    header = HEADER.replace("private:", f"    void {method}();\nprivate:")
    files = worker("turns++;", f'void SpecificWorker::{method}() {{ log.info("{method}()"); }}  // {method}', header)
    assert set(found(linked, files)) == ({(code, method)} if code else set())
    used = worker(f"{method}();", f"void SpecificWorker::{method}() {{ }}", header)
    assert found(linked, used) == []


def test_files_of_robocomps_own_tool_are_not_read(link: Link) -> None:
    left = {"genericworker.h": "class GenericWorker { std::shared_ptr<X> moth_proxy; };\n"}
    linked = link(component("cpp", "compatibility: robocomp\n"))
    left["mouthI.cpp"] = "RoboCompMouth::pose MouthI::move() { return RoboCompMouth::pose(); }\n"
    files = {**worker("moth_proxy->close(); f(RoboCompMouth::round, RoboCompMouth::Pos());"), **left}
    assert found(linked, files) == [("RC6301", "moth_proxy"), ("RC6314", "Pos")]


@pytest.mark.parametrize(
    ("more", "expected"), [("compatibility: robocomp\n", ["nwes_proxy"]), ("", ["news_proxy", "nwes_proxy"])]
)
def test_proxies_have_the_names_that_older_tools_gave_them(link: Link, more: str, expected: list[str]) -> None:
    used = worker("news_proxy->said(1); news_pubproxy->said(1); nwes_proxy->said(1);")
    reported = found(link(component("cpp", more)), used)
    assert [word for code, word in reported if code == "RC6301"] == expected


@pytest.mark.parametrize(
    ("body", "reported"),
    [
        ('a = params.at("spede");', ["spede"]),
        ('a = params["spede"].value;', ["spede"]),
        ('a = this->configLoader.get<int>("camera.fsp");', ["camera.fsp"]),
        ('try { a = params.at("spede"); } catch (const std::exception& e) { qFatal("no"); }', ["spede"]),
        ('try { a = params.at("spede"); } catch (const std::exception& e) { a = 1; }', []),
        ('a = params.at("speed"); b = params["flat"]; c = configLoader.get<int>("Period.Compute");', []),
        ('a = other.at("spede"); b = params.at(name); c = "spede";', []),
        ('key = "spede"; a = params.at("spede");', []),
    ],
)
def test_settings_of_robocomps_own_tool(link: Link, body: str, reported: list[str]) -> None:
    linked, files = link(component("cpp", "compatibility: robocomp\n")), worker(body)
    of_loader = [("RC6309", one) for one in reported if "params" not in body]
    assert found(linked, files, ("flat",)) == of_loader
    of_params = "bool SpecificWorker::setParams(RoboCompCommonBehavior::ParameterList params)"
    files["specificworker.cpp"] = files["specificworker.cpp"].replace("void SpecificWorker::compute()", of_params)
    assert found(linked, files, ("flat",)) == [("RC6309", one) for one in reported]
