// SPDX-License-Identifier: GPL-3.0-or-later
// A file against its schema, dataset by dataset: presence, class, shape with its
// symbols (n_particle and so on, defined where they first occur), range and order of
// values. Large datasets are read in blocks, packed ones in chunks. The first breach
// ends the check with its row and value.
//
// Two statuses: STATUS_BAD_DATA is a breach of the schema; STATUS_NO a number too
// large, or two too near each other, for their squares to be numbers. Results that are
// so come from sizes that were given (write.c).
//
// Symbols are defined by the first dataset that has them, so the order of datasets in a
// schema matters: what counts comes before what is counted.
#include "artifacts/check.h"

#include "basics/memory.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Squares of what is larger would overflow, and so would distances; of what is smaller,
// vanish, and so would areas.
static const double LARGEST_SIZE = 1e150, LEAST_EDGE = 1e-150;

enum { MOST_SYMBOLS = 24, MOST_RANK = 3, BLOCK_VALUES = 1 << 15 };

// Extents that symbols stand for: n_particle = 250.
struct symbols {
    int count;
    struct {
        char name[32];
        hsize_t value;
    } entry[MOST_SYMBOLS];
};

// One dataset while it is looked at.
struct subject {
    const json_t *rules;
    const char *name;
    hid_t dataset, transfer; // transfer: how it is read
    int rank;
    hsize_t extent[MOST_RANK];
    hsize_t row_values; // values in one row
};

// A schema has some twenty symbols: a linear search is enough.
static bool lookup(const struct symbols *symbols, const char *name, hsize_t *value)
{
    for (int k = 0; k < symbols->count; k++) {
        if (strcmp(symbols->entry[k].name, name)) continue;
        *value = symbols->entry[k].value;
        return true;
    }
    return false;
}

static void define(struct symbols *symbols, const char *name, hsize_t value)
{
    if (symbols->count == MOST_SYMBOLS)
        die(STATUS_INTERNAL, "schema: too many symbols");
    snprintf(symbols->entry[symbols->count].name, 32, "%s", name);
    symbols->entry[symbols->count++].value = value;
}

// ---- shape --------------------------------------------------------------------------

// "n_face+1" stands for one more than n_face; a symbol met first is defined by what is
// there. Offsets have one row more than what they point into.
static enum status check_symbol(struct symbols *symbols, const char *text,
                                hsize_t extent, const struct subject *subject, int axis,
                                struct reason *reason)
{
    char name[32];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(text, "+"), text);
    const hsize_t more = strchr(text, '+') ? 1 : 0;
    if (extent < more)
        return refuse(reason, STATUS_BAD_DATA, "%s: must have at least one row",
                      subject->name);
    hsize_t wanted;
    if (!lookup(symbols, name, &wanted))
        define(symbols, name, extent - more);
    else if (extent != wanted + more)
        return refuse(reason, STATUS_BAD_DATA,
                      "%s: extent %d must be %s = %llu, got %llu", subject->name, axis,
                      text, (unsigned long long)(wanted + more),
                      (unsigned long long)extent);
    return STATUS_OK;
}

// Rank first, as extents of more axes than MOST_RANK have no place.
static enum status check_shape(struct subject *subject, struct symbols *symbols,
                               struct reason *reason)
{
    const json_t *shape = json_object_get(subject->rules, "shape");
    const hid_t space = H5Dget_space(subject->dataset);
    const int rank = H5Sget_simple_extent_ndims(space);
    const bool fits = rank == (int)json_array_size(shape) && rank <= MOST_RANK;
    if (fits) H5Sget_simple_extent_dims(space, subject->extent, NULL);
    H5Sclose(space);
    if (!fits)
        return refuse(reason, STATUS_BAD_DATA, "%s: must have rank %zu, got %d",
                      subject->name, json_array_size(shape), rank);
    subject->rank = rank;
    subject->row_values = 1;
    for (int axis = 0; axis < rank; axis++) {
        const json_t *wanted = json_array_get(shape, (size_t)axis);
        const hsize_t extent = subject->extent[axis];
        if (axis > 0) subject->row_values *= extent;
        if (json_is_integer(wanted)) {
            if (extent == (hsize_t)json_integer_value(wanted)) continue;
            return refuse(reason, STATUS_BAD_DATA,
                          "%s: extent %d must be %lld, got %llu", subject->name, axis,
                          (long long)json_integer_value(wanted),
                          (unsigned long long)extent);
        }
        const enum status status = check_symbol(symbols, json_string_value(wanted),
                                                extent, subject, axis, reason);
        if (status) return status;
    }
    return STATUS_OK;
}

// A damaged file may claim extents that no memory holds: deflate packs at most about
// 1032 to 1, and nothing else here packs at all.
static enum status check_size(const struct subject *subject, size_t image_size,
                              struct reason *reason)
{
    double values = 1;
    for (int axis = 0; axis < subject->rank; axis++)
        values *= (double)subject->extent[axis];
    if (values <= 1100.0 * (double)image_size && subject->extent[0] < 2147483647u)
        return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "%s: claims %g values in a file of %zu bytes", subject->name, values,
                  image_size);
}

// Width and byte order may differ: HDF5 converts. A float where an integer is due would
// lose its fraction silently.
static enum status check_class(const struct subject *subject, struct reason *reason)
{
    const hid_t wanted = entry_file_type(subject->rules);
    const hid_t type = H5Dget_type(subject->dataset);
    const H5T_class_t got = H5Tget_class(type);
    H5Tclose(type);
    if (got == H5Tget_class(wanted)) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA, "%s: must hold %s", subject->name,
                  H5Tget_class(wanted) == H5T_FLOAT ? "floating-point numbers"
                                                    : "integers");
}

// ---- values -------------------------------------------------------------------------

// A bound given as a number or as a symbol. False when the rule is not there.
// "maximum": "n_node-1" is not possible; schemas say "below": "n_node".
static bool bound(const json_t *rules, const char *rule, const struct symbols *symbols,
                  double *value)
{
    const json_t *given = json_object_get(rules, rule);
    if (!given) return false;
    hsize_t extent = 0;
    if (json_is_string(given)) lookup(symbols, json_string_value(given), &extent);
    *value = json_is_string(given) ? (double)extent : json_number_value(given);
    return true;
}

// The row is that of the dataset, whatever its rank.
static enum status breach(const struct subject *subject, hsize_t index,
                          const char *sign, const json_t *rule, double limit,
                          double got, struct reason *reason)
{
    const char *symbol = json_string_value(rule);
    char of[48] = "";
    if (symbol) snprintf(of, sizeof of, " (%s)", symbol);
    return refuse(reason, STATUS_BAD_DATA,
                  "%s: row %llu: must be %s %.17g%s, got %.17g", subject->name,
                  (unsigned long long)(index / subject->row_values), sign, limit, of,
                  got);
}

// Rules by number: >=, <=, >, <, and not beyond in size.
static inline bool keeps(double value, int rule, double limit)
{
    return rule == 0   ? value >= limit
           : rule == 1 ? value <= limit
           : rule == 2 ? value > limit
           : rule == 3 ? value < limit
                       : fabs(value) <= limit;
}

// The first value that breaks a rule, or COUNT. Nearly always none does: values are
// looked at many at once, without asking after each.
static hsize_t first_breach(const double *value, hsize_t count, int rule, double limit)
{
    enum { MANY = 64 };
    for (hsize_t from = 0; from < count; from += MANY) {
        const hsize_t to = from + MANY < count ? from + MANY : count;
        int kept = 1;
        for (hsize_t k = from; k < to; k++)
            kept &= keeps(value[k], rule, limit);
        for (hsize_t k = from; k < to && !kept; k++)
            if (!keeps(value[k], rule, limit)) return k;
    }
    return count;
}

// Size first: NAN fails it, so that the other rules see numbers only.
static enum status check_range(const struct subject *subject, const double *block,
                               hsize_t first, hsize_t count,
                               const struct symbols *symbols, struct reason *reason)
{
    static const struct {
        const char *rule, *sign;
    } rules[] = {{"minimum", ">="}, {"maximum", "<="}, {"above", ">"}, {"below", "<"}};
    const hsize_t odd = first_breach(block, count, 4, LARGEST_SIZE);
    if (odd < count)
        return refuse(reason, isnan(block[odd]) ? STATUS_BAD_DATA : STATUS_NO,
                      "%s: row %llu: must be %s, got %g", subject->name,
                      (unsigned long long)((first + odd) / subject->row_values),
                      isfinite(block[odd]) ? "at most 1e150 in size" : "finite",
                      block[odd]);
    for (int r = 0; r < 4; r++) {
        double limit;
        if (!bound(subject->rules, rules[r].rule, symbols, &limit)) continue;
        const hsize_t k = first_breach(block, count, r, limit);
        if (k < count)
            return breach(subject, first + k, rules[r].sign,
                          json_object_get(subject->rules, rules[r].rule), limit,
                          block[k], reason);
    }
    return STATUS_OK;
}

static bool has(const struct subject *subject, const char *rule)
{
    return json_object_get(subject->rules, rule) != NULL;
}

// Rules on how values follow one another; PREVIOUS is the last value of the block
// before.
static enum status check_order(const struct subject *subject, const double *block,
                               hsize_t first, hsize_t count, double previous,
                               struct reason *reason)
{
    const bool increasing = has(subject, "increasing");
    const bool nondecreasing =
        has(subject, "nondecreasing") || has(subject, "offset_into");
    const bool ascending = has(subject, "ascending_rows");
    if (ascending || has(subject, "sorted_rows"))
        for (hsize_t k = 0; k + 1 < count; k += 2)
            if (ascending ? block[k] >= block[k + 1] : block[k] > block[k + 1])
                return refuse(
                    reason, STATUS_BAD_DATA,
                    "%s: row %llu: the lower index must come first, got %g, %g",
                    subject->name, (unsigned long long)((first + k) / 2), block[k],
                    block[k + 1]);
    if (!increasing && !nondecreasing) return STATUS_OK;
    for (hsize_t k = 0; k < count; k++) {
        if (first + k > 0 && (increasing ? block[k] <= previous : block[k] < previous))
            return breach(subject, first + k, increasing ? ">" : ">=", NULL, previous,
                          block[k], reason);
        previous = block[k];
    }
    return STATUS_OK;
}

// Part of a dataset: where it begins and how many of each axis.
struct part {
    hsize_t start[MOST_RANK], count[MOST_RANK];
};

// As doubles, whatever the type: exact for integers up to 2^53.
static bool read_part(const struct subject *subject, const struct part *part,
                      double *block)
{
    const hsize_t *start = part->start, *count = part->count;
    const hid_t file_space = H5Dget_space(subject->dataset);
    const hid_t memory_space = H5Screate_simple(subject->rank, count, NULL);
    H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start, NULL, count, NULL);
    const herr_t result = H5Dread(subject->dataset, H5T_NATIVE_DOUBLE, memory_space,
                                  file_space, subject->transfer, block);
    H5Sclose(memory_space);
    H5Sclose(file_space);
    return result >= 0;
}

static bool read_block(const struct subject *subject, hsize_t first_row, hsize_t rows,
                       double *block)
{
    struct part part = {.start = {first_row}, .count = {rows}};
    for (int axis = 1; axis < subject->rank; axis++)
        part.count[axis] = subject->extent[axis];
    return read_part(subject, &part, block);
}

static enum status cannot_be_read(const struct subject *subject, hsize_t row,
                                  struct reason *reason)
{
    return refuse(reason, STATUS_BAD_DATA, "%s: row %llu: cannot be read",
                  subject->name, (unsigned long long)row);
}

// Offsets go from 0 to the number of rows that they point into.
static enum status check_ends(const struct subject *subject, double first, double last,
                              struct symbols *symbols, struct reason *reason)
{
    const json_t *target = json_object_get(subject->rules, "offset_into");
    if (!target) return STATUS_OK;
    if (first != 0) return breach(subject, 0, "=", NULL, 0, first, reason);
    hsize_t extent;
    const char *name = json_string_value(target);
    if (!lookup(symbols, name, &extent))
        define(symbols, name,
               (hsize_t)last); // what it points into comes later and must fit
    else if (last != (double)extent)
        return breach(subject, subject->extent[0] - 1, "=", target, (double)extent,
                      last, reason);
    return STATUS_OK;
}

// The chunks of what lies in several beside each other: whole rows would unpack each as
// often as it has rows. False where there are none, or where rules follow the order of
// values, which chunks do not keep.
static bool has_chunks(const struct subject *subject, hsize_t chunk[MOST_RANK])
{
    static const char *const ordered[] = {"increasing", "nondecreasing", "offset_into",
                                          "ascending_rows", "sorted_rows"};
    const hid_t creation = H5Dget_create_plist(subject->dataset);
    bool chunks = H5Pget_layout(creation) == H5D_CHUNKED &&
                  H5Pget_chunk(creation, MOST_RANK, chunk) == subject->rank;
    H5Pclose(creation);
    for (int k = 0; k < 5; k++)
        chunks = chunks && !has(subject, ordered[k]);
    return chunks && subject->rank > 1 && chunk[1] < subject->extent[1] &&
           (double)chunk[0] * (double)chunk[1] < 64.0 * BLOCK_VALUES;
}

// Ranges, chunk by chunk; a row of PART has fewer values than one of the dataset.
static enum status check_chunk(const struct subject *subject, struct part *part,
                               double *block, const struct symbols *symbols,
                               struct reason *reason)
{
    struct subject within = *subject;
    within.row_values = 1;
    for (int axis = 0; axis < subject->rank; axis++) {
        const hsize_t left = subject->extent[axis] - part->start[axis];
        if (left < part->count[axis]) part->count[axis] = left;
        if (axis > 0) within.row_values *= part->count[axis];
    }
    if (!read_part(subject, part, block))
        return cannot_be_read(subject, part->start[0], reason);
    return check_range(&within, block, part->start[0] * within.row_values,
                       part->count[0] * within.row_values, symbols, reason);
}

static enum status check_chunks(const struct subject *subject,
                                const hsize_t chunk[MOST_RANK],
                                const struct symbols *symbols, struct reason *reason)
{
    const hsize_t deep = subject->rank > 2 ? subject->extent[2] : 1;
    double *block = NEW_ARRAY(double, chunk[0] * chunk[1] * deep);
    enum status status = STATUS_OK;
    for (hsize_t row = 0; row < subject->extent[0] && !status; row += chunk[0])
        for (hsize_t k = 0; k < subject->extent[1] && !status; k += chunk[1]) {
            struct part part = {{row, k, 0}, {chunk[0], chunk[1], deep}};
            status = check_chunk(subject, &part, block, symbols, reason);
        }
    free(block);
    return status;
}

// A block is whole rows and some 256 kB: small enough for the cache.
static enum status check_values(const struct subject *subject, struct symbols *symbols,
                                struct reason *reason)
{
    const hsize_t rows = subject->extent[0];
    hsize_t chunk[MOST_RANK];
    if (!rows || !subject->row_values) return STATUS_OK;
    if (has_chunks(subject, chunk))
        return check_chunks(subject, chunk, symbols, reason);
    const hsize_t most_rows =
        subject->row_values < BLOCK_VALUES ? BLOCK_VALUES / subject->row_values : 1;
    const hsize_t block_rows = most_rows < rows ? most_rows : rows;
    double *block = allocate_uncleared(block_rows * subject->row_values, sizeof *block);
    enum status status = STATUS_OK;
    double first = 0, last = 0;
    for (hsize_t row = 0; row < rows && !status; row += block_rows) {
        const hsize_t taken = rows - row < block_rows ? rows - row : block_rows;
        const hsize_t count = taken * subject->row_values;
        if (!read_block(subject, row, taken, block)) {
            status = cannot_be_read(subject, row, reason);
            break;
        }
        status = check_range(subject, block, row * subject->row_values, count, symbols,
                             reason);
        if (!status)
            status = check_order(subject, block, row * subject->row_values, count, last,
                                 reason);
        if (row == 0) first = block[0];
        last = block[count - 1];
    }
    free(block);
    return status ? status : check_ends(subject, first, last, symbols, reason);
}

// For the two corners of a box. An edge below LEAST_EDGE would give volumes of 0.
static enum status check_less_than(hid_t file, const struct subject *subject,
                                   struct reason *reason)
{
    const char *other = json_string_value(json_object_get(subject->rules, "less_than"));
    if (!other) return STATUS_OK;
    double low[3], high[3]; // used for corners only
    const hid_t upper = H5Dopen2(file, other, H5P_DEFAULT);
    if (upper < 0) return refuse(reason, STATUS_BAD_DATA, "%s: is missing", other);
    const hid_t space = H5Dget_space(upper);
    const bool fits = H5Sget_simple_extent_npoints(space) == 3;
    H5Sclose(space);
    const bool read =
        fits &&
        H5Dread(upper, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, high) >= 0 &&
        H5Dread(subject->dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                low) >= 0;
    H5Dclose(upper);
    if (!read) return refuse(reason, STATUS_BAD_DATA, "%s: must have 3 values", other);
    for (int axis = 0; axis < 3; axis++) {
        if (!(low[axis] < high[axis]))
            return refuse(reason, STATUS_BAD_DATA,
                          "%s: row %d: must be < %s = %.17g, got %.17g", subject->name,
                          axis, other, high[axis], low[axis]);
        if (high[axis] - low[axis] < LEAST_EDGE)
            return refuse(reason, STATUS_NO,
                          "%s: row %d: must be 1e-150 or more below %s", subject->name,
                          axis, other);
    }
    return STATUS_OK;
}

// ---- the file -----------------------------------------------------------------------

// Not an error, where the schema says so.
static bool is_left_out(hid_t file, const json_t *rules)
{
    return json_is_true(json_object_get(rules, "optional")) && !has_entry(file, rules);
}

// In this order because each needs the one before: values cannot be read before their
// shape is known.
static enum status check_dataset(hid_t file, const json_t *rules,
                                 struct symbols *symbols, size_t image_size,
                                 struct reason *reason)
{
    struct subject subject = {
        .rules = rules, .name = json_string_value(json_object_get(rules, "name"))};
    // Integers become doubles in a buffer; a megabyte, the default, takes longer to
    // clear than most datasets to read.
    static const size_t buffer = 1 << 16;
    if (is_left_out(file, rules)) return STATUS_OK;
    subject.dataset = H5Dopen2(file, subject.name, H5P_DEFAULT);
    if (subject.dataset < 0)
        return refuse(reason, STATUS_BAD_DATA, "%s: is missing", subject.name);
    subject.transfer = H5Pcreate(H5P_DATASET_XFER);
    H5Pset_buffer(subject.transfer, buffer, NULL, NULL);
    enum status status = check_class(&subject, reason);
    if (!status) status = check_shape(&subject, symbols, reason);
    if (!status) status = check_size(&subject, image_size, reason);
    if (!status) status = check_values(&subject, symbols, reason);
    if (!status) status = check_less_than(file, &subject, reason);
    H5Pclose(subject.transfer);
    H5Dclose(subject.dataset);
    return status;
}

// The same rules of range as for datasets, with one value.
static enum status check_attribute(hid_t file, const json_t *rules,
                                   struct reason *reason)
{
    const char *name = json_string_value(json_object_get(rules, "name"));
    char group[128];
    snprintf(group, sizeof group, "%.*s", (int)(strrchr(name, '/') - name), name);
    double value;
    if (is_left_out(file, rules)) return STATUS_OK;
    const hid_t attribute =
        H5Aopen_by_name(file, group, strrchr(name, '/') + 1, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) return refuse(reason, STATUS_BAD_DATA, "%s: is missing", name);
    const hid_t space = H5Aget_space(attribute);
    const bool read = H5Sget_simple_extent_npoints(space) == 1 &&
                      H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0;
    H5Sclose(space);
    H5Aclose(attribute);
    if (!read) return refuse(reason, STATUS_BAD_DATA, "%s: must be one number", name);
    const struct subject subject = {.rules = rules, .name = name, .row_values = 1};
    return check_range(&subject, &value, 0, 1, &(struct symbols){0}, reason);
}

enum status check_file(hid_t file, const struct schema *schema, size_t image_size,
                       struct reason *reason)
{
    struct symbols symbols = {0};
    size_t k;
    json_t *entry;
    json_array_foreach(schema->datasets, k, entry)
    {
        const enum status status =
            check_dataset(file, entry, &symbols, image_size, reason);
        if (status) return status;
    }
    json_array_foreach(schema->attributes, k, entry)
    {
        const enum status status = check_attribute(file, entry, reason);
        if (status) return status;
    }
    return STATUS_OK;
}
