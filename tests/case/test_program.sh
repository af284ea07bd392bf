#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# The program mps: each verb, exit codes, an interrupted run.
# usage: test_program.sh PROGRAM CASES
program=$1 cases=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failed=0

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
    [ $got -eq "$code" ] || fail "exit $got, not $code: $*: $(tail -3 log)"
    [ -z "$text" ] || grep -qF -- "$text" log || fail "no '$text': $*: $(head -5 log)"
}

expect 2 "usage: mps VERB" "$program"
expect 0 "usage: mps VERB" "$program" --help
expect 0 "libmps" "$program" --version
expect 2 "is no verb" "$program" rum x
expect 0 "--set" "$program" run --help
expect 2 "unknown option" "$program" run --sett x.yaml
expect 2 "is missing" "$program" run
expect 2 "one argument too many" "$program" run a b
expect 2 "needs a value" "$program" run x.yaml --set
expect 2 "1 to 1024" "$program" run x.yaml -j many
expect 2 "no.yaml" "$program" run no.yaml

# init writes cases that check accepts; it replaces nothing
for name in $("$program" list cases | cut -d' ' -f1); do
    expect 0 "$name" "$program" init "$name"
done
[ -e voyage.csv ] || fail "no voyage.csv"
expect 2 "is there already" "$program" init tank
expect 0 "tank.yaml" "$program" init tank --overwrite
expect 2 "no case with the name" "$program" init tnk
mkdir taken
echo mine > taken/voyage.csv
(cd taken && "$program" init ship > /dev/null 2>&1) && fail "init ship beside another voyage.csv"
[ -e taken/ship.yaml ] && fail "ship.yaml with the voyage.csv of another"
[ "$(cat taken/voyage.csv)" = mine ] || fail "voyage.csv was replaced"
for name in tank lng roll ship; do
    expect 0 "periods" "$program" check $name.yaml
    grep -q "particles .* of fluid" log || fail "$name: no particles"
    grep -q "<svg" $name.svg || fail "$name: no drawing"
done
"$program" check tank.yaml | grep -q "T1 1.41[78] s" || fail "T1 of 1 m, 0.24 m"
"$program" check tank.yaml --set fill.water.depth=50% | grep -q "T1 1.319 s" || fail "T1 of 1 m, 0.3 m"

for list in cases keys models settings solvers units measures; do
    [ "$("$program" list $list | wc -l)" -gt 3 ] || fail "list $list"
done
expect 2 "is no list" "$program" list model
expect 0 "solids.*.holes.pitch" "$program" list keys holes
[ "$(grep -c '^[a-z]' log)" -eq 3 ] || fail "list keys holes: $(cat log)"
expect 0 "motion.roll|pitch|yaw.jonswap" "$program" list keys roll
grep -q "^sensors" log && fail "list keys roll: sensors"
expect 2 "no key has the name 'hole'" "$program" list keys hole
expect 2 "one argument too many" "$program" list cases tank
"$program" schema > schema.json || fail "schema"
grep -q "2020-12" schema.json || fail "schema.json"

# a run, refused, replaced, from its own case
expect 0 "" "$program" run tank.yaml --set "run.until=0.05 s" --set output.frames=2 -o run -q
[ -e run/report.html ] || fail "no report.html"
expect 2 "earlier run" "$program" run tank.yaml --set "run.until=0.05 s" -o run -q
expect 0 "" "$program" run tank.yaml --set "run.until=0.05 s" --set output.frames=2 -o run -q --overwrite -j 1
expect 0 "" "$program" run run/case.yaml -o again -q
cmp run/probes.csv again/probes.csv || fail "case.yaml gives other bytes"
expect 0 "" "$program" run run/report.html -o once_more -q
cmp run/probes.csv once_more/probes.csv || fail "the case of report.html gives other bytes"
cmp run/frames/frames_000002.vtp once_more/frames/frames_000002.vtp || fail "the case of report.html gives another frame"
rm run/report.html
expect 0 "run/report.html: " "$program" report run
[ -s run/report.html ] || fail "no report.html by 'mps report'"
expect 2 "needs the folder of a finished run" "$program" report nowhere
expect 2 "page_bytes must be" "$program" run tank.yaml --set "output.page=100 kB" -o none -q
expect 2 "until" "$program" run tank.yaml --set run.until=5 -o none -q
[ -e none ] && fail "a wrong case made a folder"
expect 3 "" "$program" run tank.yaml --set "run.dt=20 ms" --set "motion.surge.amplitude=5 m" -o wild -q
[ -s wild/probes.csv ] || fail "a run that diverged has no rows"

# stats: 40 pulses, a triangle each of 0.2 s and 1000 Pa, 1025 Pa, .. at 1 s, 2 s, ..
mkdir -p pulses shifted bare
awk 'BEGIN { print "t[s],P1[Pa],P2[Pa],eta[m]"
    for (i = 0; i <= 4100; i++) {
        t = i / 100; n = int(t + 0.5); d = t - n; if (d < 0) d = -d
        p = n >= 1 && n <= 40 && d < 0.1 ? (1000 + 25 * (n - 1)) * (1 - d / 0.1) : 0
        printf "%.2f,%.9g,%.9g,%.9g\n", t, p, 0, sin(6.283185307179586 * t) } }' > pulses/probes.csv
awk 'BEGIN { print "t[s],eta[m],P1[kPa]"
    for (i = 0; i <= 4100; i++) printf "%.2f,%.9g,0\n", i / 100, sin(6.283185307179586 * (i / 100 - 0.1)) }' > shifted/probes.csv
cp pulses/probes.csv bare/
printf '{\n  "t_end": 41,\n  "inputs": [\n    {"key": "T1", "value": "1 s"},\n    {"key": "impacts.threshold", "value": "100 Pa"},\n    {"key": "impacts.sensors", "value": "P1; P2"}\n  ]\n}\n' > pulses/summary.json
expect 0 "P1: 40 events" "$program" stats pulses
for text in "highest 1975 Pa at 40 s" "above 100 Pa, until 0.2 s below it" "P2: 0 events" \
    "exceeded once in 3 h" "for screening" "Weibull " "generalised Pareto "; do
    grep -qF "$text" log || fail "stats: no '$text'"
done
grep -qE "^ +1 +1975 +40 +0.1 +0.1 " log || fail "stats: rise and decay of the highest: $(grep -E '^ +1 ' log)"
[ "$(wc -l < pulses/statistics.csv)" -eq 41 ] || fail "statistics.csv has no 40 events"
grep -q '"weibull"' pulses/statistics.json || fail "statistics.json has no fits"
expect 0 "P1: 39 events" "$program" stats bare P1 # without constants the window is 0.82 s; the record begins 0.78 s before the first
grep -q "1 left out at the ends" log || fail "stats: the first pulse is not told as cut"
grep -q "P2" log && fail "stats of one column has another"
grep -q "(by deviations: set impacts.threshold)" log || fail "stats: not told that the threshold is a guess"
expect 0 "P2: no pressure from 0.21 to 41 s: no liquid came here" "$program" stats bare P2
mkdir few
cp pulses/probes.csv few/
printf '{\n  "t_end": 41,\n  "sensor_average_most": 0.15,\n  "inputs": [\n{"key": "T1", "value": "1 s"},\n{"key": "impacts.threshold", "value": "100 Pa"},\n{"key": "impacts.least_events", "value": "100"}\n]}\n' > few/summary.json
expect 0 "that needs 100 events, at this rate a record of about 102 s" "$program" stats few P1
grep -q "40 of 40 rise or decay faster" log || fail "stats: unresolved events are not counted"
grep -q "by deviations" log && fail "stats: a threshold that is given is called a guess"
expect 0 "P_right: " "$program" stats run
expect 2 "the nearest is 'P_left'" "$program" stats run P_lift
expect 2 "is no pressure" "$program" stats run eta_left
expect 2 "no such folder" "$program" stats nowhere
expect 2 "is no folder" "$program" stats pulses/probes.csv

# compare: a sine of 1 s that is 0.1 s later differs by -2 sin(0.1 pi) cos(2 pi (t - 0.05)): rms from 0.205 to 41 s, of straight lines
expect 0 "shifted against pulses" "$program" compare pulses shifted pulses/probes.csv
awk '/^  eta/ { n++; ok += n == 2 ? $3 == 0 && $9 == 0 : ($3 - 0.4362) ^ 2 < 0.0002 ^ 2 && $9 == 0.1 && $10 == 36 }
    END { exit !(n == 3 && ok == 3) }' log || fail "compare: $(grep eta log)"
grep -q "P1.*is in kPa there" log || fail "compare: units"
grep -q "pulses against pulses/probes.csv" log || fail "compare: no reference"
expect 0 "P_left" "$program" compare run again
awk '/^  P_left/ { exit !($3 == 0) }' log || fail "the same run differs"
expect 2 "is missing" "$program" compare run
expect 2 "no such folder" "$program" compare run nowhere
expect 2 "the last argument" "$program" compare run/probes.csv run
expect 2 "no column can be compared" "$program" compare run shifted

# slots of a baffle on the page
expect 0 "" "$program" run lng.yaml --set "run.until=5 ms" --set output.frames=0 -o slots -q
for piece in "0], [0.475, 0.0375" "0.0875], [0.475, 0.1625" "0.2125], [0.475, 0.25"; do
    grep -qF "[[0.475, $piece]]" slots/summary.json || fail "no part of the baffle: $piece"
done

# info
for what in "case:tank.yaml" "table:run/probes.csv" "frame of particles:run/frames/frames_000001.vtp" \
    "series of frames:run/frames.pvd" "page:run/report.html" "summary:run/summary.json"; do
    expect 0 "${what%%:*}" "$program" info "${what#*:}"
done
head -c 3000 /dev/urandom > noise
expect 2 "is no file of mps" "$program" info noise
expect 2 "No such file" "$program" info nothing
expect 0 "report.html" "$program" info run
expect 2 "without outputs of a run" "$program" info taken

# interrupted, and continued: the same bytes as the whole run
never=1000
"$program" run tank.yaml --set "run.until=$never s" --set output.frames=0 -o cut > log 2>&1 &
pid=$!
for i in $(seq 600); do
    [ "$(wc -l 2> /dev/null < cut/probes.csv)" -gt 60 ] 2> /dev/null && break
    sleep 0.1
done
kill -INT $pid
wait $pid
got=$?
[ $got -eq 130 ] || fail "interrupted: exit $got"
expect 0 "checkpoint of a run" "$program" info cut/checkpoint.mps
last=$(tail -1 cut/probes.csv | cut -d, -f1)
end=$(awk -v t="$last" 'BEGIN { printf "%.3f", t + 0.2 }') # the last steps before the end are shorter
expect 0 "" "$program" resume cut --set "run.until=$end s" -q
expect 0 "" "$program" run tank.yaml --set "run.until=$end s" --set output.frames=0 -o whole -q
cmp cut/probes.csv whole/probes.csv || fail "a continued run has other bytes"

# several runs of one case: a table, skipped when done, refused where it cannot be
cat > sweep.yaml << END
base: tank.yaml
set: {dp: 20 mm, run.until: 0.05 s, output.frames: 0, output.page: 0 MB}
sweep: {motion.surge.period: 0.9 1 T1, motion.surge.amplitude: 10 20 mm}
collect: [P_left.max, F.last]
END
sed '/^sweep\|^collect/d' sweep.yaml > single.yaml
expect 2 "use 'mps sweep'" "$program" run sweep.yaml -o none -q
expect 2 "use 'mps sweep'" "$program" repeat sweep.yaml -o none -q
expect 2 "use 'mps run'" "$program" sweep single.yaml -o none -q
expect 2 "max, min, mean, last" "$program" sweep sweep.yaml --set "collect=[P_left.most]" -o none -q
expect 2 "must be 2 to" "$program" repeat single.yaml -n 1 -o none -q
[ -e none ] && fail "a refused series made a folder"
expect 2 "no column of probes.csv is 'P_no'" "$program" sweep sweep.yaml --set "collect=[P_no.max]" -o no_column -q
[ -e no_column/002 ] && fail "an unknown column did not end the sweep"
expect 0 "run 4 of 4: motion.surge.period=1 T1 motion.surge.amplitude=20 mm" "$program" sweep sweep.yaml -o swept
[ "$(wc -l < swept/sweep.csv)" -eq 5 ] || fail "sweep.csv: $(cat swept/sweep.csv)"
head -1 swept/sweep.csv | grep -q '^run,motion.surge.period,motion.surge.amplitude,exit,P_left.max\[Pa\],F_x.last\[N/m\],' ||
    fail "names of sweep.csv: $(head -1 swept/sweep.csv)"
most=$(awk -F, 'NR > 1 && (NR == 2 || $2 > m) { m = $2 } END { printf "%.9g", m }' swept/003/probes.csv)
last=$(awk -F, 'END { printf "%.9g", $5 }' swept/003/probes.csv)
grep -q "^003,1 T1,10 mm,0,$most,$last," swept/sweep.csv || fail "not $most, $last: $(grep ^003 swept/sweep.csv)"
expect 0 "" "$program" run single.yaml --set "motion.surge.period=1 T1" -o alone -q
cmp alone/probes.csv swept/003/probes.csv || fail "a run of a sweep has other bytes than a run alone"
cp swept/sweep.csv before.csv
rm -r swept/002
expect 0 "swept/001: is done already" "$program" sweep sweep.yaml -o swept -j 1
cmp before.csv swept/sweep.csv || fail "a sweep made whole again has another table"
expect 2 "run of another case" "$program" sweep sweep.yaml --set "run.until=0.06 s" -o swept -q
sed 's/^sweep.*/sweep: {motion.surge.amplitude: 1e-6 5 m}/' sweep.yaml > bad.yaml
expect 3 "bad/002 failed, exit code 3" "$program" sweep bad.yaml --set "run.dt=20 ms" --set "run.until=0.6 s" -o bad -q
grep -q "^002,5 m,3,nan,nan" bad/sweep.csv || fail "sweep.csv of a failed run: $(cat bad/sweep.csv)"
expect 0 "2 of 3 runs were built with the dp of an earlier one" "$program" repeat single.yaml -n 3 -o same -q
expect 0 "largest value of" "$program" repeat single.yaml --set "dp=5 mm" --set "run.until=0.01 s" -n 3 -o repeated -q
grep -q "^P_left \[Pa\]  *3 " log || fail "repeat: $(cat log)"
grep -q "^dp: 4.975 mm" repeated/001/case.yaml && grep -q "^dp: 5.025 mm" repeated/003/case.yaml || fail "dp of repeat"
expect 0 "order" "$program" converge single.yaml -o converged -q
grep -q "^ke " log || fail "converge: $(cat log)"
grep -q "^dp: 40 mm" converged/001/case.yaml && grep -q "^dp: 20 mm" converged/003/case.yaml || fail "dp of converge"

# a sweep that is interrupted stops, and goes on
long=(--set "run.until=10 s" --set "motion.surge.amplitude=10 mm")
"$program" sweep sweep.yaml "${long[@]}" -o half > log 2>&1 &
pid=$!
for i in $(seq 600); do
    [ "$(wc -l 2> /dev/null < half/001/probes.csv)" -gt 60 ] 2> /dev/null && break
    sleep 0.1
done
kill -INT $pid
wait $pid
got=$?
[ $got -eq 130 ] || fail "sweep interrupted: exit $got: $(tail -3 log)"
[ -e half/001/checkpoint.mps ] || fail "no checkpoint of an interrupted sweep"
[ -e half/002 ] && fail "an interrupted sweep went on"
expect 0 "" "$program" sweep sweep.yaml "${long[@]}" -o half -q
expect 0 "" "$program" run single.yaml "${long[@]}" --set "motion.surge.period=0.9 T1" -o unbroken -q
cmp half/001/probes.csv unbroken/probes.csv || fail "a run of a continued sweep has other bytes"
[ "$(wc -l < half/sweep.csv)" -eq 3 ] || fail "sweep.csv of a continued sweep: $(cat half/sweep.csv)"

[ $failed -eq 0 ] && echo "mps does what it says"
exit $failed
