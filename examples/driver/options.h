/* SPDX-License-Identifier: BSD-3-Clause */
/* Parser of a command line by a table of options: checks names and ranges of all values. */
#ifndef MPS_EXAMPLES_OPTIONS_H
#define MPS_EXAMPLES_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { OPTION_TEXTS = 32, OPTION_NUMBERS = 24, OPTION_MESSAGE = 512 };

/* Type of an option. TYPE_CHOICE: one of the words of `argument`, "one|two", as an int32_t from
 * 0. */
typedef enum option_type {
    TYPE_TEXT, /* const char * */
    TYPE_REAL, /* double */
    TYPE_INT,  /* int32_t */
    TYPE_FLAG, /* bool */
    TYPE_CHOICE,
    TYPE_LIST,  /* option_list; may be repeated */
    TYPE_TIMES, /* option_times; ascending, "2.2,2.3" */
    TYPE_ASK    /* ends the parsing: --help and the like */
} option_type;

/* One option. Range of reals: min <= value <= max; min = 0: 0 < value; min < 0: 0 <= value. */
typedef struct option {
    const char *name, *argument, *help;
    option_type type;
    void *value;
    double min, max;
    bool flag;   /* value that a TYPE_FLAG sets */
    bool *given; /* NULL, or set to true if the option is present */
} option;

typedef struct option_list {
    int count;
    const char *text[OPTION_TEXTS];
} option_list;

typedef struct option_times {
    int count;
    double t[OPTION_NUMBERS];
} option_times;

/* Parse argv; both "--dp 0.01" and "--dp=0.01" are accepted.
 * @param message  [OPTION_MESSAGE] out: the error, one or two lines; "" without an error
 * @return NULL, or the requested option of TYPE_ASK */
const option *options_parse(const option *table, int count, int argc, char **argv, char *message);
/* Print a line for each option, with its default. */
void options_help(FILE *out, const option *table, int count);

#endif
