#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Many runs by several processes: --jobs, --part as tasks of a queue, processes that share a folder,
# a lock of another machine, signals; all runs are checked before the first; the table contains the
# existing results.
# usage: test_series.sh PROGRAM
program=$1
. "$(dirname "$0")/program_kit.sh"
trap 'kill -KILL $(jobs -p) 2> /dev/null; rm -rf "$work"' EXIT
same_runs() { # folder, folder: files of rows
    local run
    for run in "$1"/0*; do
        for file in probes.csv steps.csv momentum.csv; do cmp "$run/$file" "$2/${run##*/}/$file" || fail "$2/${run##*/}/$file"; done
    done
}

cat > sweep.yaml << END
mps: 1
dp: 50 mm
tank: {size: 1 0.5 m}
fill: [{water: {depth: 0.2 m}}]
motion: {surge: {amplitude: 5 mm, period: 1 s}}
sensors: {P: {wall: 0 0.1 m}}
run: {until: 0.02 s}
output: {frames: 0, page: 0 MB}
sweep: {motion.surge.period: 0.9 1 T1, motion.surge.amplitude: 5 6 10 mm}
collect: [P.max]
END

# ---- a sweep by --set in a case without one, or instead of its own
sed '/^sweep\|^collect/d' sweep.yaml > single.yaml
expect 0 "run 2 of 2: title=two" "$program" sweep single.yaml --set 'sweep={"title": [one, two]}' -o given
expect 0 "run 2 of 2: title=two" "$program" sweep sweep.yaml --set 'sweep={"title": [one, two]}' -o replaced
for folder in given replaced; do
    [ "$(tail -n +2 $folder/sweep.csv | cut -d, -f1-3 | xargs)" = "001,one,0 002,two,0" ] || fail "--set sweep: $(cat $folder/sweep.csv)"
done

# ---- several processes: the same runs and table as one after the other
expect 0 "run 6 of 6" "$program" sweep sweep.yaml -o one
expect 0 "run 6 of 6 is done: motion.surge.period=1 T1 motion.surge.amplitude=10 mm" "$program" sweep sweep.yaml -o many --jobs 3
cmp one/sweep.csv many/sweep.csv || fail "--jobs: another table: $(cat many/sweep.csv)"
same_runs one many
expect 0 "" "$program" sweep sweep.yaml -o many --jobs 3 -q
[ -s log ] && fail "a quiet sweep says $(cat log)"
expect 0 "varied:" "$program" repeat single.yaml -o repeated -n 3 --jobs 2 -q
[ "$(echo repeated/0*)" = "repeated/001 repeated/002 repeated/003" ] || fail "repeat --jobs: $(echo repeated/*)"

# ---- repeat and converge in several processes and in parts: runs and table are those of one process
for verb in repeat converge; do
    count=(-n 3)
    [ $verb = converge ] && count=()
    expect 0 "" "$program" $verb single.yaml "${count[@]}" -o $verb.one -q
    [ "$(echo $verb.one/0*)" = "$verb.one/001 $verb.one/002 $verb.one/003" ] || fail "$verb: $(echo $verb.one/*)"
    cp log $verb.text
    expect 0 "" "$program" $verb single.yaml "${count[@]}" -o $verb.many -q --jobs 2
    cmp $verb.text log || fail "$verb --jobs prints $(cat log)"
    for part in 3 1; do
        expect 0 "of 3 runs in '$verb.parts' are not done" "$program" $verb single.yaml "${count[@]}" -o $verb.parts --part $part/3
    done
    [ "$(echo $verb.parts/0*)" = "$verb.parts/001 $verb.parts/003" ] || fail "$verb --part: $(echo $verb.parts/*)"
    expect 0 "" "$program" $verb single.yaml "${count[@]}" -o $verb.parts -q --part 2/3
    cmp $verb.text log || fail "the last part of $verb prints $(cat log)"
    for folder in $verb.many $verb.parts; do
        same_runs $verb.one $folder
        cmp $verb.one/$verb.csv $folder/$verb.csv || fail "$folder: another table: $(cat $folder/$verb.csv)"
    done
done

# ---- tasks of a queue: sbatch starts a process for each, in any order and at the same time
cat > sbatch << 'END'
#!/bin/bash
# a stand-in: sbatch --array=1-N SCRIPT
tasks=${1#--array=1-}
for ((task = tasks; task >= 1; task--)); do SLURM_ARRAY_TASK_ID=$task SLURM_ARRAY_TASK_COUNT=$tasks bash "$2" & done
wait
END
printf '#!/bin/bash\n#SBATCH --signal=TERM@120\n"%s" sweep sweep.yaml -o tasks -q --part $SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT\n' "$program" > job.sh
expect 0 "" bash sbatch --array=1-4 job.sh
expect 0 "tasks/sweep.csv: 6 runs" "$program" collect tasks
same_runs one tasks
expect 0 "" "$program" sweep sweep.yaml -o tasks -q
cmp one/sweep.csv tasks/sweep.csv || fail "--part: another table: $(cat tasks/sweep.csv)"
expect 0 "4 of 6 runs in 'some' are not done" "$program" sweep sweep.yaml -o some --part 2/3
[ "$(echo some/0*)" = "some/002 some/005" ] || fail "--part 2/3: $(echo some/0*)"
grep -q '^001,0.9 T1,5 mm,nan,0.005,nan,nan$' some/sweep.csv || fail "a run of another part: $(cat some/sweep.csv)"
for part in 0/3 4/3 x 1/ 1/3x /3; do expect 2 "--part $part: must be I/N" "$program" sweep sweep.yaml -o none --part $part; done

# ---- the table of existing results: different inputs, as texts and in SI
expect 0 "two.csv: 8 runs" "$program" collect one some -o two.csv
head -1 two.csv | grep -qF 'run,motion.surge.amplitude,motion.surge.period,motion.surge.amplitude.si[m],motion.surge.period.si[s],exit,P.max[Pa]' ||
    fail "names of a collected table: $(head -1 two.csv)"
T1=$(sed -n 's/.*"T1", "value": "\([.0-9]*\) s.*/\1/p' one/001/summary.json)
grep -q "^one/004,5 mm,1 T1,0.005,$T1,0,$(grep ^004 one/sweep.csv | cut -d, -f7)$" two.csv || fail "$T1: $(cat two.csv)"
# of more folders, or of one run, no folder loses its own table
cp one/sweep.csv own.csv
expect 0 "collected.csv: 8 runs" "$program" collect one some
cmp two.csv collected.csv && cmp own.csv one/sweep.csv || fail "a table of two folders"
expect 0 "collected.csv: 1 runs" "$program" collect one/001
[ ! -e one/001/sweep.csv ] && [ "$(wc -l < collected.csv)" -eq 2 ] || fail "a table of one run"
rm collected.csv
expect 2 "is no folder of a run" "$program" collect .
expect 2 "No such file" "$program" collect nowhere

# ---- a run that another process has: skipped, and no failure
mkdir -p shared/002 && printf 'other-machine.invalid 4711\n' > shared/002/run.lock
expect 0 "1 of 6 runs in 'shared' are not done or in progress in other processes" "$program" sweep sweep.yaml -o shared
grep -qE '^002,0.9 T1,6 mm,nan,0.006,nan,nan$' shared/sweep.csv || fail "a run in progress: $(cat shared/sweep.csv)"
expect 2 "process 4711 on other-machine.invalid" "$program" run single.yaml -o shared/002
touch -d '2 hours ago' shared/002/run.lock # that machine is down
expect 0 "" "$program" sweep sweep.yaml -o shared -q --jobs 2
cmp one/sweep.csv shared/sweep.csv || fail "a left lock: $(cat shared/sweep.csv)"
for k in 1 2 3; do "$program" sweep sweep.yaml -o together -q > "together.$k" 2>&1 & done
for pid in $(jobs -p); do wait "$pid" || fail "a process beside others: exit $?: $(cat together.?)"; done
expect 0 "" "$program" sweep sweep.yaml -o together -q
cmp one/sweep.csv together/sweep.csv || fail "processes in one folder: $(cat together/sweep.csv together.?)"

# ---- all runs are checked before the first
sed 's/5 6 10 mm/5 6 mm/; s/^sweep: {/&fill.water.depth: 0.2 90 m, /' sweep.yaml > bad.yaml
for jobs in "" "--jobs 2"; do
    # shellcheck disable=SC2086
    expect 2 "4 of 8 runs are refused; none is begun" "$program" sweep bad.yaml -o none $jobs
    grep -q "run 5 of 8 is refused: fill.water.depth=90 m motion.surge.period=0.9 T1 motion.surge.amplitude=5 mm" log || fail "refused: $(cat log)"
    grep -q "is more than the tank is high" log || fail "why it is refused: $(cat log)"
done
sed '/^sweep\|^collect/d; s/^dp.*/dp: 60 mm/; s/^tank.*/tank: {size: 1 0.5 m}\nsolids: {wall: {box: [0.4 0 m, 0.5 0.1 m]}}/' sweep.yaml > coarse.yaml
expect 2 "are refused; none is begun" "$program" converge coarse.yaml -o none --set "dp=150 mm"
expect 2 "8 runs, 4 refused" "$program" check bad.yaml -o bad.svg
[ -e none ] && fail "a refused series made a folder"
expect 0 "6 runs, 0 refused" "$program" check sweep.yaml --jobs 2
grep -qE "^ +about [0-9.e+-]+ to [0-9.e+-]+ (s|min|h) of wall clock in all" log || fail "time of all runs: $(cat log)"
grep -qE "with --jobs 2 about .*, at least 2 processors; [0-9]+ MB of memory, [0-9]+ MB a run" log || fail "memory of all runs: $(cat log)"

# ---- a signal ends all processes; each run has a checkpoint, and can be resumed
sed 's/until: 0.02 s/until: 500 s/; s/5 6 10 mm/5 6 mm/' sweep.yaml > long.yaml
"$program" sweep long.yaml -o stopped --jobs 2 > log 2>&1 &
pid=$!
until [ -s stopped/001/probes.csv ] && [ -s stopped/002/probes.csv ] || ! kill -0 $pid 2> /dev/null; do sleep 0.05; done
sleep 0.2
kill -TERM $pid
wait $pid
code=$?
[ $code -eq 130 ] || fail "--jobs and SIGTERM: exit $code: $(cat log)"
for run in 001 002; do [ -s stopped/$run/checkpoint.mps ] || fail "no checkpoint in stopped/$run: $(cat log)"; done
[ -e stopped/003 ] && fail "a run began after a signal"
[ -e stopped/001/run.lock ] && fail "a stopped run leaves its lock"
end=$(tail -qn 1 stopped/00?/steps.csv | awk -F, '$1 > t { t = $1 } END { print t + 0.2 }')
expect 0 "stopped/sweep.csv: 2 runs" sh -c "for run in 001 002; do '$program' resume stopped/\$run -q --set 'run.until=$end s'; done; '$program' collect stopped"

[ $failed -eq 0 ] && echo "series: all right"
exit $failed
