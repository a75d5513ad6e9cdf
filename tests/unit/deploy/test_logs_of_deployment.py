"""Logs of processes: written to files of limited size, read in order, followed across rotations."""

from __future__ import annotations

import asyncio
import errno
import os
from pathlib import Path

import pytest

from robocomp_yaml.deploy.local import log_file
from robocomp_yaml.deploy.local.log_file import LogFile
from robocomp_yaml.deploy.local.log_reader import LogReader, merged


@pytest.fixture
def logs(tmp_path: Path) -> Path:
    (tmp_path / "logs").mkdir()
    return tmp_path


def texts(lines: object) -> list[str]:
    return [line.text for line in lines]  # type: ignore[attr-defined]


def test_a_line_is_written_when_it_is_complete(logs: Path) -> None:
    reader, log = LogReader(str(logs), "a"), LogFile(f"{logs}/logs/a.log")
    log.write(b"one\ntw")
    assert texts(reader.new()) == ["one"]
    log.write(b"o\r\n\nthree")
    assert texts(reader.new()) == ["two", ""]
    log.note("ended")
    assert texts(reader.new()) == ["three", "rcyaml: ended"]
    assert texts(LogReader(str(logs), "a").last(2)) == ["three", "rcyaml: ended"]
    assert LogReader(str(logs), "a").last(0) == [] and LogReader(str(logs), "b").last(5) == []
    log.close()


def test_a_line_without_end_is_split(logs: Path) -> None:
    log = LogFile(f"{logs}/logs/a.log")
    for _ in range(4):
        log.write(b"x" * (log_file.LONGEST // 2 + 1))
    log.write(b"x\n")
    assert [len(text) for text in texts(LogReader(str(logs), "a").last(9))] == [log_file.LONGEST] * 2 + [5]
    log.close()


def test_a_follower_misses_nothing_across_rotations(logs: Path) -> None:
    reader, log = LogReader(str(logs), "a"), LogFile(f"{logs}/logs/a.log", limit=400)
    seen = []
    for number in range(100):
        log.write(f"line {number}\n".encode())
        if number % 5 == 0:  # more than one read of each file
            seen += texts(reader.new())
    seen += texts(reader.new())
    assert seen == [f"line {number}" for number in range(100)]
    assert sorted(os.listdir(logs / "logs")) == ["a.log", "a.log.1"]
    assert max(os.path.getsize(logs / "logs" / name) for name in ("a.log", "a.log.1")) <= 400
    log.close()


def test_bytes_that_are_not_text_are_shown(logs: Path) -> None:
    log = LogFile(f"{logs}/logs/a.log")
    log.write(b"caf\xe9 \xff\x00\n")
    assert texts(LogReader(str(logs), "a").last(1)) == ["caf\ufffd \ufffd\x00"]
    log.close()


def test_a_full_disk_loses_lines_and_reports_their_number(logs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log = LogFile(f"{logs}/logs/a.log")
    log.write(b"before\n")
    write = os.write

    def half(file: int, data: bytes) -> int:
        return write(file, data[: len(data) // 2])

    def none(file: int, data: bytes) -> int:
        raise OSError(errno.ENOSPC, "no space")

    for full in (half, none):
        monkeypatch.setattr(log_file.os, "write", full)
        log.write(b"lost\nlost too\n")
    monkeypatch.undo()
    log.write(b"after\n")
    assert texts(LogReader(str(logs), "a").last(9)) == [
        "before", "rcyaml: 4 lines are missing here: they could not be written", "after",
    ]  # fmt: skip
    log.close()


def test_several_are_merged_by_time_each_in_its_own_order(logs: Path) -> None:
    def stamped(*lines: tuple[int, str]) -> str:
        return "".join(f"2026-11-21T10:00:{second:02}.000Z {text}\n" for second, text in lines)

    (logs / "logs/a.log").write_text(stamped((1, "a1"), (5, "a5"), (3, "clock set back")), encoding="utf-8")
    (logs / "logs/b.log").write_text(stamped((2, "b2"), (6, "b6")), encoding="utf-8")

    async def read() -> list[str]:
        readers = [LogReader(str(logs), name) for name in ("a", "b")]
        return [line.text async for line in merged(readers, 9, False)]

    assert asyncio.run(read()) == ["a1", "b2", "a5", "clock set back", "b6"]
