# SPDX-License-Identifier: BSD-3-Clause
# Sourced by tests of the program mps: a separate folder, failures, expectations. It changes to the
# folder $work.
export LC_ALL=C # awk, printf and sort take numbers with a point
unset OMPI_COMM_WORLD_SIZE PMI_SIZE OMPI_COMM_WORLD_RANK PMI_RANK
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failed=0
# 1: a build with sanitizers, in which runs of many steps are shorter or left out
slow=$(grep -c __asan_init "$program")
[ "$slow" = 0 ] || slow=1

fail() {
    echo "FAILED: $*"
    failed=1
}

# wanted exit code, wanted text, command ..
expect() {
    local code=$1 text=$2
    shift 2
    "$@" > log 2>&1
    local got=$?
    [ $got -eq "$code" ] || fail "exit $got, not $code: $*: $(tail -4 log)"
    [ -z "$text" ] || grep -qF -- "$text" log || fail "no '$text': $*: $(head -8 log)"
}
