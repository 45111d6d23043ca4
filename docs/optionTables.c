/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    optionTables.c - a filter: copies Markdown and writes the tables of options
    in it anew, between a line '<!-- options: SECTION... -->' and a line
    '<!-- end of options -->'. Without a SECTION: the top of the dictionary.
*/
#include "ellipsoid.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char begin[] = "<!-- options:", end[] = "<!-- end of options -->";

/* Units and powers as the other tables of the guide write them. */
static void print_unit(const char *unit)
{
    for (; *unit; unit++)
    {
        printf("%s", *unit == '2' ? "²" : *unit == '3' ? "³" : "");
        if (*unit != '2' && *unit != '3')
        {
            putchar(*unit);
        }
    }
}

static void print_default(const ellipsoid_option *o,
                          const ellipsoid_options *defaults)
{
    int value;

    memcpy(&value, (const char *)defaults + o->offset, sizeof value);
    switch (o->type)
    {
    case ELLIPSOID_OPTION_SWITCH:
        printf("`%s`", value ? "yes" : "no");
        break;
    case ELLIPSOID_OPTION_CHOICE:
        printf("`%s`", o->words[value]);
        break;
    case ELLIPSOID_OPTION_VECTOR:
        putchar('`');
        for (const char *c = o->default_text; *c; c++)
        {
            if (*c != ',')
            {
                putchar(*c);
            }
        }
        putchar('`');
        break;
    default:
        printf("%s", o->default_text);
    }
}

/* The unit has a column of its own. */
static void print_range(const ellipsoid_option *o)
{
    const size_t length = strlen(o->range), unit = strlen(o->unit);
    const int has_unit = unit > 0 && length > unit
                      && strcmp(o->range + length - unit, o->unit) == 0
                      && o->range[length - unit - 1] == ' ';

    if (o->type == ELLIPSOID_OPTION_SWITCH)
    {
        printf("`yes`, `no`");
        return;
    }
    if (o->type == ELLIPSOID_OPTION_CHOICE)
    {
        for (int n = 0; o->words[n]; n++)
        {
            printf("%s`%s`", n > 0 ? ", " : "", o->words[n]);
        }
        return;
    }
    printf("%.*s%s", (int)(has_unit ? length - unit - 1 : length), o->range,
           o->type == ELLIPSOID_OPTION_VECTOR ? " each" : "");
}

/* Splits what follows the colon in a line into names; returns how many. */
static int split_names(char *line, const char *names[], int most)
{
    int count = 0;
    char *name = strtok(line + strlen(begin), " ");

    for (; name && strcmp(name, "-->\n") != 0 && count < most; count++)
    {
        names[count] = name;
        name = strtok(NULL, " ");
    }
    return count;
}

static int is_among(const char *section, const char *const names[], int count)
{
    for (int n = 0; n < count; n++)
    {
        if (strcmp(section, names[n]) == 0)
        {
            return 1;
        }
    }
    return count == 0 && *section == '\0';
}

static void print_table(char *line)
{
    const ellipsoid_options defaults = ellipsoid_options_default();
    const char *names[8];
    const int sections = split_names(line, names, 8);
    int count = 0;
    const ellipsoid_option *o = ellipsoid_option_list(&count);

    printf("| Entry | Meaning | Unit | Default | Allowed |\n"
           "|---|---|---|---|---|\n");
    for (; count > 0; count--, o++)
    {
        if (is_among(o->section, names, sections))
        {
            printf("| `%s%s%s` | %s | ", sections > 1 ? o->section : "",
                   sections > 1 ? "/" : "", o->entry, o->meaning);
            print_unit(o->unit);
            printf("%s", *o->unit ? " | " : "| ");
            print_default(o, &defaults);
            printf(" | ");
            print_range(o);
            printf(" |\n");
        }
    }
}

int main(void)
{
    char line[4096];
    int inside = 0;

    while (fgets(line, sizeof line, stdin))
    {
        if (strncmp(line, end, strlen(end)) == 0)
        {
            inside = 0;
        }
        if (!inside)
        {
            fputs(line, stdout);
        }
        if (strncmp(line, begin, strlen(begin)) == 0)
        {
            print_table(line);
            inside = 1;
        }
    }
    return inside ? EXIT_FAILURE : EXIT_SUCCESS;
}
