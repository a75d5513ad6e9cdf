"""Calls to a component beside calls to a bare Ice server with the same interface, and whether periods drift.

    python benchmarks/calls.py [ROUNDS]

A client in C++ calls a generated C++ component and a bare C++ server in turn, some thousand calls each; then the same
for Python. The ratio is that of the times by the clock, round by round. For periods, components in both languages
write down when `compute()` is called: the mean distance of 500 calls is compared with the period.
"""

from __future__ import annotations

import os
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from building import BARE, LISTS, write
from run import RCYAML

ROUNDS, CALLS = 20, 3000
PERIOD, PERIODS = 10, 500  # milliseconds, and how many of them
INTERFACE = "module: RoboCompBase\ninterfaces: {Base: {methods: {move: {in: {by: float}, returns: bool}}}}\n"
CLIENT = """\
#include <Base.h>
#include <Ice/Ice.h>
#include <chrono>
#include <cstdio>
#include <cstdlib>

int main(int argc, char* argv[])
{
    Ice::CommunicatorHolder ice(argc, argv);
    const int rounds = std::atoi(argv[1]), calls = std::atoi(argv[2]);
    for (int round = -1; round < rounds; ++round)
    {
        for (int server = 3; server < argc; ++server)
        {
            const auto proxy = Ice::uncheckedCast<RoboCompBase::BasePrx>(ice->stringToProxy(argv[server]));
            const auto begin = std::chrono::steady_clock::now();
            for (int n = 0; n < calls; ++n)
            {
                proxy->move(1);
            }
            const std::chrono::duration<double, std::micro> taken = std::chrono::steady_clock::now() - begin;
            if (round >= 0)
            {
                std::printf("%d %f\\n", server - 3, taken.count() / calls);
            }
        }
    }
}
"""
BARE_PYTHON = """\
import sys
import Ice
Ice.loadSlice(sys.argv[1])
import RoboCompBase

class Base(RoboCompBase.Base):
    def move(self, by, current):
        return True

with Ice.initialize() as ice:
    adapter = ice.createObjectAdapterWithEndpoints("Base", sys.argv[2])
    adapter.add(Base(), ice.stringToIdentity("base"))
    adapter.activate()
    ice.waitForShutdown()
"""
CPP_HEADER = """\
#pragma once
#include "genericworker.h"
#include <chrono>
#include <vector>
class SpecificWorker : public GenericWorker
{
public:
    void initialize() {}
    void compute();
    bool Base_move(float) { return true; }
private:
    std::vector<double> at_;
};
"""
CPP_CODE = """\
#include "specificworker.h"
#include <fstream>
void SpecificWorker::compute()
{
    at_.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count());
    if (at_.size() == %d)
    {
        std::ofstream("periods") << (at_.back() - at_.front()) / (at_.size() - 1) << std::endl;
    }
}
"""
PYTHON_CODE = """\
import time
from pathlib import Path
from generated.genericworker import GenericWorker

class SpecificWorker(GenericWorker):
    def initialize(self):
        self.at = []

    def compute(self):
        self.at.append(time.monotonic())
        if len(self.at) == %d:
            Path("periods").write_text(str((self.at[-1] - self.at[0]) / (len(self.at) - 1)))

    def Base_move(self, by):
        return True
"""


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@contextmanager
def started(command: list[str | Path], port: int, cwd: Path) -> Iterator[None]:
    process = subprocess.Popen(command, cwd=cwd, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        while True:
            try:
                socket.create_connection(("127.0.0.1", port), 0.2).close()
                break
            except OSError:
                time.sleep(0.05)
        yield
    finally:
        process.send_signal(signal.SIGTERM)
        process.wait()


def component(robot: Path, language: str) -> tuple[Path, int]:
    """A component's folder, and where it serves."""
    folder, port = robot / language, free_port()
    write(
        folder / f"{language}.cdsl.yaml",
        f"component: Base{language.title()}\nlanguage: {language}\nimports: [Base]\nimplements: [Base]\n"
        f"period: {PERIOD} ms\n",
    )
    write(
        folder / "etc/config.yaml",
        f"component: ../{language}.cdsl.yaml\nendpoints: {{Base: tcp -h 127.0.0.1 -p {port}}}\n",
    )
    return folder, port


def binary(folder: Path, main: str, slice_: Path) -> Path:
    write(folder / "Base.ice", slice_.read_text(encoding="utf-8"))
    write(folder / "main.cpp", main)
    write(folder / "CMakeLists.txt", LISTS.format("Base"))
    for command in (["cmake", "-G", "Ninja", "-S", ".", "-B", "build"], ["ninja", "-C", "build"]):
        subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return folder / "build" / "bare"


def main(rounds: int) -> None:
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        robot = work / "robot"
        write(robot / "rcyaml.yaml", "interfaces: [.]\n")
        write(robot / "Base.idsl.yaml", INTERFACE)
        folders = {language: component(robot, language) for language in ("cpp", "python")}
        write(folders["cpp"][0] / "src/specificworker.h", CPP_HEADER)
        write(folders["cpp"][0] / "src/specificworker.cpp", CPP_CODE % PERIODS)
        write(folders["python"][0] / "src/specificworker.py", PYTHON_CODE % PERIODS)
        for command in ("compile", "build"):
            subprocess.run([*RCYAML, "-q", command], cwd=robot, check=True, stdout=subprocess.DEVNULL)
        slice_ = robot / "slice" / "Base.ice"
        bare_cpp = binary(work / "bare", BARE.format("Base", "").replace('"tcp"', "argv[1]"), slice_)
        client = binary(work / "client", CLIENT, slice_)
        write(work / "bare.py", BARE_PYTHON)
        for language, title in (("cpp", "C++"), ("python", "Python")):
            folder, port = folders[language]
            other = free_port()
            endpoint = f"tcp -h 127.0.0.1 -p {other}"
            bare = [bare_cpp, endpoint] if language == "cpp" else [sys.executable, work / "bare.py", slice_, endpoint]
            program = folder / "bin" / f"Base{language.title()}"
            with started([program, folder / "etc/config"], port, folder), started(bare, other, work):
                identities = [f"base:tcp -h 127.0.0.1 -p {port}"]
                identities.append(f"{'Base' if language == 'cpp' else 'base'}:{endpoint}")
                told = subprocess.run(
                    [client, str(rounds), str(CALLS), *identities], check=True, capture_output=True, text=True
                ).stdout.split()
                while not (folder / "periods").is_file():
                    time.sleep(0.1)
            taken = list(map(float, told[1::2]))
            ours, floor = taken[0::2], taken[1::2]
            ratios = [one / two for one, two in zip(ours, floor, strict=True)]
            print(
                f"a call in {title:<7} {statistics.median(ours):6.1f} µs  bare {statistics.median(floor):6.1f} µs  "
                f"{statistics.median(ratios):5.2f} times ({min(ratios):.2f}–{max(ratios):.2f}), goal 1.05"
            )
            period = float((folder / "periods").read_text()) * 1000
            print(f"a period in {title:<5} {period:6.3f} ms of {PERIOD}: {period / PERIOD:.4f} times", flush=True)


if __name__ == "__main__":
    os.environ.pop("RCYAML_PATH", None)
    main(int(sys.argv[1]) if len(sys.argv) > 1 else ROUNDS)
