# SPDX-License-Identifier: GPL-3.0-or-later
# Variable: tables, the folder of the tables that pipelines/large-figure makes.
set terminal pngcairo size 1200,640 font "Helvetica,14" background "#ffffff"
set multiplot layout 1,2
set size ratio -1
set offsets graph 0.03, graph 0.03, graph 0.03, graph 0.03
set bmargin 4
unset border
unset tics
unset key
slice = tables . "/slice"
cracks = tables . "/cracks"
set style fill solid 1 noborder
set title "a slice: broken in tension (black), in shear (amber)" textcolor "#222222"
plot slice using 1:2:3 with circles linecolor rgb "#dddddd", \
    cracks using 1:2:3:($5 == 0 ? $4 : NaN) with vectors nohead linewidth 3 linecolor rgb tension, \
    cracks using 1:2:3:($5 == 1 ? $4 : NaN) with vectors nohead linewidth 3 linecolor rgb shear
set title "from above: all that broke" textcolor "#222222"
set palette defined (0 wet_to_dry(1), 1 wet_to_dry(0))
set cbrange [1:0]
set colorbox horizontal user origin screen 0.6, 0.07 size screen 0.3, 0.02
set cbtics 0.25
set label 1 "saturation at which it broke" at screen 0.75, 0.115 center textcolor "#222222"
plot tables . "/all" using 1:2:3 with points pointtype 7 pointsize 0.4 linecolor palette
unset multiplot
