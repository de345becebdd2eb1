// SPDX-License-Identifier: GPL-3.0-or-later
// The template (page/page.html, page/study.html) has places {{name}}. Each is filled by
// one function of the table `places`; a name without one is an internal error. Style
// and scripts are linked into the program (embedded.S), so that the page is one file.
//
// The page allows itself no network: its content security policy names the style and
// the script by the SHA-256 of their bytes, and allows nothing from elsewhere. So a
// text that slipped through the escaping of html.c could still not run.
//
// What the script reads are two elements: `meta`, JSON with names, sizes and scales of
// arrays (put_meta), and `data`, all arrays as compressed text (arrays.c). The rest of
// the page is there without any script.
#include "page.h"

#include "basics/file.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "facts.h"
#include "flow.h"
#include "folders.h"
#include "html.h"
#include "motion.h"
#include "provenance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

extern const char page_template[], page_style[], page_script[];
extern const char study_template[], study_script[];

// ---- one function a place of the template -------------------------------------------

static void put_title(FILE *page, const struct contents *contents)
{
    const struct run *run = contents->run;
    put_text(page, contents->title   ? contents->title
                   : contents->study ? "Runs beside each other"
                   : run->flow       ? "Flow between grains"
                   : run->motion     ? "Grains that move"
                                     : "A body of grains as it dries");
}

// What a content security policy knows an inline TEXT by. Base64 of the 32 bytes,
// between quotes, as the policy wants it.
static void put_hash(FILE *page, const char *text)
{
    char digest[65];
    unsigned char bytes[32];
    sha256(text, strlen(text), digest);
    for (size_t k = 0; k < sizeof bytes; k++) {
        const char two[] = {digest[2 * k], digest[2 * k + 1], 0};
        bytes[k] = (unsigned char)strtoul(two, NULL, 16);
    }
    char *encoded = base64(bytes, sizeof bytes);
    fprintf(page, "'sha256-%s'", encoded);
    free(encoded);
}

static void put_style_hash(FILE *page, const struct contents *contents)
{
    (void)contents;
    put_hash(page, page_style);
}

static void put_script_hash(FILE *page, const struct contents *contents)
{
    put_hash(page, contents->study ? study_script : page_script);
}

static void put_style(FILE *page, const struct contents *contents)
{
    (void)contents;
    fputs(page_style, page);
}

static void put_script(FILE *page, const struct contents *contents)
{
    fputs(contents->study ? study_script : page_script, page);
}

static void put_head_line(FILE *page, const struct contents *contents)
{
    if (contents->study)
        put_study_headline(page, contents->study);
    else if (contents->run->flow)
        put_flow_headline(page, contents->run);
    else if (contents->run->motion)
        put_motion_headline(page, contents->run);
    else
        put_headline(page, contents->run, contents->course);
}

// STUDY_PAGE is the user's: escaped as a link, then as text.
static void put_way(FILE *page, const struct contents *contents)
{
    if (!contents->study_page) return;
    char *link = link_text(contents->study_page);
    put_cell(page, "<p class=\"small\"><a href=\"", link,
             "\">All runs of this study</a></p>");
    free(link);
}

static void put_list(FILE *page, const struct contents *contents)
{
    if (contents->run->flow)
        put_flow_facts(page, contents->run, contents->body);
    else if (contents->run->motion)
        put_motion_facts(page, contents->run, contents->course, contents->body);
    else
        put_facts(page, contents->run, contents->course, contents->body);
}

static void put_cautions(FILE *page, const struct contents *contents)
{
    put_warnings(page, contents->run, contents->body);
}

static void put_out(FILE *page, const struct contents *contents)
{
    put_left_out(page, contents->run);
}

static void put_in(FILE *page, const struct contents *contents)
{
    put_modelled(page, contents->run);
}

static void put_parameters(FILE *page, const struct contents *contents)
{
    put_scene(page, contents->run);
}

static void put_calls(FILE *page, const struct contents *contents)
{
    put_commands(page, contents->run);
}

static void put_files(FILE *page, const struct contents *contents)
{
    put_sources(page, contents->run);
}

static void put_version(FILE *page, const struct contents *contents)
{
    (void)contents;
    put_line(page, "Craquelure %s, report %d", CRAQUELURE_VERSION, STAGE_VERSION);
}

// ---- what the script reads ----------------------------------------------------------

// Saturation in slices at some levels, with the key of each; null where the drying has
// none. {"depth": [n_slice], "levels": [{"key", "saturation", "slices": [n_slice]},
// ...]}
static json_t *profiles_of(const struct contents *contents)
{
    const struct artifact *drying = contents->run->of[DRYING];
    if (!drying || !artifact_has_dataset(drying, "/profiles/slice_saturation"))
        return json_null();
    int n_level, n_slice;
    double *time = artifact_get(drying, "/profiles/time", &n_level);
    double *saturation = artifact_get(drying, "/profiles/saturation", NULL);
    double *depth = artifact_get(drying, "/profiles/depth", &n_slice);
    double *slice = artifact_get(drying, "/profiles/slice_saturation", NULL);
    json_t *levels = json_array(), *depths = json_array();
    for (int s = 0; s < n_slice; s++)
        json_array_append_new(depths, json_real(depth[s]));
    for (int k = 0; k < n_level; k++) {
        json_t *row = json_array();
        for (int s = 0; s < n_slice; s++)
            json_array_append_new(row, json_real(slice[k * n_slice + s]));
        json_array_append_new(
            levels, json_pack("{s:i,s:f,s:o}", "key", key_of(contents->course, time[k]),
                              "saturation", saturation[k], "slices", row));
    }
    free(time);
    free(saturation);
    free(depth);
    free(slice);
    return json_pack("{s:o,s:o}", "depth", depths, "levels", levels);
}

// Radius of a bond over that of its smaller grain, from the parameters of the replay;
// 0.5 where there is no replay or it does not say.
static double bond_radius(const struct run *run)
{
    char *text =
        run->of[RESPONSE] ? artifact_get_text(run->of[RESPONSE], "parameters") : NULL;
    json_t *parameters = text ? json_loads(text, 0, NULL) : NULL;
    const double share = json_number_value(
        json_object_get(json_object_get(parameters, "bond"), "radius_fraction"));
    free(text);
    json_decref(parameters);
    return share > 0 && share <= 1 ? share : 0.5;
}

// gamma cos(theta), N/m: the page makes suctions of it, 2 gamma cos(theta) / r. 0 where
// the drying does not know its liquid.
static double tension_of(const struct run *run)
{
    const struct artifact *drying = run->of[DRYING];
    if (!drying || !artifact_has_number(drying, "/liquid/surface_tension")) return 0;
    const double angle = artifact_has_number(drying, "/liquid/contact_angle")
                             ? artifact_get_number(drying, "/liquid/contact_angle")
                             : 0;
    return artifact_get_number(drying, "/liquid/surface_tension") *
           cos(angle * M_PI / 180);
}

static json_t *files_of(const struct run *run)
{
    json_t *files = json_array();
    size_t k;
    json_t *source;
    json_array_foreach(run->sources, k, source)
        json_array_append(files, json_object_get(source, "name"));
    return files;
}

// All that is not an array: bounds, scales, names, how many rows. "shown" is left out
// where it is NULL, of a drying.
static void put_meta(FILE *page, const struct contents *contents)
{
    const struct run *run = contents->run;
    const struct packing *packing = &run->packing;
    const struct vector low = packing->lower, high = packing->upper;
    json_t *meta = json_pack(
        "{s:O,s:O,s:o,s:[fff],s:[fff],s:[bbb],s:i,s:i,s:i,s:f,s:f,s:o,s:s,s:O*}",
        "arrays", contents->arrays->list, "scales", contents->body->scales, "files",
        files_of(run), "lower", low.x, low.y, low.z, "upper", high.x, high.y, high.z,
        "periodic", packing->periodic[0], packing->periodic[1], packing->periodic[2],
        "rows", contents->course->n_row, "keysARow", contents->course->keys_a_row,
        "dryThroats", contents->body->dry_throats, "bondRadius", bond_radius(run),
        "tension", tension_of(run), "profiles", profiles_of(contents), "subject",
        run->flow     ? "flow"
        : run->motion ? "motion"
                      : "drying",
        "shown", contents->shown);
    if (!meta) die(STATUS_INTERNAL, "out of memory");
    char *text = json_for_script(meta);
    fputs(text, page);
    free(text);
    json_decref(meta);
}

static void put_data(FILE *page, const struct contents *contents)
{
    char *text = arrays_text(contents->arrays);
    fputs(text, page);
    free(text);
}

// ---- a study ------------------------------------------------------------------------

static void put_differing(FILE *page, const struct contents *contents)
{
    put_differences(page, contents->study);
}

static void put_table(FILE *page, const struct contents *contents)
{
    put_runs(page, contents->study);
}

static void put_strips(FILE *page, const struct contents *contents)
{
    put_distributions(page, contents->study);
}

static void put_comparison(FILE *page, const struct contents *contents)
{
    put_tests(page, contents->study);
}

// ---- the template -------------------------------------------------------------------

static const struct {
    const char *name;
    void (*put)(FILE *page, const struct contents *contents);
} places[] = {{"title", put_title},
              {"style-hash", put_style_hash},
              {"script-hash", put_script_hash},
              {"style", put_style},
              {"script", put_script},
              {"headline", put_head_line},
              {"way", put_way},
              {"facts", put_list},
              {"warnings", put_cautions},
              {"left-out", put_out},
              {"modelled", put_in},
              {"scene", put_parameters},
              {"commands", put_calls},
              {"sources", put_files},
              {"version", put_version},
              {"meta", put_meta},
              {"data", put_data},
              {"differences", put_differing},
              {"runs", put_table},
              {"distributions", put_strips},
              {"tests", put_comparison}};

static void put_place(FILE *page, const char *name, size_t length,
                      const struct contents *contents)
{
    for (size_t k = 0; k < sizeof places / sizeof *places; k++)
        if (strlen(places[k].name) == length &&
            !strncmp(places[k].name, name, length)) {
            places[k].put(page, contents);
            return;
        }
    die(STATUS_INTERNAL, "page.html: %.*s: no such place", (int)length, name);
}

// The templates are our own: each {{ has its }}.
char *page_of(const struct contents *contents, size_t *size)
{
    char *text = NULL;
    FILE *page = open_memstream(&text, size);
    const char *from = contents->study ? study_template : page_template;
    for (const char *open; (open = strstr(from, "{{"));) {
        const char *close = strstr(open, "}}");
        fwrite(from, 1, (size_t)(open - from), page);
        put_place(page, open + 2, (size_t)(close - open - 2), contents);
        from = close + 2;
    }
    fputs(from, page);
    fclose(page);
    return text;
}
