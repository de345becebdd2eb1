# SPDX-License-Identifier: GPL-3.0-or-later
# What the measuring scripts share; sourced by them in the folder of the tree.
# shellcheck shell=bash
bin=${BIN:-build/bin}
bench_dem=${bin%/bin}/tests/bench/bench_dem
export OMP_NUM_THREADS=1

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

has()
{
    command -v "$1" >/dev/null
}

title()
{
    printf '\n%s\n\n' "$1"
}

# Seconds that the command takes.
seconds()
{
    local start=$EPOCHREALTIME
    "$@" >/dev/null
    awk -v a="$start" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.4f", b - a }'
}

# Of the numbers in the file.
median()
{
    sort -g "$1" | awk '{ x[NR] = $1 }
        END { printf "%.6g", (x[int((NR + 1) / 2)] + x[int((NR + 2) / 2)]) / 2 }'
}

calculate()
{
    awk "BEGIN { printf \"$1\", $2 }"
}

# Runs $2 and $3 by turns $1 times; each prints a number. Medians in $ours and $peer, and of
# their ratio in $ratio, with its range in $range.
alternate()
{
    local k
    for ((k = 0; k < $1; k++)); do
        "$2" >>"$folder/ours"
        "$3" >>"$folder/peer"
    done
    paste "$folder/ours" "$folder/peer" | awk '{ print $1 / $2 }' | sort -g >"$folder/ratios"
    ours=$(median "$folder/ours") peer=$(median "$folder/peer")
    ratio=$(median "$folder/ratios")
    range=$(awk 'NR == 1 { printf "%.2f", $1 } END { printf " to %.2f", $1 }' "$folder/ratios")
    rm "$folder/ours" "$folder/peer" "$folder/ratios"
}

# For a peer that is not installed.
nothing()
{
    echo nan
}
