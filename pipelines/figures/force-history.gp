# SPDX-License-Identifier: GPL-3.0-or-later
# Variables: tables, the folder of the tables that pipelines/figures/force-history makes; strength of the
# bond, nN.
set terminal @svg "Helvetica,15" size 1000,380
set multiplot
@axes
set xrange [1:0]
set xlabel "saturation" offset 0,0.4
set xzeroaxis linetype 1 linecolor "#888888" linewidth 1
name = "inviscid immobile"
left(c) = 0.07 + 0.5 * c
panel = "set lmargin at screen left(c); set rmargin at screen left(c) + 0.4; \
    set tmargin at screen 0.88; set bmargin at screen 0.17; \
    set label 1 heading at screen left(c), screen 0.94 left textcolor '#222222'; \
    plot for [k = 0:1] sprintf('%s/force-%d', tables, k) using 1:(1e9 * $2) with linespoints pointtype 7 pointsize 0.4 \
        linewidth 1.6 linecolor rgb (k ? immobile : inviscid) title word(name, k + 1)"
c = 0; heading = "Normal force of the contact, nN"
set yrange [*:*]
set key top right samplen 2 textcolor "#222222"
@panel
c = 1; heading = "Where it pulls; dashed: its strength"
set yrange [-2:2]
unset key
set arrow 1 from graph 0, first -strength to graph 1, first -strength nohead dashtype (6, 4) linewidth 1.5 \
    linecolor "#222222"
@panel
unset multiplot
