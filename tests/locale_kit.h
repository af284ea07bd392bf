/* SPDX-License-Identifier: BSD-3-Clause */
/* An application whose locale has a decimal comma. The build makes the locales, so that tests
 * do not depend on those of the machine. */
#ifndef MPS_TEST_LOCALE_KIT_H
#define MPS_TEST_LOCALE_KIT_H

#include <locale.h>
#include <stdlib.h>
#include <string.h>

/* "de_DE.UTF-8" has decimal commas; in "tr_TR.UTF-8" i is not the small letter of I. Skips the
 * test where the build has no localedef. */
static inline void locale_begin(const char *name)
{
    if (!MPS_LOCALES[0]) skip();
    assert_int_equal(setenv("LOCPATH", MPS_LOCALES, 1), 0);
    if (!setlocale(LC_ALL, name)) fail_msg("no locale %s in %s", name, MPS_LOCALES);
    assert_string_equal(localeconv()->decimal_point, ",");
}

static inline void locale_end(void)
{
    assert_non_null(setlocale(LC_ALL, "C"));
    assert_int_equal(unsetenv("LOCPATH"), 0);
}

#endif
