# SPDX-License-Identifier: BSD-3-Clause
# Sourced by the tests of the drivers, whose argument is the folder of the drivers: a working
# folder, runs and failures.
drivers=$(realpath "${1:?usage: $0 FOLDER_OF_DRIVERS}") || exit 2
scratch=$(mktemp -d)
trap 'kill -KILL $(jobs -p) 2>/dev/null; rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
failures=0
fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# [s] Only a signal ends a run with this --t-end.
never=10000

# Start a run that a test stops: $pid.
starts() { # log, driver, options...
    "$drivers/$2" "${@:3}" --threads 1 >"$1" 2>&1 &
    pid=$!
}

# Wait until a command succeeds, or the run $pid has ended.
wait_for() {
    until "$@" 2>/dev/null || ! kill -0 "$pid" 2>/dev/null; do sleep 0.02; done
}

more_lines() { # file, number: it has more lines than that on the disk
    [ "$(wc -l <"$1")" -gt "$2" ]
}

# Wait for the end of the run $pid.
ends() { # exit code, what, log
    local code
    wait "$pid" 2>/dev/null
    code=$?
    [ $code = "$1" ] || { fail "$2: exit $code instead of $1"; cat "$3"; }
}

# An end for resumed runs: a multiple of an interval, 60 steps after all steps in the folders. The
# last 20 steps of a run divide the remaining time.
later() { # interval, folders...
    local interval=$1
    shift
    awk -F, -v interval="$interval" 'FNR == 1 {columns = NF} FNR > 1 && NF == columns && $1 + 60 * $2 > t {t = $1 + 60 * $2}
        END {printf "%.10g", (int(t / interval) + 1) * interval}' "${@/%//steps.csv}"
}

runs() { # exit code, driver, options...
    local wanted=$1 code
    shift
    "$drivers/$1" "${@:2}" --threads 1 >log 2>&1
    code=$?
    [ $code = "$wanted" ] || { fail "$*: exit $code instead of $wanted"; cat log; }
}
