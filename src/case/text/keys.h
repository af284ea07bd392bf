/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of keys: the language of case files. The reader, the schema and the reference are made
 * from it. */
#ifndef MPS_CASE_KEYS_H
#define MPS_CASE_KEYS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Form of a value. */
typedef enum key_shape {
    SHAPE_MAP,     /* a map of keys of the table */
    SHAPE_MAPS,    /* a map of keys of the table, or a list of such maps */
    SHAPE_NAMES,   /* a map of names that the user chooses */
    SHAPE_FILLS,   /* a list of maps with one name each */
    SHAPE_NUMBERS, /* one or more numbers with units */
    SHAPE_POINTS,  /* a list of points */
    SHAPE_TEXT,
    SHAPE_TEXTS, /* a text, or a list of texts */
    SHAPE_WORD,  /* one of `words` */
    SHAPE_FLAG,  /* yes or no */
    SHAPE_FILE,
    SHAPE_UNIT, /* a unit */
    SHAPE_PATHS /* a map of paths and values: `set` and `sweep` */
} key_shape;

/* Counts of numbers. */
enum { COUNT_DIM = -1, COUNT_MOST = 4096 };

typedef struct mps__key {
    /* Elements are separated by points; `*` is any name, `a|b` one of two. */
    const char *path;
    key_shape shape;
    uint64_t units;    /* SHAPE_NUMBERS, SHAPE_POINTS: kinds of units, bits of units.h */
    int32_t few, many; /* number of numbers, points or texts; COUNT_DIM: 2 or 3 */
    const char *range; /* of each number: "> 0", ">= 0", "1 .. 16"; "": any */
    const char *words; /* SHAPE_WORD: "a|b"; SHAPE_MAP, SHAPE_FILLS: a text instead of a map */
    bool required, whole;
    const char *otherwise; /* default, "" for none */
    const char *example;
    const char *help;
} mps__key;

/* Mutually exclusive keys: a map may have one of them. */
typedef struct mps__key_group {
    const char *path;
    const char *keys; /* "a|b|c" */
    bool required;    /* the map must have one of them */
} mps__key_group;

/* The tables; the first key is the root, "". */
extern const mps__key mps__keys[];
extern const int32_t mps__keys_count;
extern const mps__key_group mps__key_groups[];
extern const int32_t mps__key_groups_count;
/* "a|b": a map with a must have b. */
extern const mps__key_group mps__key_needs[];
extern const int32_t mps__key_needs_count;

/* Find a key below a key by name; NULL: not found. @param parent  the root for the first */
const mps__key *mps__key_below(const mps__key *parent, const char *name);
/* Whether `keys` contains the word as a whole. */
bool mps__words_have(const char *words, const char *word, size_t length);
/* Find word number `index` of "a|b". @return its length, 0 after the last */
size_t mps__words_get(const char *words, int32_t index, const char **word);
/* Whether a key is directly below another. */
bool mps__key_is_below(const mps__key *parent, const mps__key *key);
/* Last element of a path. */
const char *mps__key_last(const mps__key *key);
/* Nearest known word below a key: edit distance of at most 2, or a common prefix; NULL: none.
 * @param buffer  [size] the word */
const char *mps__key_nearest(const mps__key *parent, const char *name, char *buffer, size_t size);
/* The path of the only parent that has a key of this name; NULL: none or several have one. */
const mps__key *mps__key_elsewhere(const char *name);
/* Whether two words are as near as that. */
bool mps__words_near(const char *a, const char *b, int32_t *distance);
/* Whether a group belongs to maps of this key. */
bool mps__group_is_of(const mps__key_group *group, const mps__key *entry);
/* The key of a path in a case, "sensors.P1.wall"; NULL: not found. */
const mps__key *mps__key_at(const char *path);
/* Whether the keys of a map of this key are names that the user chooses. */
bool mps__key_names(const mps__key *key);
/* Whether the names below this key contain points: "settings" has "gas.sound". */
bool mps__key_dotted(const mps__key *key);

#endif
