# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of what crackstats counted over many runs."""
import math

from common import number, row, rounded

ROWS = [("cracks", "normal", "normal cracks"), ("cracks", "shear", "shear cracks"), ("cracks", "total", "all cracks"),
        ("first", "total", "in the first period"), ("second", "total", "in the second period"),
        ("clusters", "count", "connected cracks"), ("clusters", "largest", "the largest, in bonds"),
        ("fragments", "count", "fragments"), ("front", "saturation", "saturation of the slice a crack opens in"),
        ("front", "correlation", "correlation with the liquid that leaves")]


def mean_and_deviation(counts, group, name):
    """Over the runs: one decimal each; a single run has no deviation."""
    spread = f" ± {rounded(counts['sd'][group][name], 1)}" if counts["sd"] else ""
    return rounded(counts["mean"][group][name], 1) + spread


def counts_table(titled_counts):
    """A row for each (title, counts, published "normal,shear" or ""): cracks by mode, the largest
    connected crack, fragments."""
    yield ("| | runs | normal | shear | total | published: normal, shear | largest connected crack "
           "| in how many runs one spans sideways, upwards | fragments |")
    yield "|---|---|---|---|---|---|---|---|---|"
    for title, counts, published in titled_counts:
        clusters = [each["clusters"] for each in counts["each"]]
        sideways = sum(c["span_x"] + c["span_y"] > 0 for c in clusters)
        yield row(title, counts["runs"], *(mean_and_deviation(counts, "cracks", m) for m in ("normal", "shear", "total")),
                  (published or "-").replace(",", ", "), mean_and_deviation(counts, "clusters", "largest"),
                  f"{sideways}, {sum(c['span_z'] for c in clusters)}", mean_and_deviation(counts, "fragments", "count"))


def three(x):
    """X to three digits."""
    if x is None:
        return "-"
    if x == 0:
        return "0"
    power = math.floor(math.log10(abs(x)))
    if power < -4:
        return f"{rounded(x * 1e200 * 10.0 ** (-200 - power), 2)}e{power}"
    scale = 10.0 ** (2 - power)
    return number(math.copysign(math.floor(abs(x) * scale + 0.5), x) / scale)


def probability(x):
    return "< 1e-300" if x == 0 else three(x)  # too small for a number


def comparison(one, other, test):
    """Cracks of ONE and of the OTHER group of runs, mean ± standard deviation (95 % interval of the
    mean), and by TEST whether the two differ: as groups, or where their runs belong together, by
    their differences."""
    paired = "paired_t" in ((test["test"] or {}).get("cracks") or {}).get("total", {})

    def side(counts, group, name):
        if not counts["sd"]:
            return three(counts["mean"][group][name])
        interval = " to ".join(map(three, counts["confidence_interval"][group][name]))
        return f"{three(counts['mean'][group][name])} ± {three(counts['sd'][group][name])} ({interval})"

    def verdict(group, name):
        found = ((test["test"] or {}).get(group) or {}).get(name) or {}
        of = lambda which, what: (found.get(which) or {}).get(what)
        if not paired:
            return probability(of("welch", "p")), probability(of("mann_whitney", "p"))
        mean = of("paired_t", "mean")
        return (f"{three(mean and -mean)} ± {three(of('paired_t', 'sd'))}", probability(of("paired_t", "p")),
                probability(of("wilcoxon", "p")))

    columns = ["difference", "Student's p", "Wilcoxon's p"] if paired else ["Welch's p", "Mann and Whitney's p"]
    yield f"| | inviscid, {one['runs']} runs | immobile, {other['runs']} runs | {' | '.join(columns)} |"
    yield "|---" * (3 + len(columns)) + "|"
    for group, name, title in ROWS:
        yield row(title, side(one, group, name), side(other, group, name), *verdict(group, name))
