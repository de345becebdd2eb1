# SPDX-License-Identifier: GPL-3.0-or-later
# The lines and circles of pipelines/figures/boundary-layer, for drying K. Lengths in mean grain
# radii. Variables: tables, k, layers, thick.

function read(name, rows,    line, n) {
    n = 0
    while ((getline line < (tables "/" name)) > 0) rows[n++] = line
    close(tables "/" name)
    return n
}
function draw(name, x0, y0, x1, y1) {
    printf "%.6g %.6g\n%.6g %.6g\n\n", x0, y0, x1, y1 >(tables "/" name "-" k)
}
function circle(name, x, y, r,    step) {
    for (step = 0; step <= 24; step++)
        printf "%.5g %.5g\n", x + r * cos(step * 0.2617994), y + r * sin(step * 0.2617994) \
            >(tables "/" name "-" k)
    print "" >(tables "/" name "-" k)
}

BEGIN {
    n_grain = read("particles-position", grain); read("particles-radius", radius)
    read("kinds", auxiliary); n_node = read("nodes-position", node)
    n_throat = read("throats-nodes", throat); read("throats-kind", kind)
    n_column = read("boundary_layer-node", column); n_link = read("boundary_layer-links", link)
    read("boundary_layer-edge", edge)
    for (i = 0; i < n_grain; i++) unit += radius[i] / n_grain
    for (i = 0; i < n_node; i++) {
        split(node[i], at, " ")
        for (a = 1; a <= 3; a++) place[i, a] = at[a] / unit
    }
    flat = 1
    for (i = 0; i < n_node; i++) if ((place[i, 2] - place[0, 2])^2 > 1e-12) flat = 0
    height = thick / unit / layers
    split("grains auxiliary liquid layer column lateral area foot", files, " ")
    for (f in files) printf "" >(tables "/" files[f] "-" k)
    circle("auxiliary", -1e3, -1e3, 1) # out of sight: there may be no others
    draw("layer", -1e3, -1e3, -1e3, -1e3)
    for (i = 0; i < n_grain; i++) {
        split(grain[i], at, " ")
        if (flat) circle(auxiliary[i] + 0 ? "auxiliary" : "grains", \
                         at[1] / unit, at[3] / unit, radius[i] / unit)
    }
    for (t = 0; t < n_throat; t++) {
        split(throat[t], end, " ")
        if (flat) draw(kind[t] == 1 ? "layer" : "liquid", place[end[1], 1], place[end[1], 3], \
                       place[end[2], 1], place[end[2], 3])
    }
    for (c = 0; c < n_column; c++) {
        i = column[c]
        printf "%.6g %.6g\n", place[i, 1], place[i, flat ? 3 : 2] >(tables "/foot-" k)
        draw("column", place[i, 1], place[i, 3], place[i, 1], place[i, 3] + layers * height)
    }
    for (l = 0; l < n_link; l++) {
        split(link[l], end, " "); a = column[end[1]]; b = column[end[2]]
        split(edge[l], at, " ")
        draw("area", at[1] / unit, at[2] / unit, at[3] / unit, at[4] / unit)
        for (level = 1; level < layers; level++)
            draw("lateral", place[a, 1], place[a, 3] + level * height, \
                 place[b, 1], place[b, 3] + level * height)
    }
    # what the network spans, seen from above
    for (t = 0; t < n_throat; t++) {
        if (kind[t] == 1) continue
        split(throat[t], end, " ")
        for (e = 1; e <= 2; e++)
            for (a = 1; a <= 2; a++) {
                x = place[end[e], a]
                if (!(a in low) || x < low[a]) low[a] = x
                if (!(a in high) || x > high[a]) high[a] = x
            }
    }
    printf "%.6g %.6g\n%.6g %.6g\n%.6g %.6g\n%.6g %.6g\n%.6g %.6g\n", low[1], low[2], high[1], \
        low[2], high[1], high[2], low[1], high[2], low[1], low[2] >(tables "/rectangle-" k)
    print flat, n_column, layers >(tables "/said-" k)
}
