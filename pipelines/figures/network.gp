# SPDX-License-Identifier: GPL-3.0-or-later
# Pore networks, a column each, in four rows. Variables: tables, the folder of the tables that
# pipelines/figures/network makes; columns; unit, what lengths are given in.
wide = columns < 3 ? 400 : 300
set terminal @svg "Helvetica,14" size 70 + wide * columns, 330 + 3 * 230
set multiplot

table(name, k) = sprintf("%s/%s-%d", tables, name, k)
total = 330.0 + 3 * 230
left(c) = (64.0 + wide * c) / (70 + wide * columns)
right(c) = (44.0 + wide * (c + 1)) / (70 + wide * columns)
# Row 0 is the slice, 300 high; rows 1 to 3 the distributions.
top(r) = 1 - (r == 0 ? 44 : 330 + 230 * (r - 1) + 22) / total
bottom(r) = 1 - (r == 0 ? 292 : 330 + 230 * (r - 1) + 172) / total
panel = "set lmargin at screen left(c); set rmargin at screen right(c); \
    set tmargin at screen top(r); set bmargin at screen bottom(r)"

# --- slices -----------------------------------------------------------------------------
set palette maxcolors 7
set palette defined (2 "#b0b0b0", 3 "#2c7bb6", 4 "#7fc8e8", 5 "#f2c230", 6 "#f08030", 7 "#d6201c", 8 "#7a0177")
set cbrange [1.5:8.5]
unset key
unset border
unset tics
set cbtics ("2" 2, "3" 3, "4" 4, "5" 5, "6" 6, "7" 7, "8+" 8) scale 0 offset 0,0.5
set size ratio -1
r = 0
size = int(system("wc -l <" . table("nodes", 0))) > 3000 ? 0.3 : 0.5
do for [c = 0:columns - 1] {
    @panel
    set autoscale xy # what stats sees is what is in range
    stats table("nodes", c) using 2 nooutput
    set yrange [STATS_min - 0.5:STATS_max + 0.5]
    stats table("nodes", c) using 1 nooutput
    set xrange [STATS_min - 0.5:STATS_max + 0.5]
    nodes = int(system("wc -l <" . table("nodes", c)))
    throats = int(system("wc -l <" . sprintf("%s/length-%d-all", tables, c)))
    set label 1 sprintf("(%c)  %d nodes, %d throats", 97 + c, nodes, throats) \
        at screen left(c), screen 1 - 22 / total left textcolor '#222222'
    if (c == 0) {
        set colorbox horizontal user origin screen left(0), screen 1 - 312 / total \
            size screen 0.9 * (right(0) - left(0)), screen 8 / total
        set label 2 "throats at a node" at screen right(0), screen 1 - 309 / total left textcolor '#222222'
    } else { unset colorbox; unset label 2 }
    plot table("slice", c) using 1:2 with lines linecolor "#b8b8b8", \
        table("nodes", c) using ($4 > 0 ? $1 : NaN):2:($3 > 8 ? 8 : $3 < 2 ? 2 : $3) \
            with points pointtype 7 pointsize size linecolor palette
}
unset colorbox
unset label 1
unset label 2
set size noratio

# --- distributions ----------------------------------------------------------------------
@axes
set style fill solid 1 noborder
words = "coordination length radius"
labels = "'throats at a node' 'throat length / " . unit . "' 'throat radius / " . unit . "'"
do for [r = 1:3] {
    what = word(words, r)
    most = 0; farthest = 0
    set autoscale xy
    do for [c = 0:columns - 1] {
        stats table(what, c) using 2 nooutput
        most = STATS_max > most ? STATS_max : most
        stats table(what, c) using 1 nooutput
        farthest = STATS_max > farthest ? STATS_max : farthest
    }
    if (r == 1) { farthest = farthest > 14 ? 14 : farthest < 8 ? 8 : farthest }
    step = r == 1 ? 1.0 : farthest / 29.5
    set boxwidth (r == 1 ? 0.8 : 0.9 * step)
    set yrange [0:1.08 * most]
    set xrange [(r == 1 ? 0.5 : 0):farthest + step / 2]
    set xtics autofreq nomirror
    set ytics autofreq nomirror
    if (r == 1) { set xtics 2 nomirror }
    set xlabel word(labels, r) offset 0,0.4
    do for [c = 0:columns - 1] {
        @panel
        if (c == 0) { set ylabel (r == 1 ? "share of the nodes" : "density") offset 1,0; set format y "%g" } \
        else { unset ylabel; set format y "" }
        plot table(what, c) using 1:2 with boxes linecolor rgb blue
    }
}
unset multiplot
