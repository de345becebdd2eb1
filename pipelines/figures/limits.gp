# SPDX-License-Identifier: GPL-3.0-or-later
# Variables: tables, the folder of the tables that pipelines/figures/limits makes; levels
# of saturation; p, of the three tests, with | between.
set terminal @svg "Helvetica,15" size 1180,440
set multiplot
set border 3 linecolor "#555555"
set tics nomirror out scale 0.6 textcolor "#222222"
set grid ytics linetype 1 linecolor "#e4e4e4" linewidth 1
left(c) = 0.05 + 0.33 * c
panel = "set lmargin at screen left(c); set rmargin at screen left(c) + 0.24; \
    set tmargin at screen 0.9; set bmargin at screen 0.16; \
    set label 1 heading at screen left(c), screen 0.95 left textcolor '#222222'"

p_of(k) = system(sprintf("echo '%s' | cut -d'|' -f%d", p, k))
c = 0; heading = "Cracks (bars: standard deviation)"
@panel
set style fill solid 1 noborder
set boxwidth 0.36
set xrange [-0.6:2.6]
set yrange [0:*]
set xtics ("normal" 0, "shear" 1, "total" 2) scale 0
do for [m = 1:3] { set label 10 + m p_of(m) at m - 1, graph -0.125 center font ",12" textcolor "#777777" }
if (strlen(p) > 2) { set label 14 "p: Mann and Whitney's test" at 1, graph -0.185 center font ",12" textcolor "#777777" }
set key left top samplen 1 textcolor "#222222"
plot tables . "/modes-0" using ($0 - 0.19):1 with boxes linecolor rgb inviscid title "inviscid", \
    tables . "/modes-1" using ($0 + 0.19):1 with boxes linecolor rgb immobile title "immobile", \
    tables . "/modes-0" using ($0 - 0.19):($1 - $2):(0):(2 * $2) with vectors nohead linewidth 1.5 linecolor rgb "#222222" notitle, \
    tables . "/modes-1" using ($0 + 0.19):($1 - $2):(0):(2 * $2) with vectors nohead linewidth 1.5 linecolor rgb "#222222" notitle
unset key
do for [m = 1:4] { unset label 10 + m }

set grid xtics
set xrange [0:1]
set xtics autofreq scale 0.6
set xtics 0.2
set xlabel "height over that of the box" offset 0,0.4
set y2range [0:1.02]
set y2tics 0.2 textcolor "#222222"
set ytics nomirror
set border 11
stats tables . "/profiles-0" using (column(2 * levels)) nooutput
most = STATS_max
stats tables . "/profiles-1" using (column(2 * levels)) nooutput
most = STATS_max > most ? STATS_max : most
set yrange [0:most > 0 ? 1.05 * most : 1]
name = "inviscid immobile"
do for [k = 0:1] {
    c = 1 + k; heading = word(name, k + 1) . ": cracks (full), saturation (dashed)"
    @panel
    plot for [l = 1:levels] sprintf("%s/profiles-%d", tables, k) using 1:(column(2 * l)) with lines linewidth 1.6 \
        linecolor rgb wet_to_dry((l - 1.0) / (levels - 1)), \
        for [l = 1:levels] sprintf("%s/profiles-%d", tables, k) using 1:(column(2 * l + 1)) axes x1y2 with lines linewidth 1 \
        dashtype (5, 4) linecolor rgb wet_to_dry((l - 1.0) / (levels - 1))
}
unset multiplot
