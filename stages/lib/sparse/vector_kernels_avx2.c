// SPDX-License-Identifier: GPL-3.0-or-later
#define BYTES 32
#define NAMED(name) name##_avx2
#include "vector_kernels_template.h"
