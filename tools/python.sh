# Installs Debian's Python, with which tools/prepare.py runs, as root or by a sudo that needs no password.
advice="rcyaml needs Python 3.11 or later. An administrator installs it: sudo apt install python3"
if [ "$(id -u)" = 0 ]; then as_root=; elif sudo -n true 2>/dev/null; then as_root="sudo -n"; else as_root=none; fi
if [ "$as_root" = none ] || ! command -v apt-get >/dev/null; then
    echo "$advice" >&2
    exit 1
fi
echo "Python is missing, and is installed: python3"
export DEBIAN_FRONTEND=noninteractive
output=$($as_root apt-get -q update 2>&1 && $as_root apt-get -q install -y --no-install-recommends python3 2>&1) || {
    echo "$output" >&2
    echo "$advice" >&2
    exit 1
}
