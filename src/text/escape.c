/* SPDX-License-Identifier: BSD-3-Clause */
#include "escape.h"
#include "plain.h"
#include <stdbool.h>
#include <string.h>

static const char REPLACEMENT[] = "\xef\xbf\xbd"; /* U+FFFD */

size_t mps__character(const char *text)
{
    static const unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char *b = (const unsigned char *)text;
    const size_t length = b[0] < 0x80   ? b[0] != 0
                          : b[0] < 0xC2 ? 0
                          : b[0] < 0xE0 ? 2
                          : b[0] < 0xF0 ? 3
                          : b[0] < 0xF5 ? 4
                                        : 0;
    if (length < 2) return length;
    unsigned value = b[0] & (0x7Fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((b[i] & 0xC0) != 0x80) return 0;
        value = value << 6 | (b[i] & 0x3Fu);
    }
    const bool good = value >= least[length] && value <= 0x10FFFF &&
                      (value < 0xD800 || value > 0xDFFF);
    return good ? length : 0;
}

/* Whether the character of so many bytes is for people to read. XML forbids many others. */
static bool is_shown(const char *text, size_t length)
{
    const unsigned char *b = (const unsigned char *)text;
    unsigned c = length > 1 ? b[0] & (0x7Fu >> length) : b[0];
    for (size_t k = 1; k < length; k++) c = c << 6 | (b[k] & 0x3Fu);
    if (c < 0x20) return c == '\n' || c == '\t';
    return !((c >= 0x7f && c < 0xa0) || (c >= 0x2028 && c <= 0x202e) ||
             (c >= 0x2066 && c <= 0x2069) || (c & 0xfffe) == 0xfffe);
}

static void copy(char out[8], const char *text, size_t length)
{
    memcpy(out, text, length);
    out[length] = '\0';
}

size_t mps__shown_character(const char *text, char out[8])
{
    const size_t length = mps__character(text);
    if (text[0] == '\r' && text[1] == '\n')
        copy(out, "", 0);
    else if (length > 0 && is_shown(text, length))
        copy(out, text, length);
    else
        copy(out, REPLACEMENT, sizeof REPLACEMENT - 1);
    return length ? length : 1;
}

size_t mps__xml_character(const char *text, char out[8])
{
    static const char letters[] = "&<>\"'";
    static const char *const entity[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
    const size_t length = mps__shown_character(text, out);
    const char *found = out[0] ? strchr(letters, out[0]) : NULL;
    if (found) copy(out, entity[found - letters], strlen(entity[found - letters]));
    return length;
}

size_t mps__json_character(const char *text, char out[8])
{
    const size_t length = mps__character(text);
    const unsigned char c = (unsigned char)*text;
    if (length == 0)
        snprintf(out, 8, "\\ufffd");
    else if (c == '"' || c == '\\')
        snprintf(out, 8, "\\%c", c);
    else if (c == '\n' || c == '\t')
        snprintf(out, 8, "\\%c", c == '\n' ? 'n' : 't');
    else if (c < 0x20 || c == '<')
        snprintf(out, 8, "\\u%04x", (unsigned)c);
    else
        copy(out, text, length);
    return length ? length : 1;
}

/* Append a byte to a text of `length` bytes, as long as there is capacity. @return new length */
static size_t append(char *out, size_t size, size_t length, char byte)
{
    if (length + 1 < size) out[length] = byte;
    return length + 1;
}

size_t mps__shell_word(const char *word, char *out, size_t size)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_.,:/+=@%-";
    const bool quoted = !word[0] || word[strspn(word, plain)];
    size_t length = quoted ? append(out, size, 0, '"') : 0;
    for (; *word; word++) {
        if (strchr("\"\\$`", *word)) length = append(out, size, length, '\\');
        length = append(out, size, length, *word);
    }
    if (quoted) length = append(out, size, length, '"');
    if (size > 0) out[length < size ? length : size - 1] = '\0';
    return length;
}

void mps__put_escaped(FILE *out, const char *text, mps__escape *escape)
{
    char character[8];
    while (*text) {
        text += escape(text, character);
        fputs(character, out);
    }
}
