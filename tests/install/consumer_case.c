/* SPDX-License-Identifier: BSD-3-Clause */
/* A program that reads a case file with the installed library. */
#include <mps/case.h>
#include <stdio.h>
#include <string.h>

int main(void)
{
    static const char text[] =
        "mps: 1\ndp: 4 mm\ntank: {size: 0.8 0.5 m}\nfill: [{water: {depth: 25 %}}]\n"
        "run: {until: 5 s}\n";
    static const char *const set[] = {"run.until=60"};
    char messages[400];
    mps_case *c = NULL;
    if (mps_case_read_text(text, strlen(text), "a.yaml", 0, NULL, &c) != MPS_OK) return 1;
    puts(mps_case_text(c));
    mps_case_destroy(c);
    if (mps_case_read_text(text, strlen(text), "a.yaml", 1, set, &c) != MPS_E_ARG) return 2;
    mps_case_messages_write(c, messages, sizeof messages);
    fputs(messages, stdout);
    mps_case_destroy(c);
    return strstr(messages, "has no unit") == NULL;
}
