/* SPDX-License-Identifier: BSD-3-Clause */
/* mps info: detects the type of a file from its contents, and describes it. */
#include "cli.h"
#include "csv.h"
#include "escape.h"
#include "info.h"
#include "record.h"
#include "regular.h"
#include "summary.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

bool is_text(const head *h)
{
    for (size_t i = 0; i < h->count; i++) {
        const char c = h->text[i];
        if ((unsigned char)c < ' ' && c != '\t' && c != '\n' && c != '\r' && c != '\f')
            return false;
    }
    return true;
}

/* ---- kinds of files ---- */

/* A checkpoint: a header of 16 bytes, then parts with title, bytes per element, checksum, number of
 * elements. */
enum { TITLE = 40, PART = TITLE + 16 };

typedef struct part {
    char title[TITLE];
    uint32_t bytes;
    int64_t elements;
} part;

/* Read the header of the next part; the file is then at its elements.
 * @return false: it is truncated or damaged */
static bool read_part(const head *h, part *p)
{
    char text[PART];
    if (fread(text, 1, PART, h->file) != PART) return false;
    memcpy(p->title, text, TITLE);
    memcpy(&p->bytes, text + TITLE, sizeof p->bytes);
    memcpy(&p->elements, text + TITLE + 8, sizeof p->elements);
    p->title[TITLE - 1] = '\0';
    return p->elements >= 0 && p->bytes <= 1u << 30 && p->elements <= h->size;
}

static long long length_of(const part *p)
{
    return (p->elements * (long long)p->bytes + 7) / 8 * 8;
}

/* A part as a number of 8 bytes. */
static bool read_number(const head *h, const part *p, const char *title, void *out)
{
    if (strcmp(p->title, title) != 0 || p->bytes != 8 || p->elements != 1) return false;
    return fread(out, 8, 1, h->file) == 1 && fseek(h->file, -8, SEEK_CUR) == 0;
}

static bool describe_checkpoint(const head *h)
{
    part p;
    double t = NAN;
    int64_t step = -1;
    bool whole = false;
    if (h->count < 16 || memcmp(h->text, "mpsstate", 8) != 0) return false;
    for (int pass = 0; pass < 2; pass++) {
        if (fseek(h->file, 16, SEEK_SET) != 0) return true;
        if (pass == 1) {
            printf("checkpoint of a run");
            if (step >= 0) printf(" at t = %.9g s, after %lld steps", t, (long long)step);
            printf(", %lld bytes; 'mps resume' continues from its folder\n", h->size);
        }
        while (read_part(h, &p)) {
            whole = strcmp(p.title, "end") == 0;
            if (whole) break;
            if (pass == 0)
                (void)(read_number(h, &p, "state.t", &t) ||
                       read_number(h, &p, "state.step", &step));
            if (pass == 1)
                printf("  %-24s %lld numbers of %u bytes\n", p.title, (long long)p.elements,
                       (unsigned)p.bytes);
            if (fseek(h->file, (long)length_of(&p), SEEK_CUR) != 0) break;
        }
    }
    if (!whole) printf("  it is cut short, or damaged\n");
    return true;
}

/* Find the value of an XML attribute. */
static bool attribute(const char *text, const char *name, char *out, size_t size)
{
    char key[48];
    snprintf(key, sizeof key, "%s=\"", name);
    const char *at = strstr(text, key);
    if (!at) return false;
    at += strlen(key);
    snprintf(out, size, "%.*s", (int)strcspn(at, "\""), at);
    return true;
}

static bool describe_frame(const head *h)
{
    char points[32], name[64];
    if (!strstr(h->text, "<VTKFile") ||
        !attribute(h->text, "NumberOfPoints", points, sizeof points))
        return false;
    printf("frame of particles for ParaView, %s particles, %lld bytes\n", points, h->size);
    for (const char *at = h->text; (at = strstr(at, "<DataArray")) != NULL; at++)
        if (attribute(at, "Name", name, sizeof name)) printf("  %s\n", name);
    return true;
}

static bool describe_series(const head *h)
{
    if (!strstr(h->text, "<VTKFile") || !strstr(h->text, "type=\"Collection\"")) return false;
    printf("series of frames for ParaView, %lld bytes\n", h->size);
    return true;
}

static bool describe_page(const head *h)
{
    if (!strstr(h->text, "<!DOCTYPE html") && !strstr(h->text, "<html")) return false;
    printf("page, %lld bytes; open it in a browser; 'mps run' runs the case that it carries\n",
           h->size);
    return true;
}

static bool describe_case(const head *h)
{
    if (!is_text(h)) return false;
    if (strncmp(h->text, "mps:", 4) != 0 && !strstr(h->text, "\nmps:")) return false;
    const char *title = strstr(h->text, "\ntitle:");
    printf("case%s%.*s; 'mps check' tells what it means\n", title ? ": " : "",
           title ? (int)strcspn(title + 8, "\n") : 0, title ? title + 8 : "");
    return true;
}

static bool describe_summary(const head *h)
{
    const char *first = h->text + 1 + strspn(h->text + (h->count > 0), " \t\r\n");
    if (!is_text(h) || h->text[0] != '{' || (*first != '"' && *first != '}')) return false;
    printf("summary of a run or other JSON, %lld bytes\n", h->size);
    return true;
}

/* Read the numbers of the first column, or of none if they are texts. Words between blanks are no
 * table of texts.
 * @return false: it is no table */
static bool read_first(const head *h, mps__csv *t, bool numbers)
{
    if (mps__csv_open(t, h->path, CSV_OWN | CSV_ROUND) != CSV_OK || t->columns < 2) return false;
    for (int32_t k = 0; k < t->columns; k++) t->wanted[k] = numbers && k == 0;
    return mps__csv_read(t) == CSV_OK;
}

/* Describe a table: names of the columns, rows, first and last value of the first column. */
static bool describe_table(head *h)
{
    mps__csv t;
    const char *separator = strpbrk(h->text, "\t;,\n");
    if (!is_text(h)) return false;
    const bool separated = separator && *separator != '\n';
    bool good = read_first(h, &t, true) && (separated || t.rows > 0);
    if (!good && separated) {
        mps__csv_free(&t);
        good = read_first(h, &t, false);
        snprintf(h->why, sizeof h->why, "%s", t.why);
    }
    if (good) {
        printf("table\n");
        for (int32_t k = 0; k < t.columns; k++)
            printf("  %s%s%s%s\n", t.name[k], t.unit[k][0] ? " [" : "", t.unit[k],
                   t.unit[k][0] ? "]" : "");
        printf("%lld rows", (long long)t.rows);
        if (t.rows > 0 && t.value[0])
            printf(", first column %.9g .. %.9g", t.value[0][0], t.value[0][t.rows - 1]);
        printf("\n");
    }
    mps__csv_free(&t);
    return good;
}

/* ---- all ---- */

static int describe(head *h)
{
    static bool (*const kinds[])(const head *) = {
        describe_checkpoint, describe_frame,   describe_series, describe_page,
        describe_case,       describe_summary, info_surface};
    h->count = fread(h->text, 1, HEAD, h->file);
    h->text[h->count] = '\0';
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (kinds[i](h)) return MPS_EXIT_OK;
    if (describe_table(h)) return MPS_EXIT_OK;
    fprintf(stderr, "mps info: %s: is no file of mps%s%s\n", h->path,
            h->why[0] ? "; as a table: " : "", h->why);
    return MPS_EXIT_USAGE;
}

/* Print the case of a run, and its progress. */
static void print_run(const char *path)
{
    char name[SUMMARY_TEXT] = "", title[SUMMARY_TEXT] = "", state[400], place[4096];
    summary_text(path, "case", name);
    summary_text(path, "title", title);
    printf("folder of a run%s%s%s%s\n", name[0] ? " of " : "", name,
           strcmp(name, title) != 0 ? ": " : "", strcmp(name, title) != 0 ? title : "");
    mps__shell_word(path, place, sizeof place);
    if (summary_unfinished(path, record_last(path), state, sizeof state))
        printf("  %s\n", state);
    else if (summary_is_done(path))
        printf("  done, to t = %.9g s, %.9g steps; 'mps resume %s --set run.until=..' extends it\n",
               summary_number(path, "t_end"), summary_number(path, "steps"), place);
}

/* Describe the outputs in the folder of a run. */
static int describe_folder(const char *path)
{
    static const struct {
        const char *file, *what;
    } parts[] = {{"report.html", "page; open it in a browser"},
                 {"probes.csv", "table of the sensors; 'mps stats' finds its impacts"},
                 {"summary.json", "summary of the run"},
                 {"film.mp4", "film"},
                 {"frames.pvd", "frames of particles, for ParaView"},
                 {"checkpoint.mps", "checkpoint; 'mps resume' continues from it"}};
    int found = 0;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        char place[4096];
        struct stat status;
        snprintf(place, sizeof place, "%s/%s", path, parts[i].file);
        if (stat(place, &status) != 0 || !S_ISREG(status.st_mode)) continue;
        if (found++ == 0) print_run(path);
        printf("  %-16s %s\n", parts[i].file, parts[i].what);
    }
    if (found > 0) return MPS_EXIT_OK;
    fprintf(stderr, "mps info: %s: is a folder without outputs of a run\n", path);
    return MPS_EXIT_USAGE;
}

int verb_info(const choices *c)
{
    static head h;
    struct stat status;
    const char *why;
    h.path = c->file[0];
    if (stat(h.path, &status) == 0 && S_ISDIR(status.st_mode)) return describe_folder(h.path);
    FILE *file = mps__regular_stream(h.path, O_RDONLY, &why);
    if (!file || fstat(fileno(file), &status) != 0) {
        fprintf(stderr, "mps info: %s: %s\n", h.path, why ? why : strerror(errno));
        if (file) fclose(file);
        return MPS_EXIT_USAGE;
    }
    h.file = file;
    h.size = (long long)status.st_size;
    const int code = describe(&h);
    fclose(file);
    return code;
}
