# SPDX-License-Identifier: BSD-3-Clause
# Sourced by the tests of the drivers, whose argument is the folder of the drivers: a folder to work in, runs and failures.
drivers=$(realpath "${1:?usage: $0 FOLDER_OF_DRIVERS}") || exit 2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
failures=0
fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

runs() { # exit code, driver, options...
    local wanted=$1 code
    shift
    "$drivers/$1" "${@:2}" --threads 1 >log 2>&1
    code=$?
    [ $code = "$wanted" ] || { fail "$*: exit $code instead of $wanted"; cat log; }
}
