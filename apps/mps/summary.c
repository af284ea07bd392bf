/* SPDX-License-Identifier: BSD-3-Clause */
#include "summary.h"
#include "escape.h"
#include "json.h"
#include "regular.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SIZE = 4096, LINE_SIZE = 4096 };

/* summary.json of a folder; NULL: it cannot be read. */
static FILE *open_summary(const char *folder)
{
    char path[PATH_SIZE];
    const char *why;
    snprintf(path, sizeof path, "%s/summary.json", folder);
    return mps__regular_summary(path, &why);
}

/* What is behind `wanted` in a line that begins with it and at most `most` blanks, until the end
 * of the line. */
static bool find_text(const char *folder, const char *wanted, int most, char out[LINE_SIZE])
{
    char line[LINE_SIZE];
    bool found = false;
    const size_t length = strlen(wanted);
    FILE *in = open_summary(folder);
    while (in && !found && fgets(line, sizeof line, in)) {
        const char *at = line + strspn(line, " ");
        found = at - line <= most && strncmp(at, wanted, length) == 0;
        if (found) snprintf(out, LINE_SIZE, "%s", at + length);
    }
    if (in) fclose(in);
    return found;
}

static bool find_line(const char *folder, const char *key, char out[LINE_SIZE])
{
    char wanted[64];
    snprintf(wanted, sizeof wanted, "\"%s\": ", key);
    return find_text(folder, wanted, 2, out);
}

double summary_T1(const char *folder)
{
    char line[LINE_SIZE], *end;
    if (!find_text(folder, "{\"key\": \"T1\", \"value\": \"", 4, line)) return NAN;
    const double value = strtod(line, &end);
    return end > line ? value : NAN;
}

/* The value of JSON that fills a line, or NULL. */
static json_value *value_of(char line[LINE_SIZE])
{
    json_error error;
    size_t length = strcspn(line, "\n");
    if (length > 0 && line[length - 1] == ',') length--;
    line[length] = '\0';
    return mps__json_read(line, &error);
}

bool summary_text(const char *folder, const char *key, char out[SUMMARY_TEXT])
{
    char line[LINE_SIZE];
    json_value *value = find_line(folder, key, line) ? value_of(line) : NULL;
    const char *text = mps__json_text(value);
    const bool found = text != NULL;
    if (found) snprintf(out, SUMMARY_TEXT, "%s", text);
    mps__json_free(value);
    return found;
}

bool summary_input(const char *folder, int32_t index, char key[SUMMARY_TEXT],
                   char value[SUMMARY_TEXT])
{
    static const char begin[] = "    {\"key\": \"";
    char line[LINE_SIZE];
    json_value *input = NULL;
    FILE *in = open_summary(folder);
    while (in && fgets(line, sizeof line, in)) {
        if (strncmp(line, begin, sizeof begin - 1) != 0 || index-- > 0) continue;
        input = value_of(line);
        break;
    }
    if (in) fclose(in);
    if (input) {
        snprintf(key, SUMMARY_TEXT, "%s", mps__json_member(input, "key"));
        snprintf(value, SUMMARY_TEXT, "%s", mps__json_member(input, "value"));
    }
    const bool found = input != NULL;
    mps__json_free(input);
    return found;
}

double summary_number(const char *folder, const char *key)
{
    char line[LINE_SIZE], *end;
    if (!find_line(folder, key, line)) return NAN;
    const double value = strtod(line, &end);
    return end > line ? value : NAN;
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
    if (part) {
        char place[PATH_SIZE];
        mps__shell_word(folder, place, sizeof place);
        snprintf(out + used, size - (size_t)used,
                 "; if it is not in progress, 'mps resume %s' continues it", place);
    }
    return true;
}
