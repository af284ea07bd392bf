/* SPDX-License-Identifier: BSD-3-Clause */
#include "page_text.h"
#include "escape.h"
#include <math.h>
#include <stdbool.h>
#include <string.h>

/* ---- escape ---- */

/* A character of a string of JSON within <script>. */
static size_t script_character(const char *text, char out[8])
{
    char shown[8];
    const size_t length = mps__shown_character(text, shown);
    out[0] = '\0';
    if (shown[0]) mps__json_character(shown, out);
    if (out[0] == '>' || out[0] == '&') snprintf(out, 8, "\\u%04x", (unsigned)out[0]);
    return length;
}

void mps__html(FILE *out, const char *text)
{
    mps__put_escaped(out, text, mps__xml_character);
}

void mps__json(FILE *out, const char *text)
{
    fputc('"', out);
    mps__put_escaped(out, text, script_character);
    fputc('"', out);
}

/* ---- numbers ---- */

/* Group digits by three, from five digits on. */
static void group(char *text, size_t size)
{
    const size_t sign = text[0] == '-', whole = sign + strspn(text + sign, "0123456789");
    size_t length = strlen(text);
    if (whole - sign < 5) return;
    for (size_t at = whole; at > sign + 3 && length + 2 < size; length++) {
        at -= 3;
        memmove(text + at + 1, text + at, length - at + 1);
        text[at] = ',';
    }
}

const char *mps__whole(char out[TEXT_NUMBER], int64_t value)
{
    snprintf(out, TEXT_NUMBER, "%lld", (long long)value);
    group(out, TEXT_NUMBER);
    return out;
}

/* With as many decimals as three digits need. */
static void three_digits(char *out, size_t size, double value)
{
    const double most = fabs(value);
    const int before = most > 0 ? (int)floor(log10(most * (1 + 1e-12))) + 1 : 1;
    int places = 3 - before;
    if (places < 0) places = 0;
    if (before > 3) {
        const double unit = pow(10, before - 3); /* 5,432 stays 5,430: no more than three digits */
        value = nearbyint(value / unit) * unit;
    }
    snprintf(out, size, "%.*f", places, value);
    if (strspn(out, "-0.") == strlen(out)) snprintf(out, size, "0");
    size_t length = strlen(out);
    while (strchr(out, '.') && strchr("0.", out[length - 1])) out[--length] = '\0';
}

const char *mps__rounded(char out[TEXT_NUMBER], double value)
{
    const double most = fabs(value);
    if (!isfinite(value))
        snprintf(out, TEXT_NUMBER, "-");
    else if (most > 0 && (most < 1e-4 || most >= 1e7))
        snprintf(out, TEXT_NUMBER, "%.1e", value);
    else
        three_digits(out, TEXT_NUMBER, value);
    group(out, TEXT_NUMBER);
    if (out[0] == '-' && out[1]) { /* a minus sign, not a hyphen */
        memmove(out + 3, out + 1, strlen(out));
        for (int k = 0; k < 3; k++) out[k] = "\xe2\x88\x92"[k];
    }
    return out;
}

/* Units that take a prefix, and their suffixes. */
static bool takes_prefix(const char *unit)
{
    static const char *const scaled[] = {"Pa", "N", "J", "W"};
    for (int k = 0; k < 4; k++) {
        const size_t n = strlen(scaled[k]);
        if (strncmp(unit, scaled[k], n) == 0 && strchr(" /", unit[n])) return true;
    }
    return false;
}

/* @return the prefix, "" for none */
static const char *choose_prefix(double *value, const char *unit)
{
    const double most = fabs(*value);
    const bool small = (strcmp(unit, "m") == 0 || strcmp(unit, "s") == 0) && most < 0.0999;
    double factor = 1;
    const char *prefix = "";
    if (most == 0 || most < 1e-6) return "";
    if (small || (takes_prefix(unit) && most < 0.0999)) {
        factor = 1e3;
        prefix = "m";
    } else if (takes_prefix(unit) && most >= 999.5) {
        factor = most >= 999.5e3 ? 1e-6 : 1e-3;
        prefix = most >= 999.5e3 ? "M" : "k";
    }
    *value *= factor;
    return prefix;
}

const char *mps__quantity(char out[TEXT_NUMBER], double value, const char *unit)
{
    char number[TEXT_NUMBER];
    const char *prefix = isfinite(value) ? choose_prefix(&value, unit) : "";
    mps__rounded(number, value);
    if (unit[0] && isfinite(value))
        snprintf(out, TEXT_NUMBER, "%.24s %s%.16s", number, prefix, unit);
    else
        snprintf(out, TEXT_NUMBER, "%.24s", number);
    return out;
}

const char *mps__duration(char out[TEXT_NUMBER], double seconds)
{
    const double minutes = floor(seconds / 60 + 0.5);
    if (!isfinite(seconds) || seconds < 120) return mps__quantity(out, seconds, "s");
    if (minutes < 120)
        snprintf(out, TEXT_NUMBER, "%.0f min", minutes);
    else if (fmod(minutes, 60) == 0)
        snprintf(out, TEXT_NUMBER, "%.0f h", minutes / 60);
    else
        snprintf(out, TEXT_NUMBER, "%.0f h %.0f min", floor(minutes / 60), fmod(minutes, 60));
    return out;
}
