# SPDX-License-Identifier: GPL-3.0-or-later
# Diffusivity and permeability over porosity: direct and published, by open sections, by cylinders.
#
#     gnuplot -e 'table="table.md"; flow="flow.tsv"; out="transport.svg"' tests/bench/void/transport.gp
#
# of what `compare --rule section --rule cylinder` and `permeability` print.
load "pipelines/lib/style.gp"
set terminal @svg "sans,12" size 1060,440
set output out
@axes
set multiplot layout 1,2 margins 0.07,0.985,0.13,0.87 spacing 0.09
only(names) = sprintf("< grep -E '^\\| (%s)' %s", names, table)
random = "random|lognormal|wide|two|walls"
lattice = "sc|bcc|fcc|hcp"
set key top left reverse Left samplen 2
set xlabel "porosity"
set xrange [0.24:0.76]
set yrange [0:0.75]
set title "effective over free diffusivity"
set datafile separator "|"
plot x / (1.5 - x / 2) with lines linecolor rgb grey dashtype 2 title "bound of Hashin and Shtrikman", \
     x**1.5 with lines linecolor rgb grey title "porosity^{3/2}", \
     only(random) using 3:4 with points pointtype 7 pointsize 0.9 linecolor rgb black title "direct, random", \
     only(lattice) using 3:4 with points pointtype 5 pointsize 0.6 linecolor rgb black title "direct, lattices", \
     only(random) using 3:8 with points pointtype 6 pointsize 1.4 linewidth 1.5 linecolor rgb blue title "open sections", \
     only(lattice) using 3:8 with points pointtype 4 pointsize 1.2 linewidth 1.5 linecolor rgb blue notitle, \
     only(random . "|" . lattice) using 3:10 with points pointtype 2 pointsize 0.7 linecolor rgb red title "cylinders"
set datafile separator tab
set title "permeability over the square of the Sauter mean diameter"
set xrange [0.3:0.5]
set logscale y
set yrange [1e-5:5e-3]
set format y "10^{%L}"
solid(x) = 1 - x
drag(x) = 10 * solid(x) / x**2 + x**2 * (1 + 1.5 * sqrt(solid(x)))
plot x / (18 * solid(x) * drag(x)) with lines linecolor rgb black title "van der Hoef, Beetstra and Kuipers", \
     flow using 2:3 every ::1 with points pointtype 6 pointsize 1.4 linewidth 1.5 linecolor rgb blue title "open sections", \
     flow using 2:($4 * (1 + $6 / 100)) every ::1 with points pointtype 2 pointsize 0.7 linecolor rgb red title "cylinders"
unset multiplot
