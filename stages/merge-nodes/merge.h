// SPDX-License-Identifier: GPL-3.0-or-later
// Removes short throats by merging their two nodes [K 3.3.7].
#pragma once

#include "network/network.h"

enum merge_measure {
    MERGE_GRAIN_RADIUS, // threshold in mean grain radii
    MERGE_MEAN_LENGTH,  // in mean throat lengths, before any merging
    MERGE_ABSOLUTE,     // in metres
    MERGE_FRACTION      // share of the throats to remove, of those before any merging
};

struct merge_report {
    int nodes_before, throats_before;
    int merged; // throats whose two nodes became one
    int fused;  // throats that had become parallel to another and were united with it
    int kept;   // short throats that had to stay: from wall to opposite wall, or around
                // a box that repeats
    double lost_volume; // m3, where no throat was left to take it
};

// Merges, the shortest throat first (of equal ones that of the lowest nodes), until
// none is shorter than the threshold, or the asked-for share of throats is gone. What
// is relative is so to the network before any merging, which it remembers: merging it
// again changes nothing.
//
// A merged node lies at the mean of the nodes it was made from, those on most walls
// alone counting, and exactly on all their walls. Throats that become parallel (between
// the same two nodes) are one: they were the same opening, seen twice; the wider radius
// stays, what they conduct adds up. Lengths follow the nodes; radii are those from
// before. Faces stay closed loops; one left with fewer than three nodes is gone. Where
// the box repeats, throats between the same nodes are parallel only if they lead to the
// same image.
//
// Where throats have volumes, their sum stays: those of parallel throats add up, and
// that of a throat merged away goes to the throats at the merged node, in proportion to
// theirs. Cylinders stay cylinders of their radius and length; they overlap most where
// throats are short [K 3.3.7], so merging takes away what they count twice.
//
// O(n log n). NETWORK is changed in place. REPORT is overwritten.
void merge_nodes(struct network *network, enum merge_measure measure, double threshold,
                 struct merge_report *report);
