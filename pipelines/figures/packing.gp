# SPDX-License-Identifier: GPL-3.0-or-later
# The structure of a packing in four panels. Variables: tables, the folder of the tables
# that pipelines/figures/packing makes; the numbers of the summary it passes on.
set terminal @svg "Helvetica,15" size 1000,760
set multiplot
@axes
unset key
set style fill solid 1 noborder

table(name) = tables . "/" . name
rows(name) = int(system("grep -c . " . table(name) . " || true"))
left(column) = 0.085 + 0.5 * column
panel = "set lmargin at screen left(c); set rmargin at screen left(c) + 0.395; \
    set tmargin at screen 0.945 - 0.5 * r; set bmargin at screen 0.59 - 0.5 * r; \
    set label 1 title at screen left(c), screen 0.975 - 0.5 * r left textcolor '#222222'"
nothing = "set xrange [0:1]; set yrange [0:1]; unset tics; unset grid; unset xlabel; unset ylabel; set border 0; \
    set label 2 'not known for this packing' at graph 0.5, graph 0.5 center textcolor rgb grey; \
    plot NaN; unset label 2; @axes; set xtics autofreq; set ytics autofreq; set autoscale"

# --- porosity in slices -----------------------------------------------------------------
c = 0; r = 0
title = "Porosity in slices" . (bulk == bulk ? sprintf("  (dashed: bulk, %.3f)", bulk) : "")
@panel
set xlabel "height / mean diameter" offset 0,0.4
set ylabel "porosity" offset 1,0
set xrange [0:(upper - lower) / (2 * radius)]
set yrange [0:1]
set ytics 0.2
if (rows("slices") > 0) {
    plot bulk with lines linewidth 1.5 dashtype (6, 4) linecolor rgb red, \
        table("slices") using (($1 - lower) / (2 * radius)):2 with lines linewidth 2 linecolor rgb blue
} else { @nothing }

# --- contacts ---------------------------------------------------------------------------
c = 1; r = 0
title = sprintf("Contacts of a grain  (mean %.2f, rattlers %.3g %%)", coordination, \
    grains > 0 ? 100. * rattlers / grains : 0)
@panel
set xlabel "touching neighbours" offset 0,0.4
set ylabel "share of the grains" offset 1,0
set yrange [0:*]
set xrange [-0.7:*]
set xtics 2
set ytics autofreq
set boxwidth 0.8
if (rows("contacts") > 0) {
    most = rows("contacts") > 6 ? rows("contacts") - 1 : 6
    set xrange [-0.7:most + 0.7]
    if (most < 9) { set xtics 1 }
    plot table("contacts") using 1:($2 / grains) with boxes linecolor rgb blue
} else { @nothing }

# --- radial distribution ----------------------------------------------------------------
c = 0; r = 1
title = "Radial distribution of the centres"
@panel
set xlabel "distance / mean diameter" offset 0,0.4
set ylabel "g(r)" offset 1,0
set xrange [0:5]
set yrange [0:*]
set xtics 1
if (rows("distances") > 0) {
    plot 1 with lines linewidth 1.5 dashtype (6, 4) linecolor rgb red, \
        table("distances") using ($1 / (2 * radius)):2 with lines linewidth 2 linecolor rgb blue
} else { @nothing }

# --- sizes, or directions ---------------------------------------------------------------
c = 1; r = 1
if (rows("sizes") > 0) {
    title = "Sizes of the grains"
    @panel
    set xlabel "radius / mean radius" offset 0,0.4
    set ylabel "share of the grains" offset 1,0
    set xrange [*:*]
    set xtics autofreq
    set yrange [*:*]
    stats table("sizes") using 1 nooutput
    set yrange [0:*]
    step = (STATS_max - STATS_min) / (rows("sizes") - 1) / radius
    set boxwidth 0.86 * step
    plot table("sizes") using ($1 / radius):($2 / grains) with boxes linecolor rgb blue
} else { if (rows("inclinations") > 0) {
    title = sprintf("Directions of the contacts  (fabric deviator %.3f)", deviator)
    @panel
    set xrange [*:*]
    set yrange [*:*]
    stats table("inclinations") using 2 nooutput
    most = STATS_max > 1.25 ? STATS_max : 1.25
    unset border; unset tics; unset grid; unset xlabel; unset ylabel
    set lmargin at screen left(c) + 0.06
    set rmargin at screen left(c) + 0.335
    set bmargin at screen 0.04
    set tmargin at screen 0.445
    set size ratio -1
    set xrange [-1.15 * most:1.15 * most]
    set yrange [-1.15 * most:1.15 * most]
    set label 3 "z" at 0, 1.08 * most center textcolor rgb grey
    set arrow 1 from 0, -1.02 * most to 0, 1.02 * most nohead linecolor "#c8c8c8" back
    set arrow 2 from -1.02 * most, 0 to 1.02 * most, 0 nohead linecolor "#c8c8c8" back
    set label 4 "dashed: isotropic" at graph 1.02, graph 0.02 right textcolor rgb red font ",13"
    set object 1 circle at 0, 0 size 1 front linewidth 1.5 dashtype (6, 4) fillstyle empty border rgb red
    plot table("rose") using (0):(0):1:2:3 with circles linecolor rgb blue
} else {
    title = "Directions of the contacts"
    @panel
    @nothing
} }
unset multiplot
