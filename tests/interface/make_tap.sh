# shellcheck shell=bash disable=SC2034
# SPDX-License-Identifier: GPL-3.0-or-later
# What the make_*.t scripts share: TAP, and a scratch folder that goes away with the test.
set -uo pipefail

tree=$PWD
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
tests=0

# is WHAT EXPECTED ACTUAL
is()
{
    (( ++tests ))
    if [[ $2 == "$3" ]]; then
        echo "ok $tests - $1"
    else
        echo "not ok $tests - $1"
        printf '# expected: %s\n#      got: %s\n' "${2//$'\n'/$'\n# '}" "${3//$'\n'/$'\n# '}" >&2
    fi
}

# yes WHAT COMMAND...
yes()
{
    local what=$1 status=0
    shift
    "$@" >"$scratch/said" 2>&1 || status=$?
    is "$what" 0 $status
    (( status )) && sed 's/^/# /' "$scratch/said"
}

finish()
{
    echo "1..$tests"
}
