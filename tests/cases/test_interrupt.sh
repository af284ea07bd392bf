#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs that are stopped by a signal: a checkpoint, rows that are complete up to it and continue
# without gaps or duplicates; progress in a batch log.
# usage: tests/cases/test_interrupt.sh FOLDER_OF_DRIVERS
export LC_ALL=C # awk, printf and sort take numbers with a point
set -uo pipefail
[ -n "${HUP_ENDS:-}" ] || HUP_ENDS=1 exec env --default-signal=HUP bash "$0" "$@" # also under nohup
. "$(dirname "$0")/drivers.sh"
surge=(sloshing_surge --dp 0.025 --frames 0 --no-report --probe-dt 0.001)
tank=(static_tank --dp 0.02 --frames 0 --no-report)

begin() { # folder, driver, options...: a run that has taken steps; $pid
    starts "$1.log" "${@:2}" --t-end $never --out "$1"
    wait_for more_lines "$1/probes.csv" 1
}

# A row at every 0.001 s from 0 up to the time of the last step, which is that of the checkpoint,
# and no other.
complete() { # folder
    awk -F, -v last="$(tail -1 "$1/steps.csv" | cut -d, -f1)" 'NR == 1 {next}
        ($1 - (NR - 2) * 1e-3) ^ 2 > 1e-24 {print "row", NR, "is at", $1; exit 1}
        END {if (NR - 2 != int(last / 1e-3 + 1e-6)) {print NR - 1, "rows until", last; exit 1}}' "$1/probes.csv" ||
        fail "$1/probes.csv is not complete"
}

begin silent "${tank[@]}" --quiet # for what comes last
silent=$pid
begin batch "${tank[@]}"
batch=$pid

for signal in INT TERM HUP; do
    begin $signal "${surge[@]}"
    kill -$signal $pid
    if [ $signal = HUP ]; then while kill -HUP $pid 2>/dev/null; do sleep 0.01; done; fi # terminals say it more than once
    ends 130 SIG$signal $signal.log
    [ -s $signal/checkpoint.mps ] || fail "SIG$signal leaves no checkpoint"
    [ ! -e $signal/run.lock ] || fail "SIG$signal leaves the folder locked"
    [ -s $signal/summary.json ] || fail "SIG$signal leaves no summary"
    complete $signal
done
end=$(later 0.1 INT TERM HUP)
runs 0 "${surge[@]}" --t-end "$end" --out whole
for signal in INT TERM HUP; do
    runs 0 "${surge[@]}" --t-end "$end" --out $signal --resume
    for file in probes.csv momentum.csv steps.csv; do cmp whole/$file $signal/$file || fail "SIG$signal, --resume: other $file"; done
done

# nohup: the signal is ignored
trap '' HUP
begin nohup "${surge[@]}"
trap - HUP
kill -HUP $pid
wait_for more_lines nohup/steps.csv $(($(wc -l <nohup/steps.csv) + 200)) # more than wait in memory, which a run that ends writes too
kill -TERM $pid || fail "SIGHUP ends a run under nohup"
ends 130 "SIGTERM under nohup" nohup.log

# no process reads its output
mkfifo ears
"$drivers/static_tank" --dp 0.04 --t-end $never --frames 0 --out pipe --threads 1 2>ears &
pid=$!
: <ears # opened, then closed
wait_for more_lines pipe/probes.csv 1
kill -TERM $pid
ends 130 "SIGTERM with a closed pipe" /dev/null

# a line every 10 s; the silent run, which began before, has none when it has taken a step more
pid=$batch
wait_for grep -q left= batch.log
pid=$silent
wait_for more_lines silent/steps.csv "$(wc -l <silent/steps.csv)"
kill -TERM $batch $silent
ends 130 "the silent run" silent.log
pid=$batch
ends 130 "the batch run" batch.log
number='[0-9.e+-]+'
grep -E "^t=$number step=[0-9]+ dt=$number wall=$number left=$number\$" batch.log | sed 's/.*wall=\([0-9.]*\).*/\1/' |
    awk '{if ($1 - last < 9.9) exit 1; last = $1} END {exit !(last >= 9.9)}' || fail "not a line of progress every 10 s: $(cat batch.log)"
grep -q 'left=' silent.log && fail "--quiet shows progress"
complete batch

if [ $failures -gt 0 ]; then exit 1; fi
echo "runs that are stopped can go on"
