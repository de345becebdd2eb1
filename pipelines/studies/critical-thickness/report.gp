# SPDX-License-Identifier: GPL-3.0-or-later
# Strains at which layers crack over their thickness. Variable: tables, the folder that report makes.
set terminal @svg "Helvetica,15" size 640,440
@axes
set logscale xy
set xrange [2.7:13.5]; set yrange [0.003:0.03]
set xtics (3, 4, 6, 8, 12); set ytics (0.003, 0.005, 0.007, 0.01, 0.015, 0.02, 0.03)
set xlabel "thickness, mean diameters"; set ylabel "shrinkage strain"
set key bottom left Left reverse
file(name) = tables . "/" . name
plot file("mean") using 1:2 with lines linewidth 2 linecolor rgb blue title "layers crack", \
    file("grown") using 1:2 with lines linewidth 2 linecolor rgb red title "a slit in them grows", \
    file("slits") with points pointtype 6 pointsize 0.8 linecolor rgb red notitle, \
    file("layers") with points pointtype 7 pointsize 0.6 linecolor rgb blue notitle, \
    file("mean") using 1:3 with lines dashtype 2 linewidth 2 linecolor rgb grey title "Griffith: below it no crack can run"
