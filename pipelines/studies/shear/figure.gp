# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures of split-bottom cells. Variables: tables, the folder that pipelines/studies/shear/figure makes;
# what, which picture; n cases and their titles, between bars; heights of the levels, mm; unger, 1
# where there is its curve.
title_of(k) = system(sprintf("printf '%%s' '%s' | cut -d'|' -f%d", titles, k + 1))
colour_of(k) = series[k % 6 + 1]

if (what eq "bands") {
    set terminal @svg "Helvetica,15" size 1000,460
    set multiplot layout 1,2
    @axes
    set ylabel "height, mm"; set xlabel "centre of the band, mm"; set key bottom left
    plot for [k = 0:n - 1] tables . sprintf("/case%d", k) using 2:1:3 with xerrorbars pointtype 7 pointsize 0.5 linecolor rgb colour_of(k) title title_of(k), \
        for [k = 0:n - 1] tables . sprintf("/case%d", k) using 2:1 with lines linecolor rgb colour_of(k) notitle, \
        for [k = 1:unger] tables . "/unger" using 2:1 with lines dashtype 2 linecolor rgb black title "Unger et al."
    set xlabel "width of the band, mm"; unset key
    plot for [k = 0:n - 1] tables . sprintf("/case%d", k) using 4:1:5 with xerrorbars pointtype 7 pointsize 0.5 linecolor rgb colour_of(k), \
        for [k = 0:n - 1] tables . sprintf("/case%d", k) using 4:1 with lines linecolor rgb colour_of(k)
}

if (what eq "profiles") {
    set terminal @svg "Helvetica,15" size 760,520
    @axes
    set xlabel "r, mm"; set ylabel "angular velocity over that of the turning part"
    set yrange [-0.05:1.05]; set key outside right title "height, mm"
    levels = words(heights)
    set palette defined (0 blue, 1 pale)
    unset colorbox; set cbrange [0:levels - 1]
    plot for [k = 0:levels - 1] tables . sprintf("/points%d", k) using 1:2:(k) with points pointtype 7 pointsize 0.5 linecolor palette title word(heights, k + 1), \
        for [k = 0:levels - 1] tables . sprintf("/fit%d", k) using 1:2:(k) with lines linecolor palette notitle
}

if (what eq "rheology") {
    set terminal @svg "Helvetica,15" size 640,480
    @axes
    set xlabel "pressure, Pa"; set ylabel "shear stress, Pa"; set key top left
    set xrange [0:*]; set yrange [0:*]
    plot for [k = 0:n - 1] tables . sprintf("/case%d", k) using 1:2 with points pointtype 6 pointsize 0.4 linecolor rgb colour_of(k) notitle, \
        for [k = 0:n - 1] tables . sprintf("/line%d", k) using 1:2 with lines linewidth 2 linecolor rgb colour_of(k) title title_of(k)
}

if (what eq "torque") {
    set terminal @svg "Helvetica,15" size 640,420
    @axes
    set style fill solid 1 noborder; set boxwidth 0.6; set yrange [0:*]; set ylabel "torque, N m"
    set xrange [-0.6:n - 0.4]; set xtics scale 0 ("" -1); set offsets 0, 0, graph 0.1, 0
    set for [k = 0:n - 1] xtics add (title_of(k) k)
    unset key
    plot tables . "/bars" using 1:2 with boxes linecolor rgb pale, \
        tables . "/bars" using 1:2:3 with yerrorbars pointtype 7 pointsize 0.4 linewidth 1.5 linecolor rgb black
}

if (what eq "separations") {
    set terminal @svg "Helvetica,15" size 1260,440
    set multiplot layout 1,3
    @axes
    set xlabel "separation, mm (below 0: overlap)"; set key top right; set xtics 0.1
    set ylabel "pairs in a snapshot, per mm"; set logscale y; set format y "10^{%T}"
    plot for [k = 0:n - 1] tables . sprintf("/case%d", k) using 1:2 with steps linecolor rgb colour_of(k) title title_of(k)
    set ylabel "mean normal force, N (below 0: pulls)"; unset logscale y; set format y "%g"; unset key
    plot for [k = 0:n - 1] tables . sprintf("/case%d", k) using 1:3 with points pointtype 7 pointsize 0.3 linecolor rgb colour_of(k)
    set ylabel "pairs per mm and mm³"; set logscale y; set format y "10^{%T}"; set key top right
    plot for [k = 0:n - 1] tables . sprintf("/case%d", k) using 1:5 with steps linewidth 1.6 linecolor rgb colour_of(k) title title_of(k) . ", in the band", \
        for [k = 0:n - 1] tables . sprintf("/case%d", k) using 1:4 with steps dashtype 3 linecolor rgb colour_of(k) title (k == n - 1 ? "outside it" : "")
}
