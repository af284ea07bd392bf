#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# A driver in C and its case file give the same bytes of probes.csv and of frames.
# usage: test_same_bytes.sh DRIVERS PROGRAM CASES [NAME ..]
export LC_ALL=C # awk, printf and sort take numbers with a point
drivers=$1 program=$2 cases=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

# name, time simulated [s]: some tens of steps; test_files.sh has the cases without a driver
table=$(dirname "$0")/short_runs
diff <(cut -d' ' -f1 "$table" | sort) <(basename -a -s .yaml "$cases"/*.yaml | sort) || {
    echo "FAILED: short_runs has not a line for each case"
    exit 1
}
times=$(grep -f <(basename -a -s .c "$(dirname "$0")"/../../examples/*.c | sed 's/.*/^& /') "$table")
count=$(wc -l <<< "$times")
[ "$count" -eq "$(ls "$(dirname "$0")"/../../examples/*.c | wc -l)" ] || { echo "FAILED: a driver has no case"; exit 1; }

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
[ $failed -eq 0 ] && echo "$count drivers and case files: the same bytes"
exit $failed
