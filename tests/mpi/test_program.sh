#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# mps run CASE --mpi: the same bytes as on one process, in 2-D, 3-D and with air, and of each case
# without a driver; an interrupted run resumes with another number of ranks; a refusal is printed
# once. 77: MPI cannot start ranks. With "all" each case runs on 2 to 5 ranks.
# usage: tests/mpi/test_program.sh FOLDER_OF_MPS MPIRUN CASES [all]
export LC_ALL=C # awk, printf and sort take numbers with a point
set -uo pipefail
cases=$(realpath "$3")
. "$(dirname "$0")/ranks.sh"
mps=$drivers/mps

on() { # exit code, ranks, verb, arguments..
    local wanted=$1 n=$2 code
    "$here/run" "$mpirun" "$n" "$mps" "${@:3}" --mpi </dev/null >log 2>&1
    code=$?
    [ $code = "$wanted" ] || { fail "$n ranks, ${*:3}: exit $code instead of $wanted"; cat log; }
}
says() { # what, text: once
    [ "$(grep -cF -- "$2" log)" = 1 ] || fail "$1: says '$(cat log)', not '$2' once"
}

for start in tank lng; do "$mps" init $start >/dev/null; done
tested=
while read -r name counts case options; do
    tested+=" $case "
    [ "${4:-}" != all ] || counts=2,3,4,5
    read -ra options <<<"$options"
    case=${case/CASES/$cases} set=(-q -j 1)
    for option in "${options[@]}"; do set+=(--set "${option/\~/ }"); done
    runs 0 mps run "$case" "${set[@]}" -o "$name.1"
    [ "$(wc -l <"$name.1/probes.csv")" -gt 5 ] || fail "$name: $(wc -l "$name.1/probes.csv")"
    for n in ${counts//,/ }; do
        on 0 $n run "$case" "${set[@]}" -o "$name.$n"
        same "$name.1" "$name.$n"
        grep -q "\"ranks\": $n" "$name.$n/summary.json" || fail "$name.$n/summary.json does not tell its ranks"
    done
    [ "$(find "$name.1/frames" -name '*.vtp' | wc -l)" -ge 2 ] || fail "$name: no frames are compared"
done <<'CASES'
tank 2,3 tank.yaml dp=30~mm run.until=0.2~s output.frames=2 run.checkpoint=0.1~s
baffle_3d 2,3 CASES/sloshing_baffle_3d.yaml dp=25~mm run.until=0.02~s output.frames=1
lng_air 2,3 lng.yaml dp=20~mm run.until=0.03~s output.frames=1
roll 4 CASES/sloshing_roll.yaml dp=15.5~mm run.until=0.05~s output.frames=1 run.checkpoint=0.05~s
roll_3d 5 CASES/sloshing_roll.yaml dim=3 dp=15.5~mm run.until=0.02~s output.frames=1
wave 2 CASES/standing_wave.yaml dp=40~mm run.until=0.1~s output.frames=1
cylinder 3 CASES/cylinder_tank.yaml dp=50~mm run.until=0.05~s output.frames=1
bubble 4 CASES/rising_bubble.yaml dp=50~mm run.until=0.05~s output.frames=1
bubble_2 5 CASES/rising_bubble_2.yaml dp=50~mm run.until=0.05~s output.frames=1
droplet 2 CASES/droplet.yaml dp=1~mm run.until=0.01~s output.frames=1
oscillation 3 CASES/droplet_oscillation.yaml dp=1~mm run.until=0.01~s output.frames=1
cushion 4 CASES/air_cushion.yaml dp=30~mm run.until=0.01~s output.frames=1
CASES
for case in "$cases"/*.yaml; do # ranks/body has bodies
    name=$(basename "$case" .yaml)
    [ -e "$here/../../examples/$name.c" ] || grep -q '^body:' "$case" || [[ $tested == *" CASES/$name.yaml "* ]] ||
        fail "$name has no driver and is not tested on ranks"
done

# frames in pieces
on 0 2 run tank.yaml --set "dp=30 mm" --set "run.until=0.05 s" --set output.frames=1 --set output.pieces=yes -q -o pieces
[ "$(grep -c '\.pvtp"' pieces/frames.pvd)" = 2 ] || fail "output.pieces: $(cat pieces/frames.pvd)"

# one rank gets SIGTERM: all end with a checkpoint; one process resumes, then two ranks
calm=(--set "dp=30 mm" --set output.frames=0)
"$here/run" "$mpirun" 3 "$mps" run tank.yaml "${calm[@]}" --set "run.until=$never s" -o cut --mpi >log 2>&1 &
pid=$!
wait_for more_lines cut/steps.csv 40
kill -TERM "$(pgrep -P $pid | tail -1)"
ends 130 'SIGTERM on 3 ranks' log
says 'SIGTERM on 3 ranks' 'interrupted at t ='
[ -s cut/checkpoint.mps ] || fail 'SIGTERM leaves no checkpoint'
end=$(later 0.1 cut)
on 0 2 resume cut --set "run.until=$end s" -q
runs 0 mps run tank.yaml "${calm[@]}" --set "run.until=$end s" -q -o whole
for file in probes.csv momentum.csv steps.csv; do cmp whole/$file cut/$file || fail "resume on other ranks: other $file"; done

# a refusal is printed once, with one exit code
on 2 2 run
says 'no case' 'is missing'
on 2 2 run tank.yaml --sett x
says 'a wrong option' 'unknown option'
on 2 3 run none.yaml
says 'no file' 'none.yaml'
on 2 2 run tank.yaml --set run.until=5
says 'no unit' 'has no unit'
on 2 3 run tank.yaml -o whole
says 'a folder with a run' 'there is an earlier run'
on 2 2 run tank.yaml "${calm[@]}" --set run.solver=sundials.pcg --set run.preconditioner=ic1 -o none
says 'a solver that there is not' 'ic1'
on 2 2 sweep tank.yaml
says 'a verb without --mpi' 'unknown option'
on 0 2 run --help
says 'help' 'usage: mps run'
on 3 2 run tank.yaml "${calm[@]}" --set "run.dt=20 ms" --set "motion.surge.amplitude=5 m" -o diverged
says 'a run that diverges' 'at t ='
[ ! -e none ] || fail 'a refused run made a folder'
sed 's/^title.*/titel: x/' tank.yaml >bad.yaml
# rank 1 alone has a wrong case: rank 0 ends too, and the message is not lost
"$here/run" "$mpirun" 1 "$mps" run tank.yaml --mpi "${calm[@]}" -o lone : -n 1 "$mps" run bad.yaml --mpi -o lone </dev/null >log 2>&1
[ $? = 2 ] || fail "one rank with a wrong case: $(cat log)"
says 'one rank with a wrong case' "did you mean 'title'"
[ ! -e lone ] || fail 'a run that one rank refuses made a folder'
"$here/run" "$mpirun" 2 "$mps" run tank.yaml "${calm[@]}" -o alone </dev/null >log 2>&1 && fail 'mpirun without --mpi is not refused'
says 'mpirun without --mpi' 'mpirun started 2 processes'
[ ! -e alone ] || fail 'mpirun without --mpi makes a folder'
mkdir away && cp "$mps" away # from the module
away/mps run tank.yaml --mpi -o none >log 2>&1
[ $? = 2 ] || fail '--mpi without MPI is not refused'
says '--mpi without MPI' 'cmake -DMPS_WITH_MPI=ON'
[ $failures = 0 ]
