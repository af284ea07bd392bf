#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A rank is killed in a step: mpirun must end the others within 10 s, with a status that is not 0.
# usage: tests/mpi/test_kill.sh MPIRUN RANKS PROGRAM
set -uo pipefail
begin=$SECONDS
output=$(timeout 60 "$(dirname "$0")/run" "$1" "$2" "$3" kill 2>&1)
status=$?
if [ $status = 77 ]; then
    echo "$output"
    exit 77
fi
if [ $status = 0 ] || [ $status = 124 ] || [ $((SECONDS - begin)) -ge 10 ] || ! grep -q 'rank 1 dies' <<<"$output" || grep -q 'lives on' <<<"$output"; then
    echo "status $status after $((SECONDS - begin)) s: $output"
    exit 1
fi
echo "status $status after $((SECONDS - begin)) s"
