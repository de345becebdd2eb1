# SPDX-License-Identifier: GPL-3.0-or-later
# Dry bands over the depth. Variables: tables, the folder that pipelines/studies/shear/depth makes; n
# depths, in mm; middle, the logarithm of the width in mm where H is the split radius, for the line of slope 2/3.
colour_of(k) = series[k % 6 + 1]

set terminal @svg "Helvetica,15" size 1300,440
set multiplot layout 1,3
@axes
set xlabel "centre of the band, mm"; set ylabel "height, mm"; set key top right; set xrange [65:125]; set xtics 10
plot for [k = 0:n - 1] tables . sprintf("/centre%d", k) using 2:1:3 with xerrorbars pointtype 7 pointsize 0.4 linecolor rgb colour_of(k) title "H = " . word(depths, k + 1) . " mm", \
    for [k = 0:n - 1] tables . sprintf("/unger%d", k) using 2:1 with lines dashtype 2 linecolor rgb colour_of(k) title (k == n - 1 ? "Unger et al." : "")
set logscale xy
set xlabel "H/R_s"; set ylabel "(R_s − R_c)/R_s at the top"; set key top left
set xrange [0.15:0.8]; set xtics (0.2, 0.3, 0.4, 0.6, 0.8); set yrange [0.005:1]
plot tables . "/shifts" using 1:2:3 with yerrorbars pointtype 7 linecolor rgb blue title "measured", \
    x ** 2.5 with lines dashtype 2 linecolor rgb black title "(H/R_s)^{5/2}"
set ylabel "width at the top, mm"; set yrange [5:60]; set ytics (5, 10, 20, 40, 60)
plot tables . "/widths" using 1:2:3 with yerrorbars pointtype 7 linecolor rgb blue title "measured", \
    exp(middle) * x ** (2.0 / 3) with lines dashtype 2 linecolor rgb black title "slope 2/3"
