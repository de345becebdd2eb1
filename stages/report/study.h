// SPDX-License-Identifier: GPL-3.0-or-later
// Many runs on one page: a row each, how their results scatter, and whether two groups
// of them differ.
#pragma once

#include <stdio.h>

struct study;

// Of the runs in PATHS (N): several folders, or one that holds no artifact itself but
// folders with runs. NULL where they are neither. Links lead from the folder of OUTPUT
// to each run's report.html that is there. The caller frees it with study_free. Exits
// 65 where a folder is not a run that dries. GROUPS has the name of each run's group,
// in lines, as many as runs; NULL: groups and names are what of the scenes differs.
struct study *study_of(const char *const *paths, int n, const char *groups,
                       const char *output);
void study_free(struct study *study);

// How many runs and groups, and how many bonds broke on average in the first three.
void put_study_headline(FILE *page, const struct study *study);

// What of the scenes differs.
void put_differences(FILE *page, const struct study *study);

// A row for each run. Columns: what of the scenes differs, then the results that any
// run has.
void put_runs(FILE *page, const struct study *study);

// A strip of points for each result: one line a group, with its mean and interval.
// Results that are the same in all runs are left out.
void put_distributions(FILE *page, const struct study *study);

// Two groups against each other; nothing where there are not two.
void put_tests(FILE *page, const struct study *study);
