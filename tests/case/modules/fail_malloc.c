/* SPDX-License-Identifier: BSD-3-Clause */
/* malloc(), calloc() and realloc() of a program that is started with this in LD_PRELOAD: call
 * number FAIL_AT fails, once. Calls of the program and of libmps are counted; other libraries
 * (SUNDIALS, fontconfig) crash on a failed call. The number of calls is written to the file
 * COUNT_CALLS, if set. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);

static atomic_long calls, fail_at;
static atomic_int ended;

static void at_exit(void)
{
    atomic_store(&ended, 1);
}

/* Not at exit, where the run-time of a coverage build takes memory. What is registered before
 * main() runs too late: so at some of the first calls. */
static int fails(const void *caller)
{
    Dl_info from;
    if (atomic_load(&ended) || !dladdr(caller, &from) || !from.dli_fname) return 0;
    const char *slash = strrchr(from.dli_fname, '/'), *name = slash ? slash + 1 : from.dli_fname;
    if (strcmp(name, "mps") != 0 && strncmp(name, "libmps", 6) != 0) return 0;
    const long call = atomic_fetch_add(&calls, 1) + 1;
    if (call < 64 && (call & (call - 1)) == 0) atexit(at_exit);
    if (call != atomic_load(&fail_at)) return 0;
    errno = ENOMEM;
    return 1;
}

void *malloc(size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_calloc(count, size);
}

void *realloc(void *block, size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_realloc(block, size);
}

__attribute__((constructor)) static void begin(void)
{
    const char *text = getenv("FAIL_AT");
    atomic_store(&fail_at, text ? strtol(text, NULL, 10) : 0);
    atomic_store(&calls, 0);
}

__attribute__((destructor)) static void end(void)
{
    const long made = atomic_load(&calls);
    const char *path = getenv("COUNT_CALLS");
    FILE *out = path ? fopen(path, "w") : NULL;
    if (out) {
        fprintf(out, "%ld\n", made);
        fclose(out);
    }
}
