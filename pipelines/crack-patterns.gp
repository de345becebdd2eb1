# SPDX-License-Identifier: GPL-3.0-or-later
# Variables: tables, the folder of the tables that pipelines/crack-patterns makes; n responses; bonds of one.
wide = 260; high = 470
columns = n < 4 ? n : 4
rows = (n + columns - 1) / columns
set terminal @svg "Helvetica,14" size wide * columns, high * rows
set multiplot
thick = 3 < 75 / sqrt(bonds) ? 3 : 75 / sqrt(bonds)
unset key
unset border
unset tics
title(k) = system(sprintf("sed -n %dp %s/titles", k, tables))
count(k) = system(sprintf("sed -n %dp %s/counts", k, tables))
lines(k, mode) = sprintf("%s/lines-%d-%d", tables, k, mode)
full(k, mode) = int(system("grep -c . " . lines(k, mode) . " || true")) > 0
# Seen from the front, a little from above and from the left.
across(x, y) = x + 0.45 * y
up(y, z) = z + 0.22 * y
set size ratio -1
set autoscale
set offsets 0.03, 0.03, 0.02, 0.02
do for [k = 1:n] {
    c = (k - 1) % columns; r = (k - 1) / columns
    set lmargin at screen (c + 0.02) / columns
    set rmargin at screen (c + 0.98) / columns
    set tmargin at screen 1 - (r * high + 52.0) / (rows * high)
    set bmargin at screen 1 - ((r + 1) * high - 6.0) / (rows * high)
    set label 1 title(k) at screen (c + 0.5) / columns, screen 1 - (r * high + 20.0) / (rows * high) center textcolor "#222222"
    set label 2 count(k) at screen (c + 0.5) / columns, screen 1 - (r * high + 40.0) / (rows * high) center textcolor "#777777"
    all = "NaN notitle"
    if (full(k, 0)) { all = all . ", lines(k, 0) using (across($1, $2)):(up($2, $3)) with lines linewidth 0.5 linecolor rgb '#c4c4c4'" }
    if (full(k, 1)) { all = all . ", lines(k, 1) using (across($1, $2)):(up($2, $3)) with lines linewidth thick linecolor rgb '#0a2a7a'" }
    if (full(k, 2)) { all = all . ", lines(k, 2) using (across($1, $2)):(up($2, $3)) with lines linewidth thick linecolor rgb '#e0b000'" }
    eval "plot " . all
}
unset multiplot
