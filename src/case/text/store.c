/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory and messages of a case. */
#include "out.h"
#include "tree.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Memory is allocated in blocks and freed with the case. */
struct mps__block_of_case {
    mps__block_of_case *before;
    size_t size, used;
};

enum { BLOCK = 1 << 14, ALIGNMENT = 16, MESSAGE_CAPACITY = 700, SOURCE_CAPACITY = 200 };

static const size_t HEAD = (sizeof(mps__block_of_case) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;

void *mps__case_take(mps_case *c, size_t size)
{
    size = (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    mps__block_of_case *b = c->blocks;
    if (!b || b->size - b->used < size) {
        const size_t capacity = size > BLOCK - HEAD ? size : BLOCK - HEAD;
        b = calloc(1, HEAD + capacity);
        if (!b) {
            c->no_memory = true;
            return NULL;
        }
        *b = (mps__block_of_case){.before = c->blocks, .size = capacity};
        c->blocks = b;
    }
    char *at = (char *)b + HEAD + b->used;
    b->used += size;
    return at;
}

void mps_case_destroy(mps_case *c)
{
    if (!c) return;
    mps__plugins_close(c);
    for (mps__block_of_case *b = c->blocks, *before; b; b = before) {
        before = b->before;
        free(b);
    }
    free(c);
}

char *mps__case_copy(mps_case *c, const char *text, size_t length)
{
    char *copy = mps__case_take(c, length + 1);
    if (copy) memcpy(copy, text, length);
    return copy;
}

char *mps__case_print(mps_case *c, const char *format, ...)
{
    va_list list, again;
    va_start(list, format);
    va_copy(again, list);
    const int length = vsnprintf(NULL, 0, format, list);
    char *text = mps__case_take(c, length < 0 ? 1 : (size_t)length + 1);
    if (text) vsnprintf(text, length < 0 ? 1 : (size_t)length + 1, format, again);
    va_end(list);
    va_end(again);
    return text;
}

bool mps__case_failed(const mps_case *c)
{
    return c->no_memory || c->errors > c->known_errors;
}

void mps__case_continue(mps_case *c, bool others)
{
    c->known_errors = others ? c->errors : 0;
}

/* ---- messages ------------------------------------------------------------------------------- */

/* Line number `line` of a source, copied; NULL: not found. */
static const char *source_line(mps_case *c, const mps__source *s, int32_t line)
{
    if (s->option || line < 1) return NULL;
    const char *at = s->text;
    for (int32_t k = 1; k < line && at; k++) {
        at = strchr(at, '\n');
        if (at) at++;
    }
    return at ? mps__case_copy(c, at, strcspn(at, "\r\n")) : NULL;
}

static int32_t compare(mps__place a, int32_t source, const mps_case_message *m)
{
    if (a.source != source) return a.source < source ? -1 : 1;
    if (a.line != m->line) return a.line < m->line ? -1 : 1;
    return a.column < m->column ? -1 : a.column > m->column;
}

/* Insert an empty message in the order of positions. @return its index, or -1 */
static int32_t insert_message(mps_case *c, mps__place at)
{
    int32_t k = c->messages;
    while (k > 0 && compare(at, c->message_source[k - 1], &c->message[k - 1]) < 0) k--;
    if (k == MPS_CASE_MESSAGES) return -1;
    if (c->messages < MPS_CASE_MESSAGES) c->messages++;
    for (int32_t i = c->messages - 1; i > k; i--) {
        c->message[i] = c->message[i - 1];
        c->message_source[i] = c->message_source[i - 1];
    }
    return k;
}

void mps__case_log_at(mps_case *c, mps__place at, bool warning, const char *format, va_list list)
{
    static const mps__source none = {.name = "", .text = "", .option = true};
    const mps__source *s = at.source < c->sources ? &c->source[at.source] : &none;
    char text[MESSAGE_CAPACITY];
    vsnprintf(text, sizeof text, format, list);
    if (!warning) c->errors++;
    if (s->option) at.line = at.column = 0;
    for (int32_t i = 0; i < c->messages; i++) /* the same value is checked more than once */
        if (compare(at, c->message_source[i], &c->message[i]) == 0 &&
            strcmp(c->message[i].text, text) == 0)
            return;
    const char *kept = mps__case_copy(c, text, strlen(text));
    const char *line = source_line(c, s, at.line);
    const int32_t k = kept ? insert_message(c, at) : -1;
    if (k < 0) return;
    c->message_source[k] = at.source;
    c->message[k] = (mps_case_message){.struct_size = sizeof(mps_case_message),
                                       .warning = warning,
                                       .line = at.line,
                                       .column = at.column,
                                       .file = s->name,
                                       .text = kept,
                                       .source = line};
}

void mps__case_log(mps_case *c, const tree_node *at, bool warning, const char *format, ...)
{
    const mps__place place = {at->source, at->line, at->column};
    va_list list;
    va_start(list, format);
    mps__case_log_at(c, place, warning, format, list);
    va_end(list);
}

void mps__case_log_key(mps_case *c, const tree_node *at, const char *format, ...)
{
    const mps__place place = {at->source, at->key ? at->key_line : at->line,
                              at->key ? at->key_column : at->column};
    va_list list;
    va_start(list, format);
    mps__case_log_at(c, place, false, format, list);
    va_end(list);
}

void mps__case_fail(mps_case *c, mps__place at, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    mps__case_log_at(c, at, false, format, list);
    va_end(list);
}

int32_t mps_case_message_count(const mps_case *c)
{
    return c ? c->messages : 0;
}

mps_status mps_case_message_get(const mps_case *c, int32_t index, mps_case_message *message)
{
    if (!c || !message || message->struct_size != sizeof *message || index < 0 ||
        index >= c->messages)
        return MPS_E_ARG;
    *message = c->message[index];
    return MPS_OK;
}

/* ---- messages as text ------------------------------------------------------------------------ */

/* Number of bytes of the first characters of a UTF-8 text. */
static size_t characters(const char *text, int32_t count)
{
    size_t at = 0;
    for (; count > 0 && text[at]; count--) {
        at++;
        while (((unsigned char)text[at] & 0xC0) == 0x80) at++;
    }
    return at;
}

/* Write the line, or the part of a long line around the column, with a caret below it. */
static void put_source(mps__out *o, const mps_case_message *m)
{
    const int32_t first = m->column > SOURCE_CAPACITY / 2 ? m->column - SOURCE_CAPACITY / 2 : 0;
    const char *from = m->source + characters(m->source, first);
    const int length = (int)characters(from, SOURCE_CAPACITY);
    mps__out_put(o, "%5d | %.*s\n", (int)m->line, length, from);
    if (m->column < 1) return;
    mps__out_put(o, "      | ");
    for (int32_t k = first + 1; k < m->column; k++) {
        mps__out_put(o, "%c", *from == '\t' ? '\t' : ' ');
        from += characters(from, 1);
    }
    mps__out_put(o, "^\n");
}

size_t mps_case_messages_write(const mps_case *c, char *buffer, size_t size)
{
    mps__out o = mps__out_begin(buffer, size);
    for (int32_t i = 0; c && i < c->messages; i++) {
        const mps_case_message *m = &c->message[i];
        mps__out_put(&o, "%s", m->file);
        if (m->line > 0) mps__out_put(&o, ":%d", (int)m->line);
        if (m->line > 0 && m->column > 0) mps__out_put(&o, ":%d", (int)m->column);
        mps__out_put(&o, ": %s: %s\n", m->warning ? "warning" : "error", m->text);
        if (m->source) put_source(&o, m);
    }
    return o.length;
}
