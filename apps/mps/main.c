/* SPDX-License-Identifier: BSD-3-Clause */
/* mps: simulates tanks, liquids and motions from case files. */
#include "cli.h"
#include "words.h"
#include <fcntl.h>
#include <mps/mps.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print_all(FILE *out)
{
    fprintf(out, "usage: mps VERB ...\n\n");
    for (int i = 0; i < cli_verb_count; i++)
        fprintf(out, "  %-8s %s\n", cli_verbs[i].name, cli_verbs[i].help);
    fprintf(out, "\n'mps VERB --help' explains a verb. 'mps --version' prints the version.\n");
}

/* If the parent process closed the standard streams, the first opened files would have their
 * numbers, and messages would be written into them. */
static void fill_streams(void)
{
    for (int fd = 0; fd <= 2; fd++)
        if (fcntl(fd, F_GETFD) == -1 && open("/dev/null", fd == 0 ? O_RDONLY : O_WRONLY) != fd)
            exit(MPS_EXIT_USAGE);
}

static const verb *find_verb(const char *name)
{
    for (int i = 0; i < cli_verb_count; i++)
        if (strcmp(cli_verbs[i].name, name) == 0) return &cli_verbs[i];
    return NULL;
}

/* Propose a verb that differs by one or two letters; otherwise list all. */
static void refuse_verb(const char *name)
{
    const char *best = NULL;
    size_t least = strlen(name) > 3 ? 3 : 2;
    for (int i = 0; i < cli_verb_count; i++) {
        const size_t letters = mps__word_distance(name, cli_verbs[i].name);
        if (letters >= least) continue;
        least = letters;
        best = cli_verbs[i].name;
    }
    fprintf(stderr, "mps: '%s' is no verb%s%s%s\n", name, best ? "; the nearest is '" : "",
            best ? best : "", best ? "'" : "");
    if (best)
        fprintf(stderr, "'mps --help' lists all verbs\n");
    else
        print_all(stderr);
}

int main(int argc, char **argv)
{
    static choices c;
    fill_streams();
    signal(SIGPIPE, SIG_IGN); /* a closed reader of stderr does not end the run */
    c.verb = argc < 2 ? "" : argv[1];
    if (argc < 2 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "help") == 0) {
        print_all(argc < 2 ? stderr : stdout);
        return cli_flush(&c, argc < 2 ? MPS_EXIT_USAGE : MPS_EXIT_OK);
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("mps, libmps %s\n", mps_version(NULL, NULL, NULL));
        return cli_flush(&c, MPS_EXIT_OK);
    }
    const verb *v = find_verb(argv[1]);
    if (!v) {
        refuse_verb(argv[1]);
        return MPS_EXIT_USAGE;
    }
    c.program = argv[0];
    c.verb = v->name;
    int code = cli_begin(&c, argc, argv);
    if (code >= 0) return cli_flush(&c, code);
    code = cli_agree(&c, cli_read(&c, v, argc, argv));
    if (code < 0 && (v->options & HAS_THREADS)) code = cli_check_alone(&c);
    /* for all verbs: unwritten output is a failure */
    return cli_flush(&c, code >= 0 ? code : v->run(&c));
}
