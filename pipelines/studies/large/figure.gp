# SPDX-License-Identifier: GPL-3.0-or-later
# Variable: tables, the folder of the tables that pipelines/studies/large/figure makes.
set terminal pngcairo size 1200,640 font "Helvetica,14" background "#ffffff"
set multiplot layout 1,2
set size ratio -1
set offsets graph 0.03, graph 0.03, graph 0.03, graph 0.03
set tmargin at screen 0.93
set bmargin at screen 0.21
set border 3 linecolor "#555555"
set tics nomirror out scale 0.6 textcolor "#222222"
set xlabel "x, µm" offset 0,0.4 textcolor "#222222"
unset key
slice = tables . "/slice"
cracks = tables . "/cracks"
set style fill solid 1 noborder
set ylabel "z, µm" offset 1,0 textcolor "#222222"
set lmargin at screen 0.06
set rmargin at screen 0.49
set label 1 "a slice: broken in tension (black), in shear (amber)" at screen 0.06, 0.98 textcolor "#222222"
stats slice using 2 name "z" nooutput
stats slice using 1 name "x" nooutput
if (z_max - z_min > 2 * (x_max - x_min)) { set xtics (x_min, x_max) format "%.0f" }
plot slice using 1:2:3 with circles linecolor rgb "#dddddd", \
    cracks using 1:2:3:($5 == 0 ? $4 : NaN) with vectors nohead linewidth 3 linecolor rgb tension, \
    cracks using 1:2:3:($5 == 1 ? $4 : NaN) with vectors nohead linewidth 3 linecolor rgb shear
broken = int(system("wc -l <" . tables . "/all"))
set lmargin at screen 0.56
set rmargin at screen 0.99
set ylabel "y, µm"
set title sprintf("from above: all %d bonds that broke", broken) textcolor "#222222"
set palette defined (0 wet_to_dry(0), 1 wet_to_dry(1))
set cbrange [0:1]
set colorbox horizontal user origin screen 0.625, 0.055 size screen 0.3, 0.02
set cbtics ("1" 0, "0.75" 0.25, "0.5" 0.5, "0.25" 0.75, "0" 1) scale 0
set xtics autofreq
set label 1 "saturation at which it broke" at screen 0.775, 0.095 center textcolor "#222222"
plot tables . "/all" using 1:2:(1 - $3) with points pointtype 7 pointsize (broken < 1000 ? 0.9 : 0.5) linecolor palette
unset multiplot
