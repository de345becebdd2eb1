# SPDX-License-Identifier: GPL-3.0-or-later
# What pictures have in common; gnuplot reads it before each other *.gp. "set terminal @svg FONT
# size WIDTH,HEIGHT" begins a picture; @axes makes two axes with a grid.
svg = 'svg linewidth 1 background "#ffffff" font'
axes = 'set border 3 linecolor "#555555"; \
    set tics nomirror out scale 0.6 textcolor "#222222"; \
    set grid xtics ytics linetype 1 linecolor "#e4e4e4" linewidth 1'
blue = "#0a4a96"; red = "#d6201c"; green = "#3a8a3a"; black = "#222222"; grey = "#777777"
