# SPDX-License-Identifier: GPL-3.0-or-later
# Sorted lines of key, class, element to SVG: neighbours of one class become one path.
BEGIN { FS = "\t" }
$2 != class { flush() }
{ class = $2; if (class == "") print $3; else d = d $3 }
END { flush() }
function flush() {
    if (d != "") printf "<path class=\"%s\" d=\"%s\"/>\n", class, d
    d = ""
}
