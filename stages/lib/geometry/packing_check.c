// SPDX-License-Identifier: GPL-3.0-or-later
// packing_facts.c measures, here is judged: each function turns some of the facts into
// findings, and says what to do, with the key that does it. The limits stand below.
//
// Findings have three severities: impossible (no packing of grains is like this), wrong
// (hardly what was meant), note. Each has a fixed name for programs and a text for
// people. A finding names the first row it is about, so that it can be looked at.
#include "geometry/packing_check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

// m, of the median radius: at 10 mm a grain weighs some thirty times what water between
// grains can carry (rho g r^2/sigma); below 1 nm it is smaller than molecules of
// liquid.
static const double LARGEST_RADIUS = 1e-2, SMALLEST_RADIUS = 1e-9;
static const double SHARE_THAT_COUNTS = 0.01; // of the grains: fewer are slips of a few
static const double EMPTY_MOST = 0.1;         // share of the box

// Kept sorted, worst first, those of one severity in the order in which they were
// found.
void add_finding(struct findings *findings, enum severity severity, const char *name,
                 const char *format, ...)
{
    if (findings->count == MOST_FINDINGS) return;
    int at = findings->count++;
    for (; at > 0 && findings->item[at - 1].severity < severity; at--)
        findings->item[at] = findings->item[at - 1];
    struct finding *finding = &findings->item[at];
    finding->severity = severity;
    finding->name = name;
    va_list list;
    va_start(list, format);
    vsnprintf(finding->text, sizeof finding->text, format, list);
    va_end(list);
}

int digits_of_origin(const struct packing_facts *facts)
{
    double farthest = 0, side = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double low = component(facts->box.lower, axis);
        const double high = component(facts->box.upper, axis);
        farthest = fmax(farthest, fmax(fabs(low), fabs(high)));
        side = fmax(side, high - low);
    }
    if (!(farthest > side)) return 0;
    return (int)fmin(12, rint(log10(farthest / side)));
}

// ---- one after the other ------------------------------------------------------------

// Powers of 1000, because files are in millimetres, micrometres or nanometres. The
// largest of these that makes grains of the numbers is named, and the next; and
// centimetres (LIGGGHTS' cgs), where these make grains.
static void judge_units(const struct packing_facts *facts, struct findings *findings)
{
    static const char *const unit[] = {"milli", "micro", "nano"};
    int k = 1;
    if (facts->unit > 0) {
        add_finding(findings, FINDING_WRONG, "units",
                    "the file says (in its heading, a dump by ITEM: UNITS) that its "
                    "lengths are in units of %g m; they were taken for metres: "
                    "pack.import.scale=%g",
                    facts->unit, facts->unit);
        return;
    }
    while (k < 3 && facts->median * pow(1e-3, k) > LARGEST_RADIUS)
        k++;
    char next[100] = "";
    if (k < 3)
        snprintf(next, sizeof next, " or in %smetres (1e-%d: %g m)", unit[k],
                 3 * (k + 1), facts->median * pow(1e-3, k + 1));
    char centi[60] = "";
    if (facts->median * 1e-2 <= LARGEST_RADIUS)
        snprintf(centi, sizeof centi, ", centimetres (1e-2: %g m)",
                 facts->median * 1e-2);
    if (facts->median > LARGEST_RADIUS)
        add_finding(findings, FINDING_WRONG, "units",
                    "the median radius is %g m, and liquid holds no grains beyond a "
                    "centimetre: lengths in %smetres (pack.import.scale=1e-%d: %g "
                    "m)%s%s?",
                    facts->median, unit[k - 1], 3 * k, facts->median * pow(1e-3, k),
                    centi, next);
    if (facts->median < SMALLEST_RADIUS)
        add_finding(findings, FINDING_WRONG, "units",
                    "the median radius is %g m, less than molecules of liquid have: "
                    "are lengths "
                    "in metres? pack.import.scale is metres per unit of the file (1 "
                    "for packing.h5)",
                    facts->median);
    if (facts->radius_unit > 1)
        add_finding(findings, FINDING_WRONG, "radii",
                    "the grains fill %.2g of the box: radii in another unit than "
                    "places? Times %g they would make a body",
                    1 - facts->porosity, facts->radius_unit);
    if (facts->largest > 1000 * facts->median)
        add_finding(
            findings, FINDING_WRONG, "sizes",
            "the largest radius, %g m, is %.3g of the median: two units in one file?",
            facts->largest, facts->largest / facts->median);
}

// Of grains in a body the walls need not be those of the box.
static const char *or_domain(const struct packing_facts *facts)
{
    return facts->bounded ? " (round walls: pack.domain; they stand along z)" : "";
}

// The gravest of three only: a grain outside has its centre outside, too.
static void judge_places(const struct packing_facts *facts, struct findings *findings)
{
    if (facts->coincident)
        add_finding(
            findings, FINDING_IMPOSSIBLE, "coincident",
            "/particles/position: row %d: has the same centre as row %d (%d such "
            "pair%s): leave duplicates out",
            facts->same[1], facts->same[0], facts->coincident,
            facts->coincident > 1 ? "s" : "");
    if (facts->outside)
        add_finding(
            findings, FINDING_IMPOSSIBLE, "outside",
            "/particles/position: row %d: the grain is wholly outside the box, as %d "
            "of "
            "%d are: leave them out, or let pack.lower and pack.upper take them in%s",
            facts->first_outside, facts->outside, facts->n, or_domain(facts));
    else if (facts->centres_outside)
        add_finding(
            findings, FINDING_WRONG, "outside",
            "/particles/position: row %d: the centre is outside the box, as those of "
            "%d "
            "of %d grains are: leave them out, or let pack.lower and pack.upper take "
            "them in%s",
            facts->first_centre_outside, facts->centres_outside, facts->n,
            or_domain(facts));
    else if (facts->cut)
        add_finding(
            findings, FINDING_NOTE, "cut",
            "%d of %d grains stick out of the box, row %d the furthest, by %.3g of its "
            "radius: the porosity counts them whole",
            facts->cut, facts->n, facts->deepest, facts->depth);
}

// Doubled radii: most grains overlap, and hardly any when their radii are halved.
static bool look_like_diameters(const struct packing_facts *facts)
{
    return facts->overlapping > facts->n / 2 && facts->overlap > 0.5 &&
           facts->halved <= SHARE_THAT_COUNTS * facts->n;
}

static bool overlap_too_much(const struct packing_facts *facts)
{
    return facts->overlap > 0.5 || facts->overlapping > SHARE_THAT_COUNTS * facts->n;
}

// From the most specific cause to the least: a flattened body and doubled radii are
// overlaps as well.
static void judge_overlaps(const struct packing_facts *facts, struct findings *findings)
{
    const int *worst = facts->worst;
    if (facts->plane >= 0 && facts->overlapping > facts->n / 2)
        add_finding(findings, FINDING_WRONG, "squashed",
                    "all centres lie in one plane across %c, where %d of %d grains "
                    "overlap, rows "
                    "%d and %d by %.3g of the smaller radius: a body squashed flat, "
                    "with %c lost?",
                    "xyz"[facts->plane], facts -> overlapping, facts -> n, worst[0],
                    worst[1], facts -> overlap, "xyz"[facts->plane]);
    else if (look_like_diameters(facts))
        add_finding(
            findings, FINDING_WRONG, "diameters",
            "%d of %d grains overlap, and %s would with half the radius: diameters for "
            "radii? pack.import.diameters=true halves them",
            facts->overlapping, facts->n, facts->halved ? "hardly any" : "none");
    else if (overlap_too_much(facts))
        add_finding(findings, FINDING_WRONG, "overlaps",
                    "%d of %d grains overlap by more than %g of the smaller radius, "
                    "rows %d and "
                    "%d by %.3g: leave one of two out, part them "
                    "(pack.method=explosive_repulsion, then bond over the gaps by "
                    "pack.touching_gap), or keep them (they press only with "
                    "prestress=true)",
                    facts->overlapping, facts->n, OVERLAP_MOST, worst[0], worst[1],
                    facts->overlap);
    else if (facts->overlapping)
        add_finding(findings, FINDING_NOTE, "overlaps",
                    "%d of %d grains overlap by more than %g of the smaller radius, "
                    "rows %d and "
                    "%d by %.3g",
                    facts->overlapping, facts->n, OVERLAP_MOST, worst[0], worst[1],
                    facts->overlap);
}

// The box is larger than the grains, which reach from LOW to HIGH.
static void say_ends(const struct packing_facts *facts, struct vector low,
                     struct vector high, struct findings *findings)
{
    const int n = 6 + digits_of_origin(facts);
    add_finding(findings, FINDING_WRONG, "empty",
                "%.0f %% of the box is more than %.3g m from every grain, and would "
                "fill with liquid: end it with the grains, by "
                "pack.lower=[%.*g,%.*g,%.*g] pack.upper=[%.*g,%.*g,%.*g]",
                100 * facts->empty, facts->far, n, low.x, n, low.y, n, low.z, n, high.x,
                n, high.y, n, high.z);
}

// Of a box wider than the grains say_ends says so as well. Cylinders of pack stand
// along z.
static void judge_roundness(const struct packing_facts *facts,
                            struct findings *findings)
{
    if (facts->round < 0) return;
    const int axis = facts->round;
    if (axis == 3) {
        add_finding(findings, FINDING_WRONG, "round",
                    "the grains end at a sphere, and %.0f %% of their box, its "
                    "corners, would fill with liquid: pack.domain.shape=sphere "
                    "pack.domain.radius=%.6g",
                    100 * (1 - M_PI / 6), facts->reach);
        return;
    }
    char turn[60] = "";
    if (axis != 2)
        snprintf(turn, sizeof turn,
                 "exchange %c and z, along which it must stand, and ", "xy"[axis]);
    const double height = component(facts->upper, axis) - component(facts->lower, axis);
    add_finding(findings, FINDING_WRONG, "round",
                "the grains end at a cylinder along %c, and %.0f %% of their box, its "
                "corners, would fill with liquid: %spack.domain.shape=cylinder "
                "pack.domain.radius=%.6g pack.domain.height=%.6g",
                "xyz"[axis], 100 * (1 - M_PI / 4), turn, facts -> reach, height);
}

// `far` is how far from a surface a place must be to count as empty; where the grains
// reach all walls, the empty part is inside.
static void judge_room(const struct packing_facts *facts, struct findings *findings)
{
    const struct vector low = facts->lower, high = facts->upper;
    if (facts->porosity < 0)
        add_finding(
            findings, FINDING_IMPOSSIBLE, "porosity",
            "the porosity is %.3g: the grains have %.3g of the volume of the box: %s",
            facts->porosity, 1 - facts->porosity,
            look_like_diameters(facts)
                ? "diameters for radii? pack.import.diameters=true halves them"
            : overlap_too_much(facts) ? "they overlap; radii too large?"
                                      : "pack.lower and pack.upper leave them no room");
    if (facts->empty <= EMPTY_MOST) return;
    bool fills = true;
    for (int axis = 0; axis < 3; axis++)
        fills =
            fills &&
            component(low, axis) - component(facts->box.lower, axis) <= facts->far &&
            component(facts->box.upper, axis) - component(high, axis) <= facts->far;
    if (fills)
        add_finding(findings, FINDING_WRONG, "empty",
                    "%.0f %% of the box is more than %.3g m from every grain: a body "
                    "that is no box, or hollow, or whose top a few grains stand out "
                    "of. The empty part would fill with liquid: cut a box out of the "
                    "body (docs/your-grains.md), or say its shape by pack.domain",
                    100 * facts->empty, facts->far);
    else
        say_ends(facts, low, high, findings);
}

// A layer across y is what other stages expect (1 is y).
static void judge_plane(const struct packing_facts *facts, struct findings *findings)
{
    if (facts->plane < 0 || facts->plane == 1 || facts->overlapping > facts->n / 2)
        return;
    add_finding(findings, FINDING_NOTE, "layer",
                "all centres lie in one plane across %c: layers lie in x and z "
                "(pack.dimensions=2, tessellate.dimensions=2): exchange y and %c",
                "xyz"[facts->plane], "xyz"[facts->plane]);
}

// Two grains may touch across both sides of such a box; contacts and bonds are those of
// the nearest image.
static void judge_width(const struct packing *packing,
                        const struct packing_facts *facts, struct findings *findings)
{
    const struct vector edge = subtract(packing->upper, packing->lower);
    const double least = 4 * facts->largest * (1 - 1e-9);
    int axis = 0;
    while (axis < 3 && !(packing->periodic[axis] && component(edge, axis) < least))
        axis++;
    if (axis == 3) return;
    add_finding(findings, FINDING_NOTE, "narrow",
                "the box repeats along %c and is %.3g m wide there, less than two "
                "largest diameters: of grains that touch across both sides one contact "
                "and one bond count; take a wider body, or two side by side",
                "xyz"[axis], component(edge, axis));
}

void judge_packing(const struct packing *packing, const struct packing_facts *facts,
                   struct findings *findings)
{
    if (!facts->n) return;
    judge_units(facts, findings);
    judge_places(facts, findings);
    judge_room(facts, findings);
    judge_roundness(facts, findings);
    judge_width(packing, facts, findings);
    judge_overlaps(facts, findings);
    judge_plane(facts, findings);
}
