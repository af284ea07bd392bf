/* SPDX-License-Identifier: BSD-3-Clause */
/* Values of the summary.json of a run, which has one line per value. */
#ifndef MPS_APPS_SUMMARY_H
#define MPS_APPS_SUMMARY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SUMMARY_TEXT = 240 };

/* A text. @return false: the folder has no summary.json, or the text is missing */
bool summary_text(const char *folder, const char *key, char out[SUMMARY_TEXT]);
/* A number; nan if missing. */
double summary_number(const char *folder, const char *key);
/* Input number `index` of the case. @return false: there is none */
bool summary_input(const char *folder, int32_t index, char key[SUMMARY_TEXT],
                   char value[SUMMARY_TEXT]);
/* The first natural period, an input of the summary [s]; nan: it is not known. */
double summary_T1(const char *folder);
/* Whether the run reached its end. */
bool summary_is_done(const char *folder);
/* One line about an unfinished run, and the command that continues it.
 * @param t  of its last row [s], nan: as in the summary
 * @return false: it reached its end, or the folder is not that of a run, and `out` is "" */
bool summary_unfinished(const char *folder, double t, char *out, size_t size);

#endif
