# SPDX-License-Identifier: GPL-3.0-or-later
# Variable: tables, the folder of the tables that pipelines/studies/fronts-k/report makes.
wide = 250; high = 190; chart = 300
across = 75 + 4 * wide; total = 40.0 + 5 * high + 2 * chart
set terminal @svg "Helvetica,14" size across, total
set multiplot
level = "0.9 0.7 0.5 0.3"

# --- the five layers: their wet throats -----------------------------------------------------
unset key
unset border
unset tics
set size ratio -1
stats tables . "/state-0-1" using 1 nooutput
xlow = STATS_min; xhigh = STATS_max
stats tables . "/state-0-4" using 2 nooutput
zlow = STATS_min; zhigh = xhigh
set xrange [xlow - 0.5:xhigh + 0.5]
set yrange [zlow - 0.5:zhigh + 0.5]
set object 1 rectangle from xlow, zlow to xhigh, zhigh fillcolor "#f4f4f4" fillstyle solid 1 border linecolor "#bbbbbb" behind
do for [c = 0:3] {
    set label 1 "S = " . word(level, c + 1) at screen (60.0 + wide * (c + 0.5)) / across, screen 1 - 20 / total center textcolor '#222222'
    do for [r = 0:4] {
        set label 2 "" . (r + 1) at screen 25.0 / across, screen 1 - (40 + high * (r + 0.5)) / total center textcolor rgb series[r + 1]
        set lmargin at screen (60.0 + wide * (c + 0.5) - 0.5 * high) / across
        set rmargin at screen (60.0 + wide * (c + 0.5) + 0.5 * high) / across
        set tmargin at screen 1 - (40.0 + high * r + 3) / total
        set bmargin at screen 1 - (40.0 + high * (r + 1) - 3) / total
        plot sprintf("%s/state-%d-%d", tables, r, c + 1) using 1:2:3:4 with vectors nohead linewidth 0.7 linecolor rgb blue
    }
}
unset object 1
unset label 1
unset label 2
set size noratio

# --- rates and profiles ---------------------------------------------------------------------
@axes
set xrange [0:1]
set yrange [0:1.02]
set xtics 0.2
set ytics 0.2
place = "set lmargin at screen (75.0 + 2 * wide * c + 20 * c) / across; set rmargin at screen (75.0 + 2 * wide * (c + 1) - 85 + 20 * c) / across; \
    set tmargin at screen 1 - (40.0 + 5 * high + chart * r + 40) / total; set bmargin at screen 1 - (40.0 + 5 * high + chart * (r + 1) - 55) / total"
do for [r = 0:1] {
    c = 0
    @place
    set title (r == 0 ? "the layers above" : "1220 grains in 3D") offset 0,-0.5 textcolor "#222222"
    set xlabel "saturation of the network" offset 0,0.5
    set ylabel "rate / first rate" offset 0.5,0
    set xrange [1:0]
    set key at graph 0.98, 0.98 right top samplen 2 textcolor "#222222"
    if (r == 0) {
        plot for [k = 0:4] sprintf("%s/rate-%d", tables, k) using 1:2 with lines linewidth 1.4 linecolor rgb series[k + 1] title "" . (k + 1)
    } else {
        plot tables . "/rate-5" using 1:2 with lines linewidth 1.6 linecolor rgb red title "water, no friction", \
            tables . "/rate-6" using 1:2 with lines linewidth 1.6 linecolor rgb blue title "water, friction 0.5", \
            tables . "/rate-7" using 1:2 with lines linewidth 1.6 linecolor rgb grey title "the same, inviscid"
    }
    c = 1
    @place
    unset key
    set xrange [0:1]
    set title (r == 0 ? "mean of the five" : "water, friction 0.5") offset 0,-0.5 textcolor "#222222"
    set xlabel "depth over that of the network" offset 0,0.5
    set ylabel "saturation of slices" offset 0.5,0
    plot for [k = 2:10] tables . (r == 0 ? "/mean-profile" : "/grains-profile") using 1:k with lines linewidth 1.4 linecolor rgb blue
}
unset multiplot
