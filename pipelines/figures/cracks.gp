# SPDX-License-Identifier: GPL-3.0-or-later
# Variables: tables, the folder of the tables that pipelines/figures/cracks makes; n files.
set terminal @svg "Helvetica,15" size 1000,760
set multiplot
@axes
table(name, k) = sprintf("%s/%s-%d", tables, name, k)
rows(name, k) = int(system("grep -c . " . table(name, k) . " || true"))
title(k) = system(sprintf("sed -n %dp %s/titles", k, tables))
of(k) = series[(k - 1) % 6 + 1]
left(column) = 0.085 + 0.5 * column
panel = "set lmargin at screen left(c); set rmargin at screen left(c) + 0.395; \
    set tmargin at screen 0.945 - 0.5 * r; set bmargin at screen 0.59 - 0.5 * r; \
    set label 1 heading at screen left(c), screen 0.975 - 0.5 * r left textcolor '#222222'"

c = 0; r = 0; heading = "Cracks so far  (full: shear, dashed: normal)"
@panel
set xlabel "saturation" offset 0,0.4
set xrange [1:0]
set yrange [0:*]
unset key
plot for [k = 1:n] table("saturation", k) using 1:3 with lines linewidth 2 linecolor rgb of(k), \
    for [k = 1:n] table("saturation", k) using 1:2 with lines linewidth 2 dashtype (6, 4) linecolor rgb of(k)

c = 1; r = 0; heading = "Cracks in slices, from bottom to top"
@panel
set xlabel "height over that of the box" offset 0,0.4
set xrange [0:1]
plot for [k = 1:n] table("height", k) using 1:3 with linespoints linewidth 2 pointtype 7 pointsize 0.5 linecolor rgb of(k), \
    for [k = 1:n] table("height", k) using 1:2 with linespoints linewidth 2 pointtype 7 pointsize 0.5 dashtype (6, 4) linecolor rgb of(k)

c = 0; r = 1; heading = "Connected cracks of at least so many bonds"
@panel
set xlabel "broken bonds" offset 0,0.4
set xrange [0.8:*]
set yrange [*:*]
set logscale xy
set format xy "%g"
set key left bottom Left reverse samplen 2 textcolor "#222222"
any = 0
do for [k = 1:n] { any = any + rows("size", k) }
if (any > 0) {
    plot for [k = 1:n] (rows("size", k) > 0 ? table("size", k) : "< echo 1 nan") using 1:2 with steps linewidth 2 linecolor rgb of(k) title title(k)
}
unset key
unset logscale
set format

c = 1; r = 1; heading = "Share of the bonds that broke"
@panel
set xlabel "inclination of the bond to the vertical, degrees" offset 0,0.4
set xrange [0:90]
set xtics 15
set yrange [0:*]
plot for [k = 1:n] table("inclination", k) using 1:3 with linespoints linewidth 2 pointtype 7 pointsize 0.5 linecolor rgb of(k), \
    for [k = 1:n] table("inclination", k) using 1:2 with linespoints linewidth 2 pointtype 7 pointsize 0.5 dashtype (6, 4) linecolor rgb of(k)
unset multiplot
