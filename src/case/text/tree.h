/* SPDX-License-Identifier: BSD-3-Clause */
/* A case as a tree of texts, lists and maps, each with its place in a file. All memory is that of the case. */
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
    int32_t source, line, column; /* of the value; line and column from 1 */
    int32_t key_line, key_column;
    int32_t count; /* of children */
    tree_node *parent, *first, *last, *next;
    const mps__key *entry; /* of the table, once the tree is checked */
    uint64_t units;        /* that its numbers may have; those of the entry but for settings */
    bool in_dp;            /* a setting that libmps counts in spacings */
    double unit;           /* of a setting, in SI */
    const char *number;    /* of a setting: its text without the unit; NULL: all of it */
    bool read;             /* asked for by the code that builds the case */
};

/* What lengths in dp, times in T1 and shares are relative to. NAN: not known. */
typedef struct read_scale {
    double dp, T1, whole;
} read_scale;

/* A file, or a text of `sets`. */
typedef struct mps__source {
    const char *name;   /* in messages */
    const char *text;   /* [size + 1] */
    const char *folder; /* that names of files in it are relative to */
    size_t size;
    bool option;    /* a text of `sets`: its messages have no line */
    bool untrusted; /* a page, a text from memory, or a file that one of these names */
    int32_t line_offset;
} mps__source;

enum { CASE_SOURCES = 1024, CASE_PLUGINS = 16 };

/* A plug-in of a case: `at` names it. */
typedef struct mps__case_plugin {
    struct mps_plugin_file *file;
    const tree_node *at;
} mps__case_plugin;

typedef struct mps__block_of_case mps__block_of_case;

struct mps_case {
    mps__block_of_case *blocks; /* all memory of the case */
    bool no_memory;             /* an allocation failed: the case is of no use */
    bool no_file;               /* a file could not be read */
    int32_t sources, messages, errors, nodes;
    int32_t known_errors; /* of other parts of the case, while a further part is read for its own */
    mps__source source[CASE_SOURCES];
    mps_case_message message[MPS_CASE_MESSAGES]; /* in the order of their places */
    int32_t message_source[MPS_CASE_MESSAGES];
    tree_node *root;
    const char *text; /* merged */
    read_scale scale;
    mps_case_cost cost;    /* of the last check; struct_size 0: none */
    int32_t plugins, load; /* that are loaded; MPS_CASE_PLUGINS_... */
    mps__case_plugin plugin[CASE_PLUGINS];
};

/* ---- memory: NULL, and c->no_memory is set, where there is none */
void *mps__case_take(mps_case *c, size_t size); /* zeroed */
char *mps__case_copy(mps_case *c, const char *text, size_t length);
char *mps__case_print(mps_case *c, const char *format, ...);

/* ---- messages */
typedef struct mps__place {
    int32_t source, line, column;
} mps__place;

/* A message at a node; printf-like. */
void mps__case_say(mps_case *c, const tree_node *at, bool warning, const char *format, ...);
/* An error at the key of a node. */
void mps__case_say_key(mps_case *c, const tree_node *at, const char *format, ...);
void mps__case_say_at(mps_case *c, mps__place at, bool warning, const char *format, va_list list);
/* An error at a place. */
void mps__case_fail(mps_case *c, mps__place at, const char *format, ...);
/* Read a further part of a case that has errors, for the errors of this part:
 * mps__case_failed() is about those alone. Off again: about all. */
void mps__case_go_on(mps_case *c, bool others);
/* There are errors, or no memory. */
bool mps__case_failed(const mps_case *c);

/* ---- nodes */
tree_node *mps__tree_new(mps_case *c, tree_kind kind, mps__place at);
/* Add a child at the end. */
void mps__tree_append(tree_node *parent, tree_node *child);
void mps__tree_remove(tree_node *parent, const tree_node *child);
/* Child of a map, or the value of a one-key map in a list of such; NULL: not given. */
tree_node *mps__tree_find(const tree_node *map, const char *key);
/* Put `with` in the place of a child. */
void mps__tree_replace(tree_node *child, tree_node *with);
/* Path of a node, "fill.water.depth", cut to the room. @return buffer */
const char *mps__tree_path(const tree_node *node, char *buffer, size_t size);

/* Room for a path in messages. */
enum { PATH_ROOM = 200 };

/* ---- from file to tree */
/* Number of a new source, or -1. The text is not copied. */
int32_t mps__source_add(mps_case *c, const mps__source *source);
/* Parse source number `source`; NULL: errors. */
tree_node *mps__parse(mps_case *c, int32_t source);
/* The folder of a file, absolute, with a / at its end; NULL: no memory. */
const char *mps__folder_of(mps_case *c, const char *path);
/* The case of a page. @return start of its text in place, unescaped, or NULL */
char *mps__page_case(char *page, size_t *size, int32_t *line);

/* ---- merging */
/* Put all children of `over` into `under`; what `over` has wins. */
void mps__merge(tree_node *under, tree_node *over);
/* Put `value` at a path, with messages at `at`. */
void mps__set(mps_case *c, tree_node *root, const char *path, tree_node *value, mps__place at);
/* Set what a text "path=value" says. */
void mps__set_text(mps_case *c, tree_node *root, const char *text);

/* ---- checking */
/* Check the tree against the table of keys; each node gets its entry. */
void mps__check(mps_case *c, tree_node *root);
/* Check numbers, choice, file ... of one value against its entry. */
void mps__check_value(mps_case *c, tree_node *node);
/* Check names of models and of solvers, and units and ranges of settings, against libmps. */
void mps__check_models(mps_case *c, tree_node *root);
void mps__check_sweep(mps_case *c, tree_node *root);
/* Names of sensors that other columns have, and of 'collect' that no sensor has. */
void mps__check_columns(mps_case *c, const tree_node *root);
/* Numbers of a node in SI units, with messages. @return how many, -1: an error */
int32_t mps__node_numbers(mps_case *c, const tree_node *node, int32_t most, double *out,
                          uint64_t *found);
/* The number of a setting, in the unit of libmps. @return false: an error, with its message */
bool mps__node_setting(mps_case *c, const tree_node *node, double *value);

/* ---- plug-ins */
/* Bring `plugins` into one form, a list of maps with `file`, and add the files of a program. */
void mps__plugins_put(mps_case *c, tree_node *root, int32_t count, const char *const *files);
/* Load the plug-ins of a case that was checked, with messages. */
void mps__plugins_load(mps_case *c, tree_node *root);
/* Register all of them on a simulation. @return false: a message says why */
bool mps__plugins_register(mps_case *c, mps_sim *sim);
/* Whether the case names plug-ins that are not loaded, so that names of models are not known. */
bool mps__plugins_missing(const mps_case *c, const tree_node *root);
/* The table of a load or motion by its name, and its kind, MPS_PLUGIN_...; NULL: there is none, `near` has one that is
 * spelled alike, or "". */
const struct mps_drive_ops *mps__plugins_drive(const mps_case *c, const char *name, int32_t kind,
                                               char *near, size_t size);
/* Load or motion number `index` of all plug-ins; NULL behind the last. */
const struct mps_drive_ops *mps__plugins_drive_at(const mps_case *c, int32_t index);
void mps__plugins_close(mps_case *c);

/* The tree as YAML, in memory of the case; NULL: no memory. */
const char *mps__tree_write(mps_case *c, const tree_node *root);
/* Name of a file relative to where it is written, made absolute; NULL: no memory. */
const char *mps__file_path(mps_case *c, const tree_node *node);

#endif
