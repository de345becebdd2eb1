// SPDX-License-Identifier: GPL-3.0-or-later
// Are these grains what one thinks? Units, diameters for radii, overlaps, grains
// outside the box, grains in one place, empty space within the walls, squashed layers.
// Facts are measured (packing_facts.c), then judged (packing_check.c); who has other
// facts adds findings of its own.
#pragma once

#include "geometry/porosity.h"

// What is found in a packing. Rows are those of /particles; -1 where there is none.
// Auxiliary grains do not count, nor the part of the box that they fill.
struct packing_facts {
    struct window box;               // without auxiliary layers, m
    int n;                           // grains
    double smallest, largest;        // radius, m
    double tenth, median, ninetieth; // radii that 10, 50 and 90 % do not exceed, m
    struct vector lower, upper;      // where the grains' surfaces end, m
    double unit; // m that the file says its lengths are in, taken for metres; 0: not so
    bool bounded;    // by bodies within the box, whose walls count as its own
    double porosity; // overlaps count twice as solid, as does what sticks out
    double empty;    // share of `box` far from every grain; 0 where there is a body
    double far;      // how far that is from a surface, m
    int outside, first_outside; // grains wholly beyond a wall of the box
    int centres_outside, first_centre_outside;
    int cut, deepest;        // grains that stick out of the box, and the furthest one
    double depth;            // by so many of its radii
    int coincident, same[2]; // pairs with one centre, the first of them
    int halved;              // pairs that overlap still when all radii are halved
    int overlapping;         // grains with an overlap above OVERLAP_MOST
    double overlap;
    int worst[2];       // the largest, of the smaller radius
    int free;           // grains that touch neither grain nor wall
    double radius_unit; // what radii must be times to be in the unit of the places
    int plane;          // axis along which all centres lie in one plane; -1: none
    int round;    // axis of a cylinder at which grains end in a flat box; 3: sphere
    double reach; // from this axis, or the middle, to the outermost surface, m
};

// Share of the smaller radius: a larger overlap closes throats between grains.
static const double OVERLAP_MOST = 0.1;

// CONTACTS are the pairs within GAP, of the sum of the radii.
struct packing_facts packing_facts(const struct packing *packing,
                                   const struct contacts *contacts, double gap);

enum severity {
    FINDING_NOTE,      // worth knowing
    FINDING_WRONG,     // hardly what was meant
    FINDING_IMPOSSIBLE // no packing of grains is like this
};

// One line that says what was found, with numbers, and what to do. NAME is fixed, for
// programs that read it; the text is cut at its size.
struct finding {
    enum severity severity;
    const char *name; // "overlaps"
    char text[500];
};

enum { MOST_FINDINGS = 24 };

struct findings {
    int count;
    struct finding item[MOST_FINDINGS];
};

// Adds a finding behind those that are as severe or more; nothing once there are
// MOST_FINDINGS.
void add_finding(struct findings *findings, enum severity severity, const char *name,
                 const char *format, ...) __attribute__((format(printf, 4, 5)));

// How many more digits places need than lengths of the body, which may lie far from the
// origin.
int digits_of_origin(const struct packing_facts *facts);

// Adds to FINDINGS, which may have some, what these facts say, the worst first. Text
// names keys of pack and check, for the user to change.
void judge_packing(const struct packing *packing, const struct packing_facts *facts,
                   struct findings *findings);
