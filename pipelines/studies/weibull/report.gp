# SPDX-License-Identifier: GPL-3.0-or-later
# Cracks against the scatter of strengths. Variable: tables, the folder of the curves that
# pipelines/studies/weibull/report makes.
set terminal @svg "Helvetica,15" size 1000,420
set multiplot layout 1,2 margins 0.07,0.985,0.18,0.91 spacing 0.08
@axes
set xlabel "standard deviation over mean of the strengths" offset 0,0.3
set xrange [-0.02:0.53]
set yrange [0:*]
set key top left reverse Left samplen 2 textcolor "#222222"
curve(name) = tables . "/" . name

do for [panel = 0:1] {
    mean = 2 + 2 * panel
    set title (panel ? "broken in the first period" : "bonds broken, of 625") offset 0,-0.5
    plot curve("inviscid-weibull") using 1:mean:mean + 1 with errorlines linecolor rgb inviscid \
            linewidth 2 pointtype 7 pointsize 0.7 title "inviscid, Weibull", \
         curve("inviscid-normal") using ($1 + 0.006):mean:mean + 1 with errorlines linecolor rgb grey \
            linewidth 2 pointtype 5 pointsize 0.7 title "inviscid, normal", \
         curve("immobile-weibull") using ($1 - 0.006):mean:mean + 1 with errorlines linecolor rgb immobile \
            linewidth 2 pointtype 9 pointsize 0.8 title "immobile, Weibull"
    unset key
}
unset multiplot
