#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# References and figures of a case, in summary.json: tables by columns and units, shifted; a value
# between two times, divided.
# usage: test_references.sh PROGRAM
export LC_ALL=C # awk, printf and sort take numbers with a point
program=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failed=0
fail() {
    echo "FAILED: $*"
    failed=1
}
cat > refs.yaml << 'END'
mps: 1
dp: 30 mm
tank: {size: 0.6 0.3 m}
fill: [{water: {depth: 60 %}}]
motion: {surge: {amplitude: 15 mm, period: 1 T1}}
sensors: {P1: {wall: 0 0.06 m}}
reference:
  P1:
    - {times: 0.1 0.2 s, values: 1.2 1.4 kPa, label: two}
    - {file: known.csv, columns: [time, p], label: table, shift: 0.5 s, style: line}
  lean: {times: 1 s, values: 3 deg}
figures:
  most: {column: P1, take: largest, from: 0.05 s, until: 0.15 s}
  least: {column: P1, take: least, over: 500 Pa}
run: {until: 0.2 s}
output: {frames: 0, page: 0 MB}
END
printf 'time[ms],other[m],p[hPa]\n0,1,10\n250,2,20\n' > known.csv
"$program" run refs.yaml -q -j 1 -o run > log 2>&1 || fail "$(cat log)"
has() { grep -qF -- "$1" run/summary.json || fail "summary.json: no $1: $(grep '"label"' run/summary.json)"; }
has '{"label": "two", "unit": "Pa", "column": "P1", "line": false, "points": [[0.10000000000000001, 1200], [0.20000000000000001, 1400]]}'
has '{"label": "table", "unit": "Pa", "column": "P1", "line": true, "points": [[0.5, 1000], [0.75, 2000]]}'
has '"label": "reference", "unit": "deg", "column": null, "line": false'
# figures are of all steps, rows of a thousandth of a second: they agree to 1e-4
awk -F, 'FNR == NR {
        if (FNR > 1 && $1 >= 0.05 && $1 <= 0.15 && (most == "" || $3 > most)) most = $3
        if (FNR > 1 && (least == "" || $3 < least)) least = $3
        next
    }
    $1 ~ /^  "most": /  {split($1, w, ": "); n++; if ((w[2] / most - 1) ^ 2 < 1e-8) ok++; else print "most", w[2], most}
    $1 ~ /^  "least": / {split($1, w, ": "); n++; if ((500 * w[2] / least - 1) ^ 2 < 1e-8) ok++; else print "least", w[2], least / 500}
    END {exit !(n == 2 && ok == 2)}' run/probes.csv run/summary.json || fail "figures"

# text by sed, wanted message
refused() {
    sed "$1" refs.yaml > bad.yaml
    "$program" run bad.yaml -q -o bad > log 2>&1 && fail "not refused: $1"
    grep -qF -- "$2" log || fail "$1: no '$2': $(cat log)"
}
refused 's/values: 1.2 1.4 kPa/values: 1.2 kPa/' '2 times, but 1 values'
refused 's/\[time, p\]/[time, q]/' "'q' is no column of"
refused 's/known.csv/none.csv/' 'none.csv'
refused 's/column: P1, take: least/column: P2, take: least/' 'P2'
refused 's/times: 0.1 0.2 s/times: 0.2 0.2 s/' 'bad.yaml:9:15: error: the time 0.2 s is not later than that before it, 0.2 s'
# a table of times that decrease or repeat, in a run and in a check, in the file's order and with
# its line
printf 'time[ms],other[m],p[hPa]\n# measured\n0,1,10\n250,2,20\n200,2,20\n300,2,20\n' > back.csv
printf 'time[ms],other[m],p[hPa]\n0,1,10\n250,2,20\n250,2,30\n' > still.csv
refused 's/known.csv/back.csv/' 'back.csv:5: the time 0.2 s is not later than that before it, 0.25 s'
refused 's/known.csv/still.csv/' 'still.csv:4: the time 0.25 s is not later than that before it, 0.25 s'
"$program" check bad.yaml -q > log 2>&1 && fail "check takes times that stand still"
grep -qF "bad.yaml:10:" log && grep -qF "still.csv:4: the time" log || fail "check of times: $(cat log)"
[ ! -e bad ] || [ ! -e bad/probes.csv ] || fail 'a refused case has rows'

[ $failed -eq 0 ] && echo "references and figures are as the case says"
exit $failed
