// SPDX-License-Identifier: GPL-3.0-or-later
// Sets without common members, each a tree: PARENT[i] is i at a root. Begin with
// PARENT[i] = i for all. The root is always the lowest member, so results do not depend
// on the order in which sets are united. Nearly O(1) a call. An array of n ints is all
// there is; whoever allocates it frees it. Not for several threads at once: looking for
// a root changes the array.
#pragma once

// The root of I's set, with the way there made half as long. Path halving: every second
// entry on the way comes to point to its grandparent.
static inline int set_root(int *parent, int i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

// Makes the sets of A and B one, whose root is the lower of the two. By lowest member,
// not by size: a little slower in the worst case, but the root has a meaning. Nothing
// happens if they are one already.
static inline void unite_sets(int *parent, int a, int b)
{
    a = set_root(parent, a);
    b = set_root(parent, b);
    if (a < b)
        parent[b] = a;
    else
        parent[a] = b;
}
