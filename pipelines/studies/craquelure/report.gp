# SPDX-License-Identifier: GPL-3.0-or-later
# A layer from above. Variables: tables, the folder that pipelines/studies/craquelure/report makes; n views of
# grains with titles between bars; wide and deep, the box in diameters; opened: 1 if the map of when cracks
# opened comes beside them, of columns a step wide; 2 if it is empty; at_once: the saturation at which all opened, or -1;
# legend: commands that draw what colours mean at the foot of a picture of width and height, or "".
columns = opened ? 2 : (n < 2 ? 1 : 2)
rows = (n + (opened ? 1 : 0) + columns - 1) / columns
side = opened ? 520 : 340; foot = strlen(legend) ? 22 : 0
set terminal pngcairo background "#ffffff" font "Helvetica,11" size side * columns + (opened ? 70 : 0), (side + 30) * rows + foot
height = (side + 30.0) * rows + foot
total = side * columns + (opened ? 70.0 : 0.0)
set multiplot
unset key; unset tics; unset border
set size ratio deep / wide
set xrange [0:wide]; set yrange [0:deep]
set style fill solid border linecolor rgb "#6a6a70"
title(k) = system(sprintf("printf '%%s' '%s' | cut -d'|' -f%d", titles, k))
do for [k = 1:n] {
    c = (k - 1) % columns; r = (k - 1) / columns
    set lmargin at screen (c * side + 10) / total
    set rmargin at screen ((c + 1) * side - 10) / total
    set tmargin at screen 1 - (r * (side + 30) + 34) / height
    set bmargin at screen 1 - ((r + 1) * (side + 30) - 8) / height
    set title title(k) offset 0, -0.5 textcolor rgb black
    set object 1 rectangle from 0, 0 to wide, deep fillcolor rgb "#1c1c22" behind
    plot sprintf("%s/grains-%d", tables, k) using 1:2:3:4 with circles linewidth 0.4 fillcolor rgb variable
}
if (opened) {
    set lmargin at screen (side + 10) / total
    set rmargin at screen (2.0 * side - 10) / total
    set tmargin at screen 1 - 34.0 / (side + 30)
    set bmargin at screen 8.0 / (side + 30)
    set title "saturation of the layer at which each crack opened" offset 0, -0.5 textcolor rgb black
    set object 1 rectangle from 0, 0 to wide, deep fillcolor rgb "#f4f4f4" fillstyle solid border linecolor rgb grey behind
    set palette defined (0 shear, 0.5 sky, 1 blue)
    set cbrange [*:*] reverse
    if (at_once >= 0) { set cbrange [at_once + 0.05:at_once - 0.05] }
    set colorbox user origin screen (2.0 * side + 4) / total, 0.25 size screen 16 / total, 0.5
    set cbtics 0.1 scale 0
    half = step / 2
    if (opened == 1) {
        plot tables . "/opened" using 1:2:(half):(half):3 with boxxyerror fillstyle solid noborder linecolor palette
    } else {
        set title "no cracks by the measure of damage"
        unset colorbox
        plot NaN notitle
    }
}
if (foot) { width = total; unset title; set size noratio; eval legend }
unset multiplot
