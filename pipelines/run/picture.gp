# SPDX-License-Identifier: GPL-3.0-or-later
# Drying rate and cracks over the saturation. Variables: tables, the folder of the tables
# that pipelines/run/picture makes; top, the largest number of cracks to show; width, in pixels.
set terminal svg size width,370 font "Helvetica,15" linewidth 1
set multiplot
set border 3 linecolor "#555555"
set tics nomirror out scale 0.6 textcolor "#222222"
set xrange [1:0]
set xtics (1, 0.9, 0.75, 0.6, 0.45, 0.3, 0.15, 0)
set grid xtics ytics linetype 1 linecolor "#e4e4e4" linewidth 1
set xlabel "network saturation (drying runs to the right)" offset 0,0.3
set key left top Left reverse samplen 2.5 spacing 1.3 width -5 maxrows 2 # above the curves
set tmargin at screen 0.92
set bmargin at screen 0.2

table(limit, name) = tables . "/" . limit . "-" . name
set style line 1 linewidth 2.5
set style line 2 linewidth 2.5 dashtype (8, 5)
set style line 3 pointtype 7 pointsize 0.9 linecolor rgb black

set lmargin at screen 0.085
set rmargin at screen 0.48
set ylabel "drying rate / first rate" offset 1,0
set yrange [0:1.35]
set ytics 0, 0.2, 1
plot table("inviscid", "rate") with steps linestyle 1 linecolor rgb inviscid title "inviscid liquid", \
     table("immobile", "rate") with steps linestyle 2 linecolor rgb immobile title "immobile liquid", \
     table("inviscid", "first_period") with points linestyle 3 title "end of first period", \
     table("immobile", "first_period") with points linestyle 3 notitle

set lmargin at screen 0.585
set rmargin at screen 0.975
set ylabel "broken bonds so far" offset 1,0
set yrange [0:top]
set ytics autofreq
plot keyentry with lines linestyle 1 linecolor rgb shear title "in shear", \
     keyentry with lines linestyle 1 linecolor rgb tension title "in tension", \
     keyentry with lines linestyle 1 linecolor rgb grey title "inviscid liquid", \
     keyentry with lines linestyle 2 linecolor rgb grey title "immobile liquid", \
     for [limit = 1:2] for [mode = 3:2:-1] table(word("inviscid immobile", limit), "count") \
         using 1:mode with steps linestyle limit linecolor rgb (mode == 3 ? shear : tension) notitle
unset multiplot
