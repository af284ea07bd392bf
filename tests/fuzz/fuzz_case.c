/* SPDX-License-Identifier: BSD-3-Clause */
/* Case files: any bytes as a file; after a byte 0xff also texts "path=value" for a valid case, one
 * per line. No other file is read: the folder does not exist. */
#include "fuzz.h"
#include <mps/case.h>

enum { TEXT = 1 << 16, SETS = 16 };

static const char good[] =
    "mps: 1\ndp: 4 mm\ntank: {size: 0.8 0.5 m}\nfill: [{water: {depth: 25 %}}, {air: rest}]\n"
    "model: mmps\nmotion: {roll: {amplitude: 4 deg, period: 1 s}}\n"
    "sensors: {P: {wall: 0 50 mm}, F: {force: tank}}\nrun: {until: 5 s}\n";

/* Each message has a text, and a position or is about a whole file. */
static void check_messages(const mps_case *c)
{
    static char text[TEXT];
    mps_case_message m = {.struct_size = sizeof m};
    int32_t count = 0;
    while (mps_case_message_get(c, count, &m) == MPS_OK) {
        FUZZ_MUST(m.text && m.text[0] && m.file && m.line >= 0 && m.column >= 0);
        count++;
    }
    FUZZ_MUST(count == mps_case_message_count(c) && count <= MPS_CASE_MESSAGES);
    const size_t length = mps_case_messages_write(c, text, sizeof text);
    FUZZ_MUST((length > 0) == (count > 0));
    FUZZ_MUST(strlen(text) == (length < sizeof text ? length : sizeof text - 1));
}

static void check_sweep(const mps_case *c)
{
    char text[512];
    const int64_t runs = mps_case_runs(c);
    FUZZ_MUST(runs > 0);
    for (int32_t k = 0; k < mps_case_sweep_count(c); k++) {
        FUZZ_MUST(mps_case_sweep_get(c, 0, k, text, sizeof text) == MPS_OK);
        FUZZ_MUST(mps_case_sweep_get(c, runs - 1, k, text, sizeof text) == MPS_OK);
    }
}

/* The text of a case gives the same case. */
static void check_text(const mps_case *c)
{
    mps_case *again = NULL;
    const char *text = mps_case_text(c);
    FUZZ_MUST(mps_case_read_text(text, strlen(text), "again", 0, NULL, &again) == MPS_OK);
    FUZZ_MUST(strcmp(mps_case_text(again), text) == 0);
    mps_case_destroy(again);
}

static void read_case(const char *text, size_t size, int32_t count, const char *const *sets)
{
    mps_case *c = NULL;
    const mps_status status = mps_case_read_text(text, size, "/nowhere/case.yaml", count, sets, &c);
    FUZZ_MUST(c && (status == MPS_OK || status == MPS_E_ARG || status == MPS_E_IO));
    FUZZ_MUST((status == MPS_OK) == (mps_case_text(c) != NULL));
    FUZZ_MUST(status == MPS_OK || mps_case_message_count(c) > 0);
    check_messages(c);
    if (status == MPS_OK) {
        check_sweep(c);
        check_text(c);
    }
    mps_case_destroy(c);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0 || data[0] != 0xff) {
        read_case((const char *)data, size, 0, NULL);
        return 0;
    }
    char *text = malloc(size);
    const char *sets[SETS];
    int32_t count = 0;
    if (!text) return 0;
    memcpy(text, data + 1, size - 1);
    text[size - 1] = '\0';
    for (char *line = strtok(text, "\n"); line && count < SETS; line = strtok(NULL, "\n"))
        sets[count++] = line;
    read_case(good, sizeof good - 1, count, sets);
    free(text);
    return 0;
}
