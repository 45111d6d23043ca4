/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    giveWay.c - preloaded to ranks in tests: Open MPI calls sched_yield() as
    long as nothing has come, by which a rank that waits keeps its core busy.
*/
#define _POSIX_C_SOURCE 200809L

#include <sched.h>
#include <time.h>

/* Rests for 0.05 ms, in which another test file may go on. */
int sched_yield(void)
{
    const struct timespec rest = {0, 50000};

    return nanosleep(&rest, 0);
}
