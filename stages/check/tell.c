// SPDX-License-Identifier: GPL-3.0-or-later
// Both outputs are made from the same struct checked, so that they cannot differ.
//
// Text goes to memory first and out in one piece. Suggestions and cost are left out
// where more is wrong than overlaps, since they would be of the wrong grains.
//
// Numbers for people have three digits, and places more where the body lies far from
// the origin; those for programs have all.
//
//     SEVERITY: NAME: text             a line each finding, the worst first
//     grains, box, contacts, bonds     what was measured; not without grains
//     suggested, weight, cost          only where no more is wrong than overlaps;
//                                      suggested is what dem-replay takes by --set
//     nothing is wrong
//
// JSON has the same under wrong, findings, grains, radius, box, weight, contacts,
// bonds, suggested, cost (schemas/check.json). Lengths are in m; weights are Bond
// numbers.
#include "tell.h"

#include "basics/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const severities[] = {"note", "wrong", "impossible"};

int count_wrong(const struct findings *findings)
{
    int wrong = 0;
    for (int k = 0; k < findings->count; k++)
        wrong += findings->item[k].severity != FINDING_NOTE;
    return wrong;
}

// Overlaps change neither sizes nor bonds.
static bool may_suggest(const struct findings *findings)
{
    for (int k = 0; k < findings->count; k++)
        if (findings->item[k].severity != FINDING_NOTE &&
            strcmp(findings->item[k].name, "overlaps"))
            return false;
    return true;
}

// ---- for people ---------------------------------------------------------------------

// Nothing here judges: findings come before.
static void tell_facts(const struct checked *checked, FILE *out)
{
    const struct packing_facts *facts = checked->facts;
    const struct bond_facts *bonds = checked->bonds;
    const int n_bond = checked->packing->n_bond;
    const struct vector low = facts->box.lower, high = facts->box.upper;
    fprintf(out,
            "grains     %d, radius %.3g m (10 %%: %.3g, 90 %%: %.3g; %.3g to %.3g)\n",
            facts->n, facts->median, facts->tenth, facts->ninetieth, facts->smallest,
            facts->largest);
    fprintf(out,
            "box        %.3g x %.3g x %.3g m, porosity %.3g, %.2g %% far from grains\n",
            high.x - low.x, high.y - low.y, high.z - low.z, facts->porosity,
            100 * facts->empty);
    fprintf(out, "contacts   %d, largest overlap %.2g of the smaller radius\n",
            checked->contacts->count, facts->overlap);
    fprintf(out, "bonds      %d, %.3g a grain; the largest piece has %d grain%s",
            n_bond, 2.0 * n_bond / facts->n, bonds->largest,
            bonds->largest == 1 ? "" : "s");
    if (bonds->at_bottom)
        fprintf(out, ", %d are connected with the %d at the bottom", bonds->supported,
                bonds->at_bottom);
    fputc('\n', out);
}

// As --set takes them: a.b=1 c=[1,2,3], lists being places with so many DIGITS. Members
// that are neither numbers, lists of three nor objects do not occur.
static void tell_numbers(const char *prefix, const json_t *object, int digits,
                         FILE *out)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)object, key, value)
    {
        char name[80];
        snprintf(name, sizeof name, "%s%s", prefix, key);
        if (json_is_number(value))
            fprintf(out, " %s=%.4g", name, json_number_value(value));
        if (json_is_array(value))
            fprintf(out, " %s=[%.*g,%.*g,%.*g]", name, digits,
                    json_number_value(json_array_get(value, 0)), digits,
                    json_number_value(json_array_get(value, 1)), digits,
                    json_number_value(json_array_get(value, 2)));
        snprintf(name, sizeof name, "%s%s.", prefix, key);
        if (json_is_object(value)) tell_numbers(name, value, digits, out);
    }
}

// VALUE to two digits, which %.12g then writes without an exponent.
static double two_digits(const json_t *value)
{
    char text[32];
    snprintf(text, sizeof text, "%.1e", json_number_value(value));
    return strtod(text, NULL);
}

// The cost of each stage by the number of grains (suggest.c).
static void tell_suggested(const struct checked *checked, FILE *out)
{
    json_t *suggested = suggest(checked->material, checked->packing, checked->facts);
    fprintf(out, "suggested  dem-replay:");
    tell_numbers("", json_object_get(suggested, "dem-replay"),
                 4 + digits_of_origin(checked->facts), out);
    fprintf(out, "\n           (strengths: the stress of the largest force to expect; "
                 "try a third to three times)\n");
    fprintf(out, "weight     of a grain %.2g, of the body %.2g of its suction\n",
            checked->weight->grain, checked->weight->body);
    json_decref(suggested);
    json_t *cost = expected_cost(checked->facts->n);
    size_t k;
    json_t *row;
    json_array_foreach(cost, k, row)
    {
        const json_t *range = json_object_get(row, "range");
        fprintf(out, "%-10s %s: %.12g s", k ? "" : "cost",
                json_string_value(json_object_get(row, "stage")),
                two_digits(json_object_get(row, "seconds")));
        if (range)
            fprintf(out, " (roughly, %.12g to %.12g)",
                    two_digits(json_array_get(range, 0)),
                    two_digits(json_array_get(range, 1)));
        fprintf(out, ", %.12g MB\n", two_digits(json_object_get(row, "megabytes")));
    }
    json_decref(cost);
}

// To standard output: it is called where no output was named.
void tell(const struct checked *checked, int wrong)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    for (int k = 0; k < checked->findings->count; k++)
        fprintf(out, "%s: %s: %s\n", severities[checked->findings->item[k].severity],
                checked->findings->item[k].name, checked->findings->item[k].text);
    if (checked->facts->n) tell_facts(checked, out);
    if (may_suggest(checked->findings)) tell_suggested(checked, out);
    if (!wrong) fprintf(out, "nothing is wrong\n");
    fclose(out);
    write_whole("-", text, size);
    free(text);
}

// ---- for programs -------------------------------------------------------------------

static json_t *point(struct vector x)
{
    return json_pack("[fff]", x.x, x.y, x.z);
}

static json_t *findings_json(const struct findings *findings)
{
    json_t *list = json_array();
    for (int k = 0; k < findings->count; k++)
        json_array_append_new(list, json_pack("{s:s,s:s,s:s}", "severity",
                                              severities[findings->item[k].severity],
                                              "name", findings->item[k].name, "text",
                                              findings->item[k].text));
    return list;
}

// joining_gap is null where bonds join most grains already, or nothing would.
static json_t *bonds_json(const struct checked *checked)
{
    const struct bond_facts *bonds = checked->bonds;
    const int n = checked->facts->n, count = checked->packing->n_bond;
    return json_pack("{s:i,s:f,s:i,s:i,s:i,s:i,s:i,s:o}", "count", count, "a_grain",
                     n ? 2.0 * count / n : 0, "without", bonds->without, "pieces",
                     bonds->pieces, "largest", bonds->largest, "at_bottom",
                     bonds->at_bottom, "supported", bonds->supported, "joining_gap",
                     isnan(bonds->gap) ? json_null() : json_real(bonds->gap));
}

// Without grains there is no place where they end.
static json_t *box_json(const struct checked *checked)
{
    const struct packing_facts *facts = checked->facts;
    json_t *box = json_pack("{s:o,s:o,s:f,s:f,s:f,s:i,s:i}", "lower",
                            point(facts->box.lower), "upper", point(facts->box.upper),
                            "porosity", facts->porosity, "empty", facts->empty, "far",
                            facts->far, "outside", facts->outside, "cut", facts->cut);
    if (facts->n) {
        json_object_set_new(box, "grains_lower", point(facts->lower));
        json_object_set_new(box, "grains_upper", point(facts->upper));
    }
    return box;
}

// In the order of schemas/check.json; null where there is nothing to say.
json_t *checked_json(const struct checked *checked, int wrong)
{
    const struct packing_facts *facts = checked->facts;
    const bool no_advice = !may_suggest(checked->findings);
    json_t *document = json_object();
    json_object_set_new(document, "schema", json_string("craquelure/check/1"));
    json_object_set_new(document, "wrong", json_integer(wrong));
    json_object_set_new(document, "findings", findings_json(checked->findings));
    json_object_set_new(document, "grains", json_integer(facts->n));
    json_object_set_new(document, "radius",
                        json_pack("{s:f,s:f,s:f,s:f,s:f}", "smallest", facts->smallest,
                                  "tenth", facts->tenth, "median", facts->median,
                                  "ninetieth", facts->ninetieth, "largest",
                                  facts->largest));
    json_object_set_new(document, "box", box_json(checked));
    json_object_set_new(document, "weight",
                        facts->n
                            ? json_pack("{s:f,s:f}", "grain", checked->weight->grain,
                                        "body", checked->weight->body)
                            : json_null());
    json_object_set_new(
        document, "contacts",
        json_pack("{s:i,s:f,s:i,s:i,s:i}", "pairs", checked->contacts->count,
                  "max_overlap", facts->overlap, "overlapping", facts->overlapping,
                  "coincident", facts->coincident, "free", facts->free));
    json_object_set_new(document, "bonds", bonds_json(checked));
    json_object_set_new(
        document, "suggested",
        no_advice ? json_null() : suggest(checked->material, checked->packing, facts));
    json_object_set_new(document, "cost",
                        no_advice ? json_null() : expected_cost(facts->n));
    return document;
}
