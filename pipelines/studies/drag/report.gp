# SPDX-License-Identifier: GPL-3.0-or-later
# [C Figs. 10-12] and lattices against Stokes flow. Variable: tables, the folder of pipelines/studies/drag/report.
set terminal @svg "Helvetica,15" size 1000,760
set multiplot layout 2,2
@axes
file(name) = tables . "/" . name

set title "Nine spheres: permeability [C Fig. 10]"
set xlabel "d / D"; set ylabel "K / l^2, 10^{-4}"; set format y "%g"; set key top right opaque
plot [0:0.75] [0:12] file("nine.tsv") using 1:($2 * 1e4) with lines linewidth 2 linecolor rgb blue title "symmetric", \
    '' using 1:($6 * 1e4) with lines linewidth 2 linecolor rgb pale title "symmetric as in Yade", \
    '' using 1:($4 * 1e4) with lines linewidth 2 linecolor rgb red title "no-slip", \
    '' using 1:($8 * 1e4) with lines linewidth 2 linecolor rgb grey title "no-slip, ER"

set title "Force on the small sphere [C Fig. 12]"
set ylabel "F / (S drop)"; set key top left opaque; set logscale xy; set format y "10^{%T}"
plot [0.02:0.75] file("nine.tsv") using 1:3 with lines linewidth 2 linecolor rgb blue title "symmetric", \
    '' using 1:9 with points pointtype 7 pointsize 0.4 linecolor rgb grey title "no-slip, ER", \
    '' using 1:($5) with lines dashtype (6, 4) linewidth 2 linecolor rgb red title "no-slip"
unset logscale; set format y "%g"

set title "Throats of 200 spheres [C Fig. 11]"
set xlabel "hydraulic radius / l"; set ylabel "effective radius / l"; unset key
plot [0:0.03] [0:0.03] file("radii.tsv") with dots linecolor rgb blue, x with lines linecolor rgb grey

set title "Random packings: permeability over the published"
set xlabel "porosity"; set ylabel ""; set logscale y; set key top left; set format y "%g"; set ytics add (0.8, 1, 1.5, 2, 3, 5)
plot [0.3:0.95] [0.7:6] file("random.tsv") using 1:($2 / $5) with linespoints pointtype 7 pointsize 0.6 linewidth 2 linecolor rgb blue title "hydraulic radius", \
    '' using 1:($3 / $5) with linespoints pointtype 7 pointsize 0.6 linewidth 2 linecolor rgb sky title "open section", \
    '' using 1:($4 / $5) with lines dashtype (6, 4) linewidth 2 linecolor rgb grey title "Kozeny, Carman", \
    1 with lines linecolor rgb grey notitle
