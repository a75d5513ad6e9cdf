"""All commands of the manager."""

from __future__ import annotations

from robocomp_yaml.manager import commands, documents

COMMANDS = (*commands.COMMANDS, *documents.COMMANDS)
