# SPDX-License-Identifier: GPL-3.0-or-later
# Variable: tables, the folder of the tables that pipelines/figures/soft makes.
set terminal @svg "Helvetica,15" size 1000,960
set multiplot
unset key

# --- contact forces in the middle row, grains where they are: black pushes, red pulls ---
most = 0
do for [k = 1:3] {
    stats sprintf("%s/forces-%d", tables, k) using (abs($5)) nooutput
    most = STATS_max > most ? STATS_max : most
}
do for [s = 1:8] {
    set style arrow s nohead linewidth 1.1 * s linecolor rgb black
    set style arrow 8 + s nohead linewidth 1.1 * s linecolor rgb red
}
style(f) = (abs(f) < most / 80 ? 1 : int(ceil(8 * abs(f) / most))) + (f < 0 ? 8 : 0)
stats tables . "/grains-0" using 1:2 nooutput
set xrange [STATS_min_x - 0.1:STATS_max_x + 0.1]
set yrange [STATS_min_y - 0.1:STATS_max_y + 0.1]
set size ratio -1
unset border
unset tics
left(c) = 0.02 + 0.5 * c
set label 2 sprintf("Grains where they are, not exaggerated. Contact forces: black pushes, red pulls; widest: %.3g µN", 1e6 * most) \
    at screen 0.5, screen 0.405 center textcolor rgb grey
heading = "'before' 'all liquid, no pore empty' 'half of the liquid' 'dry'"
do for [k = 0:3] {
    c = k % 2; r = k / 2
    set lmargin at screen left(c); set rmargin at screen left(c) + 0.46
    set tmargin at screen 0.955 - 0.29 * r; set bmargin at screen 0.7 - 0.29 * r
    set label 1 word(heading, k + 1) at screen left(c) + 0.23, screen 0.975 - 0.29 * r center textcolor rgb black
    plot sprintf("%s/grains-%d", tables, k) using 1:2 with filledcurves closed linecolor rgb "#c9d6e6" fillstyle transparent solid 0.35 border, \
        sprintf("%s/forces-%d", tables, k) using 1:2:3:4:(style($5)) with vectors arrowstyle variable
}
unset label 1
unset label 2
set size noratio

# --- strain -------------------------------------------------------------------------------
set border 3 linecolor "#555555"
set xtics nomirror out scale 0.6 textcolor black
set ytics nomirror out scale 0.6 textcolor black
set grid xtics ytics linetype 1 linecolor "#e4e4e4" linewidth 1
panel = "set lmargin at screen 0.09 + 0.5 * c; set rmargin at screen 0.47 + 0.5 * c; \
    set tmargin at screen 0.345; set bmargin at screen 0.07; \
    set label 1 title at screen 0.09 + 0.5 * c, screen 0.37 left textcolor rgb black"
c = 0; title = "Shrinkage, % (the volume, and along x, y, z)"
@panel
set xlabel "saturation" offset 0,0.4
set xrange [1:0]
set yrange [*:*]
set key right top samplen 2 textcolor rgb black
plot tables . "/strain" using 1:(100 * $2) with lines linewidth 2.5 linecolor rgb black title "volume", \
    "" using 1:(-100 * $3) with lines linewidth 2 linecolor rgb blue title "x", \
    "" using 1:(-100 * $4) with lines linewidth 2 linecolor rgb sky title "y", \
    "" using 1:(-100 * $5) with lines linewidth 2 linecolor rgb red title "z"
unset key

c = 1; title = "Left when dry  (dashed: the largest, squared)"
@panel
set xrange [*:*]
set logscale xy
set format xy "10^{%T}"
set xlabel "largest shrinkage of the volume" offset 0,0.4
plot tables . "/left" using 1:($1 * $1) with lines dashtype (6, 4) linewidth 1.5 linecolor rgb grey, \
    "" using 1:2 with linespoints linewidth 2 pointtype 7 pointsize 0.6 linecolor rgb blue
unset multiplot
