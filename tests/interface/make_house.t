#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The targets that keep the house: help, deps, what recompiles what, install.
source tests/interface/make_tap.sh

# --- help --------------------------------------------------------------------------------

help=$(make help)
for target in deps all demo run check hard bench install uninstall sanitize clean; do
    is "make help tells of $target" 1 "$(grep -c "^  $target  *[a-z]" <<<"$help")"
done

# --- deps, with an apt that only notes what it is asked ------------------------------------

mkdir -p "$scratch/fake"
cd "$scratch" || exit
cp -r "$tree/Makefile" "$tree/VERSION" "$tree/pipelines" "$tree/tools" .
cat >fake/dpkg-query <<'END'
#!/bin/bash
[[ " $(cat "$SCRATCH/missing" 2>/dev/null) " == *" ${!#} "* ]] && exit 1
echo 'install ok installed'
END
cat >fake/apt-get <<'END'
#!/bin/bash
echo "$*" >>"$SCRATCH/asked"
seq 800 # lines of news
[[ -e $SCRATCH/no-network ]] && { echo "E: no network" >&2; exit 100; }
[[ $1 == install ]] && rm "$SCRATCH/missing"
exit 0
END
printf '#!/bin/bash\nexec "$@"\n' >fake/sudo
chmod +x fake/*
export SCRATCH=$scratch
with_fakes() { PATH=$scratch/fake:$PATH "$@"; }

is 'make deps with nothing missing says nothing' '' "$(with_fakes make deps 2>&1)"
is 'and asks apt for nothing' '' "$(cat asked 2>/dev/null)"
echo 'jq libgsl-dev' >missing
with_fakes make deps >said 2>&1
is 'make deps says what it installs, in a line' '  APT    libgsl-dev jq' "$(sed 's/jq libgsl-dev/libgsl-dev jq/' said)"
is 'make deps installs what is missing, no more' \
    $'update\ninstall -y --no-install-recommends libgsl-dev jq' \
    "$(sed 's/libgsl-dev jq$/&/;s/jq libgsl-dev$/libgsl-dev jq/' asked)"

echo jq >missing
touch no-network
with_fakes make deps >said 2>&1
is 'where apt fails, make does, and shows the end of what apt said' '2 E: no network' \
    "$? $(grep -o '^E: .*' said)"
is 'in few lines' yes "$( (( $(wc -l <said) < 25 )) && echo yes)"
rm no-network
mkdir pipelines/studies/goals
cat >pipelines/studies/goals/study.mk <<'END'
first second: ; @echo $@ >>asked
END
: >asked
echo jq >missing
with_fakes make -j2 second deps first >/dev/null 2>&1
is 'deps comes first, whatever the order and -j' 'update install first second' \
    "$(head -2 asked | cut -d' ' -f1 | xargs) $(tail -n +3 asked | sort | xargs)"

mkdir build
is 'so does clean' 'build gone' "$(make first clean >/dev/null; ls -d build 2>/dev/null || echo build gone)"

# --- what recompiles what ------------------------------------------------------------------

mkdir -p stages/one stages/two stages/lib/basics stages/lib/artifacts schemas tests/unit
echo '{}' >schemas/a.json
cat >stages/lib/artifacts/schemas.S <<'END'
    .global schema_a
schema_a: .incbin "schemas/a.json"
    .byte 0
    .section .note.GNU-stack, "", @progbits
END
echo 'int shared(void);' >stages/lib/basics/shared.h
printf '#include "basics/shared.h"\nint shared(void) { return 4; }\n' \
    >stages/lib/basics/shared.c
for stage in one two; do
    printf 'int core_%s(void);\nint core_%s(void) { return 1; }\n' $stage $stage \
        >stages/$stage/core.c
    cat >stages/$stage/main.c <<'END'
#include "basics/shared.h"
#include <stdio.h>
int main(void)
{
    return printf("%d %s %d\n", STAGE_VERSION, CRAQUELURE_VERSION, shared()) < 0;
}
END
done
echo 7 >stages/one/version
cat >tests/unit/cores.c <<'END'
#include <stdio.h>
int core_one(void);
int core_two(void);
int main(void)
{
    return printf("1..1\n%s 1\n", core_one() + core_two() == 2 ? "ok" : "not ok") < 0;
}
END
# compiled: what make does, sorted
compiled() { make "$@" 2>&1 | sed -n 's/^  \(CC\|AS\|LINK\)  *//p' | sort | xargs; }

compiled >/dev/null
is 'a program knows its version' '7 0.1.0 4' "$(build/bin/one)"
is 'a stage without one is version 1' '1 0.1.0 4' "$(build/bin/two)"
is 'nothing to do' 0 "$(make -q; echo $?)"
echo 8 >stages/one/version
is 'a new version recompiles its stage' 'one stages/one/core.c stages/one/main.c' \
    "$(compiled)"
is 'which then says it' '8 0.1.0 4' "$(build/bin/one)"
touch stages/lib/basics/shared.h
is 'a header recompiles what includes it' \
    'one stages/lib/basics/shared.c stages/one/main.c stages/two/main.c two' "$(compiled)"
touch schemas/a.json
is 'a schema goes into the library' 'one stages/lib/artifacts/schemas.S two' "$(compiled)"
is 'other flags: make -q' 1 "$(make -q EXTRA_CFLAGS=-DX; echo $?)"
is 'other flags recompile all' \
    'one stages/lib/artifacts/schemas.S stages/lib/basics/shared.c stages/one/core.c stages/one/main.c stages/two/core.c stages/two/main.c two' \
    "$(compiled EXTRA_CFLAGS=-DX)"
is 'the same flags nothing' 0 "$(make -q EXTRA_CFLAGS=-DX; echo $?)"
rm stages/two/core.c
is 'a removed source relinks' 'one two' "$(compiled EXTRA_CFLAGS=-DX)"

# --- install -------------------------------------------------------------------------------

cd "$tree" || exit
export PREFIX=/opt/x DESTDIR=$scratch/dest
yes 'make install' flock "$BIN" make install
root=$scratch/dest/opt/x
stages=$(cd "$BIN" && echo *)
is 'every stage is installed' "$stages" "$(cd "$root/libexec/craquelure" && echo *)"
is 'and nothing but the front command is in the path' craquelure "$(ls "$root/bin")"
listed=$("$root/bin/craquelure" --help | sed -n 's/^  \([a-z-]*\)  .*/\1/p' | sort | xargs)
is 'craquelure --help lists them all' "$stages" "$listed"
cut_off=$(for stage in $stages; do "$root/libexec/craquelure/$stage" --help | sed -n 3p; done | xargs)
is 'each with the whole line of what it does' '' "$cut_off"
is 'craquelure --version' 'craquelure 0.1.0' "$("$root/bin/craquelure" --version)"
is 'craquelure dry --version' "$("$BIN/dry" --version)" "$("$root/bin/craquelure" dry --version)"
ln -s "$root/bin/craquelure" "$scratch/link"
is 'through a link' "$("$BIN/dry" --version)" "$("$scratch/link" dry --version)"
is 'craquelure help dry' "$("$BIN/dry" --help)" "$("$root/bin/craquelure" help dry)"
is 'craquelure without a stage' 64 "$("$root/bin/craquelure" 2>/dev/null; echo $?)"
is 'craquelure with an unknown stage' 64 "$("$root/bin/craquelure" dri 2>/dev/null; echo $?)"
"$BIN/pack" -p samples/stiff-5x5x10.json >"$scratch/a"
"$root/bin/craquelure" pack -p samples/stiff-5x5x10.json >"$scratch/b"
yes 'craquelure pack makes what pack makes' cmp "$scratch/a" "$scratch/b"
for stage in $stages; do
    page=$root/share/man/man1/craquelure-$stage.1
    is "craquelure-$stage.1 has a name and a synopsis" '.SH NAME .SH SYNOPSIS' \
        "$(grep -xE '\.SH (NAME|SYNOPSIS)' "$page" | xargs)"
done
is 'a man page tells each parameter' 1 \
    "$(grep -c '^ *boundary_layer.mass_transfer=' "$root/share/man/man1/craquelure-dry.1")"

# complete WORD...: what bash offers for the last word of a command line
complete_words()
{
    bash -c 'compopt() { :; }; source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(( $# - 1 ))
        _craquelure; echo "${COMPREPLY[*]}"' - \
        "$root/share/bash-completion/completions/craquelure" "$@"
}
is 'completion of stages' 'deform dem-replay dry demo' "$(complete_words craquelure d)"
is 'completion of options' '--threads' "$(complete_words craquelure dry --th)"
is 'completion of parameters' 'liquid= liquid_density=' "$(complete_words craquelure dry --set liq)"

yes 'make uninstall' make uninstall
is 'leaves nothing' '' "$(find "$scratch/dest" -type f)"

finish
