# SPDX-License-Identifier: GPL-3.0-or-later
# Variables: tables, the folder of the tables that pipelines/figures/films makes; wide and high, how
# large the slices are side by side, over the width of one.
scale = 42.0 # pixels for a width
right = scale * wide + 40; top = scale * high + 110
set terminal @svg "Helvetica,14" size right, top
unset border
unset tics
set lmargin at screen 20 / right
set rmargin at screen 1 - 20 / right
set bmargin at screen 20 / top
set tmargin at screen 1 - 40 / top
set xrange [0:wide]
set yrange [0:high + 50 / scale] # titles above
set key at screen 0.5, screen 1 - 20 / top center horizontal samplen 2 width 2 textcolor rgb black
film = teal; air = "#d4d4d4"
plot tables . "/level" using ($1 + 0.5):(high / 2):(0.5):(high / 2) with boxxyerror fillcolor "#f8f8f8" \
        fillstyle solid border linecolor "#cccccc" notitle, \
    tables . "/dry" with vectors nohead linewidth 0.7 linecolor rgb air notitle, \
    tables . "/rings" with vectors nohead linewidth 0.9 linecolor rgb film notitle, \
    tables . "/full" with vectors nohead linewidth 0.9 linecolor rgb blue notitle, \
    tables . "/title" using 1:(high + 32 / scale):2 with labels textcolor rgb black notitle, \
    tables . "/level" using ($1 + 0.5):(high + 13 / scale):2 with labels font "Helvetica,11" textcolor rgb grey notitle, \
    NaN with lines linewidth 3 linecolor rgb blue title "full throats", \
    NaN with lines linewidth 3 linecolor rgb film title "films or rings", \
    NaN with lines linewidth 3 linecolor rgb air title "dry"
