/* SPDX-License-Identifier: BSD-3-Clause */
/* Case files and the files below them, pages that carry a case, and the calls that read a case. */
#include "run_file.h"
#include "tree.h"
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* Pages contain a film and are larger than case files. */
static const size_t PAGE_BYTES = (size_t)1 << 28;
enum { BASES = 8 };

int32_t mps__source_add(mps_case *c, const mps__source *source)
{
    if (c->sources == CASE_SOURCES) return -1;
    c->source[c->sources] = *source;
    return c->sources++;
}

/* ---- pages ----------------------------------------------------------------------------------- */

static const char page_begin[] = "<script type=\"text/yaml\" id=\"case\">",
                  page_end[] = "</script>";

/* A page writes "<" as "<\", so that no text of the case ends its script or begins another one. */
char *mps__page_case(char *page, size_t *size, int32_t *line)
{
    char *begin = strstr(page, page_begin);
    char *end = begin ? strstr(begin, page_end) : NULL;
    if (!end) return NULL;
    *line = 0;
    for (const char *p = page; p < begin; p++) *line += *p == '\n';
    begin += sizeof page_begin - 1;
    char *to = begin;
    for (const char *from = begin; from < end; from++) {
        *to++ = *from;
        if (*from == '<' && from[1] == '\\') from++;
    }
    *to = '\0';
    *size = (size_t)(to - begin);
    return begin;
}

/* ---- files ----------------------------------------------------------------------------------- */

static bool is_page(const char *path)
{
    const char *point = strrchr(path, '.');
    return point && (strcasecmp(point, ".html") == 0 || strcasecmp(point, ".htm") == 0);
}

/* Refuse a file that cannot be read, at the node that names it, or by its own name. */
static void refuse_file(mps_case *c, const char *path, const tree_node *from, const char *why)
{
    c->no_file = true;
    if (from) {
        mps__case_log(c, from, false, "'%s' cannot be read: %s", path, why);
        return;
    }
    const char *name = mps__case_copy(c, path, strlen(path));
    const mps__source s = {.name = name ? name : "", .text = "", .folder = "", .option = true};
    const int32_t source = mps__source_add(c, &s);
    mps__case_fail(c, (mps__place){source < 0 ? 0 : source, 0, 0}, "it cannot be read: %s", why);
}

static char *read_file(mps_case *c, const char *path, const tree_node *from, size_t *size)
{
    const char *why;
    FILE *file = mps__run_open(NULL, path, &why);
    char *text = file ? mps__file_read(file, is_page(path) ? PAGE_BYTES : TREE_BYTES, size) : NULL;
    if (!text && errno == ENOMEM)
        c->no_memory = true;
    else if (!text && errno == EFBIG)
        refuse_file(c, path, from, "it is larger than 1 MB; a case file is a text");
    else if (!text)
        refuse_file(c, path, from, why ? why : strerror(errno));
    if (file) fclose(file);
    return text;
}

/* The folder of a file, absolute unless the current folder was removed. */
const char *mps__folder_of(mps_case *c, const char *path)
{
    const char *slash = strrchr(path, '/');
    const int length = slash ? (int)(slash - path) + 1 : 0;
    char here[PATH_MAX];
    if (path[0] == '/' || !getcwd(here, sizeof here))
        return mps__case_copy(c, path, (size_t)length);
    return mps__case_print(c, "%s/%.*s", strcmp(here, "/") == 0 ? "" : here, length, path);
}

/* ---- base ------------------------------------------------------------------------------------ */

/* The chain of files that are being read, to detect a cycle. */
typedef struct chain {
    const struct chain *before;
    dev_t device;
    ino_t number;
    int32_t length;
    bool untrusted;
} chain;

static tree_node *load(mps_case *c, const char *path, const tree_node *from, const chain *before);

static bool is_open(const chain *files, const char *path)
{
    struct stat s;
    const bool there = stat(path, &s) == 0;
    for (; there && files; files = files->before)
        if (files->device == s.st_dev && files->number == s.st_ino) return true;
    return false;
}

static tree_node *load_base(mps_case *c, const tree_node *base, const chain *files)
{
    if (base->kind != TREE_TEXT || !*base->text) {
        mps__case_log(c, base, false, "base: the name of a file is wanted, e.g. 'lng.yaml'");
        return NULL;
    }
    const char *path = mps__file_path(c, base);
    if (!path) return NULL;
    if (is_open(files, path)) {
        mps__case_log(c, base, false, "base: '%s' is a base of itself", base->text);
        return NULL;
    }
    if (files->length == BASES) {
        mps__case_log(c, base, false, "base: more than %d files", BASES);
        return NULL;
    }
    return load(c, path, base, files);
}

/* Write the values of `set` to their paths. */
static void apply_set(mps_case *c, tree_node *root)
{
    tree_node *set = mps__tree_find(root, "set");
    if (!set) return;
    mps__tree_remove(root, set);
    if (set->kind != TREE_MAP) {
        mps__case_log(c, set, false, "set: a map of paths and values is wanted, {dp: 10 mm}");
        return;
    }
    for (tree_node *n = set->first, *next; n; n = next) {
        next = n->next;
        mps__set(c, root, n->key, n, (mps__place){n->source, n->key_line, n->key_column});
    }
}

static tree_node *load_source(mps_case *c, int32_t source, const char *path, const chain *before)
{
    struct stat s;
    const bool there = stat(path, &s) == 0; /* a text from memory is no file */
    const chain files = {before, there ? s.st_dev : 0, there ? s.st_ino : 0,
                         before ? before->length + 1 : 1, c->source[source].untrusted};
    tree_node *root = mps__parse(c, source);
    if (!root) return NULL;
    if (root->kind != TREE_MAP) {
        mps__case_log(c, root, false, "a map of keys is wanted; a case begins with 'mps: 1'");
        return NULL;
    }
    tree_node *base = mps__tree_find(root, "base");
    if (base) {
        tree_node *under = load_base(c, base, &files);
        if (!under) return NULL;
        mps__tree_remove(root, base);
        mps__merge(under, root);
        root = under;
    }
    apply_set(c, root);
    return root;
}

static int32_t add_file(mps_case *c, const char *path, char *text, size_t size, bool untrusted)
{
    mps__source s = {.name = mps__case_copy(c, path, strlen(path)),
                     .folder = mps__folder_of(c, path),
                     .untrusted = untrusted || is_page(path)};
    if (is_page(path)) {
        char *inner = mps__page_case(text, &size, &s.line_offset);
        s.text = inner ? mps__case_copy(c, inner, size) : NULL;
        if (!inner) {
            refuse_file(c, path, NULL, "the page has no case");
            return -1;
        }
    } else {
        s.text = mps__case_copy(c, text, size);
    }
    s.size = size;
    return s.name && s.folder && s.text ? mps__source_add(c, &s) : -1;
}

static tree_node *load(mps_case *c, const char *path, const tree_node *from, const chain *before)
{
    size_t size = 0;
    char *text = read_file(c, path, from, &size);
    if (!text) return NULL;
    const int32_t source = add_file(c, path, text, size, before && before->untrusted);
    free(text);
    return source < 0 ? NULL : load_source(c, source, path, before);
}

const char *mps__file_path(mps_case *c, const tree_node *node)
{
    if (node->text[0] == '/') return node->text;
    return mps__case_print(c, "%s%s", c->source[node->source].folder, node->text);
}

/* ---- calls ----------------------------------------------------------------------------------- */

/* Remove the paths that `sets` assigns from the sweep. */
static void settle_sweep(tree_node *root, int32_t count, const char *const *sets)
{
    tree_node *sweep = mps__tree_find(root, "sweep");
    if (!sweep || sweep->kind != TREE_MAP || sweep->count == 0) return;
    for (int32_t k = 0; k < count; k++) {
        const size_t length = strcspn(sets[k], "=");
        for (tree_node *n = sweep->first, *next; n; n = next) {
            next = n->next;
            if (strlen(n->key) == length && memcmp(n->key, sets[k], length) == 0)
                mps__tree_remove(sweep, n);
        }
    }
    if (sweep->count == 0) mps__tree_remove(root, sweep);
}

static mps_status finish(mps_case *c, tree_node *root, const mps_case_options *o, mps_case **out)
{
    if (root && !c->no_memory) {
        for (int32_t k = 0; k < o->set_count; k++) mps__set_text(c, root, o->set[k]);
        /* also for `sweep` given by `sets`: its runs get both */
        settle_sweep(root, o->set_count, o->set);
        mps__plugins_put(c, root, o->plugin_count, o->plugin);
        c->root = root;
        if (!c->no_memory) mps__check(c, root);
    }
    if (!mps__case_failed(c) && root) c->text = mps__tree_write(c, root);
    if (c->no_memory) {
        mps_case_destroy(c);
        return MPS_E_NOMEM;
    }
    *out = c;
    return c->no_file ? MPS_E_IO : c->errors > 0 ? MPS_E_ARG : MPS_OK;
}

static bool all_given(int32_t count, const char *const *texts)
{
    if (count < 0 || (count > 0 && !texts)) return false;
    for (int32_t k = 0; k < count; k++)
        if (!texts[k]) return false;
    return true;
}

static bool check_options(const mps_case_options *o)
{
    return o->struct_size == sizeof *o && o->load >= MPS_CASE_PLUGINS_NONE &&
           o->load <= MPS_CASE_PLUGINS_ALL && all_given(o->set_count, o->set) &&
           all_given(o->plugin_count, o->plugin);
}

/* Parse a text from memory. */
static tree_node *load_text(mps_case *c, const char *name, const char *text, size_t size)
{
    if (size > TREE_BYTES) {
        refuse_file(c, name, NULL, "it is larger than 1 MB; a case file is a text");
        c->no_file = false;
        return NULL;
    }
    const mps__source s = {.name = mps__case_copy(c, name, strlen(name)),
                           .text = mps__case_copy(c, text, size),
                           .folder = mps__folder_of(c, name),
                           .size = size,
                           .untrusted = true};
    const int32_t source = s.name && s.text && s.folder ? mps__source_add(c, &s) : -1;
    return source < 0 ? NULL : load_source(c, source, name, NULL);
}

mps_status mps_case_options_init(mps_case_options *options, size_t size)
{
    if (!options || size != sizeof *options) return MPS_E_ARG;
    *options = (mps_case_options){.struct_size = sizeof *options};
    return MPS_OK;
}

mps_status mps_case_open(const char *path, const mps_case_options *options, mps_case **out)
{
    const mps_case_options none = {.struct_size = sizeof none}, *o = options ? options : &none;
    if (out) *out = NULL;
    if (!path || !out || !check_options(o)) return MPS_E_ARG;
    mps_case *c = calloc(1, sizeof *c);
    if (!c) return MPS_E_NOMEM;
    c->scale = (read_scale){NAN, NAN, NAN};
    c->load = o->load;
    return finish(c, o->text ? load_text(c, path, o->text, o->size) : load(c, path, NULL, NULL), o,
                  out);
}

mps_status mps_case_read(const char *path, int32_t count, const char *const *sets, mps_case **out)
{
    const mps_case_options o = {.struct_size = sizeof o, .set_count = count, .set = sets};
    return mps_case_open(path, &o, out);
}

mps_status mps_case_read_text(const char *text, size_t size, const char *name, int32_t count,
                              const char *const *sets, mps_case **out)
{
    const mps_case_options o = {
        .struct_size = sizeof o, .set_count = count, .set = sets, .text = text, .size = size};
    if (text) return mps_case_open(name, &o, out);
    if (out) *out = NULL;
    return MPS_E_ARG;
}
