/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    driver.c - calls the fuzz target without libFuzzer.

    Usage: fuzz SECONDS SEED          random inputs for so long; one that fails
                                      is written to crash-SEED-NUMBER
           fuzz FILE                  one input
           fuzz FOLDER COUNT SEED     writes random inputs, to begin with
*/
#include "coreTest.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum
{
    LONGEST = 1024,
    KEPT = 64
};

/* For the signal's handler, which can be given nothing. */
static uint8_t input[LONGEST];
static size_t size;
static char crash_file[64];

static void keep_input(int number)
{
    const int file = open(crash_file, O_WRONLY | O_CREAT | O_TRUNC, 0666);

    if (file >= 0 && write(file, input, size) == (ssize_t)size)
    {
        const char text[] = "the input is kept in ";

        if (write(2, text, sizeof text - 1) > 0
            && write(2, crash_file, strlen(crash_file)) > 0)
        {
            (void)!write(2, "\n", 1);
        }
    }
    signal(number, SIG_DFL);
    raise(number);
}

static size_t below(uint64_t *seed, size_t count)
{
    return (size_t)(test_uniform(seed) * (double)count);
}

/* Random bytes, or some of an earlier input's changed. */
static void next_input(uint64_t *seed)
{
    static uint8_t kept[KEPT][LONGEST];
    static size_t sizes[KEPT];
    const size_t place = below(seed, KEPT);

    if (sizes[place] == 0 || below(seed, 2))
    {
        size = 1 + below(seed, LONGEST - 1);
        for (size_t n = 0; n < size; n++)
        {
            input[n] = (uint8_t)below(seed, 256);
        }
        memcpy(kept[place], input, size);
        sizes[place] = size;
        return;
    }
    size = sizes[place];
    memcpy(input, kept[place], size);
    for (size_t n = 1 + below(seed, 8); n > 0; n--)
    {
        input[below(seed, size)] = (uint8_t)below(seed, 256);
    }
}

static double now(void)
{
    struct timespec time;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static int run_file(const char *name)
{
    FILE *file = fopen(name, "rb");

    if (!file)
    {
        perror(name);
        return 1;
    }
    size = fread(input, 1, sizeof input, file);
    fclose(file);
    return LLVMFuzzerTestOneInput(input, size);
}

static int write_files(const char *folder, int count, uint64_t seed)
{
    for (int n = 0; n < count; n++)
    {
        char name[4096];
        FILE *file;

        snprintf(name, sizeof name, "%s/%d", folder, n);
        file = fopen(name, "wb");
        next_input(&seed);
        if (!file || fwrite(input, 1, size, file) != size || fclose(file) != 0)
        {
            perror(name);
            return 1;
        }
    }
    return 0;
}

static int run_for(double seconds, const char *seed_text)
{
    const double begun = now();
    uint64_t seed = strtoull(seed_text, NULL, 10);
    double last = begun, slowest = 0;
    long count = 0;

    signal(SIGABRT, keep_input);
    signal(SIGALRM, keep_input);
    while (last - begun < seconds)
    {
        snprintf(crash_file, sizeof crash_file, "crash-%s-%ld", seed_text,
                 count);
        next_input(&seed);
        alarm(600); /* an endless loop is a finding, too */
        LLVMFuzzerTestOneInput(input, size);
        count++;

        const double end = now();

        slowest = fmax(slowest, end - last);
        last = end;
    }
    alarm(0);
    printf("%ld inputs in %.1f s, the slowest in %.1f ms\n", count,
           last - begun, 1e3 * slowest);
    return 0;
}

int main(int argc, char **argv)
{
    switch (argc)
    {
    case 2:
        return run_file(argv[1]);
    case 3:
        return run_for(atof(argv[1]), argv[2]);
    case 4:
        return write_files(argv[1], atoi(argv[2]), strtoull(argv[3], NULL, 10));
    default:
        fprintf(stderr, "usage: %s SECONDS SEED | FILE | FOLDER COUNT SEED\n",
                argv[0]);
        return 2;
    }
}
