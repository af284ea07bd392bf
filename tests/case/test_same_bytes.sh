#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# A driver in C and its case file give the same bytes of probes.csv and of frames: case files can
# express all features of a driver.
# usage: test_same_bytes.sh DRIVERS PROGRAM CASES [NAME ..]
export LC_ALL=C # awk, printf and sort take numbers with a point
drivers=$1 program=$2 cases=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

# name, time simulated [s]: some tens of steps; a driver has no rigid body, unlike cases with `body`
times=$(grep -vf <(grep -l "^body:" "$cases"/*.yaml | sed 's|.*/||; s|[.]yaml$| |') "$(dirname "$0")/short_runs")
count=$(grep -L "^body:" "$cases"/*.yaml | wc -l)
if [ "$count" -ne "$(wc -l <<< "$times")" ]; then
    echo "FAILED: $count case files, $(wc -l <<< "$times") drivers"
    exit 1
fi

while read -r name t; do
    [ $# -gt 0 ] && [[ " $* " != *" $name "* ]] && continue
    a=$work/$name.c b=$work/$name.yaml
    "$drivers/$name" --t-end "$t" --out "$a" --frames 2 --quiet --no-report --threads 1 > "$work/log" 2>&1 || {
        echo "FAILED: $name: the driver"; cat "$work/log"; failed=1; continue; }
    "$program" run "$cases/$name.yaml" --set "run.until=$t s" --set output.frames=2 --set "output.page=0 MB" -j 1 -o "$b" --quiet \
        > "$work/log" 2>&1 || { echo "FAILED: $name: the case"; cat "$work/log"; failed=1; continue; }
    rows=$(wc -l < "$a/probes.csv")
    [ "$rows" -ge 3 ] || { echo "FAILED: $name: $rows rows"; failed=1; }
    for file in probes.csv frames/frames_000000.vtp frames/frames_000001.vtp frames/frames_000002.vtp; do
        [ -e "$a/$file" ] || { echo "FAILED: $name: no $file"; failed=1; continue; }
        cmp "$a/$file" "$b/$file" || failed=1
    done
done <<< "$times"
[ $failed -eq 0 ] && echo "17 drivers and case files: the same bytes"
exit $failed
