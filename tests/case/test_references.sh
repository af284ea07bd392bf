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

# each column of a job: values in a unit of its kind are taken, others refused at their line, by
# check as by run
cat > body.yaml << 'END'
mps: 1
dp: 50 mm
tank: {size: 0.6 0.4 m}
fill: [{water: {depth: 0.2 m}}]
body:
  forward: x
  centre: 0.3 0 m
  mass: 50 kg
  inertia: 5 kg m2
  surge: {stiffness: 2 kN/m}
  pitch: {stiffness: 100 N m/rad, friction: 1 N m}
sensors:
  P: {wall: 0 0.1 m}
  row: {panel: [0 50 mm, 0 150 mm]}
  p: {pressure: 0.3 0.1 m}
  eta: {gauge: 0.3 m}
  F: {force: tank}
  mom: {load: momentum}
  u: {measure: speed}
  area: {measure: trapped gas}
  lost: {measure: strays}
run: {until: 0.01 s}
output: {frames: 0, page: 0 MB}
END
cat > moved.yaml << 'END'
mps: 1
dim: 3
dp: 100 mm
tank: {size: 0.6 0.4 0.4 m}
fill: [{water: {depth: 0.2 m}}]
motion: {forward: x, surge: {amplitude: 1 mm, period: 1 s}, roll: {amplitude: 1 deg, period: 1 s}}
sensors:
  F: {force: tank}
  hit: {load: walls}
  vol: {measure: trapped gas}
run: {until: 0.01 s}
output: {frames: 0, page: 0 MB}
END
# name and unit of each column but the time
columns() { head -1 "$1/probes.csv" | tr , '\n' | sed '1d; s/\]$//; s/\[/ /'; }
for name in body moved; do
    "$program" run $name.yaml -q -j 1 -o $name > log 2>&1 || fail "$name: $(cat log)"
    { cat $name.yaml; echo 'reference:'; columns $name | awk '{i++; n = $1; $1 = ""; print "  r" i ": {column: " n ", times: 1 s, values: 2" $0 "}"}'; } > right.yaml
    "$program" check right.yaml -q > log 2>&1 || fail "$name, units of the columns: $(cat log)"
    "$program" run right.yaml -q -j 1 -o right --overwrite > log 2>&1 || fail "$name, units of the columns: $(cat log)"
    columns $name | awk '{n = $1; $1 = ""; sub(/^ /, ""); print "\"unit\": \"" $0 "\", \"column\": \"" n "\", \"line\": false, \"points\": [[1, 2]]"}' > wanted
    sed 's/\([0-9]\)\.[09]\{9,\}[0-9]*\]\]/\1]]/' right/summary.json > points
    while read -r one; do grep -qF "$one" points || fail "$name: no $one"; done < wanted
    # each alone, with a unit that no column has, and with the unit of another kind
    columns $name | while read -r column unit; do
        case $unit in Pa) other=m ;; *) other=Pa ;; esac
        for wrong in kg/m3 $other; do
            { cat $name.yaml; echo "reference: {r: {column: $column, times: 1 s, values: 2 $wrong}}"; } > wrong.yaml
            "$program" check wrong.yaml -q > log 2>&1 && echo "$column takes $wrong"
            grep -q "^wrong.yaml:$(wc -l < wrong.yaml):[0-9]*: error: the values have the unit '$wrong', column '$column' has " log || cat log
        done
    done > told
    [ -s told ] && fail "$name: $(cat told)"
    [ "$(columns $name | wc -l)" -gt 20 ] || fail "$name: few columns"
done
for unit in m m/s deg deg/s Pa N/m 'N m/m' J/m m2; do columns body | grep -q " $unit\$" || fail "no column in $unit"; done
for unit in m deg N 'N m' J m3; do columns moved | grep -q " $unit\$" || fail "no column in $unit"; done
columns body | grep -q '^lost *$' || fail "no column without a unit"
# values without a unit, a table for a column without one, other multiples, no column
told() { # reference, wanted message; "": taken
    { cat body.yaml; echo "reference: {r: {$1}}"; } > one.yaml
    "$program" check one.yaml -q > log 2>&1
    [ $? -eq $((${#2} > 0 ? 2 : 0)) ] && { [ -z "$2" ] || grep -qF -- "$2" log; } || fail "$1: no '$2': $(cat log)"
}
printf 't[s],n\n1,2\n' > plain.csv
told 'column: lost, times: 1 s, values: 2' ''
told 'column: lost, file: plain.csv' ''
told 'column: volume_error, times: 1 s, values: 2 %' ''
told 'column: P, times: 1 s, values: 0' ''
told 'column: P, times: 1 s, values: 2' "the values have no unit, column 'P' has 'Pa'"
told 'column: P, file: plain.csv' "column 'n' has no unit"
told 'column: lost, times: 1 s, values: 2 Pa' "column 'lost' has none"
told 'column: F_z, times: 1 s, values: 2 N' "'F_z' is no column of probes.csv; give a 'column': "
{ cat body.yaml; echo 'reference: {F: {times: 1 s, values: 2 N/m}}'; } > sensor.yaml
"$program" check sensor.yaml -q > log 2>&1 && fail "a sensor of several columns is taken as one"
grep -q "'F' is no column of probes.csv; give a 'column': .*F_x" log || fail "a sensor of several columns: $(cat log)"

[ $failed -eq 0 ] && echo "references and figures are as the case says"
exit $failed
