// SPDX-License-Identifier: GPL-3.0-or-later
// Where the artifacts of a run lie, and how pages link to each other. `make run` writes
// one folder a run. Runs of a study share their packing, tessellation and network:
// these lie one or two folders higher, so find_usual looks there, too, but only for the
// first SHARED_NAMES of the names.
//
// Links are relative, with %XX for what HTML or a URL would read otherwise: a folder of
// pages can be moved or served as a whole.
#include "folders.h"

#include "basics/memory.h"
#include "basics/status.h"

#include <dirent.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// As `make run` and `make demo` name them; those of the two limits lie in a folder of
// their own, below what both share, and those of further draws one deeper.
static const char *const usual[USUAL_NAMES] = {
    "packing.h5",  "tessellation.h5", "network.h5", "drying.h5", "forces.h5",
    "response.h5", "crackstats.json", "seeds.json", "check.json"};

// A link to a folder is one.
bool is_folder(const char *path)
{
    struct stat there;
    return !stat(path, &there) && S_ISDIR(there.st_mode);
}

static char *joined(const char *folder, const char *name)
{
    char *path = NULL;
    if (asprintf(&path, "%s/%s", folder, name) < 0)
        die(STATUS_INTERNAL, "out of memory");
    return path;
}

// The path of NAME in FOLDER, or NULL where it is not there. The caller frees it.
static char *find_in(const char *folder, const char *name)
{
    char *path = joined(folder, name);
    if (!access(path, F_OK)) return path;
    free(path);
    return NULL;
}

char *find_usual(const char *folder, int k)
{
    static const char *const above[] = {".", "..", "../.."};
    char *path = find_in(folder, usual[k]);
    for (int up = 1; !path && k < SHARED_NAMES && up < 3; up++) {
        char *higher = joined(folder, above[up]);
        path = find_in(higher, usual[k]);
        free(higher);
    }
    return path;
}

bool has_artifact(const char *folder)
{
    bool has = false;
    for (int k = 0; k < USUAL_NAMES && !has; k++) {
        char *path = find_in(folder, usual[k]);
        has = path != NULL;
        free(path);
    }
    return has;
}

static int by_name(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

// Sorted by strcmp, as scandir leaves the order to the file system. Hidden folders are
// not runs.
static char **folders_below(const char *top, int *count)
{
    struct dirent **entry;
    const int n = scandir(top, &entry, NULL, by_name);
    char **found = NEW_ARRAY(char *, n > 0 ? n : 0);
    *count = 0;
    for (int k = 0; k < n; k++) {
        char *path = joined(top, entry[k]->d_name);
        if (entry[k]->d_name[0] != '.' && is_folder(path) && has_artifact(path))
            found[(*count)++] = path;
        else
            free(path);
        free(entry[k]);
    }
    if (n >= 0) free(entry);
    return found;
}

// One folder with artifacts is a run, not a study. A folder without runs below is left
// to keep_folder, which says what is missing.
char **run_folders(const char *const *paths, int n, int *count)
{
    for (int k = 0; k < n; k++)
        if (!is_folder(paths[k])) return NULL;
    if (!n || (n == 1 && has_artifact(paths[0]))) return NULL;
    if (n == 1) {
        char **found = folders_below(paths[0], count);
        if (*count) return found;
        free(found);
        return NULL;
    }
    char **all = NEW_ARRAY(char *, n);
    for (int k = 0; k < n; k++)
        all[k] = duplicate(paths[k], strlen(paths[k]) + 1, 1);
    *count = n;
    return all;
}

char *link_text(const char *path)
{
    char *link = allocate(3 * strlen(path) + 1, 1), *end = link;
    for (const char *c = path; *c; c++)
        if (strchr("%?#:\\\"<> ", *c))
            end += sprintf(end, "%%%02X", (unsigned char)*c);
        else
            *end++ = *c;
    *end = 0;
    return link;
}

// The way from folder FROM to TO, both whole, as a link. Up for each folder of FROM
// beyond what both share, then down to TO.
static char *way(const char *from, const char *to)
{
    size_t same = 0;
    for (size_t c = 0; from[c] && from[c] == to[c]; c++)
        if (from[c] == '/') same = c + 1;
    char *path = NULL;
    size_t size;
    FILE *text = open_memstream(&path, &size);
    for (const char *c = from + same; *c; c++)
        if (*c == '/') fputs("../", text);
    fputs(to + same, text);
    fclose(text);
    char *link = link_text(path);
    free(path);
    return link;
}

// realpath first: "..", and links of the file system, would count as folders.
char *link_to(const char *folder, const char *name, const char *output)
{
    char from[PATH_MAX], to[PATH_MAX], *path = find_in(folder, name);
    if (!path) return NULL;
    char *above = duplicate(output, strlen(output) + 1, 1),
         *slash = strrchr(above, '/');
    if (slash) slash[1] = 0;
    const bool known = realpath(slash ? above : ".", from) && realpath(path, to);
    free(path);
    free(above);
    const size_t length = strlen(from);
    if (!known || length + 2 > sizeof from) return NULL;
    memcpy(from + length, "/", 2);
    return way(from, to);
}
