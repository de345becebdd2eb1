# SPDX-License-Identifier: GPL-3.0-or-later
# Variables: tables, the folder of the tables that pipelines/figures/gradients makes;
# saturation, of the upper row.
wide = 460; high = 470; low = 330; total = 40.0 + high + low; across = 30.0 + 2 * wide + 90
set terminal @svg "Helvetica,14" size across, total
set multiplot
stats tables . "/level" using 1 nooutput
level = STATS_mean
stats tables . "/throats" using ($5 > 0 ? $5 : 1/0) nooutput
least = STATS_min < level ? STATS_min : level
most = STATS_max > level ? STATS_max : level
set palette defined (0 "#bcd9f2", 0.5 "#3f86c8", 1 "#0a2f63")
set cbrange [least:most]

# --- throats and forces ---------------------------------------------------------------
unset key
unset border
unset tics
set size ratio -1
set xrange [-0.3:12.3]
set yrange [-0.3:12.3]
set style fill solid 1
title0 = "one suction everywhere (uniform)"
title1 = "suction of the viscous liquid (field)"
longest = 0.55 # force over that, micrometres an arrow
do for [c = 0:1] {
    set lmargin at screen (20.0 + wide * c) / across
    set rmargin at screen (10.0 + wide * (c + 1)) / across
    set tmargin at screen 1 - 30.0 / total
    set bmargin at screen 1 - (20.0 + high) / total
    set label 1 (c ? title1 : title0) . ", S = " . saturation at graph 0.5, screen 1 - 16.0 / total center textcolor "#222222"
    if (c == 1) {
        set colorbox user origin screen (25.0 + 2 * wide) / across, screen 1 - (high - 40.0) / total size screen 16.0 / across, screen (high - 110.0) / total noborder
        set cblabel "suction, MPa" offset 0.5,0 textcolor "#222222"
        set cbtics scale 0.4 textcolor "#222222"
    } else { unset colorbox }
    arrows = sprintf("%s/arrows-%d", tables, c ? 2 : 0)
    plot arrows using 1:2:3 with circles fillcolor "#e9e4da", \
        tables . "/throats" using 1:2:3:4:(c && $5 > 0 ? $5 : level) with vectors nohead linewidth 2 linecolor palette, \
        arrows using 1:2:($4 / longest):($5 / longest) with vectors head size 0.16,25 filled linewidth 1.2 linecolor rgb red
}
unset label 1
unset colorbox
set size noratio

# --- loads ----------------------------------------------------------------------------
@axes
array colour[3] = [grey, sky, blue]
array name[3] = ["uniform", "clusters", "field"]
set tmargin at screen (low - 26.0) / total
set bmargin at screen 72.0 / total
set xrange [0:*]
set yrange [0:12]
set xtics auto
set ytics auto
set key at graph 0.03, 0.5 left center samplen 2 textcolor "#222222"
set lmargin at screen 70.0 / across
set rmargin at screen (wide - 10.0) / across
set ylabel "height, µm" offset 0.5,0 textcolor "#222222"
set xlabel "load on level cuts, of suction times area (S = " . saturation . ")" offset 0,0.4 textcolor "#222222"
plot for [k = 0:2] sprintf("%s/cuts-%d", tables, k) using 1:2 with lines linewidth 1.8 linecolor rgb colour[k + 1] title name[k + 1]
set key at graph 0.97, 0.97 right top
set lmargin at screen (90.0 + wide) / across
set rmargin at screen (2 * wide + 20.0) / across
set xrange [1:0]
set yrange [0:*]
set ylabel "load on the middle" offset 0.5,0
set xlabel "saturation" offset 0,0.4
plot for [k = 0:2] sprintf("%s/middle-%d", tables, k) using 1:2 with lines linewidth (k ? 1 : 1.8) linecolor rgb colour[k + 1] title name[k + 1]
unset multiplot
