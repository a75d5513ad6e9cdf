"""The commands of the manager that say what can be changed, and of which types the values are."""

from __future__ import annotations

from robocomp_yaml.manager.access import READ
from robocomp_yaml.manager.commands import ONE, Command, reading

COMMANDS = (
    Command("GET", f"{ONE}/entries", READ, "The entries with their ports, and what could be added.",
            reading(lambda managed, query: managed.entries())),
    Command("GET", f"{ONE}/process", READ, "The types of a process' parameters and of its methods' arguments.",
            reading(lambda managed, query: managed.process(query.get("name", ""))), query=(("name", "The process."),)),
)  # fmt: skip
