# SPDX-License-Identifier: GPL-3.0-or-later
# Liquid in rings over suction, and stress over liquid. Variable: tables, the folder of report.
set terminal @svg "Helvetica,15" size 1000,420
set multiplot layout 1,2
@axes
file(angle) = sprintf("%s/angle-%d.tsv", tables, angle)
array angles[3] = [0, 20, 40]
array colours[3] = [blue, sky, teal]
apart(column, flag) = flag > 0 ? column : NaN

set title "Liquid in rings"
set xlabel "suction, γ / R"; set ylabel "saturation"; set logscale xy; set format y "10^{%T}"; set key bottom left
plot [1:1000] [1e-6:0.3] for [k=1:3] file(angles[k]) using 1:(apart($2, $6)) with lines linewidth 2 linecolor rgb colours[k] \
    title sprintf("contact angle %d°", angles[k]), \
    for [k=1:3] file(angles[k]) using 1:2 with lines dashtype (3, 4) linecolor rgb colours[k] title (k == 3 ? "some rings meet" : "")

set title "Stress by which rings hold the packing"
set xlabel "liquid, share of the void"; set ylabel "stress, γ / R"; unset logscale y; set format x "10^{%T}"; set format y "%g"; set key bottom right
plot [0.3:1e-6] [0:*] for [k=1:3] file(angles[k]) using 2:(apart($4, $6)) with lines linewidth 2 linecolor rgb colours[k] notitle, \
    for [k=1:3] file(angles[k]) using 2:4 with lines dashtype (3, 4) linecolor rgb colours[k] notitle, \
    tables . "/rumpf.tsv" with lines linewidth 1 linecolor rgb red title "Rumpf, 0°"
