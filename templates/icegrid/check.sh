# Checks, before anything starts, what a host has of the processes that are to run there. The words are: p NUMBER FOLDER
# PROGRAM starts a process (PROGRAM is '' if it is not checked); each of the following is about that process: v NAME PATH
# is a variable that is the text of a file, f DIGEST PATH a file with the digest that it has where the command runs, m
# PYTHON CODE a program in Python, l NAME ONLY an interface or a name on which it listens (ONLY is `only` if others would
# call it there), and t KEY N WORD... a test of a limit, with N words. Prints a line for each fault.
base=${XDG_STATE_HOME:-$HOME/.local/state}/rcyaml/pushed
declare -A pushed=()
for list in "$base"/*; do
    [[ -f $list ]] && while IFS= read -rd '' entry; do pushed[${entry#* * }]=yes; done <"$list"
done
start() { head -c 20 -- "$1" 2>/dev/null | od -An -v -tx1 | tr -d ' \n'; }
own=$(start /proc/self/exe)
say() { printf 'rcyaml-check\t%s\t%s\t%s\n' "$number" "$1" "$2"; }
while (( $# )); do
    case $1 in
        p)  number=$2 path=$4
            cd -- "${3:-/}" 2>/dev/null || { say folder ''; path=''; cd /; }
            case $path in
                '') ;;
                */*) if [[ ! -f $path ]]; then say file ''
                     elif [[ ! -x $path ]]; then say right ''
                     else
                         first=$(start "$path")
                         if [[ $first == 7f454c46* && ${first:8:4}${first:36:4} != "${own:8:4}${own:36:4}" ]]; then
                             say kind ''
                         elif [[ $first == 2321* ]]; then
                             IFS= read -r line <"$path" 2>/dev/null
                             read -r interpreter _ <<<"${line#'#!'}"
                             [[ -x $interpreter ]] || say interpreter "$interpreter"
                         fi
                     fi ;;
                *) type -P -- "$path" >/dev/null || say file '' ;;
            esac
            program=$path
            shift 4 ;;
        v)  path=$3
            [[ $path == "~/"* ]] && path=${HOME:?}/${path:2}
            [[ -f $path && -r $path ]] || say variable "the variable $2 is the text of $path"
            shift 3 ;;
        f)  if [[ ! -f $3 ]]; then
                [[ $3 == "$program" ]] || say gone "$3"
            elif [[ $(start "$3") != 7f454c46* || -n ${pushed[$3]} ]]; then
                read -r digest _ < <(sha256sum <"$3")
                [[ $digest == "$2"* ]] || say differs "$3"
            fi
            shift 3 ;;
        m)  if [[ -x $program ]]; then
                read -r line <"$program"
                read -ra words <<<"${line#'#!'}"
                [[ ${words[0]##*/} == env ]] && words=("${words[@]:1}")
                lacking=$([[ -n $2 ]] && export RCYAML_PYTHON=$2; "${words[@]}" -c "$3" "$program" "$3" </dev/null 2>/dev/null)
                [[ -z $lacking ]] || say modules "$lacking"
            fi
            shift 3 ;;
        l)  if [[ -d /sys/class/net/$2 ]]; then
                [[ -n $(ip -o address show dev "$2" scope global 2>/dev/null) || $2 == lo ]] || say interface "$2"
                [[ $3 == only ]] && say only "$2"
            elif ! getent ahosts "$2" >/dev/null; then
                all=(/sys/class/net/*/)
                all=("${all[@]%/}")
                say listen "$2 ${all[*]##*/}"
            fi
            shift 3 ;;
        t)  key=$2 count=$3
            errors=$(LC_ALL=C "${@:4:count}" 2>&1 >/dev/null) || errors=${errors:-it fails}
            [[ -z $errors ]] || say limit "$key: ${errors##*: }"
            shift $(( 3 + count )) ;;
    esac
done
exit 0
