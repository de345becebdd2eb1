// SPDX-License-Identifier: GPL-3.0-or-later
// What leads out of a file. HDF5 follows external links, external storage and the
// sources of virtual datasets wherever they lead, and waits for ever at a pipe that no
// one writes to. So all links are looked at before any is followed. A soft link leads
// to another of the same file.
#include "artifacts/check.h"

#include <stdbool.h>

// A damaged file may hold itself.
enum { MOST_LINKS = 100000 };

struct look {
    int links; // seen so far
    enum status status;
    struct reason *reason;
};

static bool is_dataset(hid_t file, const char *name)
{
    H5O_info_t object;
    return H5Oget_info_by_name2(file, name, &object, H5O_INFO_BASIC, H5P_DEFAULT) >=
               0 &&
           object.type == H5O_TYPE_DATASET;
}

// Opening a dataset opens no other file; reading it would.
static bool has_numbers_elsewhere(hid_t file, const char *name)
{
    const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
    if (dataset < 0) return false;
    const hid_t list = H5Dget_create_plist(dataset);
    const bool elsewhere = list >= 0 && (H5Pget_layout(list) == H5D_VIRTUAL ||
                                         H5Pget_external_count(list) > 0);
    H5Pclose(list);
    H5Dclose(dataset);
    return elsewhere;
}

// Ends the visit, by 1, at the first that leads away.
static herr_t look_at(hid_t file, const char *name, const H5L_info_t *link,
                      void *context)
{
    struct look *look = context;
    const bool within = link->type == H5L_TYPE_HARD || link->type == H5L_TYPE_SOFT;
    if (++look->links > MOST_LINKS)
        look->status = refuse(look->reason, STATUS_BAD_DATA,
                              "/%s: is one of more than %d objects", name, MOST_LINKS);
    else if (!within || (link->type == H5L_TYPE_HARD && is_dataset(file, name) &&
                         has_numbers_elsewhere(file, name)))
        look->status = refuse(look->reason, STATUS_BAD_DATA,
                              "/%s: lies in another file: copy it into this one", name);
    return look->status != STATUS_OK;
}

enum status check_links(hid_t file, struct reason *reason)
{
    struct look look = {.reason = reason};
    H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, look_at, &look);
    return look.status;
}
