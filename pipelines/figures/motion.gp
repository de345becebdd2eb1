# SPDX-License-Identifier: GPL-3.0-or-later
# Grains as they move, and sums over them. Variables: tables, the folder of the tables that
# pipelines/figures/motion makes; frames, times, the frame of the view (m), the last time, and
# whether there are walls and driven groups.
wide = right - left
high = top - bottom
columns = wide > 2 * high ? 2 : 4
lines_of_frames = (frames + columns - 1) / columns
room = 0.87 / columns
tall = room * 1100. * high / wide
tall = tall > 520 ? 520. : tall
below = 300.
page = lines_of_frames * (tall + 34.) + below
set terminal pngcairo background "#ffffff" font "Helvetica,11" size 1100,page
set multiplot
@axes
unset key
set palette defined (0 "#c9d6ea", 0.35 "#7fa4cf", 0.7 "#0a4a96", 1 "#1a1440")
set cbrange [0:fastest]
set cbtics fastest / (tall < 120 ? 1 : 4)
set format cb "%.2g"
set size ratio -1
unset xtics; unset ytics; unset grid
set border 15 linecolor "#cccccc"
set xrange [left:right]
set yrange [bottom:top]
do for [k = 0:frames - 1] {
    line = k / columns
    foot = below + (lines_of_frames - 1 - line) * (tall + 34.)
    set bmargin at screen foot / page
    set tmargin at screen (foot + tall) / page
    set lmargin at screen 0.02 + (k % columns) * (room + 0.005)
    set rmargin at screen 0.02 + (k % columns) * (room + 0.005) + room
    if (k == columns - 1 || k == frames - 1 && k < columns) {
        set colorbox user origin 0.925, (foot + 10.) / page size 0.012, (tall - 20.) / page
        set label 2 "speed / m/s" at screen 0.985, screen (page - 14.) / page right textcolor "#222222"
    } else { unset colorbox }
    set label 1 word(times, k + 1) . " s" at graph 0, screen (foot + tall + 13.) / page left textcolor "#222222"
    plot tables . sprintf("/frame%d", k) using 1:2:3:4 with circles fillstyle solid border linecolor "#40444444" linewidth 0.3 fillcolor palette
}
unset label 1; unset label 2
unset colorbox
set size noratio
@axes
set xtics autofreq; set ytics autofreq
set xrange [0:last]
set yrange [0:*]
set bmargin at screen 80. / page
set tmargin at screen 255. / page
set xlabel "time / s"
set key at graph 1, graph 1.14 right horizontal samplen 1.5
set format y "%.3g"
set lmargin at screen 0.09
set rmargin at screen 0.47
set ylabel "energy / J"
plot tables . "/history" using 1:2 with lines linewidth 2 linecolor rgb blue title "kinetic", \
    "" using 1:3 with lines linewidth 2 linecolor rgb red title "elastic"
set lmargin at screen 0.60
set rmargin at screen 0.98
set ylabel "largest force / N"
if (walls || driven) {
    plot tables . "/history" using 1:(walls ? $4 : NaN) with lines linewidth 2 linecolor rgb blue title (walls ? "on a wall" : ""), \
        "" using 1:(driven ? $5 : NaN) with lines linewidth 2 linecolor rgb red title (driven ? "on a driven group" : "")
}
unset multiplot
