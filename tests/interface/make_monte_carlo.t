#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A study of many runs: one that fails is repeated alone, and nothing half done is counted.
source tests/interface/make_tap.sh

cd "$tree" || exit
jq '.pack.counts = [3, 3, 4] | .["force-protocol"].steps = 5 | .["dem-replay"].cycles = 20
    | .["dem-replay"].snapshots = [1, 0]' samples/stiff-5x5x10.json >"$scratch/tiny.json"
cat >"$scratch/replay" <<END
#!/bin/bash
# The stage itself, but one run in it fails once its output has begun.
[[ \$1 == --version ]] && exec build/bin/dem-replay --version
if [[ -e $scratch/fails && \$* == *inviscid-2.h5 ]]; then echo half >"\${!#}"; exit 3; fi
exec build/bin/dem-replay "\$@"
END
chmod +x "$scratch/replay"
# study ARGUMENTS...: runs it, says which files of the study were made
study()
{
    make monte-carlo MONTE_CARLO_SCENE="$scratch/tiny.json" RUNS="$scratch" REALISATIONS=3 \
        DEM_REPLAY="$scratch/replay" "$@" >"$scratch/said" 2>"$scratch/error" || echo failed
    sed -n 's/^  RUN *.*explicit\///p' "$scratch/said" | sort | xargs
}
where=$scratch/monte-carlo/tiny/explicit

touch "$scratch/fails"
is 'a run that fails stops the study' failed "$(study -k | sed -n 1p)"
is 'the others are there, the failed one and its counts are not' \
    'immobile-1.h5 immobile-2.h5 immobile-3.h5 immobile.json inviscid-1.h5 inviscid-3.h5' \
    "$(cd "$where" && echo *.h5 *.json | tr ' ' '\n' | sort | xargs)"
rm "$scratch/fails"
is 'then it runs alone, and what counts it' \
    'counts.svg inviscid-2.h5 inviscid.json table.md test.json' "$(study)"
is 'all three are counted' 3 "$(jq .runs "$where/inviscid.json")"
is 'the test has two groups of three' '[3,3]' "$(jq -c .test.groups "$where/test.json")"
is 'nothing runs again' '' "$(study)"
# Studies of a single seed have no standard deviations.
build/bin/crackstats "$where/immobile-1.h5" -o "$scratch/one.json"
mkdir "$scratch/one"
for arm in inviscid-0.4e4 inviscid-0.8e4 inviscid-1.6e4 inviscid-2e4 immobile-1.6e4 inviscid-one-0 \
    inviscid-normal-0.1 inviscid-weibull-0.1 immobile-one-0 immobile-weibull-0.1; do
    cp "$scratch/one.json" "$scratch/one/$arm.json"
done
counts=$(jq -r '.mean | "\(.cracks.total) \(.first.total) \(.fragments.count)"' "$scratch/one.json")
read -r all first fragments <<<"$counts"
pipelines/studies/strength/table "$scratch/one" "$scratch/strength.md"
yes "and its picture" pipelines/studies/strength/figure "$scratch/strength.md" "$scratch/strength.svg"
is 'the table of strengths, of one seed' "$all (K 81)" \
    "$(awk -F' *[|] *' '$3 == "1.6e4" && $2 == "inviscid" { print $8 }' "$scratch/strength.md")"
pipelines/studies/weibull/report table "$scratch"/one/*-one-0.json "$scratch/weibull.md"
is 'and that of scattered ones' "inviscid|one|0|$all|$first.0|$fragments" \
    "$(sed -n 's/ *| */|/g; s/|\(inviscid|.*\)|[0-9.]*|\([0-9]*\)|/\1|\2/p' "$scratch/weibull.md")"

is 'one more runs alone' 'counts.svg immobile-4.h5 immobile.json inviscid-4.h5 inviscid.json table.md test.json' \
    "$(study REALISATIONS=4)"
jq '.test.cracks.total.welch.p = 0' "$where/test.json" >"$scratch/least.json"
pipelines/studies/monte-carlo/table "$where"/{inviscid,immobile}.json "$scratch/least.json" "$scratch/least.md"
is 'a probability that no number holds' '< 1e-300' "$(awk -F' *[|] *' '$2 == "all cracks" { print $5 }' "$scratch/least.md")"
mkdir "$scratch/by"
echo "stage=x version=1 output=$scratch/by/file -- cp $where/test.json $scratch/by/file" >"$scratch/recipe"
yes 'what a command line does not hold goes by a file' tools/memo run "@$scratch/recipe"
is 'which is read once' "$(<"$where/test.json")" "$(cat "$scratch/recipe" "$scratch/by/file" 2>/dev/null)"
yes 'so that there may be thousands of runs' awk 'length > 131000 { exit 1 }' <(make -n monte-carlo \
    MONTE_CARLO_SCENE="$scratch/tiny.json" RUNS="$scratch" REALISATIONS=1500 2>/dev/null)
rm "$where/immobile-1.h5"
is 'one that is lost is made again' 'immobile-1.h5' "$(study REALISATIONS=4)"
rows() { build/bin/inspect "$1" | jq '.datasets[] | select(.name == "/history/time").shape[0]'; }
study DRYING_INTERVAL=0.1 >"$scratch/coarse"
every=$(rows "$scratch/monte-carlo/tiny/drying/inviscid-1.h5")
coarse=$(rows "$scratch/monte-carlo/tiny-0.1/drying/inviscid-1.h5")
is 'dryings recorded at intervals stand apart, with fewer steps' true \
    "$(jq -n "$coarse > 5 and $coarse < $every / 2")"
is 'what cannot be meant is refused before anything runs' \
    "DRYING_INTERVAL must be a number from 0 to 1, got 'abc'|REALISATIONS must be a whole number, got ''|ENGINE must be explicit or quasi-static, got 'fast'" \
    "$(for word in DRYING_INTERVAL=abc REALISATIONS= ENGINE=fast; do
        make monte-carlo RUNS="$scratch/none" $word 2>&1 | sed -n 's/.*\*\*\* \(.*\)\.  Stop\./\1/p'
    done | paste -sd'|')$(ls "$scratch/none" 2>/dev/null)"
finish
