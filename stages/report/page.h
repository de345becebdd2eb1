// SPDX-License-Identifier: GPL-3.0-or-later
// The page: its template (page/page.html) with everything in it.
#pragma once

#include "body.h"
#include "study.h"

// All that stands in a page: of a run, or of a study. Nothing is owned here. With STUDY
// only STUDY and TITLE are read; otherwise RUN, COURSE, BODY and ARRAYS must be there.
struct contents {
    const struct study *study; // NULL: of a run
    const struct run *run;
    const struct course *course;
    const struct shown_body *body;
    const struct arrays *arrays;
    json_t *shown;          // what put_flow or put_motion say; NULL: a drying
    const char *title;      // NULL: none given
    const char *study_page; // that leads to all runs; NULL likewise
};

// The page as text of *SIZE bytes; the caller frees it. A terminating 0 follows the
// *SIZE bytes. Equal contents give equal bytes: there is no date in it.
char *page_of(const struct contents *contents, size_t *size);
