/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads frames of the library. */
#include "page_vtp.h"
#include "grow.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD_MOST = 1 << 16, BLOCK = 1 << 15, PIECES_MOST = 100000 };
static const char data_mark[] = "<AppendedData encoding=\"raw\">\n_";

static mps_status broken(page_errors *e, const char *path, const char *why)
{
    return mps__page_fail(e, MPS_E_IO, "frame '%s': %s", path, why);
}

static const char *host_order(void)
{
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first ? "byte_order=\"LittleEndian\"" : "byte_order=\"BigEndian\"";
}

/* The text after `name="` in a tag that ends at `end`; NULL: missing. */
static const char *attribute(const char *tag, const char *end, const char *name)
{
    const char *found = strstr(tag, name);
    return found && found < end ? found + strlen(name) : NULL;
}

static char type_of(const char *text)
{
    static const char *const name[] = {"Float32\"", "Float64\"", "UInt8\"", "Int32\"", "Int64\""};
    for (int k = 0; text && k < 5; k++)
        if (strncmp(text, name[k], strlen(name[k])) == 0) return "fdbil"[k];
    return 0;
}

static size_t type_size(char type)
{
    return type == 'b' ? 1 : type == 'f' || type == 'i' ? 4 : 8;
}

/* Read a tag of an array in the appended data; other tags are skipped. */
static bool take_array(vtp_piece *p, const char *tag, const char *end)
{
    const char *name = attribute(tag, end, " Name=\""), *width = attribute(tag, end, "nents=\"");
    const char *offset = attribute(tag, end, " offset=\"");
    const size_t length = name ? strcspn(name, "\"") : VTP_NAME;
    if (!name || !offset || !width || p->arrays == VTP_ARRAYS || length >= VTP_NAME) return true;
    vtp_array *a = &p->array[p->arrays];
    a->type = type_of(attribute(tag, end, " type=\""));
    a->width = (int32_t)strtol(width, NULL, 10);
    a->offset = strtoll(offset, NULL, 10);
    memcpy(a->name, name, length);
    a->name[length] = '\0';
    if (!a->type || a->width < 1 || a->width > 9 || a->offset < 0) return false;
    p->arrays++;
    return true;
}

/* Names of parts: character codes. */
static mps_status take_parts(vtp_frame *f, const char *head)
{
    const char *tag = strstr(head, "Name=\"part_names\""), *text = tag ? strchr(tag, '>') : NULL;
    if (!text || f->parts) return MPS_OK;
    const size_t most = strcspn(text, "<");
    f->parts = calloc(most + 2, 1);
    if (!f->parts) return mps__page_fail(f->run->errors, MPS_E_NOMEM, "no memory for the page");
    char *end = NULL;
    size_t n = 0;
    for (text++; n < most; text = end, n++) {
        const long code = strtol(text, &end, 10);
        if (!end || end == text) break;
        f->parts[n] = (char)code;
    }
    return MPS_OK;
}

static mps_status take_head(vtp_frame *f, vtp_piece *p, const char *head, size_t size)
{
    const char *mark = NULL, *points = strstr(head, "NumberOfPoints=\"");
    for (const char *c = head; !mark && (c = strstr(c, data_mark)) != NULL;) mark = c;
    if (!mark || !points || (size_t)(mark - head) + sizeof data_mark > size)
        return broken(f->run->errors, p->path, "is no frame of this library");
    if (!strstr(head, host_order()) || !strstr(head, "header_type=\"UInt64\""))
        return broken(f->run->errors, p->path, "is from a machine with another order of bytes");
    p->base = (long)(mark - head) + (long)sizeof data_mark - 1;
    p->points = strtoll(points + strlen("NumberOfPoints=\""), NULL, 10);
    if (p->points < 0 || p->points > INT32_MAX)
        return broken(f->run->errors, p->path, "its number of points is not usable");
    for (const char *tag = strstr(head, "<DataArray "); tag; tag = strstr(tag + 1, "<DataArray ")) {
        const char *end = strchr(tag, '>');
        if (!end || !take_array(p, tag, end))
            return broken(f->run->errors, p->path, "an array cannot be read");
    }
    f->points += p->points;
    return take_parts(f, head);
}

/* The first 64 KiB of a file, 0-terminated. */
static mps_status read_head(vtp_frame *f, const char *path, char **head, size_t *size)
{
    *head = NULL;
    FILE *file;
    const mps_status status = mps__page_open(f->run, path, &file);
    if (status == MPS_E_NAME)
        return mps__page_fail(f->run->errors, MPS_E_IO, "cannot open '%s': %s", path,
                              strerror(ENOENT));
    if (status != MPS_OK) return status;
    *head = malloc(HEAD_MOST + 1);
    if (*head) {
        *size = fread(*head, 1, HEAD_MOST, file);
        (*head)[*size] = '\0';
    }
    fclose(file);
    return *head ? MPS_OK : mps__page_fail(f->run->errors, MPS_E_NOMEM, "no memory for the page");
}

/* Takes ownership of `path`. */
static mps_status add_piece(vtp_frame *f, char *path)
{
    char *head = NULL;
    size_t size = 0;
    vtp_piece *more = path && f->pieces < PIECES_MOST
                          ? mps__grown(f->piece, f->pieces, sizeof *more)
                          : NULL;
    if (!more) {
        free(path);
        return mps__page_fail(f->run->errors, MPS_E_NOMEM, "no memory for the page");
    }
    f->piece = more;
    vtp_piece *p = &more[f->pieces++];
    memset(p, 0, sizeof *p);
    p->path = path;
    mps_status status = read_head(f, path, &head, &size);
    if (status == MPS_OK && head) status = take_head(f, p, head, size);
    free(head);
    return status;
}

/* A piece is in the folder of the file that names it. */
static char *path_beside(const char *path, const char *name, size_t length)
{
    const char *slash = strrchr(path, '/');
    const size_t folder = slash ? (size_t)(slash - path) + 1 : 0;
    char *out = malloc(folder + length + 1);
    if (!out) return NULL;
    memcpy(out, path, folder);
    memcpy(out + folder, name, length);
    out[folder + length] = '\0';
    return out;
}

static mps_status open_pieces(vtp_frame *f, const char *path)
{
    char *text = NULL;
    mps_status status = mps__page_file(f->run, path, 64 << 20, &text, NULL);
    if (status == MPS_E_NAME) status = broken(f->run->errors, path, "there is no such file");
    const char *tag = text;
    while (status == MPS_OK && (tag = strstr(tag, "<Piece Source=\"")) != NULL) {
        tag += strlen("<Piece Source=\"");
        status = add_piece(f, path_beside(path, tag, strcspn(tag, "\"")));
    }
    if (status == MPS_OK && f->pieces == 0) status = broken(f->run->errors, path, "names no piece");
    free(text);
    return status;
}

mps_status mps__vtp_open(vtp_frame *f, const page_run *run, const char *path)
{
    const size_t length = strlen(path);
    *f = (vtp_frame){.run = run};
    mps_status status = length > 5 && strcmp(path + length - 5, ".pvtp") == 0
                            ? open_pieces(f, path)
                            : add_piece(f, strdup(path));
    if (status != MPS_OK) mps__vtp_close(f);
    return status;
}

void mps__vtp_close(vtp_frame *f)
{
    for (int32_t k = 0; k < f->pieces; k++) free(f->piece[k].path);
    free(f->piece);
    free(f->parts);
    *f = (vtp_frame){0};
}

static const vtp_array *find(const vtp_piece *p, const char *name)
{
    for (int32_t k = 0; k < p->arrays; k++)
        if (strcmp(p->array[k].name, name) == 0) return &p->array[k];
    return NULL;
}

int32_t mps__vtp_width(const vtp_frame *f, const char *name)
{
    int32_t width = 0;
    for (int32_t k = 0; k < f->pieces; k++) {
        const vtp_array *a = find(&f->piece[k], name);
        if (!a || (k > 0 && a->width != width)) return 0;
        width = a->width;
    }
    return width;
}

static double number_at(const unsigned char *at, char type)
{
    float single;
    double real = 0;
    int32_t whole;
    int64_t large;
    switch (type) {
    case 'b':
        return *at;
    case 'f':
        memcpy(&single, at, sizeof single);
        return (double)single;
    case 'i':
        memcpy(&whole, at, sizeof whole);
        return whole;
    case 'l':
        memcpy(&large, at, sizeof large);
        return (double)large;
    default:
        memcpy(&real, at, sizeof real);
        return real;
    }
}

/* Read numbers of one array from the present file position. @return false: premature end of file */
static bool read_numbers(FILE *file, char type, int64_t count, double *out)
{
    unsigned char block[BLOCK];
    const size_t size = type_size(type), most = sizeof block / size;
    uint64_t bytes = 0;
    if (fread(&bytes, sizeof bytes, 1, file) != 1 || bytes != (uint64_t)count * size) return false;
    while (count > 0) {
        const size_t n = (uint64_t)count < most ? (size_t)count : most;
        if (fread(block, size, n, file) != n) return false;
        for (size_t i = 0; i < n; i++) *out++ = number_at(block + i * size, type);
        count -= (int64_t)n;
    }
    return true;
}

mps_status mps__vtp_read(const vtp_frame *f, const char *name, double *out)
{
    for (int32_t k = 0; k < f->pieces; k++) {
        const vtp_piece *p = &f->piece[k];
        const vtp_array *a = find(p, name);
        if (!a)
            return mps__page_fail(f->run->errors, MPS_E_IO, "frame '%s' has no '%s'", p->path,
                                  name);
        FILE *file;
        const mps_status status = mps__page_open(f->run, p->path, &file);
        const bool good = status == MPS_OK && a->offset < INT64_MAX / 2 &&
                          fseek(file, p->base + (long)a->offset, SEEK_SET) == 0 &&
                          read_numbers(file, a->type, p->points * a->width, out);
        if (file) fclose(file);
        if (!good)
            return mps__page_fail(f->run->errors, MPS_E_IO, "frame '%s': '%s' is not complete",
                                  p->path, name);
        out += p->points * a->width;
    }
    return MPS_OK;
}
