# SPDX-License-Identifier: GPL-3.0-or-later
# Thresholds, masses and fronts of invasion percolation. Variable: tables, the folder of
# pipelines/studies/percolation/report.
set terminal @svg "Helvetica,15" size 1260,440
set multiplot layout 1,3
@axes
file(name) = tables . "/" . name . ".tsv"
set errorbars 0.6
set style line 1 linewidth 1.5 pointtype 7 pointsize 0.5 linecolor rgb blue
set style line 2 linewidth 1.5 pointtype 7 pointsize 0.5 linecolor rgb red
set style line 3 linewidth 1.5 pointtype 7 pointsize 0.5 linecolor rgb grey
set style line 4 linewidth 1.5 pointtype 7 pointsize 0.5 linecolor rgb pale

set title "Share that is easy enough to be crossed,\nless the published threshold"
set xlabel "standard deviation"; set key bottom left
plot [0:0.05] file("cubic") using 1:2:3 with yerrorbars linestyle 1 title "cubic", \
    file("cubic-line") with lines linestyle 1 notitle, \
    file("square") using 1:2:3 with yerrorbars linestyle 3 title "square", \
    file("square-line") with lines linestyle 3 notitle, \
    file("voronoi") using 1:2:3 with yerrorbars linestyle 2 title "Voronoi", \
    file("voronoi-line") with lines linestyle 2 notitle

set title "Mass over the size to the published power,\nover that of the smallest"
set xlabel "size L"; set logscale x; set key bottom left
first(name) = real(system("head -1 " . file(name) . " | cut -f5"))
plot [10:1300] [0.6:1.1] \
    file("mass-3") using 1:($5 / first("mass-3")):($6 / first("mass-3")) with yerrorbars linestyle 1 title "3D, L^{2.523}", \
    file("mass-2") using 1:($5 / first("mass-2")):($6 / first("mass-2")) with yerrorbars linestyle 3 title "2D, L^{1.896}", \
    file("mass-2-trapping") using 1:($5 / first("mass-2-trapping")):($6 / first("mass-2-trapping")) with yerrorbars linestyle 2 title "2D, trapping, L^{1.896}"

set title "Width of a front against a gradient G"
set xlabel "1/G"; set logscale xy; set key top left
set format x "10^{%T}"
plot [20:15000] [0.8:300] file("front-2") using 1:2:3 with yerrorbars linestyle 2 title "2D, standard deviation", \
    '' using 1:4 with lines linestyle 2 notitle, \
    file("tail-3") using 1:2:3 with yerrorbars linestyle 1 title "3D, tail", \
    '' using 1:4 with lines linestyle 1 notitle
