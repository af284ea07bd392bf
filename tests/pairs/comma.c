/* SPDX-License-Identifier: BSD-3-Clause */
/* Preloaded into the program mps, which calls no setlocale(): before main() it makes the program one
 * whose locale has a decimal comma, as a host of the library may be. */
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

__attribute__((constructor)) static void set_comma(void)
{
    char number[16];
    setlocale(LC_ALL, "de_DE.UTF-8"); /* of LOCPATH */
    snprintf(number, sizeof number, "%.1f", 0.5);
    if (strcmp(number, "0,5") == 0) return;
    fprintf(stderr, "comma: the locale has no decimal comma: %s\n", number);
    _Exit(70);
}
