# SPDX-License-Identifier: GPL-3.0-or-later
# Capillary pressure, permeabilities and diffusivities over saturation. Variable: tables, the
# folder that pipelines/studies/curves/report makes.
set terminal @svg "Helvetica,15" size 1260,440
set multiplot layout 1,3
@axes
set xrange [1:0]; set xtics 0.2; set xlabel "saturation"

set title "capillary pressure, MPa"
set yrange [0:*]; set key top left
plot tables . "/pressure-free" using 1:($2 / 1e6) with steps linewidth 1.8 linecolor rgb blue title "none trapped", \
    tables . "/pressure-trapping" using 1:($2 / 1e6) with steps linewidth 1.4 linecolor rgb pale title "trapping"

set yrange [0:1.02]; set ytics 0.2; set key top center
do for [c = 0:1] {
    set title (c ? "effective diffusivity, of one phase alone" : "permeability, of one phase alone")
    plot tables . "/states-free" using 1:(column(2 + c)) with linespoints linewidth 1.8 pointtype 7 pointsize 0.5 linecolor rgb red title "gas", \
        tables . "/states-free" using 1:(column(4 + c)) with linespoints linewidth 1.8 pointtype 7 pointsize 0.5 linecolor rgb blue title "liquid", \
        tables . "/states-trapping" using 1:(column(2 + c)) with linespoints linewidth 1.2 pointtype 6 pointsize 0.5 linecolor rgb rose title "gas, trapping", \
        tables . "/states-trapping" using 1:(column(4 + c)) with linespoints linewidth 1.2 pointtype 6 pointsize 0.5 linecolor rgb pale title "liquid, trapping"
}
