/* SPDX-License-Identifier: BSD-3-Clause */
/* mps_manual mps.1|mps-case.5|completion FILE: write a manual page for scdoc, or the words of the
 * completion. */
#include "manual.h"
#include <string.h>

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*write)(FILE *out);
    } texts[] = {{"mps.1", manual_write_program},
                 {"mps-case.5", manual_write_case},
                 {"completion", manual_write_words}};
    for (size_t i = 0; argc == 3 && i < sizeof texts / sizeof *texts; i++) {
        if (strcmp(argv[1], texts[i].name) != 0) continue;
        FILE *out = fopen(argv[2], "w");
        if (!out) break;
        texts[i].write(out);
        const int bad = ferror(out);
        return fclose(out) != 0 || bad;
    }
    fprintf(stderr, "usage: mps_manual mps.1|mps-case.5|completion FILE\n");
    return 2;
}
