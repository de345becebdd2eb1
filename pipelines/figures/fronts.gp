# SPDX-License-Identifier: GPL-3.0-or-later
# Variable: tables, the folder of the tables that pipelines/figures/fronts makes.
wide = 330; high = 250; total = 40.0 + 4 * high + 2 * 300
set terminal @svg "Helvetica,14" size 70 + 3 * wide, total
set multiplot
liquid = "inviscid viscous immobile"
level = "0.9 0.7 0.5 0.3"
array colour[3] = [inviscid, viscous, immobile]

left(c) = (75.0 + wide * c) / (70 + 3 * wide)
right(c) = (25.0 + wide * (c + 1)) / (70 + 3 * wide)
top(r) = 1 - (40 + (r < 4 ? high * r + 4 : 4 * high + 300 * (r - 4) + 44)) / total
bottom(r) = 1 - (40 + (r < 4 ? high * (r + 1) - 6 : 4 * high + 300 * (r - 3) - 62)) / total
panel = "set lmargin at screen left(c); set rmargin at screen right(c); \
    set tmargin at screen top(r); set bmargin at screen bottom(r)"

# --- snapshots: the wet throats -----------------------------------------------------------
unset key
unset border
unset tics
set size ratio -1
set autoscale fix
stats tables . "/state-0-1" using 1 nooutput
xlow = STATS_min; xhigh = STATS_max
stats tables . "/state-2-1" using 2 nooutput
zlow = STATS_min; zhigh = xhigh
set xrange [xlow - 0.5:xhigh + 0.5]
set yrange [zlow - 0.5:zhigh + 0.5]
do for [c = 0:2] {
    set label 1 word(liquid, c + 1) at screen (left(c) + right(c)) / 2, screen 1 - 20 / total center textcolor '#222222'
    do for [r = 0:3] {
        @panel
        if (c == 0) {
            set label 2 "S = " . word(level, r + 1) at screen 16.0 / (70 + 3 * wide), screen (top(r) + bottom(r)) / 2 \
                center rotate by 90 textcolor '#222222'
        } else { unset label 2 }
        set object 1 rectangle from xlow, zlow to xhigh, zhigh fillcolor "#f4f4f4" fillstyle solid 1 border linecolor "#bbbbbb" behind
        plot sprintf("%s/state-%d-%d", tables, c, r + 1) using 1:2:3:4 with vectors nohead linewidth 0.9 linecolor rgb blue
    }
}
unset object 1
unset label 1
unset label 2
set size noratio

# --- profiles -----------------------------------------------------------------------------
@axes
set xrange [0:1]
set yrange [0:1]
set xtics 0.2
set ytics 0.2
r = 4
set xlabel "depth over that of the network" offset 0,0.5
do for [c = 0:2] {
    @panel
    if (c == 0) { set ylabel "saturation of slices" offset 0.5,0 } else { set ylabel " " offset 0.5,0 }
    plot for [k = 2:10] sprintf("%s/profile-%d", tables, c) using 1:k with lines linewidth 1.4 linecolor rgb colour[c + 1]
}

# --- rates --------------------------------------------------------------------------------
r = 5
set xrange [1:0]
set key at graph 0.98, 0.98 right top samplen 2 textcolor "#222222"
set xlabel "saturation of the network" offset 0,0.5
do for [c = 0:1] {
    @panel
    if (c == 0) { set ylabel "rate / first rate" offset 0.5,0 } else { set ylabel " " offset 0.5,0 }
    set title (c == 0 ? "the layer above" : "283 grains in 3D") offset 0,-0.8 textcolor "#222222"
    plot for [k = 0:2] sprintf("%s/rate-%d-%d", tables, c, k) using 1:2 with lines linewidth 1.6 \
        linecolor rgb colour[k + 1] title word(liquid, k + 1)
}
unset multiplot
