# SPDX-License-Identifier: GPL-3.0-or-later
# Sobol indices with 95 % intervals, a line a parameter. Variable: table, indices.tsv.
set terminal @svg "Helvetica,15" size 760,340
@axes
unset grid
set grid xtics linecolor rgb "#e8e8e8"
set xlabel "share of the variance of the number of cracks"
set xrange [-0.1:1.1]
set yrange [4.5:-0.9] # the first on top
set ytics noenhanced
set lmargin 34
set key top right
plot table using 2:($0 - 0.1):3:4:ytic(1) with xerrorbars pointtype 7 pointsize 0.7 linewidth 2 linecolor rgb blue title "alone (first order)", \
    '' using 5:($0 + 0.1):6:7 with xerrorbars pointtype 6 pointsize 0.7 linewidth 2 linecolor rgb sky title "with all others (total)"
