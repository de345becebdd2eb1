// SPDX-License-Identifier: GPL-3.0-or-later
// In the order of the file: signals set a flag; arrays become datasets of the restart
// artifact, under one digest; a child process writes it, so that a full disk does not
// end the run; a restart artifact is taken only by a call of the same program,
// parameters and inputs; and the keeper asks flag and clock whether a state is due.
//
//     /digest        (32) SHA-256 over the arrays, of the engine, then of the stage
//     /engine/NAME   arrays of the engine; rank and type by schemas/restart.json
//     /stage/NAME    arrays of the stage
#include "artifacts/checkpoint.h"

#include "basics/memory.h"
#include "basics/progress.h"
#include "basics/status.h"

#include <errno.h>
#include <openssl/evp.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

// ---- signals ------------------------------------------------------------------------

static const int stops[] = {SIGTERM, SIGINT, SIGHUP};
enum { STOPS = sizeof stops / sizeof *stops };

// The one thing a handler may do is to set this.
static volatile sig_atomic_t stopped_by;

static void note_signal(int signal)
{
    stopped_by = signal;
}

// A second signal of the same kind ends the program at once; one that is ignored stays
// so (nohup). When the work is done the first is let pass: the output is being written.
static void catch_signals(void)
{
    struct sigaction catch = {.sa_handler = note_signal,
                              .sa_flags = SA_RESTART | (int)SA_RESETHAND};
    sigemptyset(&catch.sa_mask);
    for (int k = 0; k < STOPS; k++) {
        struct sigaction before;
        sigaction(stops[k], NULL, &before);
        if (before.sa_handler == SIG_DFL) sigaction(stops[k], &catch, NULL);
    }
}

// ---- the file -----------------------------------------------------------------------

static const char *const type_names[] = {"float64", "int32", "int64", "uint8"};

static enum array_type type_of(const json_t *entry)
{
    const char *name = json_string_value(json_object_get(entry, "type"));
    int type = ARRAY_FLOAT64;
    while (strcmp(type_names[type], name))
        type++;
    return (enum array_type)type;
}

static int numbers_in_row(const json_t *entry)
{
    const json_t *shape = json_object_get(entry, "shape");
    int numbers = 1;
    for (size_t axis = 1; axis < json_array_size(shape); axis++)
        numbers *= (int)json_integer_value(json_array_get(shape, axis));
    return numbers;
}

void artifact_put_arrays(struct artifact *artifact, const char *group,
                         const struct array_list *list)
{
    for (int k = 0; k < list->count; k++) {
        const struct named_array *array = &list->array[k];
        char name[64];
        snprintf(name, sizeof name, "/%s/%s", group, array->name);
        const json_t *entry = schema_dataset(artifact->schema, name);
        if (!entry || type_of(entry) != array->type)
            die(STATUS_INTERNAL, "%s: not of that type in schema %s", name,
                artifact->schema->name);
        artifact_put(artifact, name, array->data,
                     (int)(array->count / numbers_in_row(entry)));
    }
}

struct array_list artifact_get_arrays(const struct artifact *artifact,
                                      const char *group)
{
    struct array_list list = {NULL, 0};
    char begin[32];
    const int length = snprintf(begin, sizeof begin, "/%s/", group);
    size_t k;
    json_t *entry;
    json_array_foreach(artifact->schema->datasets, k, entry)
    {
        const char *name = json_string_value(json_object_get(entry, "name"));
        if (strncmp(name, begin, (size_t)length) || !has_entry(artifact->file, entry))
            continue;
        int rows;
        void *data = artifact_get(artifact, name, &rows);
        add_array(&list, name + length, type_of(entry),
                  (int64_t)rows * numbers_in_row(entry), data);
        free(data);
    }
    return list;
}

// Sorts the arrays by name, as their order in the file has no meaning.
static int by_name(const void *a, const void *b)
{
    const struct named_array *const *p = a, *const *q = b;
    return strcmp((*p)->name, (*q)->name);
}

// Of each: the name with its null, the count, the numbers as they lie in memory.
static void digest_list(EVP_MD_CTX *digest, const struct array_list *list)
{
    const struct named_array **sorted =
        NEW_ARRAY(const struct named_array *, list->count);
    for (int k = 0; k < list->count; k++)
        sorted[k] = &list->array[k];
    qsort(sorted, (size_t)list->count, sizeof(const struct named_array *), by_name);
    for (int k = 0; k < list->count; k++) {
        const struct named_array *array = sorted[k];
        EVP_DigestUpdate(digest, array->name, strlen(array->name) + 1);
        EVP_DigestUpdate(digest, &array->count, sizeof array->count);
        EVP_DigestUpdate(digest, array->data,
                         (size_t)array->count * number_size(array->type));
    }
    free(sorted);
}

// HDF5 sees damage to its own structure but not to numbers.
static void digest_state(const struct kept_state *state, uint8_t sum[32])
{
    EVP_MD_CTX *digest = EVP_MD_CTX_new();
    if (!digest || !EVP_DigestInit_ex(digest, EVP_sha256(), NULL))
        die(STATUS_INTERNAL, "SHA-256 is not available");
    digest_list(digest, &state->engine);
    digest_list(digest, &state->stage);
    EVP_DigestFinal_ex(digest, sum, NULL);
    EVP_MD_CTX_free(digest);
}

static void write_here(const struct checkpoint *checkpoint,
                       const struct kept_state *state)
{
    struct invocation there = *checkpoint->invocation;
    there.output = there.checkpoint;
    struct artifact *artifact = artifact_create("restart", there.output);
    uint8_t sum[32];
    digest_state(state, sum);
    artifact_put(artifact, "/digest", sum, sizeof sum);
    artifact_put_arrays(artifact, "engine", &state->engine);
    artifact_put_arrays(artifact, "stage", &state->stage);
    artifact_finish(artifact, &there, json_incref(checkpoint->inputs),
                    "the state of a run on its way\n");
}

// By a child, whose failure is not the run's: hours of work do not end for a full disk.
// STATUS_OK, or how the child ended; it said why, unless SILENT: the same as last time.
static int write_state(const struct checkpoint *checkpoint,
                       const struct kept_state *state, bool silent)
{
    const pid_t child = fork();
    if (child == 0 && silent && !freopen("/dev/null", "w", stderr)) _exit(STATUS_IO);
    if (child <= 0) write_here(checkpoint, state);
    if (child < 0) return STATUS_OK; // none could be had: we wrote it ourselves
    if (child == 0) _exit(STATUS_OK);
    int end;
    while (waitpid(child, &end, 0) < 0 && errno == EINTR)
        continue;
    return WIFEXITED(end) ? WEXITSTATUS(end) : STATUS_IO;
}

// ---- whose it is --------------------------------------------------------------------

// As texts: JSON is canonical on both sides, so equal values are equal texts.
static void check_same(const struct artifact *artifact, const char *what,
                       const char *ours)
{
    char *theirs = artifact_get_text(artifact, what);
    if (!theirs || strcmp(theirs, ours))
        die(STATUS_BAD_DATA,
            "%s: is of another run: its %s differ%s from this call's; name another "
            "file, or remove it to start again",
            artifact->path, what, what[strlen(what) - 1] == 's' ? "" : "s");
    free(theirs);
}

static void check_run(const struct artifact *artifact,
                      const struct checkpoint *checkpoint)
{
    char program[64];
    char *parameters = json_canonical(checkpoint->invocation->parameters);
    char *inputs = json_canonical(checkpoint->inputs);
    check_same(artifact, "program",
               stage_program(checkpoint->invocation->stage, program));
    check_same(artifact, "parameters", parameters);
    check_same(artifact, "inputs", inputs);
    free(parameters);
    free(inputs);
}

static void read_state(struct checkpoint *checkpoint)
{
    const char *path = checkpoint->invocation->checkpoint;
    struct artifact *artifact = artifact_open(path, "restart");
    check_run(artifact, checkpoint);
    checkpoint->begin =
        (struct kept_state){.engine = artifact_get_arrays(artifact, "engine"),
                            .stage = artifact_get_arrays(artifact, "stage")};
    uint8_t sum[32], *wanted = artifact_get(artifact, "/digest", NULL);
    digest_state(&checkpoint->begin, sum);
    if (memcmp(sum, wanted, sizeof sum))
        die(STATUS_BAD_DATA, "%s: is damaged: its numbers do not have its digest",
            path);
    free(wanted);
    artifact_close(artifact);
}

// ---- when ---------------------------------------------------------------------------

// Never by a cycle or a load: when states are kept must not touch results.
static bool due(void *context)
{
    const struct checkpoint *checkpoint = context;
    return stopped_by || seconds_now() - checkpoint->written >=
                             checkpoint->invocation->checkpoint_every;
}

// Ends the program, by the signal, if one has come.
static void keep(void *context, const struct kept_state *state)
{
    struct checkpoint *checkpoint = context;
    const int signal_now = stopped_by;
    const bool silent = checkpoint->has_failed && !signal_now;
    const int status = write_state(checkpoint, state, silent);
    checkpoint->written = seconds_now();
    if (status && signal_now) exit(status);
    if (status && !silent)
        report("%s: the state was not kept this time; the run continues",
               checkpoint->invocation->checkpoint);
    checkpoint->has_failed = status != 0;
    if (!signal_now) return;
    if (!checkpoint->invocation->quiet)
        report("stopped: %s: repeat the same command to continue from %s",
               strsignal(signal_now), checkpoint->invocation->checkpoint);
    signal(signal_now, SIG_DFL);
    raise(signal_now);
}

void checkpoint_begin(struct checkpoint *checkpoint, struct invocation *invocation,
                      json_t *inputs)
{
    *checkpoint = (struct checkpoint){
        .invocation = invocation, .inputs = inputs, .written = seconds_now()};
    if (!invocation->checkpoint) return;
    checkpoint->keeper =
        (struct keeper){.due = due, .keep = keep, .context = checkpoint};
    if (!access(invocation->checkpoint, F_OK)) {
        read_state(checkpoint);
        invocation->resumed = true;
        checkpoint->keeper.begin = &checkpoint->begin;
    }
    catch_signals();
}

void checkpoint_end(struct checkpoint *checkpoint)
{
    const char *path = checkpoint->invocation->checkpoint;
    if (!path) return;
    free_kept_state(&checkpoint->begin);
    if (unlink(path) && errno != ENOENT)
        report("%s: cannot be removed: %s", path, strerror(errno));
}
