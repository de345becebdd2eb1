// SPDX-License-Identifier: GPL-3.0-or-later
// A call in order: options are parsed (argp), the parameter file is read, its section
// found and completed from the scene's "conditions", --set is put in, the struct of
// parameters filled; then outputs are checked, before hours of work: that they can be
// made, that the artifact replaces no input of another kind, and no output another.
//
// Who says a parameter, the strongest first:
//
//     --set KEY=VALUE                 on the command line
//     "STAGE": {"KEY": ...}           the section of the file of -p, or the file itself
//     "conditions": {"KEY": ...}      of the scene, for keys that are shared
//     "OTHER": {"KEY": ...}           of the scene, for keys whose rows name OTHER
//     the default of the table
//
// Errors of the command line exit 64, of the file or a value 65, a missing file 66. A
// parameter that is wrong does not end the run at once: all of them are reported first.
#include "parameters/stage.h"

#include "basics/file.h"
#include "basics/memory.h"
#include "basics/status.h"
#include "parameters/command_line.h"
#include "parameters/conditions.h"
#include "parameters/spelling.h"

#include <assert.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Sections a scene may hold: the stages, whether this one or another, and what several
// of them share.
static const char *const sections[] = {
    "pack",           "tessellate", "merge-nodes", "dry",
    "force-protocol", "dem-replay", "deform",      "crackstats",
    "import-network", "invade",     "bridge",      "flow",
    "check",          "report",     "simulate",    "shearstats",
    "rings",          "conditions", NULL};

enum {
    KEY_THREADS = 256,
    KEY_PROGRESS,
    KEY_SCHEMA,
    KEY_PARAMETERS,
    KEY_REPORT,
    KEY_CHECKPOINT,
    KEY_EVERY,
    KEY_ESTIMATE
};
enum { MOST_OPTIONS = 17 };

static const struct argp_option options[] = {
    {"params", 'p', "FILE", 0, "Parameters: a scene, or just this stage's section", 0},
    {"set", 's', "KEY=VALUE", 0,
     "Override one parameter; VALUE is JSON, or a word; may be repeated", 0},
    {"output", 'o', "FILE", 0, "Write to FILE; '-', or no -o: standard output", 0},
    {"threads", KEY_THREADS, "N", 0, "Threads to use [1]; results do not depend on it",
     0},
    {"quiet", 'q', NULL, 0, "Print only errors", 0},
    {"progress", KEY_PROGRESS, "WHEN", 0, "Progress bar: auto, always or never [auto]",
     0},
    {"schema", KEY_SCHEMA, NULL, 0, "Print the JSON Schema of the parameters", 1},
    {"parameters", KEY_PARAMETERS, NULL, 0, "Print the effective parameters", 1},
    VERSION_OPTION,
    {0}};

// What parsing gathers before the parameters are read.
struct command_line {
    const struct stage *stage;
    struct invocation *invocation;
    const char *params;
    char **set;
    int n_set;
    bool print_parameters;
};

const char *stage_program(const struct stage *stage, char text[64])
{
    snprintf(text, 64, "%s %d", stage->name, stage->version);
    return text;
}

// --schema: at once, without a look at files or at what follows on the command line.
static void print_schema(const struct stage *stage)
{
    json_t *schema = parameters_schema(stage->parameters, stage->name);
    json_dumpf(schema, stdout, JSON_INDENT(2) | JSON_PRESERVE_ORDER);
    putchar('\n');
    json_decref(schema);
    exit(STATUS_OK);
}

static enum progress_mode parse_progress(const char *text)
{
    if (!strcmp(text, "auto")) return PROGRESS_AUTO;
    if (!strcmp(text, "always")) return PROGRESS_ALWAYS;
    if (!strcmp(text, "never")) return PROGRESS_NEVER;
    die(STATUS_USAGE, "--progress: must be auto, always or never, got %s", text);
}

// GRAINS, GRAINS,LOADS or GRAINS,LOADS,THROATS; nothing: the input says it.
static void parse_sizes(struct invocation *invocation, const char *text)
{
    enum { SIZES = 3 };
    double *const size[SIZES] = {&invocation->grains, &invocation->loads,
                                 &invocation->throats};
    invocation->estimates = true;
    for (int k = 0; text; k++) {
        char number[32];
        const char *comma = strchrnul(text, ',');
        snprintf(number, sizeof number, "%.*s", (int)(comma - text), text);
        if (k == SIZES)
            die(STATUS_USAGE, "--estimate: must be GRAINS,LOADS,THROATS, got more");
        *size[k] = number_of_option("--estimate", number, k == 0, 1e10);
        text = *comma ? comma + 1 : NULL;
    }
}

// Only the pointer is kept: argv outlives the invocation.
static void add_input(struct command_line *line, const char *name)
{
    struct invocation *invocation = line->invocation;
    if (invocation->n_input == line->stage->most_inputs)
        die(STATUS_USAGE, "%s: too many inputs, takes at most %d", name,
            line->stage->most_inputs);
    invocation->inputs = reallocate(invocation->inputs, (size_t)invocation->n_input + 1,
                                    sizeof *invocation->inputs);
    invocation->inputs[invocation->n_input++] = name;
}

// The last of an option counts, but --set, which adds up.
static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    struct command_line *line = state->input;
    struct invocation *invocation = line->invocation;
    switch (key) {
    case 'p':
        line->params = argument;
        return 0;
    case 's':
        line->set = reallocate(line->set, (size_t)line->n_set + 1, sizeof *line->set);
        line->set[line->n_set++] = argument;
        return 0;
    case 'o':
        invocation->output = argument;
        return 0;
    case 'q':
        invocation->quiet = true;
        return 0;
    case KEY_REPORT:
        invocation->report = argument;
        return 0;
    case KEY_CHECKPOINT:
        invocation->checkpoint = argument;
        return 0;
    case KEY_EVERY:
        invocation->checkpoint_every =
            number_of_option("--checkpoint-every", argument, 0, 1e9);
        return 0;
    case KEY_ESTIMATE:
        parse_sizes(invocation, argument);
        return 0;
    case KEY_THREADS:
        invocation->threads = (int)whole_of_option("--threads", argument, 1, 1024);
        return 0;
    case KEY_PROGRESS:
        invocation->progress = parse_progress(argument);
        return 0;
    case KEY_SCHEMA:
        print_schema(line->stage);
        return 0;
    case KEY_PARAMETERS:
        line->print_parameters = true;
        return 0;
    case ARGP_KEY_ARG:
        add_input(line, argument);
        return 0;
    default:
        return parse_common_option(key, state, line->stage->name, line->stage->version);
    }
}

// Whether some parameter of TABLE may stand in "conditions".
static bool shares(const struct parameter *table)
{
    for (const struct parameter *p = table; p->key; p++)
        if (p->shared) return true;
    return false;
}

static bool mentions(const char *text, const char *word)
{
    return text && strstr(text, word);
}

// MARK is "[K" of "[K 4.22]".
static bool cites(const struct stage *stage, const char *mark)
{
    for (const struct parameter *p = stage->parameters; p->key; p++)
        if (mentions(p->text, mark)) return true;
    return mentions(stage->summary, mark) || mentions(stage->notes, mark);
}

// What the letters in texts stand for, of the papers that occur in them.
static void print_cited(const struct stage *stage, FILE *stream)
{
    static const char *const papers[][2] = {
        {"[K", "K: Kharaghani's thesis on drying and cracking of aggregates"},
        {"[G", "G: Gladkyy and Schwarze (2014) on models of capillary bridges"},
        {"[C", "C: Chareyre and others (2012) on flow through packings of spheres"}};
    const char *before = "\n";
    for (size_t k = 0; k < sizeof papers / sizeof *papers; k++) {
        if (!cites(stage, papers[k][0])) continue;
        fprintf(stream, "%s%s\n", before, papers[k][1]);
        before = "";
    }
}

// The text of --help behind the options: parameters with their defaults, what is read
// and written. argp frees the text that is returned.
static char *help_filter(int key, const char *text, void *input)
{
    if (key != ARGP_KEY_HELP_POST_DOC) return (char *)(uintptr_t)text;
    const struct stage *stage = ((const struct command_line *)input)->stage;
    char *help = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&help, &length);
    fprintf(stream, "Parameters (section \"%s\" of the scene):\n", stage->name);
    parameters_print(stage->parameters, stream);
    if (shares(stage->parameters))
        fprintf(stream, "\nParameters marked * may stand, once for all stages, in the "
                        "section\n\"conditions\" of the scene.\n");
    if (stage->notes) fprintf(stream, "\n%s\n", stage->notes);
    fprintf(stream, "\nReads: %s\n", stage->reads ? stage->reads : "nothing");
    if (stage->writes_page)
        fprintf(stream, "Writes: a page, HTML\n");
    else
        fprintf(stream, "Writes: %s (schemas/%s.json)\n", stage->writes, stage->writes);
    print_cited(stage, stream);
    fprintf(stream,
            "\nExit status:\n"
            "  0 done; 1 ran, but the answer is no; 3 not converged, or unstable;\n"
            "  64 command line; 65 bad input or parameters; 66 no such input;\n"
            "  70 internal error; 73 cannot create; 74 failed I/O");
    fclose(stream);
    return help;
}

// A key that occurs twice is refused: which of them counts would be a guess. The line
// and column are those of the parser; what is not an object has neither.
static json_t *load_json(const char *path)
{
    struct bytes bytes = read_whole(path);
    json_error_t error;
    json_t *json = json_loadb((const char *)bytes.data, bytes.size,
                              JSON_REJECT_DUPLICATES, &error);
    bytes_free(&bytes);
    if (!json)
        die(STATUS_BAD_DATA, "%s: line %d, column %d: %s", path, error.line,
            error.column, error.text);
    if (!json_is_object(json)) die(STATUS_BAD_DATA, "%s: must be a JSON object", path);
    return json;
}

static bool is_section(const char *key)
{
    for (int k = 0; sections[k]; k++)
        if (!strcmp(sections[k], key)) return true;
    return false;
}

// Whether JSON has a section of a stage; pack.check is a text, the section of check an
// object. Otherwise it is one stage's own section. One key that is a section decides,
// so that a scene with a misspelt section is still taken for a scene, and the
// misspelling told.
static bool is_scene(json_t *json, const struct parameter *table)
{
    const char *key;
    json_t *value;
    json_object_foreach(json, key, value)
    {
        bool is_parameter = false;
        for (const struct parameter *p = table; p->key; p++)
            is_parameter = is_parameter || !strcmp(p->key, key);
        if (is_section(key) && !(is_parameter && !json_is_object(value))) return true;
    }
    return false;
}

// By edit distance; of equally near ones the first.
static const char *nearest_section(const char *key)
{
    const char *nearest = sections[0];
    for (int k = 1; sections[k]; k++)
        if (edit_distance(key, sections[k]) < edit_distance(key, nearest))
            nearest = sections[k];
    return nearest;
}

// NULL where the scene has none: all defaults.
static json_t *object_of_scene(const json_t *scene, const char *path, const char *name)
{
    json_t *object = json_object_get(scene, name);
    if (object && !json_is_object(object))
        die(STATUS_BAD_DATA, "%s: %s: must be an object", path, name);
    return object;
}

// With what it shares with others. A new reference. Unknown sections are refused, since
// a misspelt one would be ignored silently. What the stage's own section says stays;
// from "conditions" it gets only what it lacks. The section is changed in place: it
// belongs to the file just read.
static json_t *section_of_scene(const json_t *scene, const char *path,
                                const struct stage *stage)
{
    const char *key;
    json_t *value;
    int unknown = 0;
    json_object_foreach((json_t *)(uintptr_t)scene, key, value)
    {
        if (is_section(key) || !strcmp(key, "comment")) continue;
        report("%s: %s: unknown section; the nearest stage is %s", path, key,
               nearest_section(key));
        unknown++;
    }
    if (unknown) exit(STATUS_BAD_DATA);
    json_t *section = object_of_scene(scene, path, stage->name);
    section = section ? json_incref(section) : json_object();
    char where[300];
    snprintf(where, sizeof where, "%s: conditions", path);
    conditions_share(section, stage->parameters,
                     object_of_scene(scene, path, "conditions"), where);
    return section;
}

// Without -p all defaults; --set may follow. SCENE, which the caller owns: NULL where
// the file is none.
static json_t *load_section(const struct command_line *line, json_t **scene)
{
    *scene = NULL;
    if (!line->params) return json_object();
    json_t *json = load_json(line->params);
    if (!is_scene(json, line->stage->parameters)) return json;
    *scene = json;
    return section_of_scene(json, line->params, line->stage);
}

// Whether TABLE has the key of ASSIGNMENT.
static bool has_key(const struct parameter *table, const char *assignment)
{
    const size_t length = strcspn(assignment, "=");
    for (const struct parameter *p = table; p->key; p++)
        if (!strncmp(p->key, assignment, length) && !p->key[length]) return true;
    return false;
}

// Keys of a scene begin with the section, this or another with the same key; those of
// --set do not.
static void set(json_t *section, const struct stage *stage, const char *assignment)
{
    const size_t own = strlen(stage->name), first = strcspn(assignment, ".=");
    const bool is_own = first == own && !strncmp(assignment, stage->name, own);
    const char *rest = assignment + first + 1;
    if (assignment[first] == '.' &&
        (is_own ||
         (!has_key(stage->parameters, assignment) && has_key(stage->parameters, rest))))
        die(STATUS_USAGE, "--set %s: must go without the section, %s", assignment,
            rest);
    parameters_set(section, assignment);
}

// Gives SECTION what other sections of SCENE say for this stage, too, and notes which.
static void borrow(const struct command_line *line, const json_t *scene,
                   json_t *section, void *parameters)
{
    char where[300];
    for (const struct parameter *p = line->stage->parameters; p->key; p++) {
        if (!p->section) continue;
        const json_t *other = object_of_scene(scene, line->params, p->section);
        snprintf(where, sizeof where, "%s: %s", line->params, p->section);
        if (parameters_borrow(section, p, other, where, parameters))
            json_object_set_new(line->invocation->borrowed, p->key, json_true());
    }
}

// WHERE begins each message: the file, the section, and whether --set took part. --set
// comes after the file and before the check, so that what it repairs is not reported.
// Effective parameters go to the invocation, which the artifact's provenance is made
// from.
static void fill(const struct command_line *line, void *parameters)
{
    json_t **scene = &line->invocation->scene;
    json_t *section = load_section(line, scene);
    for (int k = 0; k < line->n_set; k++)
        set(section, line->stage, line->set[k]);
    line->invocation->borrowed = json_object();
    if (*scene) borrow(line, *scene, section, parameters);
    char where[300];
    snprintf(where, sizeof where, "%s%s%s%s", line->params ? line->params : "",
             line->params && line->n_set ? " with --set" : "", line->params ? ": " : "",
             line->stage->name);
    line->invocation->parameters =
        parameters_fill(line->stage->parameters, section, where, parameters);
    json_decref(section);
}

// END is the row of zeros, which moves one down.
static struct argp_option *add_option(struct argp_option *end, const char *name,
                                      int key, const char *argument, int flags,
                                      const char *text)
{
    end[1] = *end;
    *end = (struct argp_option){name, key, argument, flags, text, 0};
    return end + 1;
}

// The options of every stage, and its own.
static void list_options(const struct stage *stage, struct argp_option *list)
{
    static_assert(sizeof options <= (MOST_OPTIONS - 4) * sizeof *options,
                  "room for four more");
    memcpy(list, options, sizeof options);
    struct argp_option *end = list;
    while (end->name)
        end++;
    if (stage->reports)
        end = add_option(end, "report", KEY_REPORT, "FILE", 0, stage->reports);
    if (stage->estimates == ESTIMATES_INPUT)
        end = add_option(end, "estimate", KEY_ESTIMATE, NULL, 0,
                         "Print what the run of INPUT will take, as JSON, and do not "
                         "run");
    if (stage->estimates == ESTIMATES_SIZES)
        end = add_option(end, "estimate", KEY_ESTIMATE, "GRAINS", OPTION_ARG_OPTIONAL,
                         "Print what the run will take, as JSON, and do not run. "
                         "Without INPUT: for so many irregular grains, and as "
                         "GRAINS,LOADS,THROATS under so many loads (0: not known) "
                         "with so many throats");
    if (!stage->checkpoints) return;
    end = add_option(end, "checkpoint", KEY_CHECKPOINT, "FILE", 0,
                     "Keep the state there regularly, and when stopped by SIGTERM, "
                     "SIGINT or SIGHUP; resume from it if it exists; remove it at the "
                     "end. Results do not depend on it");
    add_option(end, "checkpoint-every", KEY_EVERY, "SECONDS", 0,
               "Time between two checkpoints [600]");
}

// Another output, of OPTION, needs another place. --report and --checkpoint are
// compared with the output only, not with inputs.
static void check_other(const struct invocation *invocation, const char *option,
                        const char *path)
{
    if (!path) return;
    if (is_same_place(path, invocation->output))
        die(STATUS_USAGE, "%s %s: is where the output goes: name another file", option,
            path);
    for (int k = 0; k < invocation->n_input; k++)
        if (strcmp(path, "-") && is_same_place(path, invocation->inputs[k]))
            die(STATUS_USAGE, "%s %s: is an input: name another file", option, path);
    check_output(path);
}

// An artifact may become another of its kind in its place, as by sort -o; what is of
// another kind, or text, would be lost by a slip.
static void check_inputs(const struct invocation *invocation)
{
    const struct stage *stage = invocation->stage;
    if (stage->reads && !strcmp(stage->reads, stage->writes)) return;
    for (int k = 0; k < invocation->n_input; k++) {
        const char *path = invocation->inputs[k];
        struct stat there;
        if (!strcmp(path, "-") || stat(path, &there) || !S_ISREG(there.st_mode))
            continue;
        if (is_same_place(path, invocation->output))
            die(STATUS_USAGE,
                "%s: is an input, and where the output goes: name another file", path);
    }
}

static void check_scene(const struct command_line *line)
{
    const struct invocation *invocation = line->invocation;
    if (!line->params || !strcmp(line->params, "-")) return;
    if (is_same_place(line->params, invocation->output) ||
        (invocation->report && is_same_place(line->params, invocation->report)))
        die(STATUS_USAGE, "--params %s: is where the output goes: name another file",
            line->params);
}

// It is read back and replaced many times, which a pipe or device cannot be.
static void check_checkpoint(const struct invocation *invocation)
{
    const char *path = invocation->checkpoint;
    if (!path) return;
    if (!strcmp(path, "-"))
        die(STATUS_USAGE, "--checkpoint: must be a file, not standard output");
    if (is_device(path))
        die(STATUS_USAGE, "--checkpoint %s: must be a file, not a device or pipe",
            path);
    if (invocation->report && is_same_place(path, invocation->report))
        die(STATUS_USAGE,
            "--checkpoint %s: is where the report goes: name another file", path);
    check_other(invocation, "--checkpoint", path);
}

// Without an input standard input is read, if the stage takes any. A terminal is
// refused as output but by stages that tell people: an artifact is not text. Outputs
// are looked at last, when it is clear that there is something to run; an estimate has
// none.
struct invocation stage_begin(const struct stage *stage, int argc, char **argv,
                              void *parameters)
{
    keep_freed_memory();
    struct invocation invocation = {
        .stage = stage, .checkpoint_every = 600, .threads = 1};
    struct command_line line = {.stage = stage, .invocation = &invocation};
    struct argp_option all[MOST_OPTIONS];
    list_options(stage, all);
    const struct argp argp = {.options = all,
                              .parser = parse_option,
                              .args_doc = stage->most_inputs ? "[INPUT...]" : "",
                              .doc = stage->summary,
                              .help_filter = help_filter};
    parse_command_line(&argp, argc, argv, &line);
    invocation.tells = stage->tells && !invocation.output;
    if (!invocation.output) invocation.output = "-";
    fill(&line, parameters);
    free(line.set);
    if (line.print_parameters) {
        json_dumpf(invocation.parameters, stdout, JSON_INDENT(2) | JSON_SORT_KEYS);
        putchar('\n');
        exit(STATUS_OK);
    }
    if (invocation.estimates && stage->estimates == ESTIMATES_INPUT &&
        !invocation.n_input)
        die(STATUS_USAGE,
            "--estimate: name an input: what a run takes follows from it");
    if (invocation.estimates) return invocation;
    if (!strcmp(invocation.output, "-") && !invocation.tells && isatty(STDOUT_FILENO))
        die(STATUS_USAGE,
            "standard output is a terminal: name a file with -o, or pipe it");
    check_inputs(&invocation);
    check_scene(&line);
    check_output(invocation.output);
    check_other(&invocation, "--report", invocation.report);
    check_checkpoint(&invocation);
    if (stage->reads && !invocation.n_input) add_input(&line, "-");
    return invocation;
}

void invocation_free(struct invocation *invocation)
{
    free(invocation->inputs);
    json_decref(invocation->parameters);
    json_decref(invocation->borrowed);
    json_decref(invocation->scene);
    *invocation = (struct invocation){0};
}
