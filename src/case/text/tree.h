/* SPDX-License-Identifier: BSD-3-Clause */
/* A case as a tree of texts, lists and maps, each with its position in a file. The case owns all
 * memory. */
#ifndef MPS_CASE_TREE_H
#define MPS_CASE_TREE_H

#include "keys.h"
#include <mps/case.h>
#include <stdarg.h>
#include <stdbool.h>

/* Limits of a file. */
enum { TREE_BYTES = 1 << 20, TREE_DEPTH = 32, TREE_KEYS = 1000, TREE_NODES = 100000 };

typedef enum tree_kind { TREE_TEXT, TREE_LIST, TREE_MAP } tree_kind;

typedef struct tree_node tree_node;
struct tree_node {
    tree_kind kind;
    const char *text;             /* TREE_TEXT: as written */
    const char *key;              /* in a map: its key; else NULL */
    int32_t source, line, column; /* position of the value; line and column from 1 */
    int32_t key_line, key_column;
    int32_t count; /* number of children */
    tree_node *parent, *first, *last, *next;
    const mps__key *entry; /* entry of the table, once the tree is checked */
    uint64_t units;     /* allowed units of its numbers: those of the entry except for settings */
    bool in_dp;         /* a setting that libmps counts in spacings */
    double unit;        /* unit of a setting, in SI */
    const char *number; /* a setting: its text without the unit; NULL: the whole text */
    bool read;          /* read by the code that builds the case */
};

/* Scales of lengths in dp, times in T1 and fractions. NAN: not known. */
typedef struct read_scale {
    double dp, T1, whole;
} read_scale;

/* A file, or a text of `sets`. */
typedef struct mps__source {
    const char *name;   /* in messages */
    const char *text;   /* [size + 1] */
    const char *folder; /* relative file names in it are below this folder */
    size_t size;
    bool option;    /* a text of `sets`: its messages have no line */
    bool untrusted; /* a page, a text from memory, or a file that one of these names */
    int32_t line_offset;
} mps__source;

enum { CASE_SOURCES = 1024, CASE_PLUGINS = 16 };

/* A plug-in of a case, named at `at`. */
typedef struct mps__case_plugin {
    struct mps_plugin_file *file;
    const tree_node *at;
} mps__case_plugin;

typedef struct mps__block_of_case mps__block_of_case;

struct mps_case {
    mps__block_of_case *blocks; /* all memory of the case */
    bool no_memory;             /* an allocation failed: the case cannot be used */
    bool no_file;               /* a file could not be read */
    int32_t sources, messages, errors, nodes;
    /* errors of other parts, while a further part is read for its own errors */
    int32_t known_errors;
    mps__source source[CASE_SOURCES];
    mps_case_message message[MPS_CASE_MESSAGES]; /* in the order of their positions */
    int32_t message_source[MPS_CASE_MESSAGES];
    tree_node *root;
    const char *text; /* the merged case */
    read_scale scale;
    mps_case_cost cost;    /* of the last check; struct_size 0: none */
    int32_t plugins, load; /* loaded plug-ins; MPS_CASE_PLUGINS_... */
    mps__case_plugin plugin[CASE_PLUGINS];
};

/* ---- memory: on failure NULL, and c->no_memory is set */
void *mps__case_take(mps_case *c, size_t size); /* zero-initialised */
char *mps__case_copy(mps_case *c, const char *text, size_t length);
char *mps__case_print(mps_case *c, const char *format, ...);

/* ---- messages */
typedef struct mps__place {
    int32_t source, line, column;
} mps__place;

/* Add a message at a node; printf-like. */
void mps__case_log(mps_case *c, const tree_node *at, bool warning, const char *format, ...);
/* Add an error at the key of a node. */
void mps__case_log_key(mps_case *c, const tree_node *at, const char *format, ...);
void mps__case_log_at(mps_case *c, mps__place at, bool warning, const char *format, va_list list);
/* Add an error at a position. */
void mps__case_fail(mps_case *c, mps__place at, const char *format, ...);
/* Switch on to read a further part of a case that already has errors: mps__case_failed() then
 * reports errors of this part alone. Switched off, it reports all errors. */
void mps__case_continue(mps_case *c, bool others);
/* Whether there are errors, or memory is exhausted. */
bool mps__case_failed(const mps_case *c);

/* ---- nodes */
tree_node *mps__tree_new(mps_case *c, tree_kind kind, mps__place at);
/* Append a child. */
void mps__tree_append(tree_node *parent, tree_node *child);
void mps__tree_remove(tree_node *parent, const tree_node *child);
/* Child of a map, or the value of a one-key map in a list of such maps; NULL: not given. */
tree_node *mps__tree_find(const tree_node *map, const char *key);
/* Replace a child by `with`. */
void mps__tree_replace(tree_node *child, tree_node *with);
/* Path of a node, "fill.water.depth", truncated to the buffer. @return buffer */
const char *mps__tree_path(const tree_node *node, char *buffer, size_t size);

/* Buffer size of a path in messages. */
enum { PATH_CAPACITY = 200 };

/* ---- from file to tree */
/* Add a source. @return its number, or -1. The text is not copied. */
int32_t mps__source_add(mps_case *c, const mps__source *source);
/* Parse source number `source`; NULL: errors. */
tree_node *mps__parse(mps_case *c, int32_t source);
/* The folder of a file, absolute, with a trailing /; NULL: memory is exhausted. */
const char *mps__folder_of(mps_case *c, const char *path);
/* The case of a page. @return start of its text in place, unescaped, or NULL */
char *mps__page_case(char *page, size_t *size, int32_t *line);

/* ---- merging */
/* Merge all children of `over` into `under`; values of `over` have precedence. */
void mps__merge(tree_node *under, tree_node *over);
/* Put `value` at a path, with messages at `at`. */
void mps__set(mps_case *c, tree_node *root, const char *path, tree_node *value, mps__place at);
/* Set a value from a text "path=value". */
void mps__set_text(mps_case *c, tree_node *root, const char *text);

/* ---- checking */
/* Check the tree against the table of keys; sets the entry of each node. */
void mps__check(mps_case *c, tree_node *root);
/* Check one value (numbers, choice, file ...) against its entry. */
void mps__check_value(mps_case *c, tree_node *node);
/* Check names of models and of solvers, and units and ranges of settings, against libmps. */
void mps__check_models(mps_case *c, tree_node *root);
void mps__check_sweep(mps_case *c, tree_node *root);
/* Names of sensors that other columns have, and of 'collect' that no sensor has. */
void mps__check_columns(mps_case *c, const tree_node *root);
/* Numbers of a node in SI units, with messages. @return how many, -1: an error */
int32_t mps__node_numbers(mps_case *c, const tree_node *node, int32_t most, double *out,
                          uint64_t *found);
/* The number of a setting in the unit of libmps. @return false: an error, with its message */
bool mps__node_setting(mps_case *c, const tree_node *node, double *value);

/* ---- plug-ins */
/* Convert `plugins` to a list of maps with `file`, and add the files of a program. */
void mps__plugins_put(mps_case *c, tree_node *root, int32_t count, const char *const *files);
/* Load the plug-ins of a checked case, with messages. */
void mps__plugins_load(mps_case *c, tree_node *root);
/* Register all plug-ins on a simulation. @return false: there is a message */
bool mps__plugins_register(mps_case *c, mps_sim *sim);
/* Whether the case names plug-ins that are not loaded, so that their models are not known. */
bool mps__plugins_missing(const mps_case *c, const tree_node *root);
/* Find the table of a load or motion by its name and its kind, MPS_PLUGIN_...; NULL: not found,
 * `near` is the most similar name, or "". */
const struct mps_drive_ops *mps__plugins_drive(const mps_case *c, const char *name, int32_t kind,
                                               char *near, size_t size);
/* Load or motion number `index` of all plug-ins; NULL after the last. */
const struct mps_drive_ops *mps__plugins_drive_at(const mps_case *c, int32_t index);
void mps__plugins_close(mps_case *c);

/* The tree as YAML, in memory of the case; NULL: memory is exhausted. */
const char *mps__tree_write(mps_case *c, const tree_node *root);
/* Make a file name absolute, relative to the file that contains it; NULL: memory is exhausted. */
const char *mps__file_path(mps_case *c, const tree_node *node);

#endif
