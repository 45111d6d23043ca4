/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    options.c - what options.def says as defaults, list and check; relations
    between options; options of a cell of another size.
*/
#include "body/planeTable.h"
#include "body/vectors.h"

#include <float.h>
#include <math.h>

/* ------------------------------------------------------------ defaults */

#define BRACES(...)                                                            \
    {                                                                          \
        __VA_ARGS__                                                            \
    }

ellipsoid_options ellipsoid_options_default(void)
{
    const ellipsoid_options options = {
#define ELLIPSOID_REAL(member, section, entry, deflt, ...) .member = deflt,
#define ELLIPSOID_VECTOR(member, section, entry, deflt, ...)                   \
    .member = BRACES deflt,
#define ELLIPSOID_WHOLE(member, section, entry, deflt, ...) .member = deflt,
#define ELLIPSOID_SWITCH(member, section, entry, deflt, ...) .member = deflt,
#define ELLIPSOID_CHOICE(member, section, entry, deflt, ...) .member = deflt,
#include "options.def"
    };

    return options;
}

/* ---------------------------------------------------------------- list */

/* INDEX_friction, ...: positions in the list */
enum
{
#define ELLIPSOID_REAL(member, ...) INDEX_##member,
#define ELLIPSOID_VECTOR(member, ...) INDEX_##member,
#define ELLIPSOID_WHOLE(member, ...) INDEX_##member,
#define ELLIPSOID_SWITCH(member, ...) INDEX_##member,
#define ELLIPSOID_CHOICE(member, ...) INDEX_##member,
#include "options.def"
    OPTION_COUNT
};

/* words_motion[], ...: the words of the enumerators; allowed_motion[]: all of
   them, each after a comma and a blank */
#define ELLIPSOID_WORDS(member, words)                                         \
    static const char *const words_##member[] = {words NULL};
#define ELLIPSOID_WORD(enumerator, word, meaning) word,
#include "options.def"
#define ELLIPSOID_WORDS(member, words)                                         \
    static const char allowed_##member[] = words;
#define ELLIPSOID_WORD(enumerator, word, meaning) ", " word
#include "options.def"

#define ALWAYS -1
#define WITH(other) INDEX_##other

#define WITHIN(from, to, si)                                                   \
    .low = from, .high = to, .unit = si, .range = TEXT(#from " to " #to, si)
#define ABOVE(from, si)                                                        \
    .low = from, .high = DBL_MAX, .above = 1, .unit = si,                      \
    .range = TEXT("above " #from, si)
#define FROM(from, si)                                                         \
    .low = from, .high = DBL_MAX, .unit = si,                                  \
    .range = TEXT(#from " or more", si)
#define RELATED(from, to, si, text)                                            \
    .low = from, .high = to, .related = 1, .unit = si, .range = text
#define TEXT(text, si) sizeof si > 1 ? text " " si : text

#define OPTION(kind, name, in, keyword, deflt, about)                          \
    .type = ELLIPSOID_OPTION_##kind,                                           \
    .offset = offsetof(ellipsoid_options, name), .member = #name,              \
    .section = in, .entry = keyword, .default_text = deflt, .meaning = about

_Static_assert(ELLIPSOID_MAX_BEADS == 256, "the range of bead_count says 256");

static const ellipsoid_option list[OPTION_COUNT] = {
#define ELLIPSOID_REAL(name, in, keyword, deflt, limits, with, about)          \
    {OPTION(REAL, name, in, keyword, #deflt, about), .needs = with, limits},
#define ELLIPSOID_VECTOR(name, in, keyword, deflt, limits, with, about)        \
    {OPTION(VECTOR, name, in, keyword, #deflt, about), .needs = with, limits},
#define ELLIPSOID_WHOLE(name, in, keyword, deflt, limits, with, about)         \
    {OPTION(WHOLE, name, in, keyword, #deflt, about), .needs = with, limits},
#define ELLIPSOID_SWITCH(name, in, keyword, deflt, about)                      \
    {OPTION(SWITCH, name, in, keyword, #deflt, about), .needs = ALWAYS,        \
     WITHIN(0, 1, "")},
#define ELLIPSOID_CHOICE(name, in, keyword, deflt, about)                      \
    {OPTION(CHOICE, name, in, keyword, #deflt, about),                         \
     .needs = ALWAYS,                                                          \
     .words = words_##name,                                                    \
     .unit = "",                                                               \
     .range = &allowed_##name[2],                                              \
     .high = sizeof words_##name / sizeof *words_##name - 2},
#include "options.def"
};

const ellipsoid_option *ellipsoid_option_list(int *count)
{
    *count = OPTION_COUNT;
    return list;
}

/* --------------------------------------------------------------- check */

/* Where a member was found at fault, if any yet. */
typedef struct verdict
{
    const char *field, *range;
} verdict;

/* NaN fails every comparison, hence the form: require what must be true. */
static void require(verdict *v, int holds, int index, const char *range)
{
    if (!holds && !v->field)
    {
        v->field = list[index].member;
        v->range = range ? range : list[index].range;
    }
}

/* A component of a member, as a number */
static double number(const ellipsoid_options *o, int index, int component)
{
    const char *member = (const char *)o + list[index].offset;

    switch (list[index].type)
    {
    case ELLIPSOID_OPTION_REAL:
    case ELLIPSOID_OPTION_VECTOR:
        return ((const double *)(const void *)member)[component];
    default:
        return *(const int *)(const void *)member;
    }
}

/* Does what the option belongs to act at all? */
static int matters(const ellipsoid_options *o, int index)
{
    while ((index = list[index].needs) != ALWAYS)
    {
        if (number(o, index, 0) == 0)
        {
            return 0;
        }
    }
    return 1;
}

/* The ranges of the list; they keep every derived quantity a normal, finite
   number. */
static void check_ranges(verdict *v, const ellipsoid_options *o)
{
    for (int index = 0; index < OPTION_COUNT; index++)
    {
        const ellipsoid_option *option = &list[index];
        const int count = option->type == ELLIPSOID_OPTION_VECTOR ? 3 : 1;

        for (int i = 0; matters(o, index) && i < count; i++)
        {
            const double value = number(o, index, i);

            require(v,
                    value >= option->low && value <= option->high
                        && !(option->above && value == option->low),
                    index, NULL);
        }
    }
}

double ellipsoid_wall_range(const ellipsoid_options *options)
{
    const double *a = options->semi_axes;

    return !options->drag
                || options->wall_resistance == ELLIPSOID_WALL_RESISTANCE_NONE
             ? 0
         : options->wall_range > 0
             ? options->wall_range
             : ellipsoid_largest(a) + 4 * ellipsoid_smallest(a);
}

/* What needs drag. */
static void check_drag(verdict *v, const ellipsoid_options *o)
{
    require(v, o->drag || o->motion != ELLIPSOID_MOTION_INERTIALESS, INDEX_drag,
            "yes with motion inertialess");
    require(v, o->drag || !o->brownian, INDEX_brownian, "no without drag");
}

/* What holds between several options. */
static void check_relations(verdict *v, const ellipsoid_options *o)
{
    const double *a = o->semi_axes;
    const double smallest = ellipsoid_smallest(a);
    const double largest = ellipsoid_largest(a);

    check_drag(v, o);
    require(v,
            !matters(o, INDEX_wall_range) || o->wall_range == 0
                || o->wall_range >= largest,
            INDEX_wall_range, NULL);
    require(v,
            !matters(o, INDEX_bead_radius)
                || (o->bead_radius > 0
                    && (o->bead_radius < smallest
                        || (o->bead_count == 1 && o->bead_radius == smallest))),
            INDEX_bead_radius, NULL);
    require(v,
            !matters(o, INDEX_adhesion_range)
                || (o->adhesion_range >= 1e-6 * o->bead_radius
                    && o->adhesion_range <= o->bead_radius),
            INDEX_adhesion_range, NULL);
    if (!v->field && matters(o, INDEX_bead_count))
    {
        double bead[ELLIPSOID_MAX_BEADS][3];

        require(v, ellipsoid_beads(o, bead) > 0, INDEX_bead_count, NULL);
    }
    if (!v->field && ellipsoid_wall_range(o) > 0)
    {
        require(v, ellipsoid_plane_table_has(o->semi_axes),
                INDEX_wall_resistance,
                "none for a body that is not between 1:6 and 20:1");
    }
}

ellipsoid_status ellipsoid_options_check(const ellipsoid_options *options,
                                         const char **field, const char **range)
{
    verdict v = {NULL, NULL};

    if (!options)
    {
        return ELLIPSOID_BAD_ARGUMENT;
    }
    check_ranges(&v, options);
    check_relations(&v, options);

    if (!v.field)
    {
        return ELLIPSOID_OK;
    }
    if (field)
    {
        *field = v.field;
    }
    if (range)
    {
        *range = v.range;
    }
    return ELLIPSOID_BAD_OPTION;
}

/* ------------------------------------------------------------- resized */

/* Half the line of the beads' centres, in their radii. */
static double line_in_radii(const ellipsoid_options *o)
{
    const double *a = o->semi_axes;
    const int inside = o->bead_layout == ELLIPSOID_BEADS_STAGGERED;

    return ellipsoid_largest(a) / o->bead_radius - inside;
}

ellipsoid_options ellipsoid_options_resized(const ellipsoid_options *options,
                                            double length, double width)
{
    ellipsoid_options other = *options;
    const double wider = width / (2 * options->semi_axes[0]);

    other.semi_axes[0] *= wider;
    other.semi_axes[1] = 0.5 * length;
    other.semi_axes[2] *= wider;
    other.bead_radius *= wider;

    if (other.contact && other.bead_layout != ELLIPSOID_BEADS_PAPER
        && other.bead_count > 1
        && ellipsoid_options_check(&other, NULL, NULL) == ELLIPSOID_OK)
    {
        const int rings = (options->bead_count - 2) / 3;
        const double needed =
            ceil((rings + 1) * line_in_radii(&other) / line_in_radii(options)
                 - 1e-9)
            - 1;

        /* Never fewer: round the body they are as far apart as they were */
        other.bead_count =
            2 + 3 * (int)fmax(rings, fmin(needed, ELLIPSOID_MAX_BEADS));
    }
    return other;
}
