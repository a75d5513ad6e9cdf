# Written by rcyaml. Reads names of programs, a line each, behind the Python that the process asks for (RCYAML_PYTHON, ""
# for none) and a tab; answers with a line each: the program's path ("" where there is none that can be executed),
# digest, day, and what it needs that is not here. $1 is modules.py. Nothing that it is asked about is run, but for the
# interpreters of Python programs.
set -f
tab=$(printf '\t')
while IFS= read -r asked; do
  python=${asked%%"$tab"*} program=${asked#*"$tab"}
  path=$(command -v -- "$program" 2>/dev/null) || path=
  case $path in /*) ;; *) path= ;; esac
  [ -f "$path" ] && [ -x "$path" ] || path=
  digest= day= missing=
  if [ -n "$path" ]; then
    digest=$(sha256sum < "$path" | cut -c1-12)
    day=$(date -u -r "$path" +%Y-%m-%d)
    missing=$(ldd "$path" 2>/dev/null | sed -n 's/^[[:space:]]*\([^ ]*\) => not found.*/\1/p' | sort -u)
    words=$(head -c 256 "$path" | tr -d '\000' | sed -n '1s/^#!//p')
    interpreter=
    for word in $words; do
      case $word in /usr/bin/env | /bin/env | -* | *=*) ;; *) interpreter=$word; break ;; esac
    done
    if [ -n "$interpreter" ] && ! command -v -- "$interpreter" >/dev/null 2>&1; then
      missing="$missing $interpreter"
    else
      case ${interpreter##*/} in
        python*) missing="$missing $([ -z "$python" ] || export RCYAML_PYTHON="$python"; "$interpreter" -c "$1" "$path" "$1" </dev/null 2>/dev/null)" ;;
      esac
    fi
    missing=$(printf '%s' "$missing" | tr '\n' ' ')
  fi
  printf '%s\t%s\t%s\t%s\n' "$path" "$digest" "$day" "$missing"
done
