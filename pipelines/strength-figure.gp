# SPDX-License-Identifier: GPL-3.0-or-later
# K's Table 5.2. Variable: tables, the folder of the columns that pipelines/strength-figure makes.
set terminal @svg "Helvetica,15" size 1100,330
set multiplot layout 1,5 margins 0.05,0.99,0.2,0.87 spacing 0.045
set border 3 linecolor "#555555"
set tics nomirror out scale 0.6 textcolor "#222222"
set grid ytics linetype 1 linecolor "#e4e4e4" linewidth 1
set xtics 0.4
set xrange [0.25:2.15]
set yrange [0:*]
set key top right samplen 1 spacing 1.1 font ",13" textcolor "#222222"
blue = 0x0a4a96; red = 0xd6201c; black = 0x222222
array heading[5] = ["first period, shear", "first period, normal", "second period, shear", \
    "second period, normal", "all"]
series(liquid, k) = sprintf("%s/%s-%d", tables, liquid, k)

do for [k = 1:5] {
    set title heading[k] offset 0,-0.4 font ",15" textcolor black
    if (k == 3) { set xlabel "strength of the bonds, 10^4 N/m^2" offset 0,0.2 } else { unset xlabel }
    plot series("inviscid", k) using 1:2:3 with errorlines linecolor rgb blue linewidth 2 \
            pointtype 7 pointsize 0.6 title "inviscid", \
         series("immobile", k) using ($1 + 0.06):2:3 with yerrorbars linecolor rgb red linewidth 2 \
            pointtype 5 pointsize 0.6 title "immobile", \
         series("K", k) using ($1 + 0.06 * $3):2:($3 > 0 ? red : black) with points linecolor rgb variable \
            linewidth 1.6 pointtype 8 pointsize 1 notitle, \
         NaN with points linecolor rgb black linewidth 1.6 pointtype 8 pointsize 1 title "K"
    unset key
}
unset multiplot
