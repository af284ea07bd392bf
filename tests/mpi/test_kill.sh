#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A rank is killed in a step: mpirun must end the others, which wait for it, before their watchdog
# does; its status is not 0.
# usage: tests/mpi/test_kill.sh MPIRUN RANKS PROGRAM
export LC_ALL=C # awk, printf and sort take numbers with a point
set -uo pipefail
output=$("$(dirname "$0")/run" "$1" "$2" "$3" kill 2>&1)
status=$?
echo "status $status: $output"
[ $status != 77 ] || exit 77
[ $status != 0 ] && grep -q 'rank 1 dies' <<<"$output" && ! grep -q 'lives on' <<<"$output"
