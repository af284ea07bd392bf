/* SPDX-License-Identifier: BSD-3-Clause */
/* Searches keys in the table, and words of similar spelling. */
#include "keys.h"
#include "words.h"
#include <stdio.h>
#include <string.h>

size_t mps__words_get(const char *words, int32_t index, const char **word)
{
    for (; index > 0 && *words; index--) {
        words += strcspn(words, "|");
        words += *words == '|';
    }
    *word = words;
    return strcspn(words, "|");
}

bool mps__words_have(const char *words, const char *word, size_t length)
{
    const char *at;
    size_t l;
    for (int32_t i = 0; (l = mps__words_get(words, i, &at)) > 0; i++)
        if (l == length && memcmp(at, word, l) == 0) return true;
    return false;
}

/* Length of the first element of a path. A name that contains points is not an element of the
 * table. */
static size_t element(const char *path)
{
    return strcspn(path, ".");
}

/* Whether an element of a key matches every name that the element of its parent matches. */
static bool covers(const char *key, size_t key_length, const char *parent, size_t parent_length)
{
    if (key_length == parent_length && memcmp(key, parent, key_length) == 0) return true;
    char words[80];
    if (key_length >= sizeof words) return false;
    memcpy(words, key, key_length);
    words[key_length] = '\0';
    size_t at = 0;
    while (at < parent_length) {
        size_t l = 0;
        while (at + l < parent_length && parent[at + l] != '|') l++;
        if (!mps__words_have(words, parent + at, l)) return false;
        at += l + 1;
    }
    return true;
}

/* The rest of `path` after the elements of `parent`; NULL: `path` is not below it. */
static const char *behind(const char *parent, const char *path)
{
    while (*parent) {
        const size_t p = element(parent), k = element(path);
        if (k == 0 || !covers(path, k, parent, p)) return NULL;
        parent += p + (parent[p] == '.');
        path += k;
        if (*path != '.') return NULL;
        path++;
    }
    return *path ? path : NULL;
}

bool mps__key_is_below(const mps__key *parent, const mps__key *key)
{
    const char *rest = behind(parent->path, key->path);
    return rest && !rest[element(rest)];
}

const char *mps__key_last(const mps__key *key)
{
    const char *point = strrchr(key->path, '.');
    return point ? point + 1 : key->path;
}

const mps__key *mps__key_below(const mps__key *parent, const char *name)
{
    for (int32_t k = 1; k < mps__keys_count; k++) {
        const mps__key *key = &mps__keys[k];
        if (!mps__key_is_below(parent, key)) continue;
        const char *last = mps__key_last(key);
        if (strcmp(last, "*") == 0 || mps__words_have(last, name, strlen(name))) return key;
    }
    return NULL;
}

bool mps__key_names(const mps__key *key)
{
    return key->shape == SHAPE_NAMES || key->shape == SHAPE_FILLS;
}

bool mps__key_dotted(const mps__key *key)
{
    return key->shape == SHAPE_PATHS || strcmp(key->path, "settings") == 0;
}

enum { WORD_CAPACITY = 40 };

bool mps__words_near(const char *a, const char *b, int32_t *distance)
{
    size_t same = 0;
    const size_t la = strlen(a), lb = strlen(b);
    while (a[same] && a[same] == b[same]) same++;
    const size_t edits = mps__word_distance(a, b);
    *distance = edits < WORD_CAPACITY ? (int32_t)edits : WORD_CAPACITY;
    if (*distance <= 2 && (size_t)*distance < (la > lb ? la : lb)) return true;
    *distance += WORD_CAPACITY; /* a common prefix ranks after a small distance */
    return same >= 3 && (same == la || same == lb);
}

const char *mps__key_nearest(const mps__key *parent, const char *name, char *buffer, size_t size)
{
    int32_t best = 2 * WORD_CAPACITY + 1, distance;
    bool found = false;
    for (int32_t k = 1; k < mps__keys_count; k++) {
        const char *word;
        size_t length;
        if (!mps__key_is_below(parent, &mps__keys[k])) continue;
        for (int32_t i = 0; (length = mps__words_get(mps__key_last(&mps__keys[k]), i, &word)) > 0;
             i++) {
            char known[WORD_CAPACITY];
            if (length >= sizeof known || *word == '*') continue;
            memcpy(known, word, length);
            known[length] = '\0';
            if (!mps__words_near(name, known, &distance) || distance >= best) continue;
            if (length >= size) continue;
            best = distance;
            memcpy(buffer, known, length + 1);
            found = true;
        }
    }
    return found ? buffer : NULL;
}

/* The parent of a key: the first key of the table above it. */
static const mps__key *parent_of(const mps__key *key)
{
    for (int32_t k = 0; k < mps__keys_count; k++)
        if (mps__key_is_below(&mps__keys[k], key)) return &mps__keys[k];
    return NULL;
}

const mps__key *mps__key_elsewhere(const char *name)
{
    const mps__key *found = NULL;
    for (int32_t k = 1; k < mps__keys_count; k++) {
        const mps__key *key = &mps__keys[k];
        if (!mps__words_have(mps__key_last(key), name, strlen(name))) continue;
        if (found) return NULL;
        found = parent_of(key);
    }
    return found;
}

bool mps__group_is_of(const mps__key_group *group, const mps__key *entry)
{
    char below[100]; /* pattern of the group as a path of a key */
    const int length = snprintf(below, sizeof below, "%s%sx", group->path,
                                group->path[0] ? "." : "");
    const mps__key probe = {.path = below};
    return length < (int)sizeof below && mps__key_is_below(entry, &probe);
}

const mps__key *mps__key_at(const char *path)
{
    const mps__key *key = &mps__keys[0];
    while (key && *path) {
        char name[80];
        const size_t length = mps__key_dotted(key) ? strlen(path) : element(path);
        if (length >= sizeof name) return NULL;
        memcpy(name, path, length);
        name[length] = '\0';
        path += length + (path[length] == '.');
        /* one of several maps is named by its number */
        if (key->shape == SHAPE_MAPS && name[strspn(name, "0123456789")] == '\0') continue;
        key = mps__key_below(key, name);
    }
    return key;
}
