#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Manual pages of mps: all verbs, options and keys, no warning. 77: there is no man.
# usage: test_manual.sh PROGRAM FOLDER
program=$1 folder=$2
command -v man > /dev/null || { echo "skipped: there is no man"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failed=0
fail() {
    echo "FAILED: $*"
    failed=1
}

for page in mps.1 mps-case.5; do
    LC_ALL=C.UTF-8 MANROFFSEQ='' MANWIDTH=200 man --warnings -l "$folder/$page" > $page 2> warnings
    [ -s warnings ] && fail "$page: $(cat warnings)"
    [ -s $page ] || fail "$page is empty"
    for title in NAME DESCRIPTION "SEE ALSO"; do grep -qx "$title" $page || fail "$page: no $title"; done
    [ "$(lexgrog "$folder/$page" | grep -c ': "mps')" = 1 ] || fail "$page: $(lexgrog "$folder/$page")"
done

# a line of help without its filling; a page breaks lines elsewhere
page=$(tr -s ' \n' ' ' < mps.1)
for verb in $("$program" --help | sed -n 's/^  \([a-z]*\) .*/\1/p'); do
    "$program" "$verb" --help > help
    [[ $page == *"$(sed -n '3p' help)"* ]] || fail "mps.1: $verb: no '$(sed -n '3p' help)'"
    line=$(sed -n '1s/^usage: //p' help)
    [[ $page == *"$line"* ]] || fail "mps.1: no '$line'"
    sed -n 's/^  .* \(--[a-z]*\) .*/\1/p' help > options
    while read -r option; do
        grep -qE "^ +(-., )?$option( [A-Z=]+)?$" mps.1 || fail "mps.1: no $option"
        grep -E "Options: .*$option[,.]" mps.1 > /dev/null || fail "mps.1: $option is not named by a verb"
    done < options
done
[ "$(grep -c . options)" -ge 0 ] || fail "no options"

keys=0
while read -r key; do
    keys=$((keys + 1))
    grep -qxF -- "       $key" mps-case.5 || fail "mps-case.5: no $key"
done < <("$program" list keys | sed -n 's/^\([^ ].*\)$/\1/p' | sed 's/ (required)$//')
[ $keys -gt 100 ] || fail "$keys keys"
"$program" list units | sed 's/^\(.\{24\}\).*/\1/; s/ *$//' | grep -v ' or \|number\|^unit\|^points' | while read -r kind; do
    grep -qxF -- "       ${kind%%,*}" mps-case.5 || echo "$kind"
done > missing
[ -s missing ] && fail "mps-case.5: no units of $(cat missing)"

# what the page shows as an example is a case
sed -n '/^EXAMPLE$/,/^ *More of them/p' mps-case.5 | sed '1d;$d' | sed 's/^           //' > example.yaml
"$program" check example.yaml > log 2>&1 || fail "the example is no case: $(cat log example.yaml)"

[ $failed -eq 0 ] && echo "manual pages have all verbs, options and keys"
exit $failed
