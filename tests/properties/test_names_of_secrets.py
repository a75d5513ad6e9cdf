"""Names that say that something is secret: rcyaml and components in Python have one rule; that of C++ is to agree."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from robocomp_yaml import secrets
from robocomp_yaml.languages import language

SECRET = (
    "PASSWORD DB_PASSWORD dbpassword MYSQL_PWD PGPASSWORD wifiPassword api-key apiKey API_KEY mail.ApiKey ACCESS_TOKEN "
    "authtoken authToken APIToken SECRET_KEY AWS_SECRET_ACCESS_KEY private_key passphrase credentials userpass DB_PASS "
    "token tokens github_tokens contraseña contrasena --api-key Ice.X.Password SSHPrivateKey pass x.private secret2"
).split()
PLAIN = (
    "compass bypass tokenizer max_tokens PWD OLDPWD low_pass lowpass highPass use_password password_file token_path "
    "private_ip speed passive passenger keyboard monkey author key low_pass_filter password_length ñ é_1 _ 3 x.size"
).split()
URLS = (
    "https://u:p@ss@host/x?a=b",
    "mqtt://:hunter2@host",
    "tcp -h localhost -p 10001",
    "ssh://git@host",
    "no://",
    "://a:b@c",
    "a://b:c@d e://f:g@h",
    "x://a:b",
    "x://a@b:c",
    "x://a:@b",
    "é://a:b@c",
    "http://h:80/a@b",
    "@",
    "",
)


@pytest.mark.parametrize("name", SECRET)
def test_names_that_say_so(name: str) -> None:
    assert secrets.is_secret(name)


@pytest.mark.parametrize("name", PLAIN)
def test_names_that_only_sound_so(name: str) -> None:
    assert not secrets.is_secret(name)


@pytest.fixture(scope="module")
def asker(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that says of each line, between two signs, what C++ makes of it."""
    folder = tmp_path_factory.mktemp("secrecy")
    runtime = language("cpp").templates / "runtime"
    (folder / "main.cpp").write_text(
        f'#include "{runtime}/secrecy.cpp"\n#include <iostream>\nint main()\n{{\n'
        "    for (std::string line; std::getline(std::cin, line);)\n"
        "        std::cout << runtime::isSecret(line) << runtime::withoutPasswords(line) << '\\n';\n}\n"
    )
    done = subprocess.run(["g++", "-std=c++17", "-Wall", "-Wextra", "-Werror", "-o", str(folder / "ask"),
                           str(folder / "main.cpp")], capture_output=True, text=True)  # fmt: skip
    assert done.returncode == 0, done.stderr
    return folder / "ask"


def test_cpp_run_time_has_the_same_rules(asker: Path) -> None:
    parts = [
        "pass",
        "Pass",
        "DB",
        "token",
        "Tokens",
        "API",
        "api",
        "Key",
        "_",
        "file",
        "max",
        "ñ",
        "2",
        "private",
        "x",
        "PWD",
    ]
    made = [f"{one}{two}{three}" for one in parts for two in parts for three in ("", *parts[:8])]
    lines = [*SECRET, *PLAIN, *URLS, *made]
    done = subprocess.run([asker], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == [f"{secrets.is_secret(line):d}{secrets.url(line)}" for line in lines]
