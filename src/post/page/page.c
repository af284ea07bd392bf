/* SPDX-License-Identifier: BSD-3-Clause */
/* report.html of a run: its parts are written to unnamed files, then to a temporary file that is
 * renamed. */
#include "page_assets.h"
#include "page_parts.h"
#include "page_text.h"
#include "run_file.h"
#include <errno.h>
#include <mps/page.h>
#include <mps/stats.h>
#include <stdlib.h>
#include <string.h>

enum { BYTES_LEAST = 500000, BYTES_DEFAULT = 12000000 };

static const mps_page_config config_default = {.struct_size = sizeof(mps_page_config),
                                               .bytes = BYTES_DEFAULT};
static const mps_page_info info_default = {.struct_size = sizeof(mps_page_info)};

mps_status mps_page_config_init(mps_page_config *config, size_t size)
{
    if (!config || size != sizeof *config) return MPS_E_ARG;
    *config = config_default;
    return MPS_OK;
}

mps_status mps_page_info_init(mps_page_info *info, size_t size)
{
    if (!info || size != sizeof *info) return MPS_E_ARG;
    *info = info_default;
    return MPS_OK;
}

/* A part of the page, in an unnamed file. Not in memory: a stream to memory does not report every
 * failure. */
typedef struct part {
    FILE *out;
    int64_t size; /* -1: it is incomplete */
} part;

static mps_status part_fail(const page_run *r)
{
    return mps__page_fail(r->errors, MPS_E_IO, "cannot write a part of the page in '%s': %s",
                          r->folder, strerror(errno));
}

static mps_status part_open(part *p, const page_run *r)
{
    char *path = mps__page_path(r->folder, "report.html.part");
    if (!path) return mps__page_fail(r->errors, MPS_E_NOMEM, "no memory for the page");
    p->out = mps__run_create(path, "w+b");
    mps_status status = p->out ? MPS_OK : part_fail(r);
    if (p->out) remove(path); /* the file exists until it is closed */
    p->size = -1;
    free(path);
    return status;
}

/* Complete the part. @return status, or MPS_E_IO */
static mps_status part_end(part *p, const page_run *r, mps_status status)
{
    if (status != MPS_OK) return status;
    if (fflush(p->out) == 0 && !ferror(p->out)) p->size = ftell(p->out);
    return p->size < 0 ? part_fail(r) : MPS_OK;
}

/* @return false: it cannot be read back */
static bool part_copy(const part *p, FILE *out)
{
    char block[1 << 14];
    int64_t left = p->size;
    rewind(p->out);
    while (left > 0) {
        const size_t most = left < (int64_t)sizeof block ? (size_t)left : sizeof block;
        if (fread(block, 1, most, p->out) != most) return false;
        fwrite(block, 1, most, out);
        left -= (int64_t)most;
    }
    return true;
}

static void part_close(part *p)
{
    if (p->out) fclose(p->out);
}

static void write_asset(FILE *out, const unsigned char *data, size_t size)
{
    fwrite(data, 1, size, out);
}

/* Write a module into an element with other modules: without its imports and the word "export". */
static void write_module(FILE *out, const unsigned char *data, size_t size)
{
    const char *line = (const char *)data, *const end = line + size;
    while (line < end) {
        const char *stop = memchr(line, '\n', (size_t)(end - line));
        size_t length = stop ? (size_t)(stop - line) + 1 : (size_t)(end - line);
        const size_t skip = length > 7 && strncmp(line, "export ", 7) == 0 ? 7 : 0;
        if (length < 7 || strncmp(line, "import ", 7) != 0)
            fwrite(line + skip, 1, length - skip, out);
        line += length;
    }
}

static void write_begin(FILE *out, const page_run *r)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<meta name=\"color-scheme\" content=\"light dark\">\n"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src "
          "'unsafe-inline'; style-src 'unsafe-inline'; img-src data:\">\n<title>",
          out);
    mps__html(out, mps__page_title(r));
    fputs("</title>\n<style>\n", out);
    write_asset(out, mps__page_plot_style, mps__page_plot_style_size);
    write_asset(out, mps__page_style, mps__page_style_size);
    fputs("</style></head>\n<body>\n<a class=\"skip\" href=\"#film\">To the film</a>\n", out);
    mps__page_head(out, r);
    fputs("<main>\n<noscript><p class=\"warning\">Film and curves need JavaScript. Verdict, tables "
          "and "
          "pictures are below.</p></noscript>\n",
          out);
    mps__page_summary(out, r);
}

static void write_scripts(FILE *out)
{
    fputs("<script>\n/*\n", out);
    write_asset(out, mps__page_plot_licence, mps__page_plot_licence_size);
    fputs("\n*/\n", out);
    write_asset(out, mps__page_plot, mps__page_plot_size);
    fputs("\n</script>\n<script type=\"module\">\n", out);
    write_module(out, mps__page_decode, mps__page_decode_size);
    write_module(out, mps__page_curves_js, mps__page_curves_js_size);
    write_module(out, mps__page_view, mps__page_view_size);
    write_module(out, mps__page_main, mps__page_main_size);
    fputs("</script>\n", out);
}

/* Write all that follows the film. */
static mps_status write_rest(FILE *out, const page_run *r, int64_t bytes)
{
    mps__page_sketch(out, r);
    mps_status status = mps__page_comparison(out, r);
    if (status == MPS_OK) status = mps__page_impacts(out, r, bytes / 10);
    mps__page_forces(out, r);
    mps__page_budget(out, r);
    if (status == MPS_OK && r->frames == 0) status = mps__page_pictures(out, r, bytes / 2);
    mps__page_about(out, r);
    fputs("</main>\n<footer>Made by libmps ", out);
    mps__html(out, mps__page_string(r, "version"));
    fputs(". Plots: uPlot, (c) Leon Sorokin, MIT licence.</footer>\n", out);
    if (status == MPS_OK) status = mps__page_curves(out, r, bytes / 6);
    write_scripts(out);
    return status;
}

/* ---- the file -------------------------------------------------------------------------------- */

static mps_status cannot(const page_run *r, const char *what, const char *path)
{
    return mps__page_fail(r->errors, MPS_E_IO, "cannot %s '%s': %s", what, path, strerror(errno));
}

/* Parts of a page in their order: begin, film, rest; the stage is between begin and rest. */
typedef struct page {
    part begin, film, rest;
    int64_t shown[2];
    char note[320];
} page;

static bool write_page(FILE *out, const page_run *r, const page *p)
{
    bool good = part_copy(&p->begin, out);
    mps__page_stage(out, r, p->shown[0] > 0, p->note);
    good = part_copy(&p->rest, out) && good;
    good = part_copy(&p->film, out) && good;
    fputs("</body></html>\n", out);
    return good;
}

static mps_status save(const page_run *r, const page *p, int64_t *bytes)
{
    char *path = mps__page_path(r->folder, "report.html");
    char *other = mps__page_path(r->folder, "report.html.tmp");
    mps_status status = MPS_OK;
    FILE *out = path && other ? mps__run_create(other, "wb") : NULL;
    if (!path || !other)
        status = mps__page_fail(r->errors, MPS_E_NOMEM, "no memory for the page");
    else if (!out)
        status = cannot(r, "create", other);
    if (out) {
        const bool good = write_page(out, r, p) && fflush(out) == 0 && ferror(out) == 0;
        *bytes = ftell(out);
        if (fclose(out) != 0 || !good || *bytes < 0)
            status = cannot(r, "write", other);
        else if (rename(other, path) != 0)
            status = cannot(r, "replace", path);
        if (status != MPS_OK) remove(other);
    }
    free(path);
    free(other);
    return status;
}

static mps_status make_film(page *p, const page_run *r, int64_t bytes, int32_t frames)
{
    film f;
    mps_status status = mps__film_survey(&f, r);
    if (status == MPS_OK) status = part_open(&p->film, r);
    if (status == MPS_OK)
        status = mps__film_write(&f, bytes, frames, p->film.out, p->note, sizeof p->note, p->shown);
    status = part_end(&p->film, r, status);
    mps__film_free(&f);
    return status;
}

static mps_status make_parts(page *p, const page_run *r, const mps_page_config *config)
{
    enum { STAGE = 6000 }; /* upper bound of the stage and its note */
    mps_status status = part_open(&p->begin, r);
    if (status == MPS_OK) {
        write_begin(p->begin.out, r);
        status = part_end(&p->begin, r, status);
    }
    if (status == MPS_OK) status = part_open(&p->rest, r);
    if (status == MPS_OK) status = part_end(&p->rest, r, write_rest(p->rest.out, r, config->bytes));
    const int64_t left = config->bytes - p->begin.size - p->rest.size - STAGE;
    if (status == MPS_OK && left < 0)
        status = mps__page_fail(r->errors, MPS_E_ARG,
                                "bytes is %lld: without a film the page has %lld already",
                                (long long)config->bytes, (long long)(config->bytes - left));
    return status == MPS_OK ? make_film(p, r, left, config->frames) : status;
}

static void fill_info(mps_page_info *info, const page *p, int64_t bytes)
{
    if (!info) return;
    info->frames = (int32_t)p->shown[0];
    info->particles = p->shown[1];
    info->bytes = bytes;
    snprintf(info->left_out, sizeof info->left_out, "%s", p->note);
}

static mps_status write_folder(const char *folder, const mps_page_config *config, page_errors *e,
                               mps_page_info *info)
{
    page_run r;
    page p = {.note = ""};
    int64_t bytes = 0;
    mps_status status = mps__page_run_read(&r, folder, e);
    r.impacts = config->impacts;
    if (status == MPS_OK) status = mps__page_peaks_read(&r);
    if (status == MPS_OK) status = make_parts(&p, &r, config);
    if (status == MPS_OK) status = save(&r, &p, &bytes);
    if (status == MPS_OK) fill_info(info, &p, bytes);
    part_close(&p.begin);
    part_close(&p.film);
    part_close(&p.rest);
    mps__page_run_free(&r);
    return status;
}

mps_status mps_page_write(const char *folder, const mps_page_config *config, mps_page_info *info)
{
    if (!config) config = &config_default;
    if (config->struct_size != sizeof *config) return MPS_E_ARG;
    page_errors e = {config->error, config->error_size};
    if (e.text && e.size > 0) e.text[0] = '\0';
    if (!folder) return mps__page_fail(&e, MPS_E_ARG, "folder is NULL");
    if (info && info->struct_size != sizeof *info)
        return mps__page_fail(&e, MPS_E_ARG, "info: call mps_page_info_init() first");
    if (config->bytes < BYTES_LEAST)
        return mps__page_fail(&e, MPS_E_ARG, "bytes is %lld: %d or more", (long long)config->bytes,
                              BYTES_LEAST);
    if (config->frames < 0)
        return mps__page_fail(&e, MPS_E_ARG, "frames is %d: 0 or more", (int)config->frames);
    mps_stats_constant first = {.struct_size = sizeof first};
    if (config->impacts && mps_stats_constant_get(config->impacts, 0, &first) != MPS_OK)
        return mps__page_fail(&e, MPS_E_ARG, "impacts: call mps_stats_config_init() first");
    return write_folder(folder, config, &e, info);
}
