/* SPDX-License-Identifier: BSD-3-Clause */
/* Common code of the tests of case files. */
#ifndef MPS_TEST_CASE_KIT_H
#define MPS_TEST_CASE_KIT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "tree.h"

#define CASES PROJECT_FOLDER "/tests/case/cases/"

/* A name in the current folder as an absolute path: names in a case are relative to its file. */
static inline char *kit_here(char *out, size_t size, const char *name)
{
    char folder[512];
    assert_non_null(getcwd(folder, sizeof folder));
    assert_true((size_t)snprintf(out, size, "%s/%s", folder, name) < size);
    return out;
}

/* Read a text with at most three sets, NULL behind the last. */
static inline mps_status kit_read(const char *text, const char *const *sets, mps_case **c)
{
    int32_t count = 0;
    while (sets && sets[count]) count++;
    return mps_case_read_text(text, strlen(text), CASES "test.yaml", count, sets, c);
}

/* All messages; the caller frees them. */
static inline char *kit_messages(const mps_case *c)
{
    const size_t size = mps_case_messages_write(c, NULL, 0) + 1;
    char *text = malloc(size);
    assert_non_null(text);
    assert_int_equal(mps_case_messages_write(c, text, size), size - 1);
    return text;
}

/* Whether a message at this line and column contains all words of `words`, "a|b"; line 0: any
 * position. */
static inline bool kit_has(const mps_case *c, int32_t line, int32_t column, const char *words)
{
    for (int32_t i = 0; i < mps_case_message_count(c); i++) {
        mps_case_message m = {.struct_size = sizeof m};
        const char *word;
        size_t length;
        bool all = true;
        assert_int_equal(mps_case_message_get(c, i, &m), MPS_OK);
        if (line > 0 && (m.line != line || m.column != column)) continue;
        for (int32_t k = 0; (length = mps__words_get(words, k, &word)) > 0; k++) {
            char one[200];
            snprintf(one, sizeof one, "%.*s", (int)length, word);
            all = all && strstr(m.text, one);
        }
        if (all) return true;
    }
    return false;
}

/* The text must be refused at this position with these words. */
static inline void kit_refused(const char *text, int32_t line, int32_t column, const char *words)
{
    mps_case *c = NULL;
    const mps_status status = kit_read(text, NULL, &c);
    assert_non_null(c);
    if (status != MPS_E_ARG || mps_case_text(c) || !kit_has(c, line, column, words)) {
        char *all = kit_messages(c);
        const char *at = text;
        for (int32_t k = 1; at && k < line; k++) at = strchr(at, '\n') + 1;
        print_message("wanted at %d:%d: %s\nline: %.*s\nmessages:\n%s", (int)line, (int)column,
                      words, (int)strcspn(at, "\n"), at, all);
        free(all);
        fail();
    }
    mps_case_destroy(c);
}

static inline char *kit_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    char *text = calloc(1, 1 << 18);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 18) - 1, file) > 0);
    fclose(file);
    return text;
}

#endif
