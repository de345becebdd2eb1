# SPDX-License-Identifier: GPL-3.0-or-later
# Lateral tension, suction and broken bonds over the saturation. Variables: tables, the folder with `rows`;
# wet, 1 where there is a suction.
set terminal pngcairo background "#ffffff" font "Helvetica,11" size 640, 400
set xrange [1:0]
set yrange [0:*]; set y2range [0:*]
set xlabel "saturation"; set ylabel "MPa"; set y2label "broken bonds, share"
set ytics nomirror; set y2tics
set key outside bottom center horizontal
plot tables . "/rows" using 1:3 with lines linecolor rgb grey title wet ? "suction" : "", \
     "" using 1:2 with linespoints pointtype 7 pointsize 0.4 linewidth 2 linecolor rgb blue title "lateral tension", \
     "" using 1:4 axes x1y2 with lines linewidth 2 linecolor rgb tension title "broken bonds"
