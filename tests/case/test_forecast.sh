#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# The memory estimate of 'mps check' is that of the run, with its last picture and report.html,
# within a factor of 1.2.
# usage: test_forecast.sh PROGRAM
export LC_ALL=C # awk, printf and sort take numbers with a point
program=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failed=0
# name, first lines of the case
same_memory() {
    printf 'mps: 1\n%b\nfill: [{water: {depth: 50 %%}}]\nrun: {until: 0.03 s, threads: 1}\noutput: {frames: 2}\n' "$2" > "$1.yaml"
    "$program" check "$1.yaml" -o "$1.svg" > told 2>&1 && "$program" run "$1.yaml" -q -o "$1" > log 2>&1 || { cat told log; failed=1; }
    local told used
    told=$(sed -n 's/^cost .* \([0-9]*\) MB of memory$/\1/p' told)
    used=$(sed -n 's/^  "peak_rss_bytes": \([0-9]*\),$/\1/p' "$1/summary.json")
    awk -v a="$told" -v b="$used" 'BEGIN { r = 1e6 * a / b; exit !(r > 1 / 1.2 && r < 1.2) }' || { echo "FAILED: $1: told $told MB, used $used bytes"; failed=1; }
    echo "$1: told $told MB, used $used bytes"
}
same_memory flat 'dp: 10 mm\ntank: {size: 1 0.6 m}'
same_memory box 'dim: 3\ndp: 50 mm\ntank: {size: 1.2 0.8 0.6 m}'
same_memory tube 'dim: 3\ndp: 60 mm\ntank: {cylinder: {radius: 0.5 m, length: 1 m, axis: z}}'
[ $failed -eq 0 ] && echo "runs take the memory that is told"
exit $failed
