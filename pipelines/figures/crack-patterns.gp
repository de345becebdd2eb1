# SPDX-License-Identifier: GPL-3.0-or-later
# Variables: tables, the folder of the tables that pipelines/figures/crack-patterns makes; n responses; bonds of one;
# tall, the height of a view over its width.
wide = 260; high = 58 + 269 * tall < 470 ? 58 + 269 * tall : 470; foot = n == 1 ? 76.0 : 36.0
columns = n < 4 ? n : 4
rows = (n + columns - 1) / columns
total = high * rows + foot
set terminal @svg "Helvetica,14" size wide * columns, total
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

# What is what, once, below: in a line, or one below the other.
key_x(i) = n == 1 ? 16.0 / wide : (16 + 160.0 * i) / (wide * columns)
key_y(i) = (n == 1 ? 60.0 - 20 * i : 18) / total
words = "'bond that holds' 'broken in tension' 'broken in shear'"
colours = "#c4c4c4 " . tension . " " . shear
do for [i = 0:2] {
    set arrow i + 1 from screen key_x(i), screen key_y(i) to screen key_x(i) + 22.0 / (wide * columns), screen key_y(i) nohead \
        linewidth (i ? 3 : 1) linecolor rgb word(colours, i + 1)
    set label i + 3 word(words, i + 1) at screen key_x(i) + 29.0 / (wide * columns), screen key_y(i) left textcolor rgb black
}

do for [k = 1:n] {
    c = (k - 1) % columns; r = (k - 1) / columns
    set lmargin at screen (c + 0.02) / columns
    set rmargin at screen (c + 0.98) / columns
    set tmargin at screen 1 - (r * high + 52.0) / total
    set bmargin at screen 1 - ((r + 1) * high - 6.0) / total
    set label 1 title(k) at screen (c + 0.5) / columns, screen 1 - (r * high + 20.0) / total center textcolor "#222222"
    set label 2 count(k) at screen (c + 0.5) / columns, screen 1 - (r * high + 40.0) / total center textcolor "#777777"
    all = "NaN notitle"
    if (full(k, 0)) { all = all . ", lines(k, 0) using (across($1, $2)):(up($2, $3)) with lines linewidth 0.5 linecolor rgb '#c4c4c4'" }
    if (full(k, 1)) { all = all . ", lines(k, 1) using (across($1, $2)):(up($2, $3)) with lines linewidth thick linecolor rgb tension" }
    if (full(k, 2)) { all = all . ", lines(k, 2) using (across($1, $2)):(up($2, $3)) with lines linewidth thick linecolor rgb shear" }
    eval "plot " . all
    if (k == 1) {
        unset arrow
        do for [i = 0:2] { unset label i + 3 }
    }
}
unset multiplot
