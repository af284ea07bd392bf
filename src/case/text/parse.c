/* SPDX-License-Identifier: BSD-3-Clause */
/* Builds the tree from the YAML events of libyaml. Refuses what case files do not use: anchors,
 * tags, merge keys, several documents. */
#include "tree.h"
#include <stdio.h>
#include <string.h>
#include <yaml.h>

typedef struct parse {
    mps_case *c;
    int32_t source;
    int32_t depth;
    tree_node *at; /* the open list or map */
    tree_node *root;
    const char *key; /* in a map: key of the next value */
    mps__place key_place;
    int32_t documents;
    bool stop;
} parse;

static mps__place place_of(const parse *p, yaml_mark_t mark)
{
    const mps__source *s = &p->c->source[p->source];
    return (mps__place){p->source, (int32_t)mark.line + 1 + s->line_offset,
                        (int32_t)mark.column + 1};
}

/* ---- before libyaml: invalid bytes ----------------------------------------------------------- */

static bool refuse_byte(parse *p, size_t at)
{
    const mps__source *s = &p->c->source[p->source];
    yaml_mark_t mark = {0};
    for (size_t i = 0; i < at; i++) {
        if (s->text[i] == '\n') {
            mark.line++;
            mark.column = 0;
        } else if (((unsigned char)s->text[i] & 0xC0) != 0x80) {
            mark.column++;
        }
    }
    mps__case_fail(p->c, place_of(p, mark),
                   "byte 0x%02x: this is no text in UTF-8; a case file is YAML",
                   (unsigned)(unsigned char)s->text[at]);
    return false;
}

/* Number of bytes of the UTF-8 character at `at`; 0: invalid. */
static size_t character(const unsigned char *at, size_t left)
{
    if (at[0] < 0x80) return 1;
    const size_t length = at[0] >= 0xF0 ? 4 : at[0] >= 0xE0 ? 3 : 2;
    if (at[0] < 0xC2 || at[0] > 0xF4 || length > left) return 0;
    for (size_t k = 1; k < length; k++)
        if ((at[k] & 0xC0) != 0x80) return 0;
    if ((at[0] == 0xE0 && at[1] < 0xA0) || (at[0] == 0xED && at[1] > 0x9F) ||
        (at[0] == 0xF0 && at[1] < 0x90) || (at[0] == 0xF4 && at[1] > 0x8F))
        return 0;
    return length;
}

static bool is_text(parse *p)
{
    const mps__source *s = &p->c->source[p->source];
    for (size_t i = 0; i < s->size;) {
        const unsigned char *at = (const unsigned char *)s->text + i;
        const size_t length = character(at, s->size - i);
        const bool control = (at[0] < 0x20 && !strchr("\t\n\r", at[0])) || at[0] == 0x7F || !at[0];
        if (length == 0 || control) return refuse_byte(p, i);
        i += length;
    }
    return true;
}

/* ---- events ---------------------------------------------------------------------------------- */

static void refuse_syntax(parse *p, const yaml_parser_t *y)
{
    const mps__place at = place_of(p, y->problem_mark);
    const mps__source *s = &p->c->source[p->source];
    const char *line = s->text;
    if (y->error == YAML_MEMORY_ERROR) {
        p->c->no_memory = true;
        return;
    }
    if (y->error == YAML_READER_ERROR) {
        refuse_byte(p, y->problem_offset < s->size ? y->problem_offset : s->size);
        return;
    }
    for (size_t k = 0; line && k < y->problem_mark.line; k++) {
        line = strchr(line, '\n');
        if (line) line++;
    }
    if (line && line[strspn(line, " ")] == '\t') {
        mps__case_fail(p->c, (mps__place){p->source, at.line, (int32_t)strspn(line, " ") + 1},
                       "a tab in the indentation; write blanks");
        return;
    }
    mps__case_fail(p->c, at, "this is no YAML: %s%s%s", y->problem, y->context ? ", " : "",
                   y->context ? y->context : "");
}

static void refuse_extra(parse *p, yaml_mark_t mark, const char *what)
{
    mps__case_fail(p->c, place_of(p, mark), "%s; case files have none", what);
}

/* Append a value to the open list, to the open map under the key, or make it the root. */
static void place_value(parse *p, tree_node *value)
{
    if (!value) {
        p->stop = true;
        return;
    }
    if (++p->c->nodes > TREE_NODES) {
        mps__case_fail(p->c, (mps__place){p->source, value->line, value->column},
                       "more than %d values", TREE_NODES);
        p->stop = true;
    }
    if (!p->at) {
        p->root = value;
        return;
    }
    if (p->at->kind == TREE_MAP) {
        const tree_node *before = mps__tree_find(p->at, p->key);
        value->key = p->key;
        value->key_line = p->key_place.line;
        value->key_column = p->key_place.column;
        p->key = NULL;
        if (before) {
            mps__case_log_key(p->c, value, "key '%s' is given twice; first in line %d", value->key,
                              (int)before->key_line);
            value->parent = p->at; /* its elements are still to be read */
            return;
        }
        if (p->at->count == TREE_KEYS) {
            mps__case_log_key(p->c, value, "more than %d keys in a map", TREE_KEYS);
            p->stop = true;
        }
    }
    mps__tree_append(p->at, value);
}

static bool wants_key(const parse *p)
{
    return p->at && p->at->kind == TREE_MAP && !p->key;
}

static void take_scalar(parse *p, const yaml_event_t *e)
{
    const char *text = (const char *)e->data.scalar.value;
    const size_t length = e->data.scalar.length;
    const mps__place at = place_of(p, e->start_mark);
    if (e->data.scalar.anchor) refuse_extra(p, e->start_mark, "an anchor");
    if (e->data.scalar.tag) refuse_extra(p, e->start_mark, "a tag");
    if (strlen(text) != length) {
        mps__case_fail(p->c, at, "a text with a byte 0");
        p->stop = true;
        return;
    }
    const char *copy = mps__case_copy(p->c, text, length);
    if (!copy) {
        p->stop = true;
    } else if (wants_key(p)) {
        p->key = copy;
        p->key_place = at;
        if (strcmp(copy, "<<") == 0 && e->data.scalar.style == YAML_PLAIN_SCALAR_STYLE)
            refuse_extra(p, e->start_mark, "a merge key");
    } else {
        tree_node *value = mps__tree_new(p->c, TREE_TEXT, at);
        if (value) value->text = copy;
        place_value(p, value);
    }
}

static void take_start(parse *p, const yaml_event_t *e, tree_kind kind)
{
    const bool map = kind == TREE_MAP;
    if (map ? e->data.mapping_start.anchor != NULL : e->data.sequence_start.anchor != NULL)
        refuse_extra(p, e->start_mark, "an anchor");
    if (map ? e->data.mapping_start.tag != NULL : e->data.sequence_start.tag != NULL)
        refuse_extra(p, e->start_mark, "a tag");
    const mps__place at = place_of(p, e->start_mark);
    if (wants_key(p)) {
        mps__case_fail(p->c, at, "a %s as a key; keys are words", map ? "map" : "list");
        p->stop = true;
        return;
    }
    if (++p->depth > TREE_DEPTH) {
        mps__case_fail(p->c, at, "more than %d levels of lists and maps", TREE_DEPTH);
        p->stop = true;
        return;
    }
    tree_node *value = mps__tree_new(p->c, kind, at);
    place_value(p, value);
    p->at = value;
}

static void take_alias(parse *p, const yaml_event_t *e)
{
    refuse_extra(p, e->start_mark, "an alias");
    if (wants_key(p)) {
        p->key = "*";
        p->key_place = place_of(p, e->start_mark);
    } else {
        place_value(p, mps__tree_new(p->c, TREE_TEXT, place_of(p, e->start_mark)));
    }
}

static void take_document(parse *p, const yaml_event_t *e)
{
    if (++p->documents > 1) {
        refuse_extra(p, e->start_mark, "a second document");
        p->stop = true;
    }
    if (e->data.document_start.version_directive ||
        e->data.document_start.tag_directives.start != e->data.document_start.tag_directives.end)
        refuse_extra(p, e->start_mark, "a directive");
}

static void take_event(parse *p, const yaml_event_t *e)
{
    switch (e->type) {
    case YAML_DOCUMENT_START_EVENT:
        take_document(p, e);
        break;
    case YAML_ALIAS_EVENT:
        take_alias(p, e);
        break;
    case YAML_SCALAR_EVENT:
        take_scalar(p, e);
        break;
    case YAML_SEQUENCE_START_EVENT:
        take_start(p, e, TREE_LIST);
        break;
    case YAML_MAPPING_START_EVENT:
        take_start(p, e, TREE_MAP);
        break;
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        p->depth--;
        if (p->at) p->at = p->at->parent;
        break;
    case YAML_STREAM_END_EVENT:
        p->stop = true;
        break;
    default:
        break;
    }
}

static void run_parser(parse *p, yaml_parser_t *y)
{
    const mps__source *s = &p->c->source[p->source];
    yaml_parser_set_encoding(y, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(y, (const unsigned char *)s->text, s->size);
    while (!p->stop) {
        yaml_event_t e;
        if (!yaml_parser_parse(y, &e)) {
            refuse_syntax(p, y);
            return;
        }
        take_event(p, &e);
        yaml_event_delete(&e);
    }
}

tree_node *mps__parse(mps_case *c, int32_t source)
{
    parse p = {.c = c, .source = source};
    yaml_parser_t y;
    const int32_t errors = c->errors;
    if (!is_text(&p)) return NULL;
    if (!yaml_parser_initialize(&y)) {
        c->no_memory = true;
        return NULL;
    }
    run_parser(&p, &y);
    yaml_parser_delete(&y);
    if (c->no_memory) return NULL;
    if (!p.root && c->errors == errors)
        mps__case_fail(c, (mps__place){source, 1, 1},
                       "there is nothing in it; a case begins with 'mps: 1'");
    return c->errors == errors ? p.root : NULL;
}
