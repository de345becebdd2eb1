# SPDX-License-Identifier: GPL-3.0-or-later
# What the programs of pipelines/ that draw and tell share; sourced. BIN (build/bin) is where the
# stages are. All data of artifacts come through `inspect` and jq.
set -euo pipefail
export LC_ALL=C
here=$(dirname "$(readlink -f "$0")")
lib=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
bin=${BIN:-$lib/../../build/bin}
inspect=$bin/inspect
tables=$(mktemp -d) # for what is drawn
trap 'rm -rf "$tables"' EXIT

colour() { # NAME, as style.gp has it
    sed -n "s/^$1 = \"\(#[0-9a-f]*\)\"$/\1/p" "$lib/style.gp"
}

usage() { # ARGUMENTS that the program takes
    echo "Usage: $0 $1" >&2
    exit 64
}

numbers() { # ARTIFACT DATASET: a row a line
    "$inspect" --data "$2" "$1" | jq -r '.[] | if type == "array" then flatten | map(tostring) | join(" ") else . end'
}

# Of a drying: saturation and rate.
rates() { paste -d' ' <(numbers "$1" /history/saturation) <(numbers "$1" /history/normalised_rate); }

# Of rows with a falling first column, those that are more than STEP below the last.
thin() { awk -v step="$1" 'NR == 1 || last - $1 > step { print; last = $1 }'; }

# Of a drying: depth, then the saturation of its slices in each snapshot.
profile() {
    paste -d' ' <(numbers "$1" /profiles/depth) <(numbers "$1" /profiles/slice_saturation |
        awk '{ for (s = 1; s <= NF; s++) value[s] = value[s] " " $s; n = NF }
            END { for (s = 1; s <= n; s++) print value[s] }')
}

# Throats with liquid in the first four snapshots of DRYING, one a row: an end, what leads to the
# other, along x and z in micrometres, and the saturation. To TABLE-1 to TABLE-4.
wet_throats() { # DRYING TABLE
    numbers "$1" /throats/nodes >"$tables/ends"
    numbers "$1" /nodes/position >"$tables/position"
    numbers "$1" /snapshots/throat_saturation >"$tables/states"
    awk -v table="$2" '
        FILENAME == ARGV[1] { a[FNR] = $1 + 1; b[FNR] = $2 + 1; next }
        FILENAME == ARGV[2] { x[FNR] = $1 * 1e6; z[FNR] = $3 * 1e6; next }
        FNR <= 4 { printf "" >(table "-" FNR)
            for (t = 1; t <= NF; t++) if ($t > 0)
                print x[a[t]], z[a[t]], x[b[t]] - x[a[t]], z[b[t]] - z[a[t]], $t >(table "-" FNR) }' \
        "$tables/ends" "$tables/position" "$tables/states"
}

# Has NAME.gp, called as the program, draw OUT from the tables and its VARIABLES.
draw() { # OUT [VARIABLES]
    gnuplot -e "tables = '$tables'; ${2-}" "$lib/style.gp" "$here/${0##*/}.gp" >"$tables/picture"
    cp "$tables/picture" "$1" # which may lead elsewhere
}
