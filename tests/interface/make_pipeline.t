#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Make re-runs by content, shown with stages that are small scripts: each notes that it ran,
# and writes what it was given.
source tests/interface/make_tap.sh

cp -r Makefile VERSION pipelines tools "$scratch"
rm -f "$scratch/pipelines/run/picture"* # the demo's; not this test's
cd "$scratch" || exit
mkdir -p build/bin samples
unset SCENE RUN THREADS PACK TESSELLATE MERGE_NODES DRY FORCE_PROTOCOL DEM_REPLAY CRACKSTATS

cat >stage <<'END'
#!/bin/bash
# The key "unseen" of its section does not show in its output.
name=${0##*/} sets=() inputs=() checkpoint=''
while (( $# )); do
    case $1 in
    --version) echo "$name $(<"$(dirname "$0")/$name.version")"; exit ;;
    --parameters)
        jq -c --arg name "$name" '.[$name] // {}' "$scene"
        [[ $(<"$scene") != *"wrong-$name"* ]]
        exit ;;
    -p) scene=$2; shift ;;
    --set) sets+=("$2"); shift ;;
    -o) output=$2; shift ;;
    --checkpoint=*) checkpoint=${1#*=} ;;
    *) inputs+=("$1") ;;
    esac
    shift
done
echo "$name" >>ran
if [[ -e $checkpoint ]]; then
    cat "$checkpoint" >>ran
    [[ $(<"$checkpoint") != damaged ]] || exit 65
fi
[[ -e fail-$name ]] && exit 3
[[ -e slow-$name ]] && { touch slow; sleep 2.1; }
[[ -e hang-$name ]] && {
    echo half >"$output"
    [[ ! $checkpoint ]] || echo continues >"$checkpoint"
    touch hangs
    sleep 60
}
{
    echo "$name ${sets[*]}"
    jq -cS --arg name "$name" '.[$name] // {}
        | walk(if type == "object" then del(.comment, .unseen) else . end)' "$scene"
    for input in "${inputs[@]}"; do [[ -d $input ]] || echo "$(<"$input")"; done
} >"$output"
[[ ! -e $checkpoint ]] || rm "$checkpoint"
END
chmod +x stage
all='pack tessellate merge-nodes dry force-protocol dem-replay crackstats'
for name in $all report; do
    mkdir -p "stages/$name"
    cp stage "build/bin/$name"
    echo 1 >"stages/$name/version"
done

scene=samples/x.json
x=build/runs/x
cat >$scene <<'END'
{
  "comment": "a scene",
  "pack": {"counts": [2, 2], "radius": 1e-7},
  "dry": {"liquid": "inviscid", "layer": {"comment": "deep", "thickness": 5, "nodes": 3}},
  "dem-replay": {"stiffness": 1}
}
END

# edit JQ-FILTER: changes the scene
edit() { jq "$1" $scene >edited && mv edited $scene; }
# ran [MAKE-ARGUMENTS...]: runs the pipeline; says which stages ran
ran()
{
    : >ran
    make run SCENE=$scene "$@" >said 2>&1 || echo "make: status $?"
    names <ran
}
names() { local all; read -rd '' -a all; echo "${all[*]}"; } # in a line
planned() { make -n run SCENE=$scene | sed -n 's/.* stage=\([^ ]*\).*/\1/p' | names; }
# What make runs is what it plans, so `make -q` tells; `runs_nothing` shows it.
settled() { is "$1: make -q" 0 "$(make -q run SCENE=$scene >/dev/null 2>&1; echo $?)"; }
runs_nothing()
{
    settled "$1"
    is "$1: nothing runs again" "" "$(ran)"
}

is 'make -q before: not made' 1 "$(make -q run SCENE=$scene >/dev/null 2>&1; echo $?)"
is 'make -n before: all stages' "$all" "$(planned)"
is 'make -n makes nothing' "" "$(ls build/runs 2>/dev/null)"
is 'the first run runs all stages' "$all" "$(ran)"
runs_nothing 'after the first run'
is 'after the first run: make -n plans nothing' "make: Nothing to be done for 'run'." \
    "$(make -n run SCENE=$scene 2>&1)"

touch $scene
settled 'touched scene'
touch -d '3 days ago' $x/{crackstats.json,drying.h5}
touch $x/network.h5
runs_nothing 'touched artifacts'
touch build/bin/dry Makefile tools/memo
echo '# recompiled' >>build/bin/dry
runs_nothing 'recompiled program'

edit '.comment = "another" | .dry.layer.comment = "not so deep" | .pack.comment = "new"'
runs_nothing 'changed comments'
edit 'to_entries | reverse | from_entries | .dry |= (to_entries | reverse | from_entries)'
settled 'other order of keys'
jq -c . $scene >edited && mv edited $scene
settled 'other spacing'

edit '.["dem-replay"].stiffness = 2'
is 'a DEM parameter: make -n' 'dem-replay crackstats' "$(planned)"
is 'a DEM parameter: make -q' 1 "$(make -q run SCENE=$scene >/dev/null 2>&1; echo $?)"
is 'a DEM parameter: dem-replay and crackstats' 'dem-replay crackstats' "$(ran)"
settled 'after a DEM parameter'

edit '.["dem-replay"].stiffness = 2.5'
touch -d tomorrow $x/{response.h5,crackstats.json}
is 'nor does a clock that runs ahead matter' 'dem-replay crackstats' "$(ran)"

before=$(stat -c %y $x/drying.h5)
edit '.dry.unseen = 7'
is 'a result that comes out the same stops there' dry "$(ran)"
is 'and is left as it was' "$before" "$(stat -c %y $x/drying.h5)"
settled 'after the same result'

echo 2 >stages/dry/version
is 'a new stage version' 'dry' "$(ran)"
settled 'after a new stage version'

rm $x/tessellation.h5
is 'a removed artifact is made again; the same bytes stop there' tessellate "$(ran)"
settled 'after a removed artifact'
echo spoilt >>$x/forces.h5
is 'a spoilt artifact is made again' force-protocol "$(ran)"
settled 'after a spoilt artifact'
rm $x/network.h5.key
is 'a lost key' merge-nodes "$(ran)"
settled 'after a lost key'
rm -r $x
is 'a removed run' "$all" "$(ran)"

edit '.["wrong-crackstats"] = 1'
is 'a wrong section stops make before anything runs' 'make: status 2' "$(ran)"
edit 'del(.["wrong-crackstats"])'

touch fail-dem-replay
edit '.["dem-replay"].stiffness = 3'
was=$(sha256sum $x/response.h5)
is 'a stage that fails stops make' $'make: status 2\ndem-replay' "$(ran)"
is 'and leaves the earlier output' "$was" "$(sha256sum $x/response.h5)"
is 'make -q then: not made' 1 "$(make -q run SCENE=$scene >/dev/null 2>&1; echo $?)"
rm fail-dem-replay
is 'and runs once it can' 'dem-replay crackstats' "$(ran)"
runs_nothing 'after a failure'

# killed COMMAND...: kills it, and all that it began, where dry hangs
killed()
{
    touch hang-dry hang-mydry
    rm -f hangs
    setsid "$@" >said 2>&1 &
    local leader=$! i
    disown # its death is not news
    for (( i = 0; i < 300; i++ )); do [[ -e hangs ]] && break; sleep 0.1; done
    kill -9 -- -$leader
    rm hang-dry hang-mydry
}

edit '.dry.liquid = "immobile"'
killed make run SCENE=$scene
is 'after kill -9 make goes on from the checkpoint' \
    'dry continues force-protocol dem-replay crackstats' "$(ran)"
runs_nothing 'after kill -9'
is 'and nothing is left over' "" "$(find $x -name '.*' -o -name '*.unfinished*')"

edit '.dry.liquid = "viscous"'
killed make run SCENE=$scene
edit '.dry.liquid = "inviscid" | .dry.seed = 2'
is 'with another parameter it begins anew' \
    'dry force-protocol dem-replay crackstats' "$(ran)"
is 'and the old checkpoint goes' "" "$(find $x -name '*.unfinished*')"

edit '.dry.seed = 3'
killed make run SCENE=$scene
echo damaged >"$(echo $x/drying.h5.unfinished-*)"
is 'after a damaged checkpoint it begins anew' \
    'dry damaged dry force-protocol dem-replay crackstats' "$(ran)"

edit '.dry.seed = 4'
killed make run SCENE=$scene
touch fail-dry
ran >failed
rm fail-dry
is 'an error ends what was begun' 'dry force-protocol dem-replay crackstats' "$(ran)"

cp stage mydry
echo 1 >mydry.version
killed make run SCENE=$scene DRY=./mydry
is 'the own program keeps none' "" "$(find $x -name '*.unfinished*')"

cp tools/memo memo-itself
rm -f begun
tools/memo run stage=s version=1 output=long -- bash -c 'touch begun; sleep 1; echo made >"$0"' long >said 2>&1 & long=$!
for (( i = 0; i < 300; i++ )); do [[ -e begun ]] && break; sleep 0.1; done
{ echo '#!/bin/bash'; printf '(%.0s' {1..30000}; } >tools/memo
wait $long; status=$?
is 'a newer memo does not spoil what the older one is making' '0 made' \
    "$status $(cat long 2>/dev/null)"
cp memo-itself tools/memo

chain() { tools/memo run stage=chain version=1 output=chained -- \
    build/bin/pack -p $scene -o @packing --then build/bin/dry -p $scene @packing -o chained; }
export -f chain
export scene
killed bash -c chain
: >ran
chain >said
is 'of several stages one after the other each keeps its own' 'pack dry continues' "$(names <ran)"
edit 'del(.dry.seed) | .dry.liquid = "immobile"'
ran >said

cp stage mydry
echo 1 >mydry.version
is 'a stage swapped for the own program' \
    'mydry force-protocol dem-replay crackstats' "$(ran DRY=./mydry)"
is 'is known by its --version' "" "$(ran DRY=./mydry)"
echo '# changed' >>mydry
is 'not by its bytes' "" "$(ran DRY=./mydry)"
echo 2 >mydry.version
is 'and runs again when that changes' 'mydry' "$(ran DRY=./mydry)"
is 'and back' 'dry force-protocol dem-replay crackstats' "$(ran)"

is 'a program that is not there is named' 'memo: ./nothere: no such program' \
    "$(make run SCENE=$scene DRY=./nothere 2>&1 | grep memo:)"

cat >launch <<'END'
#!/bin/bash
echo launch >>ran
exec "$@"
END
chmod +x launch
edit '.crackstats.slices = 3'
is 'RUN= prefixes the stages' 'launch crackstats' "$(ran RUN=./launch)"
settled 'RUN= is not part of the result'

is 'make run without a scene' 64 \
    "$(make run SCENE= 2>&1 | grep -o 'Error .*' | cut -d' ' -f2)"

# More recipes than a command line holds.
mkdir pipelines/studies/{many,wrong}
cat >pipelines/studies/many/study.mk <<'END'
ifeq ($(MAKECMDGOALS),many)
long := $(shell printf %030000d)
$(foreach n,1 2 3 4 5 6,$(call step,$(RUNS)/many/$n.h5,pack,$(PACK),$(SCENE),counts=$(long)$n,))
endif
pipeline_goals += many
many: $(artifacts)
END
make many SCENE=$scene >said 2>&1
is 'many artifacts: all made' 6 "$(find build/runs/many -name '*.h5' | wc -l)"
is 'many artifacts: all current' 0 "$(make -q many SCENE=$scene; echo $?)"
rm build/runs/many/3.h5
is 'many artifacts: one is not' "$(printf '  RUN   %s' build/runs/many/3.h5)" \
    "$(make many SCENE=$scene | grep -v TOOK)"

# Two at once on one scene.
edit '.dry.liquid = "viscous"'
touch slow-dry
make run SCENE=$scene >said 2>&1 & first=$!
for (( i = 0; i < 300; i++ )); do [[ -e slow ]] && break; sleep 0.1; done
is 'two makes of one scene: the second waits and finds it made' 'make: status 0 WAIT' \
    "make: status $(make run SCENE=$scene >other 2>&1; echo $?) $(awk '$2 ~ /drying/ { print $1 }' other)"
wait $first
is 'and the first ends well too' 0 $?
is 'and says what took long' drying "$(sed -n 's|^  TOOK  [2-9] s: .*/\(.*\)\.h5$|\1|p' said)"
rm slow-dry
settled 'after both'

# Two at once: one begins while the other looks at what is stale.
make run SCENE=$scene >said 2>&1
mv tools/memo memo-itself
cat >tools/memo <<'END'
#!/bin/bash
[[ $1 == check ]] && sleep 0.5
exec ./memo-itself "$@"
END
chmod +x tools/memo
cp $scene samples/y.json
edit '.pack.radius = 3'
make -n run SCENE=$scene >plan & sleep 0.2
make -n run SCENE=samples/y.json >said
wait $!
mv memo-itself tools/memo
is 'of two makes at once each sees what is stale' 1 "$(grep -c 'memo run .*stage=pack' plan)"

# --- digests that are remembered ----------------------------------------------------------

mkdir counting
cat >counting/sha256sum <<'END'
#!/bin/bash
shift # --
printf '%s\n' "$@" >>hashed
exec /usr/bin/sha256sum -- "$@"
END
chmod +x counting/sha256sum
# What make reads to find what is stale, as "names: what is stale".
hashed()
{
    : >hashed
    local stale
    stale=$(PATH=$PWD/counting:$PATH planned)
    echo "$(sed 's|.*/||' hashed | sort | names): $stale"
}
rm -r $x
ran >/dev/null
everything=$(cd "$x" && printf '%s\n' *.h5 *.json | sort | names)
touch old
sleep 3 # what is older is remembered
is 'what is new is read, once' "$everything: " "$(hashed)"
is 'and then remembered' ': ' "$(hashed)"
echo stage=s version=1 input=old input=new output=none >recipe
cp recipe again
touch new && tools/memo check recipe few >said
is 'not what could change within a tick of the clock' old "$(sed 's/.* //' few | names)"
tools/memo check again few >said
is 'files of other recipes stay remembered' "old $(wc -l <build/digests)" \
    "$(cp build/digests few; echo output=old stage=s version=1 >again; tools/memo check again few >said
    sed 's/.* //' few | grep -x old) $(grep -cv ' old$' few)"
size=$(stat -c %s $x/drying.h5)
cp -p $x/drying.h5 was
tr 0-9 1-90 <was >$x/drying.h5
touch -r was $x/drying.h5
is 'other bytes of the same size and time: read' "$size drying.h5: dry force-protocol dem-replay crackstats" \
    "$(stat -c %s $x/drying.h5) $(hashed)"
mv was $x/drying.h5
is 'the old file in its place: read' 'drying.h5: ' "$(hashed)"
echo 'no digests' >build/digests
is 'a file of digests that is none: all is read' "$everything: " "$(hashed)"
rm build/digests
mkdir build/digests
is 'digests that cannot be kept: all is read' "$everything: " "$(hashed 2>/dev/null)"
rm -rf build/digests

# --- names of files: they work, or are refused in one line, and none is run ----------------

make run BUILD=/proc/none >said 2>&1
is 'a folder of builds that cannot be written is named' yes "$(grep -q '/proc/none: cannot be written' said && echo yes || cat said)"

# refused VARIABLE NAME [MAKE-ARGUMENTS...]
refused()
{
    local variable=$1 name=$2
    shift 2
    make run "$@" "$variable=$name" >said 2>&1
    local said line=$'^[^\n]*make takes no blanks or signs in names of files[^\n]*$'
    said=$(<said)
    is "$variable=${name//[$'\n'#]/?} is refused${1:+, by make $1}" refused "$([[ $said =~ $line ]] && echo refused || echo "$said")"
}
for name in 'a b' "it's" 'a;touch PWN;' 'a#b' 'a(b' 'a)b' 'a:b' 'a=b' 'a\b' 'a%b' 'a|touch PWN' \
    'a`touch PWN`' 'a$(touch PWN)' 'a$(shell touch PWN)' 'a&touch PWN' $'a\ntouch PWN' \
    "a';touch PWN;'" 'a>PWN' 'a*' 'a{b,c}'; do
    refused SCENE "samples/$name.json" -n
done
for name in 'a b' 'a$(touch PWN)' 'a`touch PWN`' $'a\ntouch PWN'; do
    refused IMPORT "$name.txt" -n SCENE=$scene
done
for variable in SCENE IMPORT RUNS BUILD NAME; do
    refused $variable 'a;touch PWN;' -n SCENE=$scene
    refused $variable 'a;touch PWN;' -q SCENE=$scene
    refused $variable 'a;touch PWN;' -B SCENE=$scene
done
for variable in BUILD RUNS; do
    is "$variable= without a name is refused" "$variable=: must be the name of a folder.  Stop." \
        "$(make -n run SCENE=$scene $variable= 2>&1 | grep -o "$variable=.*")"
done
for name in ../x .. x/y; do
    is "NAME=$name would lie elsewhere, and is refused" 1 \
        "$(make study NAME=$name 2>&1 >/dev/null | grep -c 'must be the name of a folder, without /')"
done
is 'NAME=other is the folder of a run' build/runs/other/packing.h5 \
    "$(make -n run SCENE=$scene NAME=other 2>&1 | grep -o 'build/runs/[a-z]*/packing.h5' | sort -u)"
mkdir elsewhere
jq '.pack.radius = 2e-7' $scene >elsewhere/x.json
: >ran
is 'a scene of the same name elsewhere does not take the folder' \
    'build/runs/x: holds the run of samples/x.json: NAME= gives that of elsewhere/x.json another folder' \
    "$(make run SCENE=elsewhere/x.json 2>&1 | grep holds | sed "s|$(realpath .)/||")"
is 'and nothing runs' '' "$(names <ran)"
make run SCENE=elsewhere/x.json NAME=elsewhere >said 2>&1
is 'by another name it runs' "$all" "$(names <ran)"
is 'a NAME of the environment is not' build/runs/$(basename $scene .json)/packing.h5 \
    "$(NAME=host make -nB run SCENE=$scene 2>&1 | grep -o 'build/runs/[-a-z0-9]*/packing.h5' | sort -u)"
is 'nor that of a study, as is one on the command line' '0 1' \
    "$(NAME=host make -n study STUDY=x.json 2>&1 | grep -c -e '--name=.*host') $(make -n study STUDY=x.json NAME=host | grep -c -e '--name=.*host')"
is 'grains that are not there' 'IMPORT=nowhere.txt: no such file.' \
    "$(make run SCENE=$scene IMPORT=nowhere.txt 2>&1 | grep -o 'IMPORT=.*file[.]')"
is 'in the environment as well' 2 \
    "$(IMPORT='a;touch PWN;' make -n run SCENE=$scene >/dev/null 2>&1; echo $?)"
is 'SEEDS, THREADS: not run either' '' "$(make -n strength SEEDS='1;touch PWN' 2>&1 | grep memo)$(
    make -n run SCENE=$scene THREADS='1;touch PWN' 2>&1 | grep memo)"
make -n soft SET="a='\$(touch PWN)';touch PWN;'" DRY="x';touch PWN;'" >said 2>&1
is 'and nothing was run' '' "$(find . -name 'PWN*')"
is 'nor is anything left behind' '' "$(find build -name 'recipes*')"
for name in 'a,b' 'a@b+c' 'a~b^c' 'größe' '-a'; do
    cp $scene "samples/$name.json"
    : >ran
    make run SCENE="samples/$name.json" >said 2>&1
    is "a scene named $name works" "$all" "$(names <ran)"
done
cat >pipelines/studies/wrong/study.mk <<'END'
$(if $(filter wrong,$(MAKECMDGOALS)),$(call artifact,$(RUNS)/wrong,what='is (this,,true,true))
pipeline_goals += wrong
wrong: $(RUNS)/wrong
END
make -n wrong >said 2>&1
is 'recipes that cannot be read leave nothing either' '' "$(find build -name 'recipes*')"
rm pipelines/studies/wrong/study.mk
cp $scene samples/stiff-5x5x10.json
plan=$(make -n demo)
is 'make demo: one network, one picture of its cracks' 'figures/crack-patterns merge-nodes pack tessellate' \
    "$(sed -n 's/.* stage=\([^ ]*\).*/\1/p' <<<"$plan" | sort | uniq -u | names)"
is 'make demo: two limits' 'immobile inviscid' \
    "$(grep -o -- '--set .liquid=[a-z]*' <<<"$plan" | cut -d= -f2 | sort | names)"

# Draws of the throat radii, where the scene draws some.
seeds() { sed -n "s/.* stage=dry .*set=.liquid=$1. \(set=.throat_radius.seed=\([0-9]*\)\)\?.*/s\2/p" | sort | names; }
is 'a scene that draws no radii dries once' 's s' "$(seeds inviscid <<<"$plan") $(seeds immobile <<<"$plan")"
is 'also where one draw is asked for' 's s' \
    "$(make -n demo DEMO_SEEDS=1 | tee said | seeds inviscid) $(seeds immobile <said)"
is 'so it takes no seeds' 2 "$(make -n demo DEMO_SEEDS='1 2' >said 2>&1; echo $?)"
jq '.dry.throat_radius = {"distribution": "normal", "seed": 5}' $scene >samples/stiff-5x5x10.json
plan=$(make -n demo)
is 'one that does: eight draws, the first its own' 's s10 s11 s12 s6 s7 s8 s9' "$(seeds inviscid <<<"$plan")"
is 'in both limits' "$(seeds inviscid <<<"$plan")" "$(seeds immobile <<<"$plan")"
is 'or those that are asked for, each once' 's s3 s7' "$(make -n demo DEMO_SEEDS='7 5 3 7' | seeds inviscid)"
is 'whole numbers only' 'must be whole numbers' \
    "$(make -n demo DEMO_SEEDS='1;touch PWN' 2>&1 | grep -o 'must be whole numbers')"
cat >pipelines/figures/crack-patterns <<'END'
#!/bin/bash
touch "${!#}"
END
: >ran
make demo DEMO_SEEDS='5 3' >said 2>&1
is 'they pass through the same pipeline: a network, and per draw and limit the rest' \
    '6 crackstats 4 dem-replay 4 dry 4 force-protocol 1 merge-nodes 1 pack 3 report 1 tessellate' \
    "$(sort ran | uniq -c | names)"
: >ran
make demo DEMO_SEEDS='5 3 8' >said 2>&1
is 'one more: nothing else again' '4 crackstats 2 dem-replay 2 dry 2 force-protocol 3 report' \
    "$(sort ran | uniq -c | names)"
: >ran
make run SCENE=samples/stiff-5x5x10.json >said 2>&1
is 'nor the network, for a run of the scene' '1 crackstats 1 dem-replay 1 dry 1 force-protocol' "$(sort ran | uniq -c | names)"

# --- studies with scenes of their own -------------------------------------------------------

touch grains.txt
for goal in coupled curves percolation; do
    for given in SCENE=samples/stiff-5x5x10.json IMPORT=grains.txt; do
        is "make $goal ${given%=*}= is refused" "${given%=*}: make $goal takes none" "$(make -n $goal "$given" 2>&1 | grep -o "${given%=*}: make .*none")"
    done
done
is 'make large takes another scene by LARGE_SCENE' LARGE_SCENE "$(make -n large SCENE=$scene 2>&1 | grep -o LARGE_SCENE)"
is 'and its grains by IMPORT' 1 "$(make -n large LARGE_SCENE=$scene IMPORT=grains.txt | grep -c 'pack.* grains.txt')"

# --- layers that crack ----------------------------------------------------------------------

is 'a layer of no scene' 'nowhere.json: no such file' "$(make -n craquelure SCENE=nowhere.json 2>&1 | grep -o 'nowhere.*file')"
touch grains.txt
is 'several seeds of grains that do not change' 'CRAQUELURE_SEEDS: one only' \
    "$(make -n craquelure SCENE=samples/stiff-5x5x10.json IMPORT=grains.txt CRAQUELURE_SEEDS='1 2' 2>&1 | grep -o 'CRAQ[^,]*')"
jq '.pack.method = "explosive_repulsion"' $scene >samples/apart.json
several=(IMPORT=grains.txt CRAQUELURE_SEEDS='1 2')
is 'several seeds of grains that these move apart' 'seed=1 seed=2' \
    "$(make -n craquelure SCENE=samples/apart.json "${several[@]}" | grep -o "set .seed=[12]" | grep -o 'seed=.' | sort -u | names)"
is 'as SET has it' "2 0" "$(make -n craquelure SCENE=samples/apart.json SET=pack.method=import "${several[@]}" >said 2>&1; echo $?) $(
    make -n craquelure SCENE=samples/x.json SET=pack.method=explosive_repulsion "${several[@]}" >said 2>&1; echo $?)"

# Both make a folder of the scene's name.
cp $scene samples/layer.json
both=$(make -n run craquelure SCENE=samples/layer.json | grep -o 'output=[^ ]*' | sort)
is 'a run of a layer that cracks, and its polygons, share no file' '' "$(uniq -d <<<"$both")"
is 'each has a table of its own' 'output=build/runs/layer/crackstats.json output=build/runs/layer/polygons.json' \
    "$(grep '\.json$' <<<"$both" | names)"

# A layer that dem-replay drains takes no drying.
jq '.["dem-replay"].capillary = {"suction": 1e6}' $scene >samples/drains.json
for goal in run report demo; do
    : >ran
    is "make $goal of a layer that drains is refused" 2 "$(make $goal SCENE=samples/drains.json >said 2>&1; echo $?)"
    is "make $goal: in a line that says what to do" 'make craquelure SCENE=samples/drains.json' \
        "$(grep -c . <(grep -v '^make: ' said) | grep -x 1 >/dev/null && grep -o 'make craquelure .*' said)"
    is "make $goal: before anything runs" '' "$(names <ran)"
done
mkdir own
cp stage own/dem-replay
echo 1 >own/dem-replay.version
: >ran
make run SCENE=samples/drains.json DEM_REPLAY=own/dem-replay >said 2>&1
is 'but not where another program replays' 1 "$(grep -cx dem-replay ran)"

# --- what a run comes down to, in a line ---------------------------------------------------

told() { jq -rf pipelines/run/headline.jq --arg draws 'draws of the throat radii' <<<"$1"; }
cracks() { echo "{\"total\": $1, \"normal\": $2, \"shear\": $3}"; }
is 'one run' 'one run: 75 of 625 bonds broke, 24 in tension, 51 in shear; every load came to rest' \
    "$(told "{\"runs\": 1, \"bonds\": 625, \"cracks\": $(cracks 75 24 51), \"confidence_interval\": null,
        \"mean\": {\"cracks\": $(cracks 75 24 51), \"unsettled\": {\"loads\": 0, \"cracks\": 0}}}")"
again='. That count may change once grains come to rest: run again with dem-replay.engine=explicit and
 twice the dem-replay.cycles and most_cycles, and compare'
again=${again//$'\n'/}
is 'one that did not settle: what to do' \
    'one run: 5 of 9 bonds broke, 2 in tension, 3 in shear; grains still moved at the end of 1 load, under which 2 bonds broke'"$again" \
    "$(told "{\"runs\": 1, \"bonds\": 9, \"cracks\": $(cracks 5 2 3), \"confidence_interval\": null,
        \"mean\": {\"cracks\": $(cracks 5 2 3), \"unsettled\": {\"loads\": 1, \"cracks\": 2}}}")"
many="{\"runs\": 2, \"bonds\": 625, \"confidence_interval\": {\"cracks\": {\"total\": [67.6, 82.4]}},
    \"each\": [{\"cracks\": $(cracks 57 1 56)}, {\"cracks\": $(cracks 100 3 97)}],
    \"parameters\": {\"confidence\": 0.95},
    \"mean\": {\"cracks\": $(cracks 78.5 2 76.5), \"unsettled\": {\"loads\": 1.25, \"cracks\": 10.2}}}"
is 'many' "79 of 625 bonds broke (95 % interval of the mean 68 to 82, 2 draws of the throat radii: 57 to 100), 2 in tension,\
 77 in shear; grains still moved at the end of 1.3 loads a run, under which 10 bonds broke$again" "$(told "$many")"
is 'nothing to do where no bond broke then' 'the end of 1 load, under which 0 bonds broke' \
    "$(told "{\"bonds\": 9, \"cracks\": $(cracks 5 2 3), \"mean\": {\"cracks\": $(cracks 5 2 3),
        \"unsettled\": {\"loads\": 1, \"cracks\": 0}}}" | grep -o 'the end.*')"
is 'no count is below 0' '0 to 82' \
    "$(told "$(jq '.confidence_interval.cracks.total[0] = -3' <<<"$many")" | grep -o '[-0-9]* to 82')"
is 'counts and no more, of a program in place of crackstats' 'one run: 7 of 8 bonds broke, 4 in tension, 3 in shear' \
    "$(told "{\"bonds\": 8, \"cracks\": $(cracks 7 4 3)}")"

finish
