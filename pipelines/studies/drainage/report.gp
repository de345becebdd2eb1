# SPDX-License-Identifier: GPL-3.0-or-later
# Suction, and the stress of the liquid, over saturation as a packing drains. Variable: tables, the folder of report.
set terminal @svg "Helvetica,15" size 1000,440
set multiplot layout 1,2
@axes
file(angle) = sprintf("%s/angle-%d.tsv", tables, angle)
array angles[3] = [0, 20, 40]
array colours[3] = [blue, sky, teal]

set xlabel "saturation"; set ylabel "suction, γ / R"; set xrange [1:0]; set yrange [0:30]; set key top left
plot for [k=1:3] file(angles[k]) using 2:1 with lines linewidth 2 linecolor rgb colours[k] title sprintf("contact angle %d°", angles[k]), \
    file(0) using 3:1 with lines dashtype (3, 4) linecolor rgb blue title "0°, without rings", \
    file(0) using 4:1 with lines linewidth 1 linecolor rgb grey title "0°, throats hold all liquid"

set ylabel "stress, γ / R"; set yrange [0:5]; set key top right
set style fill solid 0.25 noborder
plot tables."/rumpf.tsv" using 1:2:3 with filledcurves linecolor rgb grey title "0°, Rumpf and Schubert", \
    "" using 1:2 with lines linewidth 3 linecolor rgb grey notitle, \
    for [k=1:3] file(angles[k]) using 2:5 with lines linewidth 2 linecolor rgb colours[k] notitle, \
    file(0) using 2:($1 * $3) with lines dashtype (3, 4) linecolor rgb blue title "0°, full pores alone", \
    file(0) using 2:($5 - $1 * $3) with lines linewidth 1 linecolor rgb grey title "0°, rings alone"
