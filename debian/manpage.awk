# SPDX-License-Identifier: BSD-3-Clause
# A manual page from the --help of a driver: awk -f manpage.awk -v name=mps_static_tank -v version=1.0.0 -v date=2026-11-22
# --help has a first line "program - what it is", "usage: ..", options indented by two, then text; "Exit:" begins the exit status.

function plain(text)
{
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    if (text ~ /^[.']/) text = "\\&" text
    return text
}

NR == 1 {
    about = $0
    sub(/^[^ ]+ - /, "", about)
    printf ".TH %s 1 %s \"libmps %s\" \"User Commands\"\n", toupper(name), date, version
    printf ".SH NAME\n%s \\- %s\n.SH SYNOPSIS\n.B %s\n[\\fIoptions\\fR]\n", name, plain(about), name
    next
}
/^usage: / || (/^$/ && !options) {next}
/^  --/ {
    if (!options++) print ".SH OPTIONS"
    option = $1
    rest = substr($0, index($0, option) + length(option))
    argument = ""
    if (rest !~ /^  /) { # one blank: an argument follows
        argument = $2
        rest = substr(rest, index(rest, argument) + length(argument))
    }
    sub(/^ +/, "", rest)
    printf ".TP\n\\fB%s\\fR", plain(option)
    if (argument != "") printf " \\fI%s\\fR", plain(argument)
    printf "\n%s\n", plain(rest)
    next
}
/^$/ {if (!output++) print ".SH OUTPUT"; next}
/^Exit: / {
    print ".SH EXIT STATUS"
    sub(/^Exit: /, "")
}
/^  / { # an example
    sub(/^ +/, "")
    printf ".PP\n.RS\n%s\n.RE\n.PP\n", plain($0)
    next
}
{print plain($0)}
