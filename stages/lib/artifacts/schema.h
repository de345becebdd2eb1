// SPDX-License-Identifier: GPL-3.0-or-later
// The schemas of the artifacts: names, shapes, units, ranges (schemas/*.json). Those of
// HDF5 artifacts list datasets and attributes; an entry is a JSON object with "name",
// "type", "units", and, for a dataset, "shape", whose symbols ("n_particle") stand for
// equal extents. The texts are compiled in: no file is read at run time.
//
// An entry, as it stands in schemas/network.json:
//     {"name": "/throats/radius", "type": "float64", "shape": ["n_throat"],
//      "units": "m", "minimum": 0, "text": "radius of the cylinder"}
// A new dataset is a line there, one where it is put and one where it is read; the
// check of every artifact goes by the same text.
#pragma once

#include <hdf5.h>
#include <jansson.h>
#include <stdbool.h>

struct schema {
    const char *name;   // "packing"
    const char *id;     // "craquelure/packing/1"
    json_t *document;   // the file
    json_t *datasets;   // list of dataset entries, those of "extends" included
    json_t *attributes; // list of attribute entries, of this schema alone
};

// The schema called NAME ("packing"), or whose id is NAME; NULL if there is none. The
// caller frees it with schema_free. O(size of the text): it is parsed on each call.
struct schema *schema_find(const char *name);
void schema_free(struct schema *schema);

// The entry of dataset or attribute NAME, or NULL. It is the schema's, and ends with
// it.
const json_t *schema_dataset(const struct schema *schema, const char *name);
const json_t *schema_attribute(const struct schema *schema, const char *name);

// Whether FILE has that dataset or attribute: an "optional" one may be left out.
bool has_entry(hid_t file, const json_t *entry);

// The HDF5 types of an entry: as it lies in files (little endian), and in memory. HDF5
// owns both: they are not to be closed.
hid_t entry_file_type(const json_t *entry);
hid_t entry_memory_type(const json_t *entry);
