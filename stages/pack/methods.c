// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the method by the parameters, checks them, and gives it a domain. If the user
// gives only a count, the domain is a cube of the volume that the method is expected to
// need (expected_porosity); if only a domain, the count follows alike. Radii are drawn
// from a clone of the random stream first, so that both see the same grains.
//     edge  = (sum of volumes / (1 - expected_porosity))^(1/dimensions),
//     count = the first at which sum of volumes >= (1 - expected_porosity) volume.
// expected_porosity is a guess, unless the target is a porosity. The edge is at least
// the largest diameter. A given INPUT keeps its box and count.
#include "methods.h"

#include "pack.h"

#include <gsl/gsl_rng.h>
#include <math.h>

// ---- lattices -----------------------------------------------------------------------

// Two methods are flat by nature.
static int dimensions_of(const struct pack_parameters *parameters)
{
    const int method = parameters->method;
    if (method == METHOD_SQUARE || method == METHOD_INWARD_SPIRAL) return 2;
    return (int)parameters->dimensions;
}

// The hexagonal lattice is another one in a plane.
static enum lattice lattice_of(const struct pack_parameters *parameters)
{
    switch (parameters->method) {
    case METHOD_BODY_CENTRED:
        return LATTICE_BODY_CENTRED;
    case METHOD_FACE_CENTRED:
        return LATTICE_FACE_CENTRED;
    case METHOD_HEXAGONAL:
        return parameters->dimensions == 2 ? LATTICE_TRIANGULAR : LATTICE_HEXAGONAL;
    case METHOD_HONEYCOMB:
        return LATTICE_HONEYCOMB;
    default:
        return LATTICE_CUBIC;
    }
}

// Otherwise `counts` decides how large the box is.
static bool fills_domain(const struct pack_parameters *parameters)
{
    return parameters->domain.shape != DOMAIN_BOX ||
           !isnan(parameters->domain.upper[0]);
}

// Grains of a lattice touch only if they have one size.
static enum status check_lattice(const struct pack_parameters *parameters,
                                 struct reason *reason)
{
    const int method = parameters->method;
    if (parameters->sizes.distribution != SIZES_ONE)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.sizes.distribution: must be one for a lattice");
    if (parameters->dimensions == 2 && method != METHOD_SQUARE &&
        method != METHOD_HEXAGONAL && method != METHOD_HONEYCOMB)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.dimensions: must be 3 for this lattice (two dimensions: "
                      "square, hexagonal, honeycomb)");
    if (dimensions_of(parameters) == 2 && parameters->counts[1] != 1 &&
        !fills_domain(parameters))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.counts: a %s lattice is one layer: must be 1 along y, got "
                      "%lld",
                      method == METHOD_SQUARE      ? "square"
                      : method == METHOD_HEXAGONAL ? "triangular"
                                                   : "honeycomb",
                      (long long)parameters->counts[1]);
    return STATUS_OK;
}

// The box of the given counts, or the domain to fill and the counts that cover it.
static enum status lattice_domain(const struct pack_parameters *parameters,
                                  enum lattice lattice, int64_t counts[3],
                                  struct domain *domain, struct reason *reason)
{
    const double radius = parameters->sizes.radius;
    const struct domain_parameters *wanted = &parameters->domain;
    const int dimensions = dimensions_of(parameters);
    if (fills_domain(parameters)) {
        const enum status status =
            domain_init(wanted, dimensions, radius, domain, reason);
        return status ? status
                      : lattice_counts(lattice, domain, radius, counts, reason);
    }
    struct vector lower = {0};
    for (int axis = 0; axis < 3; axis++) {
        counts[axis] = parameters->counts[axis];
        if (!isnan(wanted->lower[axis]))
            set_component(&lower, axis, wanted->lower[axis]);
    }
    const struct vector size =
        lattice_extent(lattice, counts, radius, wanted->periodic);
    return domain_around(wanted, dimensions, lower, add(lower, size), domain, reason);
}

static enum status make_lattice(const struct pack_parameters *parameters,
                                struct domain *domain, struct packing *packing,
                                struct reason *reason)
{
    const enum lattice lattice = lattice_of(parameters);
    int64_t counts[3];
    enum status status = check_lattice(parameters, reason);
    if (!status) status = lattice_domain(parameters, lattice, counts, domain, reason);
    if (status) return status;
    if (lattice_grains(lattice, counts) < 0)
        return refuse(reason, STATUS_BAD_DATA, "pack.%s: must make at most 1e8 grains",
                      fills_domain(parameters) ? "radius" : "counts");
    *packing = lattice_packing(lattice, counts, parameters->sizes.radius, domain);
    if (packing->n_particle) return STATUS_OK;
    packing_free(packing);
    return refuse(reason, STATUS_BAD_DATA,
                  "pack.domain.shape: must leave room for at least one grain of the "
                  "lattice");
}

// ---- random methods and the spiral --------------------------------------------------

// A user's bound wins over that of the distribution.
static double least_radius(const struct pack_parameters *parameters,
                           const struct sizes *sizes)
{
    const double entry = parameters->sizes.smallest;
    return isnan(entry) ? sizes->smallest : entry;
}

static enum status place_drawn(const struct pack_parameters *parameters,
                               const struct domain *domain, const struct sizes *sizes,
                               gsl_rng *random, struct progress *progress,
                               struct packing *packing, struct reason *reason)
{
    const int count = (int)parameters->count;
    switch (parameters->method) {
    case METHOD_POISSON:
        if (!count)
            return refuse(reason, STATUS_BAD_DATA,
                          "pack.count: must be given for poisson");
        return poisson_points(domain, sizes, count, random, packing, reason);
    case METHOD_RANDOM_SEQUENTIAL:
        return random_sequential(domain, sizes, count, parameters->most_trials, random,
                                 progress, packing, reason);
    default:
        return inward_spiral(domain, sizes, count, parameters->densify,
                             least_radius(parameters, sizes), random, packing, reason);
    }
}

static gsl_rng *random_of(const struct pack_parameters *parameters)
{
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(random, (unsigned long)parameters->seed);
    return random;
}

// The largest radius first: the domain must have room for it.
static enum status make_drawn(const struct pack_parameters *parameters,
                              struct progress *progress, struct domain *domain,
                              struct packing *packing, struct reason *reason)
{
    struct sizes sizes;
    enum status status = sizes_prepare(&parameters->sizes, &sizes, reason);
    if (!status)
        status = domain_init(&parameters->domain, dimensions_of(parameters),
                             sizes.largest, domain, reason);
    if (status) return status;
    gsl_rng *random = random_of(parameters);
    status = place_drawn(parameters, domain, &sizes, random, progress, packing, reason);
    gsl_rng_free(random);
    return status;
}

// ---- moving grains ------------------------------------------------------------------

// The porosity that the method usually reaches. Random close packing of equal spheres
// has 0.36, of discs 0.16; grains that fall end a little looser. Soft spheres come to
// rest in any number where they do not quite jam.
static double expected_porosity(const struct pack_parameters *parameters)
{
    const struct dynamics_parameters *how = &parameters->dynamics;
    if (how->target == TARGET_POROSITY) return how->value;
    // falls from random points within the sphere itself
    if (parameters->method == METHOD_DEPOSITION &&
        parameters->domain.shape == DOMAIN_SPHERE)
        return parameters->dimensions == 2 ? 0.6 : 0.72;
    if (parameters->method == METHOD_DEPOSITION)
        return parameters->dimensions == 2 ? 0.2 : 0.42;
    if (parameters->method == METHOD_SOFT_SPHERES) return 0.4;
    if (parameters->method == METHOD_EXPLOSIVE_REPULSION)
        return parameters->dimensions == 2 ? 0.2 : 0.4;
    if (parameters->method == METHOD_RANDOM_SEQUENTIAL) return 0.62;
    return parameters->dimensions == 2 ? 0.17 : 0.37;
}

// Deposition ends at rest; compression can aim at a porosity, a coordination or a
// pressure.
static enum status check_target(const struct pack_parameters *parameters,
                                struct reason *reason)
{
    const struct dynamics_parameters *how = &parameters->dynamics;
    const bool compressed = parameters->method == METHOD_RADIUS_EXPANSION ||
                            parameters->method == METHOD_DOMAIN_CONTRACTION;
    if (how->target == TARGET_SETTLED) return STATUS_OK;
    if (isnan(how->value))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.target_value: must be given, for this target");
    if (how->target == TARGET_POROSITY && how->value >= 1)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.target_value: must be below 1 for a porosity, got %g",
                      how->value);
    if (!compressed &&
        (how->target != TARGET_POROSITY || parameters->method == METHOD_DEPOSITION))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.target: must be settled for this method, or, for "
                      "explosive_repulsion, porosity");
    return STATUS_OK;
}

// Volume of COUNT grains as they will be drawn; in two dimensions the area, m^2. The
// clone leaves RANDOM where it was, so the grains drawn later are these.
static double sum_of_sizes(const struct sizes *sizes, int count, int dimensions,
                           const gsl_rng *random)
{
    gsl_rng *same = gsl_rng_clone(random);
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const double radius = sizes_draw(sizes, same);
        sum += M_PI * radius * radius * (dimensions == 2 ? 1 : 4 * radius / 3);
    }
    gsl_rng_free(same);
    return sum;
}

// A cube, or square, for the count, if the user gives no box. From the lower corner, 0
// unless given, with equal edges.
static enum status give_box(const struct pack_parameters *parameters,
                            const struct sizes *sizes, const gsl_rng *random,
                            struct domain_parameters *box, struct reason *reason)
{
    *box = parameters->domain;
    if (box->shape != DOMAIN_BOX || !isnan(box->upper[0])) return STATUS_OK;
    if (!parameters->count)
        return refuse(
            reason, STATUS_BAD_DATA,
            "pack.count: must be given, or pack.upper: the box to fill, or grains "
            "as an input (make run IMPORT=FILE)");
    const int dimensions = (int)parameters->dimensions;
    const double sum = sum_of_sizes(sizes, (int)parameters->count, dimensions, random);
    const double room = sum / (1 - expected_porosity(parameters));
    const double edge = fmax(pow(room, 1.0 / dimensions), 2 * sizes->largest);
    for (int axis = 0; axis < 3; axis++)
        box->upper[axis] = (isnan(box->lower[axis]) ? 0 : box->lower[axis]) + edge;
    return STATUS_OK;
}

// The number of grains that fill the domain to the expected porosity. In two dimensions
// areas and not volumes: a disc fills the layer's thickness.
static enum status count_grains(const struct pack_parameters *parameters,
                                const struct domain *domain, const struct sizes *sizes,
                                const gsl_rng *random, int *count,
                                struct reason *reason)
{
    *count = (int)parameters->count;
    if (*count) return STATUS_OK;
    const double thick =
        domain->dimensions == 2 ? domain->upper.y - domain->lower.y : 1;
    const double solid =
        (1 - expected_porosity(parameters)) * domain_volume(domain) / thick;
    gsl_rng *same = gsl_rng_clone(random);
    double sum = 0;
    while (sum < solid && *count < 100000000) {
        const double radius = sizes_draw(sizes, same);
        sum += M_PI * radius * radius * (domain->dimensions == 2 ? 1 : 4 * radius / 3);
        ++*count;
    }
    gsl_rng_free(same);
    if (sum >= solid) return STATUS_OK;
    return refuse(reason, STATUS_BAD_DATA,
                  "pack.upper: must hold at most 1e8 grains of this size");
}

// Sizes for the box, the box for the count: each needs the one before.
static enum status prepare(const struct pack_parameters *parameters,
                           const gsl_rng *random, struct sizes *sizes,
                           struct domain *domain, int *count, struct reason *reason)
{
    struct domain_parameters box;
    enum status status = sizes_prepare(&parameters->sizes, sizes, reason);
    if (!status) status = give_box(parameters, sizes, random, &box, reason);
    if (!status)
        status = domain_init(&box, dimensions_of(parameters), sizes->largest, domain,
                             reason);
    return status ? status
                  : count_grains(parameters, domain, sizes, random, count, reason);
}

static enum status move_grains_there(const struct making *making,
                                     const struct pack_parameters *parameters,
                                     int count, struct reason *reason)
{
    switch (parameters->method) {
    case METHOD_DEPOSITION:
        return deposit(making, count, reason);
    case METHOD_RADIUS_EXPANSION:
        return densify(making, count, true, reason);
    case METHOD_DOMAIN_CONTRACTION:
        return densify(making, count, false, reason);
    default:
        return repel(making, count, reason);
    }
}

static enum status check_soft(const struct pack_parameters *parameters,
                              struct reason *reason)
{
    const struct dynamics_parameters *how = &parameters->dynamics;
    if (parameters->dimensions != 3 || parameters->domain.shape != DOMAIN_BOX ||
        parameters->domain.cut != CUT_NONE)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.method: soft_spheres fill boxes in three dimensions, "
                      "without a cut");
    if (how->target != TARGET_SETTLED && how->target != TARGET_POROSITY)
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.target: must be settled or porosity for soft_spheres");
    if (how->target == TARGET_POROSITY && !(how->value < 1))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.target_value: must be given, and below 1, for a porosity");
    if (how->target == TARGET_SETTLED && !isnan(how->value))
        return refuse(reason, STATUS_BAD_DATA,
                      "pack.target_value: must be null where pack.target is settled");
    return STATUS_OK;
}

static enum status make_soft(const struct pack_parameters *parameters,
                             struct progress *progress, struct domain *domain,
                             struct packing *packing, struct reason *reason)
{
    struct sizes sizes;
    enum status status = check_soft(parameters, reason);
    if (status) return status;
    gsl_rng *random = random_of(parameters);
    int count = 0;
    status = prepare(parameters, random, &sizes, domain, &count, reason);
    if (!status)
        status = soft_spheres(domain, &sizes, count, random, progress, packing, reason);
    gsl_rng_free(random);
    return status;
}

// The sizes of given grains: moving needs only their range. Nothing is drawn from it.
static struct sizes sizes_of(const struct packing *packing)
{
    struct sizes sizes = {.smallest = HUGE_VAL};
    for (int i = 0; i < packing->n_particle; i++) {
        sizes.smallest = fmin(sizes.smallest, packing->radius[i]);
        sizes.largest = fmax(sizes.largest, packing->radius[i]);
    }
    sizes.radius = sizes.largest;
    return sizes;
}

// All of it first: sizes, box and count are needed for the checks.
static enum status make_moved(const struct pack_parameters *parameters,
                              const char *given, struct progress *progress,
                              struct domain *domain, struct packing *packing,
                              struct reached *reached, struct reason *reason)
{
    struct sizes sizes;
    enum status status = check_target(parameters, reason);
    if (status) return status;
    gsl_rng *random = random_of(parameters);
    const struct making making = {.given = given,
                                  .how = &parameters->dynamics,
                                  .sizes = &sizes,
                                  .random = random,
                                  .progress = progress,
                                  .domain = domain,
                                  .packing = packing,
                                  .reached = reached};
    int count = 0;
    if (given)
        sizes = sizes_of(packing);
    else
        status = prepare(parameters, random, &sizes, domain, &count, reason);
    if (!status && domain->dimensions == 2) { // a plane does not repeat across itself
        domain->periodic[1] = false;
        packing->periodic[1] = false;
    }
    if (!status) status = check_moved(parameters, given, domain, &sizes, reason);
    if (!status) status = move_grains_there(&making, parameters, count, reason);
    gsl_rng_free(random);
    return status;
}

enum status make_grains(const struct pack_parameters *parameters, const char *given,
                        struct progress *progress, struct domain *domain,
                        struct packing *packing, struct reached *reached,
                        struct reason *reason)
{
    switch (parameters->method) {
    case METHOD_POISSON:
    case METHOD_RANDOM_SEQUENTIAL:
    case METHOD_INWARD_SPIRAL:
        return make_drawn(parameters, progress, domain, packing, reason);
    case METHOD_DEPOSITION:
    case METHOD_RADIUS_EXPANSION:
    case METHOD_DOMAIN_CONTRACTION:
    case METHOD_EXPLOSIVE_REPULSION:
        return make_moved(parameters, given, progress, domain, packing, reached,
                          reason);
    case METHOD_SOFT_SPHERES:
        return make_soft(parameters, progress, domain, packing, reason);
    default:
        return make_lattice(parameters, domain, packing, reason);
    }
}

// ---- how many -----------------------------------------------------------------------

static enum status lattice_count(const struct pack_parameters *parameters,
                                 double *grains, struct reason *reason)
{
    const enum lattice lattice = lattice_of(parameters);
    struct domain domain;
    int64_t counts[3];
    const enum status status =
        lattice_domain(parameters, lattice, counts, &domain, reason);
    if (status) return status;
    const struct vector edge = subtract(domain.upper, domain.lower);
    *grains = (double)lattice_grains(lattice, counts) * domain_volume(&domain) /
              box_volume(edge);
    return STATUS_OK;
}

enum status expected_count(const struct pack_parameters *parameters, double *grains,
                           struct reason *reason)
{
    if (parameters->method < METHOD_POISSON)
        return lattice_count(parameters, grains, reason);
    struct sizes sizes;
    struct domain domain;
    int count = 0;
    gsl_rng *random = random_of(parameters);
    const enum status status =
        prepare(parameters, random, &sizes, &domain, &count, reason);
    gsl_rng_free(random);
    *grains = count;
    return status;
}
