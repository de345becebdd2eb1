# SPDX-License-Identifier: GPL-3.0-or-later
# The lines and circles of pipelines/boundary-figure, for drying K. Lengths in mean grain
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

BEGIN {
    n_grain = read("particles-position", grain); read("particles-radius", radius)
    read("kinds", auxiliary); n_node = read("nodes-position", node)
    n_throat = read("throats-nodes", throat); read("throats-kind", kind)
    n_column = read("boundary_layer-node", column); n_link = read("boundary_layer-links", link)
    read("boundary_layer-edge", edge); read("box", box); split(box[0], corner, " ")
    for (i = 0; i < n_grain; i++) unit += radius[i] / n_grain
    for (i in corner) corner[i] /= unit
    for (i = 0; i < n_node; i++) {
        split(node[i], at, " ")
        for (a = 1; a <= 3; a++) place[i, a] = at[a] / unit
    }
    flat = 1
    for (i = 0; i < n_node; i++) if ((place[i, 2] - place[0, 2])^2 > 1e-12) flat = 0
    # In space a slice of the network, a grain thick, in the middle.
    middle = (corner[2] + corner[5]) / 2
    height = thick / unit / layers

    for (name in files) ; # nothing yet
    split("grains auxiliary liquid layer column lateral areas feet rectangle", files, " ")
    for (f in files) printf "" >(tables "/" files[f] "-" k)
    for (i = 0; i < n_grain; i++) {
        split(grain[i], at, " ")
        y = at[2] / unit - middle; r2 = (radius[i] / unit)^2 - (flat ? 0 : y * y)
        if (r2 <= 0) continue
        printf "%.6g %.6g %.6g\n", at[1] / unit, at[3] / unit, sqrt(r2) >(tables "/" \
            (auxiliary[i] + 0 ? "auxiliary" : "grains") "-" k)
    }
    for (t = 0; t < n_throat; t++) {
        split(throat[t], end, " ")
        if (!flat && ((place[end[1], 2] - middle)^2 > 1 || (place[end[2], 2] - middle)^2 > 1)) continue
        draw(kind[t] == 1 ? "layer" : "liquid", place[end[1], 1], place[end[1], 3], place[end[2], 1], place[end[2], 3])
    }
    for (c = 0; c < n_column; c++) {
        i = column[c]
        printf "%.6g %.6g\n", place[i, 1], place[i, 2] >(tables "/feet-" k)
        if (!flat && (place[i, 2] - middle)^2 > 1) continue
        for (level = 0; level < layers; level++)
            draw("column", place[i, 1], place[i, 3] + level * height, place[i, 1], place[i, 3] + (level + 1) * height)
    }
    for (l = 0; l < n_link; l++) {
        split(link[l], end, " "); a = column[end[1]]; b = column[end[2]]
        split(edge[l], at, " ")
        draw("areas", at[1] / unit, at[2] / unit, at[3] / unit, at[4] / unit)
        if (!flat && ((place[a, 2] - middle)^2 > 1 || (place[b, 2] - middle)^2 > 1)) continue
        for (level = 1; level < layers; level++)
            draw("lateral", place[a, 1], place[a, 3] + level * height, place[b, 1], place[b, 3] + level * height)
    }
    printf "%.6g %.6g\n%.6g %.6g\n%.6g %.6g\n%.6g %.6g\n%.6g %.6g\n", corner[1], corner[2], corner[4],
        corner[2], corner[4], corner[5], corner[1], corner[5], corner[1], corner[2] >(tables "/rectangle-" k)
    printf "%d %d %d\n", flat, n_column, layers >(tables "/said-" k)
}
