"""A link is cut, or the other end halts: calls fail by themselves within 15 s. A call that only takes long does not."""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from components import build
from conftest import in_long
from cpp_programs import FAST, cmake, locked, needs_cpp
from java_programs import java_build, needs_java
from processes import Ports, Start, until
from scenario import INTERFACES, cdsl

LANGUAGES = [
    pytest.param("python", id="python"),
    pytest.param("cpp", id="cpp", marks=[pytest.mark.slow, needs_cpp]),
    pytest.param("java", id="java", marks=[in_long, needs_java]),
]
WITHIN = 15.0
PYTHON = """
import time
import Ice
from generated.genericworker import GenericWorker

class SpecificWorker(GenericWorker):
    def compute(self):
        print("calls", flush=True)
        begin = time.monotonic()
        try:
            self.arm_proxy.block(SECONDS)
            print("returned", flush=True)
        except Ice.LocalException:
            print("failed after", time.monotonic() - begin, flush=True)
        time.sleep(0.2)
"""
CPP = """
#include "specificworker.h"
#include <Ice/LocalException.h>
#include <iostream>
#include <thread>

void SpecificWorker::initialize() {}
void SpecificWorker::compute()
{
    std::cout << "calls" << std::endl;
    const auto begin = std::chrono::steady_clock::now();
    try
    {
        arm_proxy->block(SECONDS);
        std::cout << "returned" << std::endl;
    }
    catch (const Ice::LocalException&)
    {
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        std::cout << "failed after " << taken.count() << std::endl;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
}
"""
JAVA = """
import generated.GenericWorker;

public class SpecificWorker extends GenericWorker {
    @Override
    public void compute() throws Exception {
        System.out.println("calls");
        long begin = System.nanoTime();
        try {
            arm_proxy.block(SECONDS);
            System.out.println("returned");
        } catch (com.zeroc.Ice.LocalException error) {
            System.out.println("failed after " + (System.nanoTime() - begin) / 1e9);
        }
        Thread.sleep(200);
    }
}
"""
SERVER = """
import time
from generated.genericworker import GenericWorker

class SpecificWorker(GenericWorker):
    def Arm_block(self, seconds):
        time.sleep(seconds)
"""
FOREIGN = """\
import sys, time
import Ice
Ice.loadSlice("", ["--all", f"-I{sys.argv[2]}", f"{sys.argv[2]}/Arm.ice"])
import RoboCompArm

class Arm(RoboCompArm.Arm):
    def block(self, seconds, current):
        time.sleep(seconds)

with Ice.initialize(["--Ice.ThreadPool.Server.Size=2"]) as ice:
    adapter = ice.createObjectAdapterWithEndpoints("Arm", f"tcp -h 127.0.0.1 -p {sys.argv[1]}")
    adapter.add(Arm(), ice.stringToIdentity("arm"))
    adapter.activate()
    print("serves", flush=True)
    ice.waitForShutdown()
"""
SECONDS = 20


class Cable:
    """Connects a port to another one, until it is cut: then both ends hear nothing more."""

    def __init__(self, to: int, port: int) -> None:
        self._to, self._is_cut = to, threading.Event()
        self._server = socket.create_server(("127.0.0.1", port))
        self._ends: list[socket.socket] = []
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self) -> None:
        while True:
            try:
                near = self._server.accept()[0]
                far = socket.create_connection(("127.0.0.1", self._to))
            except OSError:
                return
            self._ends += [near, far]
            for one, other in ((near, far), (far, near)):
                threading.Thread(target=self._carry, args=(one, other), daemon=True).start()

    def _carry(self, one: socket.socket, other: socket.socket) -> None:
        try:
            while data := one.recv(65536):
                if not self._is_cut.is_set():
                    other.sendall(data)
        except OSError:
            pass

    def cut(self) -> None:
        self._is_cut.set()

    def mend(self) -> None:
        """New connections work, and old ones end."""
        ends, self._ends = self._ends, []
        self._is_cut.clear()
        for end in ends:
            end.shutdown(socket.SHUT_RDWR)
            end.close()

    def close(self) -> None:
        for end in (self._server, *self._ends):
            end.close()


@pytest.fixture
def cables() -> Iterator[list[Cable]]:
    made: list[Cable] = []
    yield made
    for cable in made:
        cable.close()


@pytest.fixture(params=LANGUAGES)
def client(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a client that calls a method which takes SECONDS, again and again."""
    base, language = tmp_path_factory.getbasetemp(), request.param
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "cut links"
    folder.mkdir(exist_ok=True)
    root = folder / language / "c"
    with locked(folder / f"{language}.lock"):
        if not root.is_dir():
            documents = {**INTERFACES, "c/c.cdsl.yaml": cdsl("Caller", language, requires=["Arm"], period="100 ms")}
            build(documents, folder / language)
            name, text = {
                "python": ("specificworker.py", PYTHON),
                "cpp": ("specificworker.cpp", CPP),
                "java": ("SpecificWorker.java", JAVA),
            }[language]
            (root / "src" / name).write_text(text.replace("SECONDS", str(SECONDS)))
            if language == "cpp":
                cmake(root, *FAST)
            elif language == "java":
                java_build(root)
    return root


@pytest.fixture
def server(tmp_path: Path) -> Path:
    built = build({**INTERFACES, "s/s.cdsl.yaml": cdsl("Server", implements=["Arm"])}, tmp_path)["Server"]
    (built.root / "src" / "specificworker.py").write_text(SERVER)
    return built.root


def command(root: Path, name: str, folder: Path, properties: dict[str, str]) -> list[str | Path]:
    config = folder / f"{name}.config"
    config.write_text("".join(f"{key} = {value}\n" for key, value in properties.items()))
    return [*([sys.executable] if (root / "src" / "specificworker.py").exists() else []), root / "bin" / name, config]


def test_a_cut(client: Path, server: Path, tmp_path: Path, start: Start, free_port: Ports, cables: list[Cable]) -> None:
    port, through = free_port(), free_port()
    endpoints = {"Arm.Endpoints": f"tcp -h 127.0.0.1 -p {port}", "Ice.ThreadPool.Server.Size": "4"}
    start(command(server, "Server", tmp_path, endpoints)).wait_for("Server is running")
    cables.append(Cable(port, through))
    caller = start(command(client, "Caller", tmp_path, {"ArmProxy": f"arm:tcp -h 127.0.0.1 -p {through}"}))
    caller.wait_for("returned")  # a call that takes longer than the limit
    until(lambda: caller.output.count("calls") == 2, "the next one")
    time.sleep(1)
    cables[0].cut()
    began = time.monotonic()
    caller.wait_for("failed after", WITHIN + 5)
    assert time.monotonic() - began <= WITHIN + 1
    cables[0].mend()
    until(lambda: caller.output.count("returned") == 2, lambda: f"it to connect again:\n{caller.output}")


def test_a_halted_server(client: Path, server: Path, tmp_path: Path, start: Start, free_port: Ports) -> None:
    port = free_port()
    endpoints = {"Arm.Endpoints": f"tcp -h 127.0.0.1 -p {port}"}
    running = start(command(server, "Server", tmp_path, endpoints)).wait_for("Server is running")
    caller = start(command(client, "Caller", tmp_path, {"ArmProxy": f"arm:tcp -h 127.0.0.1 -p {port}"}))
    caller.wait_for("calls")
    time.sleep(5)
    os.kill(running.process.pid, signal.SIGSTOP)
    began = time.monotonic()
    caller.wait_for("failed after", WITHIN + 5)
    assert time.monotonic() - began <= WITHIN + 1
    os.kill(running.process.pid, signal.SIGCONT)


def test_a_long_call_of_another_server(
    client: Path, server: Path, tmp_path: Path, start: Start, free_port: Ports, ice: Any
) -> None:
    """It sends no heartbeats as components do."""
    port = free_port()
    start([sys.executable, "-c", FOREIGN, str(port), server / "slice"]).wait_for("serves")
    caller = start(command(client, "Caller", tmp_path, {"ArmProxy": f"arm:tcp -h 127.0.0.1 -p {port}"}))
    caller.wait_for("returned")
    assert "failed" not in caller.output
