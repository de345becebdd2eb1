// SPDX-License-Identifier: GPL-3.0-or-later
// Measures a packing: sizes, overlaps, contacts, fabric, porosity in slices, and the
// radial distribution. Porosities are exact (spheres cut by boxes, overlaps counted
// once). Bulk values are taken in a window away from the walls; for a cylinder or
// sphere in the largest inscribed cuboid, whose half edge is (R - margin) / sqrt(number
// of round axes).
//
// Slices are a fifth of a mean diameter high, distances of g(r) a twentieth apart, to
// five diameters. Measures without meaning are left out by not being finite:
// report_number drops them. Each `say_` function adds the entries of one measure, in
// the order in which they are reported.
#include "report.h"

#include "artifacts/document.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "geometry/fabric.h"
#include "geometry/neighbours.h"
#include "geometry/radial_distribution.h"

#include <stdlib.h>
#include <string.h>

// 13 classes of inclination: no contact of a common lattice lies on their borders.
enum { MAX_SLICES = 4096, INCLINATIONS = 13, SIZES = 24 };
static const int SLICES_OF_A_DIAMETER = 5, DISTANCES_OF_A_DIAMETER = 20,
                 DIAMETERS_TO_LOOK = 5;

// The packing under study, and the windows of its measurements.
struct subject {
    const struct packing *packing;
    const struct domain *domain;
    struct contacts contacts;
    double gap;
    bool flat, has_friction;
    bool has_bulk, has_column;
    struct window bulk;   // away from the walls
    struct window column; // what is sliced
};

// ---- what is said -------------------------------------------------------------------

void report_number(struct packing_report *report, const char *name, double number)
{
    if (!(fabs(number) <= 1e150)) return; // the largest that artifacts hold
    if (report->count == MAX_ENTRIES) die(STATUS_INTERNAL, "%s: too much to say", name);
    report->entry[report->count++] =
        (struct report_entry){.name = name, .number = number};
}

// Takes VALUE over. A curve with one number that is not finite is dropped whole: half
// of it would mislead.
static void report_curve(struct packing_report *report, const char *name, double *value,
                         int count)
{
    bool fits = count > 0;
    for (int k = 0; k < count; k++)
        fits = fits && fabs(value[k]) <= 1e150;
    if (!fits) {
        free(value);
        return;
    }
    report_number(report, name, 0);
    report->entry[report->count - 1].count = count;
    report->entry[report->count - 1].value = value;
}

// The middles of COUNT equal classes from LOW on.
static double *class_middles(double low, double width, int count)
{
    double *middle = NEW_ARRAY(double, count);
    for (int k = 0; k < count; k++)
        middle[k] = low + (k + 0.5) * width;
    return middle;
}

// ---- where --------------------------------------------------------------------------

// The largest cuboid in a cylinder or sphere with equal edges along its round axes,
// MARGIN away from the wall. False where nothing is left of it.
static bool cuboid_within(const struct subject *subject, double margin,
                          struct window *window)
{
    const struct domain *domain = subject->domain;
    const bool sphere = domain->shape == DOMAIN_SPHERE;
    const bool round[3] = {true, !subject->flat, sphere};
    const double half =
        (domain->radius - margin) / sqrt(round[0] + round[1] + round[2]);
    *window = (struct window){domain->lower, domain->upper};
    for (int axis = 0; axis < 3; axis++) {
        const double centre = component(domain->centre, axis);
        const bool wall = !round[axis] && !domain->periodic[axis] && axis == 2;
        const double low = component(domain->lower, axis) + (wall ? margin : 0);
        const double high = component(domain->upper, axis) - (wall ? margin : 0);
        set_component(&window->lower, axis, round[axis] ? centre - half : low);
        set_component(&window->upper, axis, round[axis] ? centre + half : high);
        if (!(component(window->upper, axis) - component(window->lower, axis) >
              1e-9 * margin))
            return false;
    }
    return true;
}

// A ring or a domain with a cut-out has no inscribed cuboid that stands for it: no bulk
// then, and no slices.
static void choose_windows(struct subject *subject)
{
    const struct domain *domain = subject->domain;
    if (!subject->packing->n_particle || domain->cut != CUT_NONE ||
        domain->shape == DOMAIN_RING)
        return;
    if (domain->shape == DOMAIN_BOX) {
        subject->has_bulk = inner_window(subject->packing, &subject->bulk);
        subject->has_column = true;
        subject->column =
            (struct window){subject->packing->lower, subject->packing->upper};
        return;
    }
    const double margin = 2 * mean_radius(subject->packing);
    subject->has_bulk = cuboid_within(subject, margin, &subject->bulk);
    subject->has_column = subject->has_bulk;
    subject->column = subject->bulk;
    if (domain->shape == DOMAIN_SPHERE) return;
    subject->column.lower.z = subject->packing->lower.z;
    subject->column.upper.z = subject->packing->upper.z;
}

// Whether a grain spans a periodic box more than a hundred times: not worth the time.
static bool reaches_round(const struct packing *packing)
{
    for (int axis = 0; axis < 3; axis++) {
        const double edge =
            component(packing->upper, axis) - component(packing->lower, axis);
        for (int i = 0; i < packing->n_particle && packing->periodic[axis]; i++)
            if (packing->radius[i] > 100 * edge) return true;
    }
    return false;
}

// ---- measurements -------------------------------------------------------------------

// One size has no histogram.
static void say_sizes(const struct packing *packing, struct packing_report *report)
{
    const int n = packing->n_particle;
    if (!n) return;
    double least = packing->radius[0], most = least;
    for (int i = 1; i < n; i++) {
        least = fmin(least, packing->radius[i]);
        most = fmax(most, packing->radius[i]);
    }
    report_number(report, "/summary/mean_radius", mean_radius(packing));
    report_number(report, "/summary/smallest_radius", least);
    report_number(report, "/summary/largest_radius", most);
    if (!(most - least > 1e-9 * most)) return;
    const double width = (most - least) / SIZES;
    double *count = NEW_ARRAY(double, SIZES);
    for (int i = 0; i < n; i++) {
        const int k = (int)((packing->radius[i] - least) / width);
        count[k < SIZES ? k : SIZES - 1]++;
    }
    report_curve(report, "/structure/radius/value", class_middles(least, width, SIZES),
                 SIZES);
    report_curve(report, "/structure/radius/count", count, SIZES);
}

// Over the smaller radius, as schemas/packing.json says; pairs across a gap count as 0.
static void say_overlaps(const struct subject *subject, struct packing_report *report)
{
    const struct packing *packing = subject->packing;
    double most = 0, sum = 0;
    for (int k = 0; k < subject->contacts.count; k++) {
        const int i = subject->contacts.pair[k][0], j = subject->contacts.pair[k][1];
        const double a = packing->radius[i], b = packing->radius[j];
        const double apart = norm(nearest_image(packing, i, j));
        const double overlap = fmax(0, (a + b - apart) / fmin(a, b));
        most = fmax(most, overlap);
        sum += overlap;
    }
    report_number(report, "/summary/max_overlap", most);
    if (subject->contacts.count)
        report_number(report, "/summary/mean_overlap", sum / subject->contacts.count);
}

static void say_histogram(const int *contacts, int n, struct packing_report *report)
{
    int most = 0;
    for (int i = 0; i < n; i++)
        most = contacts[i] > most ? contacts[i] : most;
    double *grains = NEW_ARRAY(double, most + 1);
    for (int i = 0; i < n; i++)
        grains[contacts[i]]++;
    report_curve(report, "/structure/coordination", grains, n ? most + 1 : 0);
}

// Rattlers carry nothing: `firm` counts contacts between grains that are none.
static void say_contacts(const struct subject *subject, struct packing_report *report)
{
    const int n = subject->packing->n_particle;
    const struct contacts *contacts = &subject->contacts;
    int *walls = wall_contacts(subject->packing, subject->gap);
    int *count = grain_contacts(subject->packing, contacts);
    uint8_t *rattler =
        find_rattlers(subject->packing, contacts, walls,
                      least_contacts(subject->packing, subject->has_friction));
    int64_t at_walls = 0;
    int rattlers = 0, firm = 0;
    for (int i = 0; i < n; i++) {
        at_walls += walls[i];
        rattlers += rattler[i];
    }
    for (int k = 0; k < contacts->count; k++)
        firm += !rattler[contacts->pair[k][0]] && !rattler[contacts->pair[k][1]];
    report_number(report, "/summary/coordination", n ? 2.0 * contacts->count / n : 0);
    report_number(report, "/summary/contacts", contacts->count);
    report_number(report, "/summary/wall_contacts", (double)at_walls);
    report_number(report, "/summary/rattlers", rattlers);
    if (n > rattlers)
        report_number(report, "/summary/coordination_without_rattlers",
                      2.0 * firm / (n - rattlers));
    say_histogram(count, n, report);
    free(walls);
    free(count);
    free(rattler);
}

// Nothing without contacts.
static void say_fabric(const struct subject *subject, struct packing_report *report)
{
    double *fabric = NEW_ARRAY(double, 9);
    if (!fabric_tensor(subject->packing, &subject->contacts, fabric)) {
        free(fabric);
        return;
    }
    report_number(report, "/summary/fabric_deviator",
                  fabric_deviator(fabric, subject->flat));
    report_curve(report, "/structure/fabric", fabric, 9);
    double *density = NEW_ARRAY(double, INCLINATIONS);
    contact_inclination(subject->packing, &subject->contacts, INCLINATIONS, density);
    report_curve(report, "/structure/inclination/angle",
                 class_middles(0, M_PI_2 / INCLINATIONS, INCLINATIONS), INCLINATIONS);
    report_curve(report, "/structure/inclination/density", density, INCLINATIONS);
}

// Slices about a fifth of a diameter high, at most MAX_SLICES.
static void say_porosity(const struct subject *subject, struct packing_report *report)
{
    const struct packing *packing = subject->packing;
    report_number(report, "/summary/solid_volume",
                  solid_volume(packing, &subject->contacts));
    if (reaches_round(packing)) return;
    if (subject->has_bulk) {
        double porosity;
        slice_porosity(packing, &subject->contacts, &subject->bulk, 1, &porosity);
        report_number(report, "/summary/bulk_porosity", porosity);
    }
    if (!subject->has_column) return;
    const struct window *column = &subject->column;
    const double height = column->upper.z - column->lower.z;
    const double wanted =
        round(SLICES_OF_A_DIAMETER * height / (2 * mean_radius(packing)));
    const int count = (int)fmax(1, fmin(wanted, MAX_SLICES));
    double *porosity = NEW_ARRAY(double, count);
    slice_porosity(packing, &subject->contacts, column, count, porosity);
    report_curve(report, "/structure/slice/position",
                 class_middles(column->lower.z, height / count, count), count);
    report_curve(report, "/structure/slice/porosity", porosity, count);
}

// g(r), to five diameters or as far as the bulk reaches. The first class is centred at
// 0, so distances are multiples of the width.
static void say_distances(const struct subject *subject, struct packing_report *report)
{
    if (!subject->has_bulk) return;
    const double width = 2 * mean_radius(subject->packing) / DISTANCES_OF_A_DIAMETER;
    const double reach = radial_reach(subject->packing, &subject->bulk);
    const int count = (int)fmin(floor(reach / width),
                                DIAMETERS_TO_LOOK * DISTANCES_OF_A_DIAMETER + 1);
    if (count < 2) return;
    double *value = NEW_ARRAY(double, count);
    if (!radial_distribution(subject->packing, &subject->bulk, width, count, value)) {
        free(value);
        return;
    }
    report_curve(report, "/structure/radial_distribution/distance",
                 class_middles(-width / 2, width, count), count);
    report_curve(report, "/structure/radial_distribution/value", value, count);
}

struct packing_report report_packing(const struct packing *packing,
                                     const struct domain *domain,
                                     const struct contacts *contacts, double gap,
                                     bool has_friction)
{
    struct subject subject = {.packing = packing,
                              .domain = domain,
                              .contacts = *contacts,
                              .gap = gap,
                              .has_friction = has_friction,
                              .flat = packing_is_flat(packing)};
    choose_windows(&subject);

    struct packing_report report = {0};
    say_porosity(&subject, &report);
    say_overlaps(&subject, &report);
    say_contacts(&subject, &report);
    say_fabric(&subject, &report);
    say_sizes(packing, &report);
    say_distances(&subject, &report);
    return report;
}

void report_free(struct packing_report *report)
{
    for (int k = 0; k < report->count; k++)
        free(report->entry[k].value);
    *report = (struct packing_report){0};
}

// ---- out ----------------------------------------------------------------------------

// The schema says which numbers are counts.
static bool is_integer(const struct schema *schema, const struct report_entry *entry)
{
    const json_t *row = entry->count ? schema_dataset(schema, entry->name)
                                     : schema_attribute(schema, entry->name);
    return !strcmp(json_string_value(json_object_get(row, "type")), "int64");
}

static void put_curve(const struct report_entry *entry, struct artifact *artifact)
{
    const bool square = !strcmp(entry->name, "/structure/fabric");
    const int rows = square ? 3 : entry->count;
    if (!is_integer(artifact->schema, entry)) {
        artifact_put(artifact, entry->name, entry->value, rows);
        return;
    }
    int64_t *value = NEW_ARRAY(int64_t, rows);
    for (int k = 0; k < rows; k++)
        value[k] = (int64_t)entry->value[k];
    artifact_put(artifact, entry->name, value, rows);
    free(value);
}

void report_put(const struct packing_report *report, struct artifact *artifact)
{
    for (int k = 0; k < report->count; k++)
        if (report->entry[k].count)
            put_curve(&report->entry[k], artifact);
        else
            artifact_put_number(artifact, report->entry[k].name,
                                report->entry[k].number);
}

static json_t *json_number(double number, bool integer)
{
    return integer ? json_integer((json_int_t)number) : json_real(number);
}

static json_t *json_said(const struct report_entry *entry, bool integer)
{
    if (!entry->count) return json_number(entry->number, integer);
    json_t *list = json_array();
    const bool square = !strcmp(entry->name, "/structure/fabric");
    for (int k = 0; k < entry->count; k++) {
        if (square && k % 3 == 0) json_array_append_new(list, json_array());
        json_t *row = square ? json_array_get(list, (size_t)(k / 3)) : list;
        json_array_append_new(row, json_number(entry->value[k], integer));
    }
    return list;
}

// Under "/structure/slice/porosity" goes structure.slice.porosity.
static void set_path(json_t *document, const char *path, json_t *value)
{
    char part[64];
    const char *slash = strchr(path + 1, '/');
    if (!slash) {
        json_object_set_new(document, path + 1, value);
        return;
    }
    snprintf(part, sizeof part, "%.*s", (int)(slash - path - 1), path + 1);
    if (!json_object_get(document, part))
        json_object_set_new(document, part, json_object());
    set_path(json_object_get(document, part), slash, value);
}

void report_write(const struct packing_report *report, const char *path,
                  json_t *reached)
{
    struct schema *schema = schema_find("packing");
    json_t *document = json_object();
    for (int k = 0; k < report->count; k++) {
        const struct report_entry *entry = &report->entry[k];
        set_path(document, entry->name, json_said(entry, is_integer(schema, entry)));
    }
    json_object_set_new(document, "reached", reached ? reached : json_null());
    write_json(path, document);
    schema_free(schema);
}
