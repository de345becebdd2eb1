# SPDX-License-Identifier: GPL-3.0-or-later
# Boundary layers, two a row. Variables: tables, the folder of the tables that
# pipelines/figures/boundary-layer makes; columns, how many there are.
wide = 440; high = 430
rows = (columns + 1) / 2
set terminal @svg "Helvetica,14" size (columns > 1 ? 2 : 1) * wide, rows * high + 44
set multiplot
table(name, k) = sprintf("%s/%s-%d", tables, name, k)
said(k, word) = int(system("cut -d' ' -f" . word . " " . table("said", k)))
x(k) = (k % 2) / (columns > 1 ? 2.0 : 1.0)
y(k) = 1 - ((k / 2 + 1) * high + 44) / (rows * high + 44.0)

unset border
unset tics
unset key
set size ratio -1
do for [k = 0:columns - 1] {
    flat = said(k, 1)
    set lmargin at screen x(k) + 0.02
    set rmargin at screen x(k) + (columns > 1 ? 0.48 : 0.98)
    set bmargin at screen y(k) + 10 / (rows * high + 44.0)
    set tmargin at screen y(k) + (high - 34) / (rows * high + 44.0)
    set label 1 sprintf(flat ? "(%c)  %d columns of %d layers, from the side" : "(%c)  %d exchange areas, from above", \
        97 + k, said(k, 2), said(k, 3)) at screen x(k) + 0.03, screen y(k) + (high - 14) / (rows * high + 44.0) \
        left textcolor "#222222"
    set autoscale xy
    stats table(flat ? "grains" : "rectangle", k) using 1 nooutput # what is in range
    least = STATS_min - 0.6; most = STATS_max + 0.6
    stats table(flat ? "column" : "rectangle", k) using 2 nooutput
    set xrange [least:most]
    set yrange [(flat ? -0.6 : STATS_min - 0.6):STATS_max + 0.6]
    if (flat) {
        plot table("grains", k) with filledcurves closed fillcolor "#e9e4da" fillstyle solid noborder, \
            table("grains", k) with lines linecolor "#b8b0a0", \
            table("auxiliary", k) with lines linecolor "#909090" dashtype 2, \
            table("lateral", k) with lines linecolor "#9cc7e8", \
            table("column", k) with lines linecolor "#9cc7e8", \
            table("layer", k) with lines linecolor rgb grey linewidth 2, \
            table("liquid", k) with lines linecolor rgb blue linewidth 2, \
            table("foot", k) with points pointtype 7 pointsize 0.5 linecolor rgb red
    } else {
        plot table("area", k) with lines linecolor rgb blue, \
            table("rectangle", k) with lines linecolor "#222222", \
            table("foot", k) with points pointtype 7 pointsize 0.35 linecolor rgb red
    }
}

# --- what is what -----------------------------------------------------------------------
unset label 1
set lmargin at screen 0
set rmargin at screen 1
set bmargin at screen 0
set tmargin at screen 1
set xrange [0:1]
set yrange [0:1]
set size noratio
dy = 22 / (rows * high + 44.0)
word = "'liquid throat' 'auxiliary throat' 'column, lateral link' 'node with a column'"
colour = blue . " " . grey . " #9cc7e8 " . red
do for [i = 1:4] {
    at = 0.04 + 0.24 * (i - 1)
    if (i < 4) { set arrow from at, 1 - dy to at + 0.03, 1 - dy nohead linewidth 2 linecolor rgb word(colour, i) }
    set label word(word, i) at at + 0.038, 1 - dy left textcolor "#222222"
}
plot "+" using (0.775):(1 - dy) every ::0::0 with points pointtype 7 pointsize 0.5 linecolor rgb red
unset multiplot
