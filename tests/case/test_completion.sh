#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Completion of mps in bash: result of the tabulator key.
# usage: test_completion.sh PROGRAM COMPLETION
program=$1
export LC_ALL=C
set -u
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. "$2" || exit 1
set +u # as in a user's shell
cd "$work" || exit 1
failed=0
fail() {
    echo "FAILED: $*"
    failed=1
}

# The answers to the words of a line, the last of which is being typed.
answers() {
    COMP_WORDS=("$@")
    COMP_CWORD=$(($# - 1))
    COMPREPLY=()
    _mps 2> errors
    [ -s errors ] && fail "$*: $(cat errors)"
    printf '%s\n' "${COMPREPLY[@]}" | sort
}

# wanted answers in one text, words ..
gives() {
    local wanted=$1 got
    shift
    got=$(answers "$@" | tr '\n' ' ')
    [ "${got% }" = "$wanted" ] || fail "$*: '${got% }', not '$wanted'"
}

# all verbs and all options of --help, and no others
verbs=$("$program" --help | sed -n 's/^  \([a-z]*\) .*/\1/p')
[ "$(wc -w <<< "$verbs")" -gt 10 ] || fail "no verbs: $verbs"
gives "$(printf '%s\n' --help --version $verbs | sort | tr '\n' ' ' | sed 's/ $//')" mps ''
gives "repeat report resume run" mps r
for verb in $verbs; do
    wanted=$({ "$program" "$verb" --help | sed -n 's/^  .* \(--[a-z-]*\) .*/\1/p'; echo --help; } | sort | tr '\n' ' ')
    gives "${wanted% }" mps "$verb" --
done
gives "--out --overwrite" mps run --o
gives "" mps rum --

# files by what a verb takes
mkdir -p out/run cases
touch tank.yaml tank.svg lng.yml report.html out/run/probes.csv crests.csv "my tank.yaml"
printf 't[s],P_left[Pa],P_right[Pa],eta[m]\n0,1,2,3\n' > out/run/probes.csv
gives "cases lng.yml my tank.yaml out report.html tank.yaml" mps run ''
gives "tank.yaml" mps check t
gives "tank.svg tank.yaml" mps info t
gives "out/run" mps resume out/
gives "" mps resume out/run ''
gives "cases out" mps stats ''
gives "P_left P_right eta" mps stats out/run ''
gives "P_left P_right" mps stats out/run eta P
gives "cases crests.csv out" mps compare out/run ''
gives "cases lng.yml my tank.yaml out report.html tank.yaml" mps run -j 2 ''
gives "cases lng.yml my tank.yaml out report.html tank.yaml" mps run --threads = 2 ''
gives "tank.svg tank.yaml" mps run lng.yml --out t
gives "tank.svg tank.yaml" mps run lng.yml --out = t
gives "" mps run lng.yml -j ''

# names
gives "roll" mps init ro
names=$("$program" list cases | cut -d' ' -f1)
for name in $names; do gives "$(grep "^$name" <<< "$names" | paste -sd ' ')" mps init "$name"; done
gives "settings solvers" mps list s

# paths of values: '.' where more follows, '=' where a value does
gives "dim= domain= dp=" mps run tank.yaml --set d
gives "tank." mps run tank.yaml -s tan
gives "tank.chamfer.across= tank.chamfer.bottom= tank.chamfer.top=" mps run tank.yaml --set tank.chamfer.
gives "motion.roll.period= motion.roll.phase=" mps run tank.yaml --set motion.roll.p
gives "motion.roll.period= motion.roll.phase=" mps run tank.yaml --set = motion.roll.p
gives "impacts." mps stats out/run --set ''
gives "impacts.share=" mps report out/run --set impacts.sh
gives "impacts.scale= impacts.seed= impacts.sensors= impacts.share=" mps stats out/run --set impacts.s
gives "sensors.P_left.wall=" mps run tank.yaml --set sensors.P_left.w
gives "" mps run tank.yaml --set sensors.
gives "" mps run tank.yaml --set dp = ''
gives "" mps run tank.yaml --set dp =
gives "cases lng.yml my tank.yaml out report.html tank.yaml" mps run --set dp = 5 ''

# each key without a name of the user's is found from its own beginning
for key in $("$program" list keys | sed -n 's/^\([a-z_.]*\)\( (required)\)\?$/\1/p'); do
    answers mps run x.yaml --set "$key" | grep -qxE -- "${key//./\\.}[.=]" || fail "$key is not completed"
done

# a shell loads it as from share/bash-completion
bash -c '. "$1" && complete -p mps' - "$2" | grep -q -- '-F _mps mps' || fail "not registered"

[ $failed -eq 0 ] && echo "completion knows the verbs, options, keys and files of mps"
exit $failed
