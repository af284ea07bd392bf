# SPDX-License-Identifier: BSD-3-Clause
# Completion of mps for bash: verbs, options, files, cases to start from, columns, and the paths of --set.

# Words of a list that begin as typed.
_mps_words() {
    mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")
}

# Folders, and files with one of these endings; none: all files.
_mps_files() {
    local ending
    compopt -o filenames 2>/dev/null
    if [ $# = 0 ]; then
        mapfile -t COMPREPLY < <(compgen -f -- "$cur")
        return
    fi
    mapfile -t COMPREPLY < <(
        compgen -d -- "$cur"
        for ending in "$@"; do compgen -f -X "!*.$ending" -- "$cur"; done
    )
}

# The next word of a path, with '.' where more follows and '=' where a value does. A '*' of the table is a name, which the user types.
_mps_paths() {
    local -A found=()
    local key i fits end=$cur
    local -a typed words
    compopt -o nospace 2>/dev/null
    IFS=. read -ra typed <<<"$cur."
    local last=$((${#typed[@]} - 1))
    for key in "${_mps_keys[@]}"; do
        [[ $verb != @(stats|report) || $key == impacts.* ]] || continue # of a run that is done
        IFS=. read -ra words <<<"$key"
        [ ${#words[@]} -gt $last ] || continue
        fits=1
        for ((i = 0; i < last; i++)); do
            [[ ${words[i]} == '*' || ${words[i]} == "${typed[i]}" ]] || fits=0
        done
        [[ $fits = 1 && ${words[last]} != '*' && ${words[last]} == "${typed[last]}"* ]] || continue
        end=${cur%"${typed[last]}"}${words[last]}
        if [ ${#words[@]} -gt $((last + 1)) ]; then
            unset "found[$end=]"
            found[$end.]=1
        elif [ -z "${found[$end.]}" ]; then
            found[$end=]=1
        fi
    done
    COMPREPLY=("${!found[@]}")
}

# Columns of the probes.csv of a run.
_mps_columns() {
    local names
    names=$(head -1 "$1/probes.csv" 2>/dev/null | tr ',' '\n' | sed -e 1d -e 's/\[.*//')
    _mps_words "$names"
}

_mps_argument() { # what the verb takes, number of arguments before this one, the first of them
    case $1 in
    CASE) _mps_files yaml yml json html ;;
    NAME) _mps_words "$_mps_cases" ;;
    FILE) _mps_files ;;
    'DIR [COLUMN ..]') if [ "$2" = 0 ]; then _mps_files -; else _mps_columns "$3"; fi ;;
    DIR) [ "$2" != 0 ] || _mps_files - ;;
    DIR*) _mps_files csv ;;
    \[*) _mps_words "$(tr '[]|' ' ' <<<"$1")" ;;
    esac
}

_mps() {
    local cur=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} verb=${COMP_WORDS[1]}
    local i count=0 first='' equals=0
    COMPREPLY=()
    if [ "$COMP_CWORD" = 1 ]; then
        _mps_words "$_mps_verbs"
        return
    fi
    # '--out=x' and 'dp=x' arrive as three words
    if [ "$cur" = = ]; then cur='' equals=1; elif [ "$before" = = ]; then before=${COMP_WORDS[COMP_CWORD - 2]} equals=1; fi
    local value=${_mps_values[${before:--}]}
    case $value in
    PATH=VALUE) _mps_paths ;;
    PLACE) _mps_files ;;
    esac
    [ -z "$value" ] && [ $equals = 0 ] || return
    if [[ $cur == -* ]]; then
        _mps_words "${_mps_options[$verb]}"
        return
    fi
    for ((i = 2; i < COMP_CWORD; i++)); do
        case ${COMP_WORDS[i]} in
        =) ((i++)) ;;
        -*) [ -z "${_mps_values[${COMP_WORDS[i]}]}" ] || [ "${COMP_WORDS[i + 1]}" = = ] || ((i++)) ;;
        *) [ $((count++)) -gt 0 ] || first=${COMP_WORDS[i]} ;;
        esac
    done
    _mps_argument "${_mps_arguments[$verb]}" $count "$first"
}
complete -F _mps mps
