// SPDX-License-Identifier: GPL-3.0-or-later
// Folders of runs, and ways between them. Paths are the user's, in any form; nothing
// here is opened but to be listed.
#pragma once

#include <stdbool.h>

// Whether PATH is there and a folder.
bool is_folder(const char *path);

// Whether it holds one that `make run` makes.
bool has_artifact(const char *folder);

// The artifact K of a run under the name that `make run` gives it in FOLDER, or NULL;
// the first SHARED_NAMES of the USUAL_NAMES also in the two folders above. The caller
// frees it.
enum { SHARED_NAMES = 3, USUAL_NAMES = 9 };
char *find_usual(const char *folder, int k);

// PATHS (N) where they are several folders; the folders with runs in one that has no
// artifact itself, by name; else NULL. Frees nothing; the caller frees all of it. A new
// array of *COUNT new strings.
char **run_folders(const char *const *paths, int n, int *count);

// PATH as a link: what means something else there is %XX. The caller frees it.
char *link_text(const char *path);

// FOLDER/NAME as a link in a page OUTPUT ("-": here), or NULL where it is not there.
// The caller frees it.
char *link_to(const char *folder, const char *name, const char *output);
