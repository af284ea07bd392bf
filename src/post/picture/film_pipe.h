/* SPDX-License-Identifier: BSD-3-Clause */
/* A child process that reads from this one. */
#ifndef MPS_POST_FILM_PIPE_H
#define MPS_POST_FILM_PIPE_H

#include "page_read.h"
#include <sys/types.h>

typedef struct film_pipe {
    const char *program;
    pid_t child;
    int end;     /* the child reads what is written here */
    FILE *words; /* its stderr */
} film_pipe;

/* Start argv[0], searched in PATH. @return MPS_E_IO: there is no such program */
mps_status mps__pipe_start(film_pipe *p, const char *const *argv, page_errors *e);
/* @return false: the child reads no more; mps__pipe_end() has the reason */
bool mps__pipe_write(film_pipe *p, const void *data, size_t size);
/* Close the pipe and wait until the child ends. @return MPS_E_IO with the end of its stderr */
mps_status mps__pipe_end(film_pipe *p, page_errors *e);

#endif
