#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What `make install` puts in a place runs from there alone: another folder, without the tree, and
# with names that make and its shell would take apart.
source tests/interface/make_tap.sh

prefix=$scratch/prefix
place="$scratch/another place; touch PWN"
yes 'make install' flock "$BIN" make install PREFIX="$prefix" DESTDIR=
# Links would lead back.
is 'only files that stand by themselves' '' "$(find "$prefix" -type l)"
is 'nothing of it names the tree' '' "$(grep -rlF "$tree" "$prefix/share" "$prefix/bin" || true)"

mkdir -p "$place/scenes"
jq '.pack.counts = [2, 2, 3] | .["force-protocol"].steps = 10 | .["dem-replay"].cycles = 20' \
    samples/stiff-5x5x10.json >"$place/scenes/small scene.json"
jq '.pack = {"method": "import"}' "$place/scenes/small scene.json" >"$place/own.json"
yes 'the tree runs the scene' make run SCENE="$(cp "$place/scenes/small scene.json" \
    "$scratch/small.json" && echo "$scratch/small.json")" RUNS="$scratch/runs"

cd "$place" || exit
craquelure() { env -i PATH=/usr/bin:/bin "$prefix/bin/craquelure" "$@"; }
made() { sed -n 's/^  RUN   //p' | sed 's|.*/||' | xargs; } # what was remade

# --- run ---------------------------------------------------------------------------------

run='packing.h5 tessellation.h5 network.h5 drying.h5 forces.h5 response.h5 crackstats.json'
all="$run report.html"
is 'a scene runs' "$all" "$(craquelure run 'scenes/small scene.json' 2>"$scratch/said" | made)"
is 'in ./runs' "$all" "$(cd runs/small_scene && echo *.h5 *.json *.html | xargs -n1 |
    grep -xFf <(tr ' ' '\n' <<<"$all") | awk -v all="$all" 'BEGIN { n = split(all, order) }
        { seen[$0] = 1 } END { for (k = 1; k <= n; k++) if (seen[order[k]]) print order[k] }' | xargs)"
yes 'to the bytes of the tree' cmp runs/small_scene/crackstats.json "$scratch/runs/small/crackstats.json"
again=$(craquelure run 'scenes/small scene.json')
is 'again: nothing is remade' '' "$(made <<<"$again")"
is 'and it says how many bonds broke, and where' 'artifacts: runs/small_scene page: runs/small_scene/report.html' \
    "$(tail -2 <<<"$again" | xargs)"
is 'a changed parameter remakes what depends on it' 'response.h5 crackstats.json report.html' \
    "$(craquelure run 'scenes/small scene.json' -s dem-replay.bond.normal_strength=1e3 2>/dev/null | made)"
is 'which it is' 1000 \
    "$(craquelure inspect runs/small_scene/response.h5 | jq .parameters.bond.normal_strength)"
is 'the scene itself is as it was' 16000 \
    "$(jq '.["dem-replay"].bond.normal_strength | floor' 'scenes/small scene.json')"
craquelure run 'scenes/small scene.json' --runs="$scratch/else where" --name=other --no-page >"$scratch/shown" 2>&1
is 'in a chosen folder, by a chosen name' "artifacts: $scratch/else where/other" \
    "$(tail -1 "$scratch/shown")"
yes 'where it is' test -s "$scratch/else where/other/crackstats.json"
is 'without a page' no "$([[ -e $scratch/else\ where/other/report.html ]] && echo yes || echo no)"
is 'a sample by its name' 0 "$(craquelure run stiff-5x5x10 -s dem-replay.cycles=1 \
    -s 'pack.counts=[2,2,2]' -s force-protocol.steps=3 >/dev/null 2>&1; echo $?)"

grains="my grains; touch PWN \$(touch PWN) 'x'.txt"
craquelure inspect -d /particles/position runs/small_scene/packing.h5 |
    jq -r '.[] | map(tostring) + ["250e-9"] | join(" ")' >"$grains"
is 'grains of a file with an odd name' "$all" "$(craquelure run own.json --import "$grains" 2>/dev/null | made)"
is 'are those imported' 12 "$(craquelure inspect -d /particles/radius runs/own/packing.h5 | jq length)"
is 'the same by standard input: nothing is remade' '' \
    "$(craquelure run own.json --import=- <"$grains" 2>/dev/null | made)"
is 'no name was run as a command' '' "$(find "$scratch" -name PWN)"

cat >mycrackstats <<'END'
#!/bin/bash
[[ $1 == --version ]] && echo 'mine 1' && exit
echo '{"cracks": {"total": 7, "normal": 4, "shear": 3}, "bonds": 8}' >"${!#}"
END
chmod +x mycrackstats
is 'a stage of one'\''s own' 'one run: 7 of 8 bonds broke, 4 in tension, 3 in shear' \
    "$(env -i PATH=/usr/bin:/bin CRACKSTATS=./mycrackstats "$prefix/bin/craquelure" run \
        'scenes/small scene.json' 2>/dev/null | tee "$scratch/own" | grep broke)"
is 'whose run has no page, and is whole' 1 "$(grep -c '^no page: report: .*crackstats.json' "$scratch/own")"

# --- what is refused ---------------------------------------------------------------------

# refused WHAT STATUS LINE WORD...
refused()
{
    local what=$1 status=$2 line=$3 got
    shift 3
    got=$(craquelure "$@" 2>&1 >/dev/null </dev/null)
    is "$what" "$status" $?
    is "$what: why" 1 "$(grep -c -- "$line" <<<"$got")"
}
refused 'no scene' 64 'craquelure run: which scene?' run
refused 'a scene that is not there' 66 'nonesuch.json: no such file, nor a sample' run nonesuch.json
refused 'an option that is none' 64 '--sets: no such option' run own.json --sets=1
refused 'grains that are not there' 66 'no-grains.txt: no such file' run own.json --import=no-grains.txt
refused 'a key that is none, before any work' 65 'crackstats.slice: unknown key' \
    run 'scenes/small scene.json' --set crackstats.slice=3 --name=never
refused 'a layer that drains by itself' 65 'samples/craquelure-wet-40.json: dem-replay.capillary drains the packing itself' \
    run craquelure-wet-40 --name=never
is 'no work was done' no "$([[ -e runs/never ]] && echo yes || echo no)"
mkdir elsewhere
cp own.json elsewhere
refused 'a scene of the name of another' 73 "^craquelure run: runs/own: holds the run of .*/own.json: --name gives that of elsewhere/own.json" \
    run elsewhere/own.json
echo 'three 2 1' >words.txt
refused 'the status is that of the stage that failed' 65 'words.txt: line 1: must be four numbers' \
    run own.json --import=words.txt

# --- demo --------------------------------------------------------------------------------

craquelure demo 'scenes/small scene.json' --seeds=1,4,2 >"$scratch/demo" 2>/dev/null
is 'demo says what broke in both limits' 'immobile: inviscid:' \
    "$(grep -o '^[a-z]*:.* bonds broke' "$scratch/demo" | cut -d' ' -f1 | sort | xargs)"
# Three draws: Student's t of two degrees of freedom is 0.95 sqrt(2 / (1 - 0.95^2)) at 95 %.
for limit in inviscid immobile; do
    mean=$(for run in . seed-4 seed-2; do
        craquelure inspect runs/small_scene/$limit/$run/response.h5 | jq .summary.cracks; done |
        jq -rs --arg limit $limit 'def few: if . < 10 then . * 10 | round / 10 else round end;
            (add / 3) as $mean | (map(. - $mean | . * .) | add / 2 | sqrt) as $sd
            | (0.95 * (2 / (1 - 0.95 * 0.95) | sqrt) * $sd / (3 | sqrt)) as $half
            | "\($limit): \($mean | few) of 20 bonds broke (95 % interval of the mean \([0, $mean - $half]
                | max | few) to \($mean + $half | few), 3 draws of the throat radii: \(min) to \(max))"')
    is "$limit: the mean of three draws, its interval and their range" "$mean" \
        "$(grep -o "^$limit: .*draws of the throat radii: [0-9]* to [0-9]*)" "$scratch/demo")"
done
for page in study inviscid/report immobile/report; do
    yes "and makes $page.html" grep -q '</html>' "runs/small_scene/$page.html"
done
is 'pages lead to each other' '2 2' "$(grep -o '<a href="[a-z]*/report.html">' runs/small_scene/study.html | wc -l) $(
    cat runs/small_scene/*/report.html | grep -c '<a href="../study.html">')"
for picture in picture patterns; do
    yes "and draws $picture.svg" grep -q '</svg>' "runs/small_scene/$picture.svg"
done

cd "$tree" || exit
yes 'make uninstall' make uninstall PREFIX="$prefix" DESTDIR=
is 'leaves nothing of ours' '' "$(find "$prefix" -type f; find "$prefix" -name 'craquelure*')"

finish
