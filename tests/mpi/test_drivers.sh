#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Drivers with --mpi stop together, and resume with another number of ranks. 77: MPI cannot start
# ranks.
# usage: tests/mpi/test_drivers.sh FOLDER_OF_DRIVERS MPIRUN
export LC_ALL=C # awk, printf and sort take numbers with a point
set -uo pipefail
. "$(dirname "$0")/ranks.sh"

says() { # what, text
    grep -qF -- "$2" log || fail "$1: says '$(cat log)', not '$2'"
    [ "$(grep -cF -- "$2" log)" = 1 ] || fail "$1: says '$2' more than once"
}

runs 0 dam_break --dp 0.02 --t-end 0.1 --frames 0 --out dam.1
ranks 0 1 dam_break --dp 0.02 --t-end 0.1 --frames 0 --out dam.one
same dam.1 dam.one

# ---- stopped by a signal, on with other numbers of ranks
surge=(sloshing_surge --dp 0.05 --frames 0 --probe-dt 0.001)
rows=1

stopped() { # signal, ranks, options...: the signal goes to mpirun, which passes on USR1 and no other; or to its last rank
    local to
    "$here/run" "$mpirun" "$2" "$drivers/${surge[0]}" --mpi "${surge[@]:1}" --t-end $never "${@:3}" >log 2>&1 &
    pid=$! to=$!
    wait_for more_lines steps.now/steps.csv $rows
    [ "$1" = USR1 ] || to=$(pgrep -P $pid | tail -1)
    kill -"$1" "$to"
    ends 130 "SIG$1 on $2 ranks" log
    says "SIG$1" 'interrupted at t ='
    [ -s steps.now/checkpoint.mps ] || fail "SIG$1 leaves no checkpoint"
    [ ! -e steps.now/run.lock ] || fail "SIG$1 leaves the folder locked"
    rows=$(wc -l <steps.now/steps.csv)
}
stopped USR1 2 --out steps.now
stopped TERM 3 --out steps.now --resume
surge+=(--t-end "$(later 0.1 steps.now)")
runs 0 "${surge[@]}" --out whole
ranks 0 2 "${surge[@]}" --out steps.now --resume
for file in probes.csv momentum.csv steps.csv picture_end.png; do cmp whole/$file steps.now/$file || fail "--resume on other ranks: other $file"; done

# ---- frames in pieces; a run with another number of ranks in the same folder removes them
pieces=(dam_break --dp 0.02 --t-end 0.1 --frames 2 --out pieces)
ranks 0 3 "${pieces[@]}" --pieces
[ "$(grep -c '\.pvtp"' pieces/frames.pvd)" = 3 ] || fail "--pieces: $(cat pieces/frames.pvd)"
[ "$(ls pieces/frames/frames_00000?.pvtp pieces/frames/frames_00000?_000?.vtp | wc -l)" = 12 ] || fail "--pieces: $(ls pieces/frames)"
ranks 0 2 "${pieces[@]}" --pieces --overwrite
[ "$(ls pieces/frames | wc -l)" = 9 ] || fail "--pieces --overwrite: $(ls pieces/frames)"
rows=1
rm -rf steps.now
stopped TERM 2 --out steps.now --frames 4 --pieces # a stop adds no frame: the run that continues has those of a whole one
[ "$(grep -c '\.pvtp"' steps.now/frames.pvd)" = 1 ] || fail "stopped with --pieces: $(cat steps.now/frames.pvd)"
[ -s steps.now/picture_end.png ] || fail 'stopped with --pieces: no last picture'
ranks 0 3 "${surge[@]}" --t-end "$(later 0.1 steps.now)" --out steps.now --frames 4 --pieces --resume
[ "$(ls steps.now/frames/*.pvtp | wc -l)" = "$(grep -c '\.pvtp"' steps.now/frames.pvd)" ] || fail "--pieces --resume: $(ls steps.now/frames)"
rm -rf steps.now
runs 0 "${pieces[@]}" --pieces --overwrite
[ "$(ls pieces/frames | wc -l)" = 3 ] || fail "--pieces on one rank: $(ls pieces/frames)"

# ---- a refusal is printed once, and all ranks end
ranks 2 2 dam_break --bogus
says 'a wrong option' 'unknown option --bogus'
ranks 2 2 dam_break --out dam.1
says 'a folder with a run' 'there is an earlier run'
ranks 2 2 dam_break --out nothing --resume
says 'no checkpoint' "there is no run in 'nothing'"
ranks 2 2 dam_break --solver sundials.pcg/ic0 --dp 0.02 --t-end 0.01 --out ic0
says 'a solver for one rank' 'works on one rank only'
ranks 0 2 dam_break --help
says 'help' 'usage: dam_break'
ranks 3 2 sloshing_surge --dp 0.05 --dt 0.1 --t-end 5 --frames 2 --out diverged
says 'a run that diverges' 'at t ='
[ -s diverged/summary.json ] || fail 'a run that diverges leaves no summary'
# rank 1 alone refuses its options: rank 0 ends too, and the message is not lost
"$here/run" "$mpirun" 1 "$drivers/dam_break" --mpi --dp 0.02 --out lone : -n 1 "$drivers/dam_break" --mpi --set shift.bogus=1 </dev/null >log 2>&1
[ $? = 2 ] || fail "one rank with a wrong setting: $(cat log)"
says 'one rank with a wrong setting' 'has no setting "bogus"'
"$here/run" "$mpirun" 2 "$drivers/dam_break" --dp 0.02 --t-end 0.01 --out alone </dev/null >log 2>&1 && fail 'mpirun without --mpi is not refused'
says 'mpirun without --mpi' 'mpirun started 2 processes'
[ ! -e alone ] || fail 'mpirun without --mpi makes a folder'
cp "$drivers/dam_break" . # away from the module
./dam_break --mpi --out none >log 2>&1
[ $? = 2 ] || fail '--mpi without MPI is not refused'
says '--mpi without MPI' 'cmake -DMPS_WITH_MPI=ON'
[ $failures = 0 ]
