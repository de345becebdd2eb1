# SPDX-License-Identifier: GPL-3.0-or-later
# The picture of a study. Variables: tables, the folder of the tables that pipelines/study/figure.py
# makes; kind; panels, their number and their titles with | between; names of the series likewise;
# xtitle, ytitle, logarithmic; xrange, and step, between the labels of x, or xmarks, these labels; name,
# of the study; ranges of the panels, where their values have none.
columns = panels < 4 ? panels : (panels + 1) / 2
lines = (panels + columns - 1) / columns
set terminal @svg "Helvetica,14" size 60 + 340 * columns, 40 + 330 * lines noenhanced
set multiplot layout lines, columns title name font ",15"
@axes
part(text, k) = k == 1 ? (strstrt(text, "|") ? text[1:strstrt(text, "|") - 1] : text) : \
    part(text[strstrt(text, "|") + 1:strlen(text)], k - 1)
parts(text) = strlen(text) == 0 ? 1 : 1 + (strstrt(text, "|") ? parts(text[strstrt(text, "|") + 1:strlen(text)]) : 0)
count = parts(names)
set key top right samplen 1.5 textcolor "#222222" font ",12"
set style fill transparent solid 0.18 noborder
set offsets graph 0.04, graph 0.04, graph 0.06, graph 0.06
if (kind eq "map") { unset key; unset grid; set style fill solid 1 noborder; unset offsets; set palette defined (0 "#f2efe6", 0.5 sky, 1 blue) }
rotated = kind eq "strip" && strlen(names) > 24

do for [m = 0:panels - 1] {
    set title part(titles, m + 1) offset 0,-0.5
    range = strlen(part(ranges, m + 1)) ? part(ranges, m + 1) : "[*:*]"
    if (kind eq "map") { eval "set cbrange " . range } else { eval "set yrange " . range }
    if (kind eq "curves") {
        eval "set xrange " . xrange
        if (logarithmic) { set logscale x; set format x "%.2g" } else { set xtics step }
        if (strlen(xmarks)) { eval "set xtics " . xmarks }
        set xlabel xtitle offset 0,0.3
        # Above the curves of the first panel is room for their names.
        if (count > 1) { set offsets graph 0.04, graph 0.04, graph (m ? 0.06 : 1 / (0.96 - 0.085 * (count < 9 ? count : 8)) - 1), graph 0.06 }
        plot for [s = 0:count - 1] sprintf("%s/curve-%d-%d", tables, m, s) using 1:3:4 with filledcurves \
                linecolor rgb series[1 + s % 6] notitle, \
             for [s = 0:count - 1] sprintf("%s/curve-%d-%d", tables, m, s) using 1:2 with linespoints linewidth 2 \
                pointtype 7 pointsize 0.5 dashtype 1 + s / 6 linecolor rgb series[1 + s % 6] title (m ? "" : part(names, s + 1)), \
             for [s = 0:count - 1] sprintf("%s/reference-%d-%d", tables, m, s) using 1:2 with points linewidth 1.6 \
                pointtype 8 pointsize 1.1 linecolor rgb series[1 + s % 6] notitle
    }
    if (kind eq "strip") {
        unset xtics
        set xrange [0.4:count + 0.6]
        do for [s = 1:count] {
            if (s == 1) { set xtics (part(names, s) s) scale 0 } else { set xtics add (part(names, s) s) }
        }
        if (rotated) { set xtics rotate by 25 right }
        plot sprintf("%s/runs-%d", tables, m) using ($1 + 0.3 * (rand(0) - 0.5)):2 with points pointtype 7 pointsize 0.35 \
                linecolor rgb pale notitle, \
             sprintf("%s/means-%d", tables, m) using 1:2:3:4 with yerrorbars linewidth 2 pointtype 7 pointsize 0.7 \
                linecolor rgb blue notitle, \
             sprintf("%s/reference-%d", tables, m) using 1:2 with points linewidth 1.6 pointtype 8 pointsize 1.1 \
                linecolor rgb black notitle
    }
    if (kind eq "map") {
        set xlabel xtitle offset 0,0.3
        set ylabel ytitle offset 0.8,0
        set xrange [-0.5:parts(xnames) - 0.5]; set yrange [-0.5:parts(ynames) - 0.5]
        set xtics (part(xnames, 1) 0) scale 0; set ytics (part(ynames, 1) 0) scale 0
        do for [k = 2:parts(xnames)] { set xtics add (part(xnames, k) k - 1) }
        do for [k = 2:parts(ynames)] { set ytics add (part(ynames, k) k - 1) }
        if (parts(xnames) > 4) { set xtics rotate by 40 right }
        plot sprintf("%s/map-%d", tables, m) using 1:2:3 with image pixels
    }
    if (kind eq "scatter") {
        unset title
        set xlabel part(titles, m + 1) offset 0,0.3
        set ylabel ytitle offset 0.8,0
        plot sprintf("%s/scatter-%d", tables, m) using 1:2 with points pointtype 7 pointsize 0.35 linecolor rgb blue notitle
    }
}
unset multiplot
