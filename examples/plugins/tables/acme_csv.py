"""A network as a table: a row for each process."""

import csv
import io
import shlex

from robocomp_yaml.api.plugins import Unwritable


def export(network):
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(["process", "host", "command", "after"])
    for process in network.processes.values():
        if process.env:
            raise Unwritable("a table cannot express an environment", process.name, process.span)
        rows.writerow([process.name, process.host, shlex.join(process.command), " ".join(process.after)])
    return {f"{network.name}.csv": out.getvalue()}
