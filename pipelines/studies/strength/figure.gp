# SPDX-License-Identifier: GPL-3.0-or-later
# K's Table 5.2. Variable: tables, the folder of the columns that pipelines/studies/strength/figure makes.
set terminal @svg "Helvetica,15" size 1100,330
set multiplot layout 1,5 margins 0.05,0.99,0.2,0.87 spacing 0.045
set border 3 linecolor "#555555"
set tics nomirror out scale 0.6 textcolor "#222222"
set grid ytics linetype 1 linecolor "#e4e4e4" linewidth 1
set xtics 0.4
set xrange [0.25:2.15]
set yrange [0:*]
set key top right samplen 1 spacing 1.1 font ",13" textcolor "#222222"
array heading[5] = ["first period, shear", "first period, normal", "second period, shear", \
    "second period, normal", "all"]
column_of(liquid, k) = sprintf("%s/%s-%d", tables, liquid, k)

do for [k = 1:5] {
    set title heading[k] offset 0,-0.4 font ",15" textcolor black
    if (k == 3) { set xlabel "strength of the bonds, 10^4 N/m^2" offset 0,0.2 } else { unset xlabel }
    plot column_of("inviscid", k) using 1:2:3 with errorlines linecolor rgb inviscid linewidth 2 \
            pointtype 7 pointsize 0.6 title "inviscid", \
         column_of("immobile", k) using ($1 + 0.06):2:3 with yerrorbars linecolor rgb immobile linewidth 2 \
            pointtype 5 pointsize 0.6 title "immobile", \
         column_of("K", k) using ($3 > 0 ? $1 + 0.06 : NaN):2 with points linecolor rgb immobile \
            linewidth 1.6 pointtype 8 pointsize 1 notitle, \
         column_of("K", k) using ($3 > 0 ? NaN : $1):2 with points linecolor rgb black \
            linewidth 1.6 pointtype 8 pointsize 1 notitle, \
         NaN with points linecolor rgb black linewidth 1.6 pointtype 8 pointsize 1 title "K"
    unset key
}
unset multiplot
