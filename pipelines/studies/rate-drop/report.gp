# SPDX-License-Identifier: GPL-3.0-or-later
# Drying rates over saturation under many assumptions. Variable: tables, the folder that
# pipelines/studies/rate-drop/report makes.
set terminal @svg "Helvetica,15" size 1260,560
set multiplot layout 1,2
@axes
set xrange [1:0]; set yrange [0:1.02]; set xtics 0.2; set ytics 0.2
set xlabel "saturation"; set key outside bottom center Left reverse maxrows 3
set label 1 "K: 0.6" at 0.98, 0.63 textcolor "#777777" font ",13"
set arrow 1 from 0,0.6 to 1,0.6 nohead dashtype 2 linecolor "#777777"
file(name) = tables . "/" . name
shade = "#08306b #2171b5 #6baed6 #9ecae1 #c6dbef"
runs = "ten two one fifth"
names = "'5 µm' '1 µm' '0.5 µm' '0.1 µm'"
set title "drying rate, of the first: thickness of the layer"
plot for [k = 1:4] file(word(runs, k)) using 1:2 with lines linewidth 1.8 linecolor rgb word(shade, k) title word(names, k), \
    file("wet") using 1:2 with lines linewidth 2 linecolor rgb red title "wet share"

set title "other assumptions, layer of 5 µm but for the last"
plot file("lumped") using 1:2 with lines linewidth 1.6 linecolor rgb blue title "no exchange sideways", \
    file("auxiliary") using 1:2 with lines linewidth 1.6 linecolor rgb teal title "auxiliary layer, surface water", \
    file("drawn") using 1:2 with lines linewidth 1.6 linecolor rgb pink title "radii drawn", \
    file("water") using 1:2 with lines linewidth 1.6 linecolor rgb sky title "water", \
    file("water-thick") using 1:2 with lines linewidth 1.6 linecolor rgb grey title "8 times as viscous", \
    file("water-one") using 1:2 with lines linewidth 1.6 linecolor rgb red title "water, 0.5 µm"
