# SPDX-License-Identifier: GPL-3.0-or-later
# One picture of a film of a layer: from above, and below it a cut. Variables: tables, the folder with `above` and
# `cut`; title; wide, deep and high, the box in diameters; legend: commands that draw what colours mean at the
# foot of a picture of width and height, or "".
side = 420.0; margin = 10.0; head = 26.0; foot = strlen(legend) ? 22.0 : 0.0
cut = (side - 2 * margin) * high / wide
total = side + head + cut + margin + foot
set terminal pngcairo background "#ffffff" font "Helvetica,11" size side, total
set multiplot
unset key; unset tics; unset border
set style fill solid border linecolor rgb "#6a6a70"
set lmargin at screen margin / side; set rmargin at screen 1 - margin / side
set object 1 rectangle from graph 0, 0 to graph 1, 1 fillcolor rgb "#1c1c22" behind
set xrange [0:wide]; set yrange [0:deep]
set tmargin at screen 1 - head / total; set bmargin at screen (foot + cut + 2 * margin) / total
set title title offset 0, -0.5 textcolor rgb black
plot tables . "/above" using 1:2:3:4 with circles linewidth 0.4 fillcolor rgb variable
unset title
set yrange [0:high]
set tmargin at screen (foot + cut + margin) / total; set bmargin at screen (foot + margin) / total
plot tables . "/cut" using 1:2:3:4 with circles linewidth 0.4 fillcolor rgb variable
if (foot) { width = side; height = total; eval legend }
unset multiplot
