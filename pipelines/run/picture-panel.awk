# SPDX-License-Identifier: GPL-3.0-or-later
# One drawing of the sample at one time, seen at a slant from above, as SVG elements, one
# a line: key, class, element. Sorted by their keys they run from back to front.
#
# Reads four tables: throats (x y z x y z radius, m, and liquid share), grains (x y z
# radius), forces (x y z, N) on those grains, cracks (x y z, direction x y z, mode).
# Variables: lower, upper (corners of the box, m), scale (px/m), force_scale (px/N),
# crack_radius (m).

BEGIN {
    split(lower, low); split(upper, high)
    azimuth = 27 * atan2(0, -1) / 180; elevation = 17 * atan2(0, -1) / 180
    right[1] = cos(azimuth); right[2] = sin(azimuth); right[3] = 0
    up[1] = -sin(azimuth) * sin(elevation); up[2] = cos(azimuth) * sin(elevation)
    up[3] = cos(elevation)
    into[1] = -sin(azimuth) * cos(elevation); into[2] = cos(azimuth) * cos(elevation)
    into[3] = -sin(elevation)
    for (k = 1; k <= 3; k++) {
        middle[k] = (low[k] + high[k]) / 2
        half[k] = (high[k] - low[k]) / 2
    }
    ahead[1] = -sin(azimuth); ahead[2] = cos(azimuth); ahead[3] = 0
    deepest = extent(into) / 2; farthest = extent(ahead) / 2
    if (measure) {
        print extent(right), extent(up)
        exit
    }
    draw_box()
}

table == 1 { draw_throat() }
table == 2 { n_grain++; for (k = 1; k <= 3; k++) centre[n_grain, k] = $k; draw_grain() }
table == 3 { draw_force(FNR) }
table == 4 { draw_crack() }

# How far the box reaches in a direction, from side to side.
function extent(axis,  k, sum) {
    for (k = 1; k <= 3; k++) sum += 2 * half[k] * (axis[k] < 0 ? -axis[k] : axis[k])
    return sum
}

function along(axis, x, y, z) { return axis[1] * x + axis[2] * y + axis[3] * z }

# Where a point falls on the paper (at_x, at_y, px), how deep it lies behind it (0 front,
# 1 back), and how far off on the ground, which pales it: top and bottom look alike.
function project(x, y, z) {
    x -= middle[1]; y -= middle[2]; z -= middle[3]
    at_x = scale * along(right, x, y, z)
    at_y = -scale * along(up, x, y, z)
    at_depth = (along(into, x, y, z) / deepest + 1) / 2
    at_distance = (along(ahead, x, y, z) / farthest + 1) / 2
}

# Slices of equal depth are drawn together, so that neighbours share one path.
function emit(depth, rank, class, element) {
    if (depth < 0) depth = 0
    if (depth > 1) depth = 1
    printf "%03d%d\t%s\t%s\n", 500 - int(40 * depth + 0.5), rank, class, element
}

# Six shades, 0 in front.
function shade() {
    return at_distance <= 0 ? 0 : at_distance >= 1 ? 5 : int(6 * at_distance)
}

function path(x0, y0, z0, x1, y1, z1,  d) {
    project(x0, y0, z0)
    d = sprintf("M%.1f %.1f", at_x, at_y)
    project(x1, y1, z1)
    return d sprintf("L%.1f %.1f", at_x, at_y)
}

function draw_box(  k, i, j, a, b, p, q, front) {
    for (k = 1; k <= 3; k++) {
        a = k % 3 + 1; b = a % 3 + 1
        for (i = 0; i < 2; i++)
            for (j = 0; j < 2; j++) {
                p[k] = low[k]; q[k] = high[k]
                p[a] = q[a] = i ? high[a] : low[a]
                p[b] = q[b] = j ? high[b] : low[b]
                # an edge is behind when both its faces look away
                front = (i ? -into[a] : into[a]) > 0 || (j ? -into[b] : into[b]) > 0
                emit(front ? 0 : 1, front ? 9 : 0, "box", path(p[1], p[2], p[3], q[1], q[2], q[3]))
            }
    }
}

function draw_throat(  d, width) {
    d = path($1, $2, $3, $4, $5, $6)
    project(($1 + $4) / 2, ($2 + $5) / 2, ($3 + $6) / 2)
    if ($8 < 1) emit(at_depth, 1, "dry", d)
    if ($8 <= 0) return
    width = int(1 + 0.6 * sqrt($8) * $7 * scale + 0.5)
    if (width > 12) width = 12
    emit(at_depth, 2, "wet" shade() " w" width, d)
}

function draw_grain() {
    project($1, $2, $3)
    emit(at_depth, 4, "", sprintf("<circle class=\"g\" cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"/>", at_x,
        at_y, $4 * scale))
}

function draw_force(i,  dx, dy, size) {
    project(centre[i, 1], centre[i, 2], centre[i, 3])
    dx = force_scale * along(right, $1, $2, $3)
    dy = -force_scale * along(up, $1, $2, $3)
    size = sqrt(dx * dx + dy * dy)
    if (size > 1.5) emit(at_depth, 6, "force" shade(), arrow(at_x, at_y, dx / size, dy / size, size))
}

# An arrow as one closed outline, from x, y in direction ux, uy.
function arrow(x, y, ux, uy, size,  head, d) {
    head = size < 9 ? size : 9
    d = "M" beside(x, y, ux, uy, 0, 0.9) "L" beside(x, y, ux, uy, size - head, 0.9)
    d = d " " beside(x, y, ux, uy, size - head, 0.36 * head) " " beside(x, y, ux, uy, size, 0)
    d = d " " beside(x, y, ux, uy, size - head, -0.36 * head)
    return d " " beside(x, y, ux, uy, size - head, -0.9) " " beside(x, y, ux, uy, 0, -0.9) "Z"
}

# The point so far along a direction and so far to its side.
function beside(x, y, ux, uy, far, side) {
    return sprintf("%.1f %.1f", x + far * ux - side * uy, y + far * uy + side * ux)
}

# The cross-section of a broken bond: a disc, seen at its slant.
function draw_crack(  size, dx, dy, tilt) {
    project($1, $2, $3)
    size = sqrt($4 * $4 + $5 * $5 + $6 * $6)
    dx = along(right, $4, $5, $6) / size; dy = -along(up, $4, $5, $6) / size
    tilt = along(into, $4, $5, $6) / size
    if (tilt < 0) tilt = -tilt
    if (tilt < 0.3) tilt = 0.3
    emit(at_depth, 7, "", sprintf( \
        "<ellipse class=\"%s\" rx=\"%.1f\" ry=\"%.1f\" transform=\"translate(%.1f %.1f)rotate(%.0f)\"/>", \
        $7 ? "shear" : "normal", crack_radius * scale * tilt, crack_radius * scale, at_x, at_y, \
        atan2(dy, dx) * 180 / atan2(0, -1)))
}
