#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs that end early, by kill -9 or a signal: what 'mps info', 'stats', 'report' and 'resume' do
# with their folders.
# usage: test_stopped.sh PROGRAM
program=$1
. "$(dirname "$0")/program_kit.sh"
trap 'kill -KILL $(jobs -p) 2> /dev/null; rm -rf "$work"' EXIT
says() { grep -qE -- "$1" log || fail "no '$1' in: $(head -8 log)"; }

cat > titled.yaml << END
mps: 1
title: A tank of mine
dp: 50 mm
tank: {size: 1 0.5 m}
fill: [{water: {depth: 0.2 m}}]
motion: {surge: {amplitude: 5 mm, period: 1 s}}
sensors: {P: {wall: 0 0.1 m}, eta: {gauge: 0.3 m}}
run: {until: 1000 s, threads: 1}
output: {frames: 0, page: 0 MB}
END
sed '/^title/d' titled.yaml > plain.yaml

begin() { # folder, case, options ..: a run that has taken steps; $pid
    "$program" run "$2" -o "$1" "${@:3}" > "$1.log" 2>&1 &
    pid=$!
    for ((k = 0; k < 3000; k++)); do
        # rows of steps are in its file after many steps
        [ "$(wc -l 2> /dev/null < "$1/steps.csv")" -gt 30 ] 2> /dev/null && return
        sleep 0.02
    done
    fail "$1 takes no steps: $(cat "$1.log")"
}
ends() { # exit code
    wait $pid 2> /dev/null
    local got=$?
    [ $got -eq "$1" ] || fail "exit $got, not $1"
}
text_of() { sed -n "s/^  \"$2\": \"\(.*\)\",*\$/\1/p" "$1/summary.json"; }

# ---- each signal: after its step, with a checkpoint, and nothing is lost
for signal in TERM HUP USR1 USR2 XCPU; do
    begin $signal plain.yaml
    kill -$signal $pid
    case $signal in HUP | USR1 | USR2 | XCPU) # a scheduler may send it more than once
        kill -$signal $pid 2> /dev/null ;;
    esac
    ends 130
    grep -q "^plain: interrupted at t = .* mps resume $signal continues$" $signal.log || fail "SIG$signal says $(cat $signal.log)"
    [ -s $signal/checkpoint.mps ] || fail "SIG$signal leaves no checkpoint"
    [ ! -e $signal/run.lock ] || fail "SIG$signal leaves the folder locked"
    last=$(tail -1 $signal/steps.csv | cut -d, -f1)
    awk -v a="$last" -v b="$(sed -n 's/.*"t_end": \([-+.0-9e]*\),.*/\1/p' $signal/summary.json)" 'BEGIN { exit !(a == b && a > 0) }' ||
        fail "SIG$signal: steps to $last, $(grep t_end $signal/summary.json)"
done

# ---- kill -9: before the first checkpoint, and after one
begin early titled.yaml
kill -KILL $pid
ends 137
[ -e early/checkpoint.mps ] && fail "a checkpoint before 10 minutes"
begin late titled.yaml --set "run.checkpoint=50 ms"
kill -KILL $pid
ends 137
[ -s late/checkpoint.mps ] || fail "no checkpoint: $(ls late)"
for folder in early late USR1; do
    reached=$(tail -2 $folder/probes.csv | cut -d, -f1) # the last row may be cut
    for verb in info stats report; do
        expect 0 "'mps resume $folder' continues it" "$program" $verb $folder
        t=$(sed -n 's/^ *unfinished, at t = \(.*\) s of 1000 s; if it is not in progress,.*/\1/p' log)
        # with 5 digits, a row of the table
        [ -n "$t" ] && for row in $reached; do printf '%.5g\n' "$row"; done | grep -qx -- "$t" || fail "$verb $folder: t = $t, not one of $reached"
    done
    [ -s $folder/report.html ] && grep -q "If the run is not in progress" $folder/report.html || fail "no page of $folder"
    grep -q '"P"' $folder/statistics.json || fail "no statistics of $folder"
done
cp -r late/probes.csv late.csv

# ---- all continue, and have the bytes of one run; name and title are those of the case
end=$(tail -qn 1 */steps.csv | awk -F, '$1 > t { t = $1 } END { printf "%.1f", t + 0.3 }')
expect 0 "" "$program" run titled.yaml -o whole --set "run.until=$end s" -q
mkdir elsewhere
for folder in TERM HUP USR1 USR2 XCPU early late; do
    name=plain title=plain
    case $folder in early | late) name=titled title="A tank of mine" ;; esac
    (cd elsewhere && "$program" resume ../$folder --set "run.until=$end s") > log 2>&1 || fail "resume $folder: $(cat log)"
    says "^$name: t = $end s, "
    for file in probes.csv momentum.csv steps.csv; do cmp whole/$file $folder/$file || fail "resume $folder: $file"; done
    [ "$(text_of $folder case)" = $name ] && [ "$(text_of $folder title)" = "$title" ] || fail "$folder: $(grep -E '"(case|title)"' $folder/summary.json)"
    expect 0 "" "$program" report $folder
    grep -q "<title>$title" $folder/report.html || fail "title of the page of $folder: $(grep -o '<title>[^<]*' $folder/report.html)"
    expect 0 "folder of a run of $name" "$program" info $folder
    says "^  done, to t = $end s, [0-9]+ steps; 'mps resume $folder --set run.until=..' extends it$"
    grep -q "unfinished" log && fail "$folder is unfinished: $(cat log)"
done
[ "$(wc -l < late.csv)" -lt "$(wc -l < late/probes.csv)" ] || fail "a run that was killed was not continued"

# ---- the commands that texts contain continue the run, whatever its folder is called
told() { # text before the command, text behind it, options: runs the command that the log has
    local command
    command=$(sed -n "s/^.*$1\(mps resume .*\)$2\$/\1/p" log)
    [ -n "$command" ] || fail "no command in: $(cat log)"
    eval "${command/#mps/\"\$program\"} -q $3" > log 2>&1 || fail "$command: $(cat log)"
}
odd='my "tank", at $5'
begin "$odd" plain.yaml --set "impacts={deviations: 0.5, window: 0.2 s, least_events: 9, scale: 40, density_ratio: 1.025}"
kill -TERM $pid
ends 130
cp "$odd.log" log
end=$(tail -1 "$odd/steps.csv" | awk -F, '{ printf "%.1f", $1 + 3 }')
told "there; " " continues" "--set run.until='$end s'"
end=$(awk -v t="$end" 'BEGIN { print t + 0.2 }')
expect 0 "" "$program" info "$odd"
told "steps; '" " --set run.until=.*" "--set run.until='$end s'"
expect 0 "done, to t = $end s" "$program" info "$odd"

# ---- statistics of a model: what is of the model, and what is at full scale
expect 0 "" "$program" stats "$odd"
says "impacts.scale 40, impacts.density_ratio 1.025$"
says "^P: [2-8] events, .* a minute, highest [0-9.]+ k?Pa in the model \([0-9.]+ k?Pa at full scale\) at [0-9.]+ s$"
says "^  a model: at full scale pressures are 41 times and times 6.325 times as large; all but 'at full scale' is of the model$"
end=$(sed -n "s/.*a record of about .* s: mps resume .* --set run.until='\(.*\) s'$/\1/p" log)
told "a record of about .* s: " ""
expect 0 "done, to t = $end s" "$program" info "$odd"
expect 0 "  exceeded once in 3 h at full scale, 0.4743 h in the model (" "$program" stats "$odd" --set impacts.least_events=2
says "^    Weibull  +[0-9.]+ k?Pa in the model \([0-9.]+ k?Pa at full scale\), band [0-9.]+ k?Pa in the model \("
says "^constants by --set: impacts.least_events 2$"
sed -n 's/.*"weibull".*"value": \([-+.0-9e]*\),.*"full_scale": \([-+.0-9e]*\),.*/\1 \2/p' "$odd/statistics.json" |
    awk '{ n++; if (($2 / $1 / 41 - 1) ^ 2 > 1e-14) exit 1 } END { exit !n }' || fail "full scale of $(cat "$odd/statistics.json")"

[ $failed -eq 0 ] && echo "stopped runs: all right"
exit $failed
