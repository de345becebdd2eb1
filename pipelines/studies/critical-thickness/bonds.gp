# SPDX-License-Identifier: GPL-3.0-or-later
# Strains at which layers crack over Griffith's, and tensions that suction reaches over thickness. Variable:
# tables, the folder that `bonds` makes.
set terminal @svg "Helvetica,15" size 1200,460
@axes
file(name) = tables . "/" . name
set multiplot layout 1,2
set logscale xy
set xrange [0.0035:0.04]; set yrange [0.0009:0.04]
set xtics (0.005, 0.01, 0.02); set ytics (0.001, 0.002, 0.005, 0.01, 0.02)
set xlabel "Griffith's strain"; set ylabel "strain at the largest tension"
set key bottom right Left reverse
plot x with lines dashtype 2 linewidth 2 linecolor rgb grey title "Griffith: below it no crack can run", \
    file("bonds-usual") with points pointtype 7 pointsize 0.7 linecolor rgb blue title "3 to 8 diameters", \
    file("bonds-strong") with points pointtype 8 pointsize 1 linecolor rgb blue title "bonds twice as strong", \
    file("bonds-stiff") with points pointtype 10 pointsize 1 linecolor rgb blue title "all twice as stiff", \
    file("bonds-floor0.5") with points pointtype 4 pointsize 1 linecolor rgb teal title "floor half as strong as the layer", \
    file("bonds-floor0.2") with points pointtype 5 pointsize 1 linecolor rgb teal title "floor a fifth as strong"
unset logscale
set xrange [2.5:8.5]; set yrange [0:2.5]
set xtics (3, 4, 6, 8); set ytics 0.5
set key top left Left reverse
set xlabel "thickness, mean diameters"; set ylabel "largest tension by suction / Griffith's"
plot 1 with lines dashtype 2 linewidth 2 linecolor rgb grey notitle, \
    file("suction") using 1:2 with points pointtype 6 pointsize 1 linecolor rgb blue title "strength 1.8 MPa", \
    file("suction-weak") using 1:2 with points pointtype 7 pointsize 0.7 linecolor rgb red title "1.2 MPa"
unset multiplot
