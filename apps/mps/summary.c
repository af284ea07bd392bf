/* SPDX-License-Identifier: BSD-3-Clause */
#include "summary.h"
#include "constants.h"
#include "json.h"
#include "run_file.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SIZE = 4096, SUMMARY_MOST = 64 << 20 };

/* @return NULL: there is none that can be read */
static json_value *read_summary(const char *folder)
{
    char path[PATH_SIZE];
    const char *why;
    size_t size;
    json_error error;
    snprintf(path, sizeof path, "%s/summary.json", folder);
    FILE *file = mps__run_open(NULL, path, &why);
    char *text = file ? mps__file_read(file, SUMMARY_MOST, &size) : NULL;
    json_value *all = text ? mps__json_read(text, &error) : NULL;
    free(text);
    if (file) fclose(file);
    return all;
}

bool summary_text(const char *folder, const char *key, char out[SUMMARY_TEXT])
{
    json_value *all = read_summary(folder);
    const char *text = mps__json_text(mps__json_get(all, key));
    const bool found = text != NULL;
    if (found) snprintf(out, SUMMARY_TEXT, "%s", text);
    mps__json_free(all);
    return found;
}

double summary_number(const char *folder, const char *key)
{
    json_value *all = read_summary(folder);
    const double value = mps__json_number(mps__json_get(all, key));
    mps__json_free(all);
    return value;
}

int32_t summary_inputs(const char *folder, summary_input **inputs)
{
    json_value *all = read_summary(folder);
    const json_value *list = mps__json_get(all, "inputs");
    const int32_t count = (int32_t)mps__json_count(list);
    summary_input *out = calloc((size_t)count + 1, sizeof *out);
    const json_value *v = count > 0 ? list->first : NULL;
    for (int32_t k = 0; out && k < count; k++, v = v->next) {
        snprintf(out[k].key, SUMMARY_TEXT, "%s", mps__json_member(v, "key"));
        snprintf(out[k].value, SUMMARY_TEXT, "%s", mps__json_member(v, "value"));
    }
    mps__json_free(all);
    *inputs = out;
    return out ? count : -1;
}

double summary_T1(const char *folder)
{
    summary_input *inputs;
    const int32_t count = summary_inputs(folder, &inputs);
    double value = NAN;
    for (int32_t k = 0; k < count; k++) {
        char *end;
        if (strcmp(inputs[k].key, "T1") != 0) continue;
        value = strtod(inputs[k].value, &end);
        if (end == inputs[k].value) value = NAN;
    }
    free(inputs);
    return value;
}

bool summary_is_done(const char *folder)
{
    char status[SUMMARY_TEXT];
    return summary_text(folder, "status", status) && strcmp(status, "ok") == 0;
}

bool summary_unfinished(const char *folder, double t, char *out, size_t size)
{
    char status[SUMMARY_TEXT];
    const double reached = summary_number(folder, "t_end"), until = summary_number(folder, "until");
    out[0] = '\0';
    if (!summary_text(folder, "status", status) || strcmp(status, "ok") == 0) return false;
    const bool part = strcmp(status, "unfinished") == 0 || strcmp(status, "MPS_W_STOPPED") == 0;
    int used = snprintf(out, size, "%s, at t = %.5g s", part ? "unfinished" : status,
                        isnan(t) ? reached : t);
    if (!isnan(until)) used += snprintf(out + used, size - (size_t)used, " of %.5g s", until);
    if (part)
        snprintf(out + used, size - (size_t)used,
                 "; if it is not in progress, 'mps resume %s' continues it", folder);
    return true;
}
