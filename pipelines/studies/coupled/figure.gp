# SPDX-License-Identifier: GPL-3.0-or-later
# Variable: courses, two files a sample: a column of panels for each.
set terminal @svg "Helvetica,15" size 1600,980
set multiplot
set border 3 linecolor "#555555"
set xtics nomirror out scale 0.6 textcolor black
set ytics nomirror out scale 0.6 textcolor black
set grid xtics ytics linetype 1 linecolor "#e4e4e4" linewidth 1
set xrange [1:0]
set key top right samplen 2 textcolor rgb black
heading(c) = word("'The soft aggregate, 0.3 of its load' 'The same, weak bonds' 'Irregular and soft' 'The stiff aggregate'", c + 1)
panel = "set lmargin at screen 0.045 + 0.245 * c; set rmargin at screen 0.245 + 0.245 * c; \
    set tmargin at screen 0.93 - 0.23 * r; set bmargin at screen 0.765 - 0.23 * r; \
    set label 1 title at screen 0.045 + 0.245 * c, screen 0.945 - 0.23 * r left textcolor rgb black"
do for [c = 0:3] {
    one = word(courses, 2 * c + 1); two = word(courses, 2 * c + 2)
    set label 2 heading(c) at screen 0.145 + 0.245 * c, screen 0.98 center font ",17" textcolor rgb black
    r = 0; title = "Shrinkage of the volume, %"
    @panel
    set yrange [0:*]
    plot one index 1 using 1:(100 * $2) with lines dashtype (6, 4) linewidth 2 linecolor rgb grey title "one way", \
        two index 1 using 1:(100 * $2) with lines linewidth 2 linecolor rgb blue title "coupled"
    unset label 2
    r = 1; title = "Room for liquid, of the first"
    @panel
    set yrange [0.75:1.05]
    plot one index 0 using 1:4 with lines dashtype (6, 4) linewidth 2 linecolor rgb grey notitle, \
        two index 0 using 1:4 with lines linewidth 2 linecolor rgb blue notitle
    r = 2; title = "Drying rate, of the first"
    @panel
    set yrange [0:1.05]
    plot one index 0 using 1:3 with lines dashtype (6, 4) linewidth 2 linecolor rgb grey notitle, \
        two index 0 using 1:3 with lines linewidth 2 linecolor rgb blue notitle
    r = 3; title = "Cracks"
    @panel
    set xlabel "liquid left, of what the body held when full" offset 0,0.3
    set yrange [0:(c == 1 ? 80 : c == 3 ? 120 : 10)]
    plot one index 2 using 1:2 with steps dashtype (6, 4) linewidth 2 linecolor rgb grey notitle, \
        two index 2 using 1:2 with steps linewidth 2 linecolor rgb blue notitle
    unset xlabel
}
unset multiplot
