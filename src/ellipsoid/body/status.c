/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    status.c - the texts of the status codes, and of the version.
*/
#include "ellipsoid.h"

const char *ellipsoid_version(void) { return ELLIPSOID_VERSION; }

const char *ellipsoid_status_text(ellipsoid_status status)
{
#define ELLIPSOID_STATUS_TEXT(name, text)                                      \
    case ELLIPSOID_##name:                                                     \
        return text;

    switch (status)
    {
        ELLIPSOID_STATUS_LIST(ELLIPSOID_STATUS_TEXT)
    case ELLIPSOID_STATUS_COUNT:
        break;
    }
#undef ELLIPSOID_STATUS_TEXT
    return "unknown status";
}

const char *ellipsoid_status_name(ellipsoid_status status)
{
#define ELLIPSOID_STATUS_NAME(name, text)                                      \
    case ELLIPSOID_##name:                                                     \
        return #name;

    switch (status)
    {
        ELLIPSOID_STATUS_LIST(ELLIPSOID_STATUS_NAME)
    case ELLIPSOID_STATUS_COUNT:
        break;
    }
#undef ELLIPSOID_STATUS_NAME
    return "UNKNOWN";
}
