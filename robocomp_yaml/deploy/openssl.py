"""Keys and certificates, made by openssl.

A certificate is valid from 1970 on, because the clock of a host without a battery starts there. Only `openssl ca` lets
one set the first day.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator

from robocomp_yaml.deploy.local import procfs

FOR_EVER = "99991231235959Z"
_UNFINISHED = "making-"
_SETTINGS = """\
[ca]
default_ca = own
[own]
database = database
new_certs_dir = .
rand_serial = yes
default_md = sha256
default_startdate = 19700101000000Z
default_enddate = {end}
policy = any
unique_subject = no
x509_extensions = extensions
[any]
commonName = supplied
[extensions]
{extensions}
"""


@contextlib.contextmanager
def certificate(folder: str, name: str, extensions: str, *, end: str = FOR_EVER, signer: str = "") -> Iterator[str]:
    """A temporary folder below `folder` with a new key and its certificate, in the files `key` and `certificate`.
    `extensions` are lines as openssl's settings have them, `signer` is the path without ending of the key (.key) and
    the certificate (.crt) that sign; by default it signs itself. Raises OSError if openssl is missing or fails."""
    signing = ("-keyfile", f"{signer}.key", "-cert", f"{signer}.crt") if signer else ("-selfsign", "-keyfile", "key")
    remove_unfinished(folder)
    with tempfile.TemporaryDirectory(prefix=f"{_UNFINISHED}{os.getpid()}-", dir=folder) as work:
        for file, text in (("settings", _SETTINGS.format(end=end, extensions=extensions)), ("database", "")):
            with open(f"{work}/{file}", "w", encoding="ascii") as opened:
                opened.write(text)
        _run(work, "req", "-new", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes",
             "-subj", f"/CN={name}", "-keyout", "key", "-out", "request")  # fmt: skip
        _run(work, "ca", "-batch", "-notext", "-config", "settings", *signing, "-in", "request", "-out", "certificate")
        yield work


def remove_unfinished(folder: str) -> None:
    """Removes what a process left that was killed while it made a certificate in this folder."""
    with contextlib.suppress(OSError):
        for name in os.listdir(folder):
            pid = name.removeprefix(_UNFINISHED).partition("-")[0]
            if name.startswith(_UNFINISHED) and not (pid.isdigit() and procfs.entry(int(pid))):
                shutil.rmtree(os.path.join(folder, name), ignore_errors=True)


def _run(folder: str, *words: str) -> None:
    mask = os.umask(0o077)
    try:
        done = subprocess.run(
            ["openssl", *words], cwd=folder, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL
        )
    finally:
        os.umask(mask)
    if done.returncode:
        raise OSError(0, f"openssl cannot create a certificate: {done.stderr.strip()[-300:]}")
