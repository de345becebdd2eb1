# SPDX-License-Identifier: GPL-3.0-or-later
# What pictures have in common; gnuplot reads it before each other *.gp. "set terminal @svg FONT
# size WIDTH,HEIGHT" begins a picture; @axes makes two axes with a grid. Saturations run from 1 to
# 0: time runs to the right.
svg = 'svg linewidth 1 background "#ffffff" font'
axes = 'set border 3 linecolor "#555555"; \
    set tics nomirror out scale 0.6 textcolor "#222222"; \
    set grid xtics ytics linetype 1 linecolor "#e4e4e4" linewidth 1'

# Colours: one meaning each, a line each, for `colour` of common.py reads them too. Nothing must be
# told apart by red and green.
black = "#222222"
grey = "#777777"
blue = "#0a4a96"
red = "#d6201c"
sky = "#4aa3df"
pale = "#7fa4cf"
rose = "#eda29f"
pink = "#cc79a7"
teal = "#1b9e77"
tension = "#101014"
shear = "#e69f00"

# Liquid is blue, forces are red; what broke in tension (normal cracks) or in shear is `tension` or
# `shear`. Curves of drying limits, and of anything else:
inviscid = blue
viscous = sky
immobile = red
array series[6] = [blue, red, sky, pink, teal, grey]

# From wet, 0, to dry, 1.
wet_to_dry(share) = sprintf("#%02x%02x%02x", 10 + 204 * share, 74 - 42 * share, 150 - 122 * share)
