// SPDX-License-Identifier: GPL-3.0-or-later
// Histograms before and after merging, with the same classes, so that they can be drawn
// in one figure [K Figs. 3.24, 3.25]. For lengths and for radii there are 40 classes,
//     class k = k width .. (k + 1) width,   width = most / 40,
// with `most` the largest of both networks: merging lengthens throats, but of radii it
// only ever keeps the wider one, so the first network has the largest. Where all are 0
// the width is 1 m.
//
// coordination.nodes[k] is the number of nodes with k throats; its mean is 2 n_throat /
// n_node. All throats count, those of the boundary layer too, and volumes are of all.
// Mean and standard deviation (n - 1) are of the values, not of the classes; 0 where
// there are too few.
#include "report.h"

#include "basics/memory.h"

#include <gsl/gsl_histogram.h>
#include <gsl/gsl_statistics_double.h>
#include <stdlib.h>

enum { CLASSES = 40 };

struct census take_census(const struct network *network)
{
    const size_t n_throat = (size_t)network->n_throat;
    struct census census = {
        .n_node = network->n_node,
        .n_throat = network->n_throat,
        .coordination = NEW_ARRAY(int, network->n_node),
        .length = duplicate(network->throat_length, n_throat, sizeof(double)),
        .radius = duplicate(network->throat_radius, n_throat, sizeof(double))};
    for (int t = 0; t < network->n_throat; t++) {
        census.volume += throat_volume(network, t);
        for (int end = 0; end < 2; end++) {
            const int count = ++census.coordination[network->throat_nodes[t][end]];
            if (count > census.max_throats) census.max_throats = count;
        }
    }
    return census;
}

void census_free(struct census *census)
{
    free(census->coordination);
    free(census->length);
    free(census->radius);
    *census = (struct census){0};
}

// The number of nodes with 0, 1, 2, ... throats.
static json_t *coordination_json(const struct census *census)
{
    int *nodes = NEW_ARRAY(int, census->max_throats + 1);
    for (int i = 0; i < census->n_node; i++)
        nodes[census->coordination[i]]++;
    json_t *list = json_array();
    for (int k = 0; k <= census->max_throats; k++)
        json_array_append_new(list, json_integer(nodes[k]));
    free(nodes);
    return json_pack("{s:f,s:o}", "mean",
                     census->n_node ? 2.0 * census->n_throat / census->n_node : 0,
                     "nodes", list);
}

// Histogram of COUNT values from 0 to MOST in CLASSES equal classes, with mean and
// standard deviation.
static json_t *classes_json(const double *value, int count, double most)
{
    gsl_histogram *histogram = gsl_histogram_alloc(CLASSES);
    const double width = most > 0 ? most / CLASSES : 1;
    gsl_histogram_set_ranges_uniform(histogram, 0, CLASSES * width);
    for (int k = 0; k < count; k++) // the last class holds its upper end as well
        gsl_histogram_increment(histogram, fmin(value[k], (CLASSES - 0.5) * width));
    json_t *middle = json_array(), *throats = json_array();
    for (size_t k = 0; k < CLASSES; k++) {
        json_array_append_new(middle, json_real(((double)k + 0.5) * width));
        json_array_append_new(
            throats, json_integer((json_int_t)gsl_histogram_get(histogram, k)));
    }
    gsl_histogram_free(histogram);
    const size_t n = (size_t)count;
    return json_pack("{s:f,s:f,s:o,s:o}", "mean", n ? gsl_stats_mean(value, 1, n) : 0,
                     "standard_deviation", n > 1 ? gsl_stats_sd(value, 1, n) : 0,
                     "middle", middle, "throats", throats);
}

static double largest(const double *value, int count)
{
    double most = 0;
    for (int k = 0; k < count; k++)
        most = fmax(most, value[k]);
    return most;
}

// LONGEST and WIDEST, m, are the upper ends of the classes.
static json_t *census_json(const struct census *census, double longest, double widest)
{
    return json_pack("{s:i,s:i,s:f,s:o,s:o,s:o}", "nodes", census->n_node, "throats",
                     census->n_throat, "volume", census->volume, "coordination",
                     coordination_json(census), "length",
                     classes_json(census->length, census->n_throat, longest), "radius",
                     classes_json(census->radius, census->n_throat, widest));
}

json_t *merging_json(const struct merge_report *report, const struct census *before,
                     const struct census *after)
{
    const double longest = fmax(largest(before->length, before->n_throat),
                                largest(after->length, after->n_throat));
    const double widest = largest(before->radius, before->n_throat); // the wider stays
    return json_pack("{s:i,s:i,s:i,s:f,s:o,s:o}", "merged", report->merged, "fused",
                     report->fused, "kept", report->kept, "lost_volume",
                     report->lost_volume, "before",
                     census_json(before, longest, widest), "after",
                     census_json(after, longest, widest));
}
