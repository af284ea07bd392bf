/* SPDX-License-Identifier: BSD-3-Clause */
/* A command line by a table of options: every value is checked by name and range. */
#ifndef MPS_EXAMPLES_OPTIONS_H
#define MPS_EXAMPLES_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { OPTION_TEXTS = 32, OPTION_NUMBERS = 24, OPTION_MESSAGE = 512 };

/* How the text of an option is read. TYPE_CHOICE: one of the words of `argument`, "one|two", into an int32_t from 0. */
typedef enum option_type {
    TYPE_TEXT, /* const char * */
    TYPE_REAL, /* double */
    TYPE_INT,  /* int32_t */
    TYPE_FLAG, /* bool */
    TYPE_CHOICE,
    TYPE_LIST,  /* option_list; may be given several times */
    TYPE_TIMES, /* option_times; ascending, "2.2,2.3" */
    TYPE_ASK    /* ends the parsing: --help and the like */
} option_type;

/* One option. Reals are checked against min <= value <= max, with min = 0 against 0 < value; min < 0 stands for 0 <= value. */
typedef struct option {
    const char *name, *argument, *help;
    option_type type;
    void *value;
    double min, max;
    bool flag;   /* what a TYPE_FLAG sets */
    bool *given; /* NULL, or set to true if the option is there */
} option;

typedef struct option_list {
    int count;
    const char *text[OPTION_TEXTS];
} option_list;

typedef struct option_times {
    int count;
    double t[OPTION_NUMBERS];
} option_times;

/* Parse argv; both "--dp 0.01" and "--dp=0.01" are understood.
 * @param message  [OPTION_MESSAGE] out: what is wrong, one or two lines; "" if nothing is
 * @return NULL, or the option of TYPE_ASK that was asked for */
const option *options_parse(const option *table, int count, int argc, char **argv, char *message);
/* A line for each option, with its default. */
void options_help(FILE *out, const option *table, int count);

#endif
