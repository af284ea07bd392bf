#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Cases in README, tutorials and how-tos: 'mps check' accepts each block of YAML without a warning,
# and 'mps run' begins it; a block that is part of a case is in a file of cases.
# usage: test_documents.sh PROGRAM SOURCE_FOLDER
program=$(realpath "$1") root=$(realpath "$2")
. "$(dirname "$0")/program_kit.sh"
mkdir bin
ln -s "$program" bin/mps
PATH=$work/bin:$PATH

# blocks PAGE LANGUAGE: writes each block of this language to block_1, block_2, ..
blocks() {
    rm -f block_*
    awk -v language="$2" '$0 == "```" language {file = "block_" ++count; next} /^```$/ {file = ""} file {print > file}' "$1"
}

# What the cases of a page need: the files that its commands, or commands beside it, write.
companions() {
    case $1 in
    */ship_motion.md)
        blocks "$1" sh
        . ./block_1
        [ "$(wc -l < motion.csv)" -eq 402 ] || fail "$1: motion.csv"
        ;;
    */your_own_geometry.md)
        blocks "$1" sh
        bash -e block_1 > log 2>&1 || fail "$1: $(cat log)"
        grep -q "It has $(sed -n 's/.*"n_fluid": \([0-9]*\).*/\1/p' out/box/summary.json) fluid particles" "$1" ||
            fail "$1: number of particles: $(grep n_fluid out/box/summary.json)"
        ;;
    */your_own_model.md)
        "${CC:-cc}" -shared -fPIC -I"$root/include" "$root/examples/plugins/drag/drag.c" -o libdrag.so || fail "libdrag.so"
        ;;
    */anti_roll_tank.md) mps init anti_roll_tank > log ;;
    */many_cases.md) mps init tank > log ;;
    esac
}

# A block of a part of a case: its lines are in a file of cases, in this order.
quoted() {
    local case
    for case in "$root"/cases/*.yaml; do
        awk 'NR == FNR {want[n++] = $0; next} {k = $0 == want[k] ? k + 1 : $0 == want[0]; if (k == n) found = 1} END {exit !found}' "$1" "$case" && return
    done
    fail "$2: not in cases: $(head -3 "$1")"
}

# A body with a load of its own, instead of that of the case of its page.
fitted() {
    awk '/^[a-z]/ {skip = /^body:/} !skip' anti_roll_tank.yaml | cat - "$1" > "whole_$1"
    printf 't[s],M[kN m]\n0,0\n100,5\n' > push.csv
    accepted "whole_$1" "$2"
}

# A case: checked, and run for a short time.
accepted() {
    expect 0 "periods" mps check "$1"
    ! grep "warning: " log || fail "$2: a warning of $1"
    expect 0 "" mps run "$1" --set "run.until=20 ms" --set output.frames=0 --set "output.page=0 MB" -q -o "run_$1" --overwrite
    awk -F, 'END {exit !($1 > 0.0199 && $1 < 0.0201)}' "run_$1/probes.csv" || fail "$2: $1 ends at $(tail -1 "run_$1/probes.csv")"
}

# A sweep: as many runs as the lists of its page have values, whose columns exist.
swept() {
    expect 0 "$3 runs" mps check "$1"
    ! grep "warning: " log || fail "$2: a warning of $1"
}

count=0 parts=0
for page in "$root"/README.md "$root"/docs/tutorials/*.md "$root"/docs/how-to/*.md; do
    grep -q '^```yaml$' "$page" || continue
    mkdir "$work/$(basename "$page" .md)" && cd "$work/$(basename "$page" .md)" || exit 1
    companions "$page"
    blocks "$page" yaml
    for block in block_*; do
        name=$(sed -n '1s/^# \([a-z_]*\.yaml\).*/\1/p' "$block")
        name=${name:-$(basename "$page" .md)_$block.yaml}
        mv "$block" "$name"
        count=$((count + 1))
        if grep -q '^sweep:' "$name"; then
            runs=7
            [[ $page == */many_cases.md ]] && runs=15
            swept "$name" "$page" $runs
        elif grep -q '^dp:' "$name"; then
            accepted "$name" "$page"
        else
            parts=$((parts + 1))
            if grep -q push.csv "$name"; then fitted "$name" "$page"; else quoted "$name" "$page"; fi
        fi
    done
done
[ $count -ge 10 ] || fail "$count blocks"
[ $parts -eq 2 ] || fail "$parts parts of cases"

# what the tutorial of ship motion says about the case is what the program says
page=$root/docs/tutorials/ship_motion.md
cd "$work/ship_motion" || exit 1
mps check ship.yaml 2>&1 | sed "s|$PWD/||" > log
grep -v "ramp:" ship.yaml > no_ramp.yaml
mps check no_ramp.yaml 2>&1 | sed "s|no_ramp|ship|; s|$PWD/||" > warned
awk '/^```/ {code = !code} !code && sub(/^    /, "") && !/^mps /' "$page" > lines
shown=0
while read -r line; do
    case $line in
    motion\ * | start\ * | sway:* | heave:* | roll:* | pitch:*) where=log ;;
    ship.yaml:*) where=warned ;;
    *) continue ;;
    esac
    shown=$((shown + 1))
    grep -qF -- "${line% ..}" $where || fail "$page: '$line' is not what mps check says: $(cat $where)"
done < lines
[ $shown -eq 8 ] || fail "$page: $shown lines of mps check"

# the case of the tutorial of Python
sed -n '/^CASE = """$/,/^"""$/p' "$root/docs/tutorials/python.md" | sed '1d;$d' > python.yaml
accepted python.yaml docs/tutorials/python.md

[ $failed -eq 0 ] && echo "$count blocks of YAML are cases"
exit $failed
