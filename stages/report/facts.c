// SPDX-License-Identifier: GPL-3.0-or-later
// Every number is read from an artifact or counted here; none is made up, and what is
// not known is left out, not written as 0. Numbers that belong to a moment carry its
// key and grain, so that the page can lead there.
//
// Which artifact says what: cracks the response, rates and saturations the drying,
// suction the forces, pieces and shrinkage crackstats.
//
//     first crack       /cracks of the response, row 0; they are in the order of time
//     modes             /cracks/mode: 0 tension, 1 shear
//     broken before     /earlier_cracks and /weight_cracks of the response
//     rates             /history/rate of the drying at the rows of the course; of its
//                       /summary first_period_end_time and _saturation, and
//                       breakthrough_saturation
//     open sides        /summary/open_walls of the drying, bits
//     forces            the largest load (body.c), /summary/capillary_pressure of the
//                       forces, the largest of /snapshots/contact_force of the response
//     pieces            mean.fragments, .clusters, .shrinkage of crackstats of this run
//     makeup            the packing and network themselves
#include "facts.h"

#include "html.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

// The number at a path of objects, "mean", "cracks", "total", NULL; NAN: none.
static double number_in(const json_t *json, const char *const *path)
{
    for (; *path; path++)
        json = json_object_get(json, *path);
    return json_is_number(json) ? json_number_value(json) : NAN;
}
#define IN(json, ...) number_in(json, (const char *const[]){__VA_ARGS__, NULL})

// NAN where there is no such artifact, or it does not say. NAME is a whole path.
static double summary_of(const struct run *run, enum kind kind, const char *name)
{
    const struct artifact *artifact = run->of[kind];
    return artifact && artifact_has_number(artifact, name)
               ? artifact_get_number(artifact, name)
               : NAN;
}

// COUNT[0] in tension, [1] in shear.
static void count_modes(const struct run *run, int count[2])
{
    count[0] = count[1] = 0;
    for (int k = 0; k < run->n_crack; k++)
        count[run->crack_mode[k]]++;
}

// ---- the headline -------------------------------------------------------------------

// The mode with more cracks first.
static void say_modes(FILE *page, const struct run *run)
{
    int count[2];
    count_modes(run, count);
    const int total = count[0] + count[1];
    const int more = count[1] >= count[0];
    static const char *const mode[] = {"tension", "shear"};
    if (count[!more] == 0)
        put_line(page, ", %s in %s", total == 1 ? "it was" : "all", mode[more]);
    else
        put_line(page, ", %d in %s and %d in %s", count[more], mode[more], count[!more],
                 mode[!more]);
}

// An interval may reach below 0, a count cannot. Of the crackstats of several runs;
// nothing where it has no interval.
static void say_repeated(FILE *page, const json_t *repeated)
{
    const double runs = IN(repeated, "runs"),
                 total = IN(repeated, "mean", "cracks", "total");
    const json_t *interval = json_object_get(
        json_object_get(json_object_get(repeated, "confidence_interval"), "cracks"),
        "total");
    if (!json_is_array(interval) || isnan(total)) return;
    char text[3][40];
    put_line(page, " Over %g runs %s broke on average (%s to %s: %s).", runs,
             plain(total, 3, text[0]),
             plain(fmax(0, json_number_value(json_array_get(interval, 0))), 3, text[1]),
             plain(json_number_value(json_array_get(interval, 1)), 3, text[2]),
             json_string_value(json_object_get(repeated, "interval_of"))
                 ? json_string_value(json_object_get(repeated, "interval_of"))
                 : "confidence interval");
}

// Cracks are in the order of time: half of them have broken with number (n - 1) / 2.
static void say_cracks(FILE *page, const struct run *run)
{
    const int bonds = run->packing.n_bond, n = run->n_crack;
    if (!n) {
        put_line(page, "None of the %d bonds broke.", bonds);
        const double shrinkage = counted_mean(run, "shrinkage", "largest");
        if (shrinkage > 0)
            put_line(page, " The body shrank by up to %.3g %% of its volume.",
                     100 * shrinkage);
        return;
    }
    put_line(page, "%d of %d bonds broke (%.2g %%)", n, bonds, 100.0 * n / bonds);
    say_modes(page, run);
    put_line(page, ": the first at a saturation of %.2g, half of them by %.2g.",
             run->crack_saturation[0], run->crack_saturation[(n - 1) / 2]);
}

// The last artifact of the chain gives the sentence: cracks, else the drying, else the
// body.
void put_headline(FILE *page, const struct run *run, const struct course *course)
{
    char time[40];
    if (run->of[RESPONSE])
        say_cracks(page, run);
    else if (run->of[DRYING] && course->n_row)
        put_line(page, "The liquid of %d grains dried to a saturation of %.2g in %s.",
                 run->packing.n_particle, course->saturation[course->n_row - 1],
                 with_unit(course->time[course->n_row - 1], "s", time));
    else
        put_line(page, "%d grains, %d bonds.", run->packing.n_particle,
                 run->packing.n_bond);
    if (run->repeated) say_repeated(page, run->repeated);
}

// ---- the list -----------------------------------------------------------------------

const struct where nowhere = {-1, -1};

// The button carries key and grain for the script; without script it does nothing.
void put_fact(FILE *page, struct where where, const char *term, const char *format, ...)
{
    char text[600];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    fputs("<div><dt>", page);
    put_text(page, term);
    fputs("</dt><dd>", page);
    put_text(page, text);
    if (where.key >= 0) {
        fprintf(page, " <button type=\"button\" class=\"go\" data-key=\"%lld\"",
                (long long)where.key);
        if (where.grain >= 0)
            fprintf(page, " data-grain=\"%lld\"", (long long)where.grain);
        fputs(" aria-label=\"Show: ", page);
        put_text(page, term);
        fputs("\">show</button>", page);
    }
    fputs("</dd></div>\n", page);
}

// Where between two sides of the box.
static double share_of_box(const struct packing *packing, struct vector place, int axis)
{
    const double low = component(packing->lower, axis),
                 high = component(packing->upper, axis);
    const double share = (component(place, axis) - low) / (high - low);
    return packing->periodic[axis] ? share - floor(share) : share;
}

// Several bonds may break under one load; the first listed stands for them.
static void put_first_crack(FILE *page, const struct run *run,
                            const struct course *course)
{
    static const char *const mode[] = {"tension", "shear"};
    if (!run->n_crack) return;
    const struct packing *packing = &run->packing;
    const int32_t *bond = packing->bond[run->crack_bond[0]];
    struct vector *place = artifact_get(run->of[RESPONSE], "/cracks/position", NULL);
    const struct vector first = place[0];
    free(place);
    int others = 0;
    while (others + 1 < run->n_crack &&
           run->crack_time[others + 1] == run->crack_time[0])
        others++;
    char time[40], more[60] = "";
    if (others)
        snprintf(more, sizeof more, "; %d more opened under the same load", others);
    put_fact(page, (struct where){key_of(course, run->crack_time[0]), bond[0]},
             "First crack",
             "at saturation %.3g (%s), in %s, between grains %d and %d, at %.0f %% of "
             "the height of the box (z), %.0f %% along x and %.0f %% along y%s",
             run->crack_saturation[0], with_unit(run->crack_time[0], "s", time),
             mode[run->crack_mode[0]], bond[0], bond[1],
             100 * share_of_box(packing, first, 2),
             100 * share_of_box(packing, first, 0),
             100 * share_of_box(packing, first, 1), more);
}

static void put_broken_before(FILE *page, const struct run *run)
{
    if (run->n_before)
        put_fact(page, nowhere, "Broken before",
                 "%d bond%s, in replays that this one goes on from or under the "
                 "weight: no crack%s of this replay",
                 run->n_before, run->n_before == 1 ? "" : "s",
                 run->n_before == 1 ? "" : "s");
}

static void put_modes(FILE *page, const struct run *run)
{
    if (!run->of[RESPONSE]) return;
    int count[2];
    count_modes(run, count);
    if (count[0] + count[1])
        put_fact(page, nowhere, "Modes", "%d in tension, %d in shear (%.0f %%)",
                 count[0], count[1], 100.0 * count[1] / (count[0] + count[1]));
}

double counted_mean(const struct run *run, const char *group, const char *name)
{
    return IN(run->counted, "mean", group, name);
}

// Of rows, so it is as fine as these.
int row_of_half_rate(const struct course *course)
{
    int row = 0;
    while (row < course->n_row && course->rate &&
           course->rate[row] > course->rate[0] / 2)
        row++;
    return course->rate && row < course->n_row ? row : -1;
}

// Only a drying has rates. Its end is the last row of the course.
static void put_rates(FILE *page, const struct run *run, const struct course *course)
{
    if (!course->rate || !course->n_row) return;
    char time[40];
    const int row = row_of_half_rate(course);
    if (row >= 0)
        put_fact(page, (struct where){(int64_t)row * course->keys_a_row, -1},
                 "Rate at half its start", "at saturation %.3g (%s)",
                 course->saturation[row], with_unit(course->time[row], "s", time));
    const double first = summary_of(run, DRYING, "/summary/first_period_end_time");
    put_fact(page, (struct where){key_of(course, first), -1}, "First drying period",
             "ends at saturation %.3g (%s)",
             summary_of(run, DRYING, "/summary/first_period_end_saturation"),
             with_unit(first, "s", time));
    put_fact(page, nowhere, "Drying ends", "at saturation %.3g, after %s",
             course->saturation[course->n_row - 1],
             with_unit(course->time[course->n_row - 1], "s", time));
    const double through = summary_of(run, DRYING, "/summary/breakthrough_saturation");
    if (through > 0)
        put_fact(page, nowhere, "Gas breaks through", "at saturation %.3g", through);
}

// What FORCE on the second of two grains does to them; where the box repeats the way
// between them is not that between their places.
static const char *push_or_pull(const struct run *run, const int32_t pair[2],
                                struct vector force)
{
    const struct packing *packing = &run->packing;
    if (packing->periodic[0] || packing->periodic[1] || packing->periodic[2])
        return "between";
    const struct vector apart =
        subtract(packing->position[pair[1]], packing->position[pair[0]]);
    return dot(force, apart) > 0 ? "presses" : "pulls at";
}

// The button leads to the first of the two grains.
static void say_contact(FILE *page, const struct run *run, const struct course *course,
                        const int32_t pair[2], struct vector force, double when)
{
    char text[40];
    put_fact(page, (struct where){key_of(course, when), pair[0]},
             "Largest contact force",
             "%s %s grains %d and %d, at saturation %.3g (of the snapshots)",
             with_unit(norm(force), "N", text), push_or_pull(run, pair, force), pair[0],
             pair[1], saturation_at(course, when));
}

// Over snapshots, not over all loads: the response keeps contact forces at those alone.
static void put_largest_contact(FILE *page, const struct run *run,
                                const struct course *course)
{
    const struct artifact *response = run->of[RESPONSE];
    if (!response) return;
    int n_snapshot, n_contact;
    int32_t(*pair)[2] = artifact_get(response, "/contacts/particles", &n_contact);
    double *time = artifact_get(response, "/snapshots/time", &n_snapshot);
    struct vector *force = artifact_get(response, "/snapshots/contact_force", NULL);
    double most = 0;
    size_t at = 0;
    for (size_t k = 0; k < (size_t)n_snapshot * (size_t)n_contact; k++)
        if (norm(force[k]) > most) {
            most = norm(force[k]);
            at = k;
        }
    if (most > 0)
        say_contact(page, run, course, pair[at % (size_t)n_contact], force[at],
                    time[at / (size_t)n_contact]);
    free(pair);
    free(time);
    free(force);
}

// The sides that dry. Bits of the walls -x, +x, -y, +y, -z, +z.
static void put_open_sides(FILE *page, const struct run *run)
{
    static const char *const side[] = {"-x", "+x",          "-y",
                                       "+y", "-z (bottom)", "+z (top)"};
    const double bits = summary_of(run, DRYING, "/summary/open_walls");
    char text[80] = "";
    for (int w = 0; bits > 0 && w < 6; w++)
        if ((int)bits >> w & 1)
            snprintf(text + strlen(text), sizeof text - strlen(text), "%s%s",
                     *text ? ", " : "", side[w]);
    if (*text) put_fact(page, nowhere, "Open to the air", "%s", text);
}

// HEAVIEST and its time come from put_body, which saw every load.
static void put_forces(FILE *page, const struct run *run, const struct course *course,
                       const struct shown_body *body)
{
    char text[40];
    if (body->largest_load > 0)
        put_fact(page,
                 (struct where){key_of(course, body->heaviest_time), body->heaviest},
                 "Pulled most by the liquid",
                 "grain %d: the liquid pulls it with %s at saturation %.3g",
                 body->heaviest, with_unit(body->largest_load, "N", text),
                 saturation_at(course, body->heaviest_time));
    const double suction = summary_of(run, FORCES, "/summary/capillary_pressure");
    if (suction > 0)
        put_fact(page, nowhere, "Suction", "%s in a throat of mean radius",
                 with_unit(suction, "Pa", text));
    put_largest_contact(page, run, course);
}

// Each only where crackstats says it: it is the one that counts them.
static void put_pieces(FILE *page, const struct run *run)
{
    const double pieces = counted_mean(run, "fragments", "count");
    if (!isnan(pieces))
        put_fact(page, nowhere, "Pieces at the end", "%.0f, the largest of %.0f grains",
                 pieces, counted_mean(run, "fragments", "largest"));
    const double largest = counted_mean(run, "clusters", "largest");
    if (!isnan(largest))
        put_fact(page, nowhere, "Connected cracks",
                 "%.0f clusters, the largest of %.0f bonds",
                 counted_mean(run, "clusters", "count"), largest);
    const double shrinkage = counted_mean(run, "shrinkage", "largest");
    if (!isnan(shrinkage))
        put_fact(page, nowhere, "Shrinkage", "at most %.3g %% of the volume",
                 100 * shrinkage);
}

// One size if all are equal to a thousandth.
void put_makeup(FILE *page, const struct run *run)
{
    const struct packing *packing = &run->packing;
    if (!packing->n_particle) return;
    double least = packing->radius[0], most = least;
    for (int i = 1; i < packing->n_particle; i++) {
        least = fmin(least, packing->radius[i]);
        most = fmax(most, packing->radius[i]);
    }
    char low[40], high[40], all[100];
    snprintf(all, sizeof all, most > least * 1.001 ? "%s to %s" : "%s",
             with_unit(2 * least, "m", low), with_unit(2 * most, "m", high));
    put_fact(page, nowhere, "Grains", "%d, %s in diameter, %d bonds",
             packing->n_particle, all, packing->n_bond);
    if (run->network.n_throat)
        put_fact(page, nowhere, "Pores", "%d throats between %d nodes",
                 run->network.n_throat, run->network.n_node);
}

// The order is that in which people ask: cracks, drying, forces, pieces, the body.
void put_facts(FILE *page, const struct run *run, const struct course *course,
               const struct shown_body *body)
{
    fputs("<dl class=\"facts\">\n", page);
    put_first_crack(page, run, course);
    put_modes(page, run);
    put_broken_before(page, run);
    put_rates(page, run, course);
    put_open_sides(page, run);
    put_forces(page, run, course, body);
    put_pieces(page, run);
    put_makeup(page, run);
    fputs("</dl>\n", page);
}
