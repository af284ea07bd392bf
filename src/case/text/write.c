/* SPDX-License-Identifier: BSD-3-Clause */
/* Writes a tree as YAML that parses to the same tree. */
#include "tree.h"
#include <stdio.h>
#include <string.h>

/* A growing text; without a buffer only its length is counted. */
typedef struct output {
    mps_case *c;
    char *text;
    size_t used;
} output;

static void put(output *o, const char *text, size_t length)
{
    if (o->text) memcpy(o->text + o->used, text, length);
    o->used += length;
}

static void put_text(output *o, const char *text)
{
    put(o, text, strlen(text));
}

static void put_blanks(output *o, int32_t count)
{
    while (count-- > 0) put(o, " ", 1);
}

/* Whether a text needs no quotes, in blocks and in lists. */
static bool is_plain(const char *text)
{
    static const char good[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                               "_./+-%()* ";
    const size_t length = strlen(text);
    if (length == 0 || strspn(text, good) != length) return false;
    if (strchr(" %*", text[0]) || text[length - 1] == ' ') return false;
    if (text[0] == '-') return text[1] == '.' || (text[1] >= '0' && text[1] <= '9');
    return strncmp(text, "...", 3) != 0;
}

/* The escape of a character beyond ASCII that YAML treats as a line break or a byte-order mark, or
 * refuses; "" for any other. */
static const char *escape_of(const char *text, size_t *length)
{
    static const char *const known[][2] = {{"\xe2\x80\xa8", "\\L"},
                                           {"\xe2\x80\xa9", "\\P"},
                                           {"\xef\xbb\xbf", "\\uFEFF"},
                                           {"\xef\xbf\xbe", "\\uFFFE"},
                                           {"\xef\xbf\xbf", "\\uFFFF"}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        *length = strlen(known[k][0]);
        if (strncmp(text, known[k][0], *length) == 0) return known[k][1];
    }
    return "";
}

static void put_quoted(output *o, const char *text)
{
    put_text(o, "\"");
    while (*text) {
        char code[8];
        size_t length = 1;
        const unsigned char c = (unsigned char)*text, next = (unsigned char)text[1];
        const char *escape = escape_of(text, &length);
        if (*escape) {
            put_text(o, escape);
            text += length;
            continue;
        }
        if (c == 0xC2 && next < 0xA0) { /* U+0080 to U+009F; U+0085 is a line break */
            snprintf(code, sizeof code, "\\x%02X", (unsigned)next);
            put_text(o, code);
            text += 2;
            continue;
        }
        if (c == '"' || c == '\\') {
            put(o, "\\", 1);
            put(o, text, 1);
        } else if (c < 0x20 || c == 0x7F) {
            snprintf(code, sizeof code, "\\x%02x", (unsigned)c);
            put_text(o, code);
        } else {
            put(o, text, 1);
        }
        text++;
    }
    put_text(o, "\"");
}

static void put_scalar(output *o, const char *text)
{
    if (is_plain(text))
        put_text(o, text);
    else
        put_quoted(o, text);
}

/* File names are written absolute, so that the text is valid in any folder. */
static void put_value(output *o, const tree_node *node)
{
    const bool file = node->entry && node->entry->shape == SHAPE_FILE;
    const char *text = file ? mps__file_path(o->c, node) : node->text;
    if (text) put_scalar(o, text);
}

static bool all_texts(const tree_node *list)
{
    for (const tree_node *n = list->first; n; n = n->next)
        if (n->kind != TREE_TEXT) return false;
    return true;
}

static void put_map(output *o, const tree_node *map, int32_t indent, bool begun);

static void put_list(output *o, const tree_node *list, int32_t indent)
{
    if (all_texts(list)) {
        put_text(o, " [");
        for (const tree_node *n = list->first; n; n = n->next) {
            if (n != list->first) put_text(o, ", ");
            put_value(o, n);
        }
        put_text(o, "]\n");
        return;
    }
    put_text(o, "\n");
    for (const tree_node *n = list->first; n; n = n->next) {
        put_blanks(o, indent);
        put_text(o, "-");
        if (n->kind == TREE_MAP && n->count > 0) {
            put_text(o, " ");
            put_map(o, n, indent + 2, true);
        } else if (n->kind == TREE_LIST) {
            put_list(o, n, indent + 2);
        } else {
            put_text(o, " ");
            if (n->kind == TREE_TEXT) put_value(o, n);
            put_text(o, n->kind == TREE_MAP ? "{}\n" : "\n");
        }
    }
}

static void put_map(output *o, const tree_node *map, int32_t indent, bool begun)
{
    for (const tree_node *n = map->first; n; n = n->next) {
        if (!begun) put_blanks(o, indent);
        begun = false;
        put_scalar(o, n->key);
        put_text(o, ":");
        if (n->kind == TREE_TEXT) {
            put_text(o, " ");
            put_value(o, n);
            put_text(o, "\n");
        } else if (n->kind == TREE_LIST) {
            put_list(o, n, indent + 2);
        } else if (n->count == 0) {
            put_text(o, " {}\n");
        } else {
            put_text(o, "\n");
            put_map(o, n, indent + 2, false);
        }
    }
}

const char *mps__tree_write(mps_case *c, const tree_node *root)
{
    output o = {.c = c};
    put_map(&o, root, 0, false);
    char *text = mps__case_take(c, o.used + 1);
    if (!text) return NULL;
    o = (output){.c = c, .text = text};
    put_map(&o, root, 0, false);
    return c->no_memory ? NULL : text;
}

const char *mps_case_text(const mps_case *c)
{
    return c ? c->text : NULL;
}
