// SPDX-License-Identifier: GPL-3.0-or-later
// What concerns the HDF5 library and format as a whole, not one artifact.
#include "artifacts/artifact.h"

#include <hdf5.h>
#include <string.h>

void hdf5_begin(void)
{
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

bool is_hdf5(const struct bytes *bytes)
{
    static const unsigned char signature[8] = {0x89, 'H',  'D',  'F',
                                               '\r', '\n', 0x1a, '\n'};
    return bytes->size >= sizeof signature &&
           !memcmp(bytes->data, signature, sizeof signature);
}
