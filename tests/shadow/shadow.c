/* SPDX-License-Identifier: BSD-3-Clause */
#include "shadow.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void *room(void *self, size_t bytes)
{
    shadow *s = self;
    s->rooms++;
    return malloc(bytes);
}

static void give(void *self, void *bytes)
{
    shadow *s = self;
    s->rooms--;
    free(bytes);
}

static void upload(void *self, void *to, const void *from, size_t bytes)
{
    shadow *s = self;
    s->uploads++;
    memcpy(to, from, bytes);
}

static void download(void *self, void *to, const void *from, size_t bytes)
{
    shadow *s = self;
    s->downloads++;
    memcpy(to, from, bytes);
}

/* Integers get a number that is no region, no condition and no row. */
static void outdated(void *self, void *array, size_t bytes, size_t number)
{
    const int32_t poison = INT32_MIN + 1;
    const double nan = NAN;
    shadow *s = self;
    s->outdated++;
    for (size_t at = 0; at < bytes; at += number)
        memcpy((char *)array + at, number == sizeof poison ? (const void *)&poison : &nan, number);
}

void shadow_attach(shadow *s, mps_sim *sim)
{
    *s = (shadow){.engine = {.room = room,
                             .give = give,
                             .upload = upload,
                             .download = download,
                             .outdated = outdated,
                             .self = s}};
    mps__twins_attach(&sim->world.host.twins, &s->engine);
}
