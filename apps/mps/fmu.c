/* SPDX-License-Identifier: BSD-3-Clause */
/* mps fmu: exports a case as an FMU, which programs with bodies import. */
#include "fmu.h"
#include "cli.h"
#include "regular.h"
#include "run_file.h"
#include "zip.h"
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <mps/mps.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ERROR_SIZE = 8192, PATH_SIZE = 1024 };

typedef struct part {
    char *data;
    size_t size;
} part;

static int refuse(const choices *c, int code, const char *what, const char *why)
{
    fprintf(stderr, "mps %s: %s: %s\n", c->verb, what, why);
    return code;
}

/* Open the module in the folder of the program, or in its installed folder beside that one. NULL:
 * not found, with errno, or *why */
static FILE *open_module(char *path, size_t size, const char **why)
{
    static const char name[] = "libmps_fmu.so";
    if (mps__program_file(name, MODULE_FOLDER, path, size))
        return mps__regular_stream(path, O_RDONLY, why);
    *why = NULL;
    snprintf(path, size, "%s", name);
    errno = ENOENT;
    return NULL;
}

/* Read a whole file, and close it. @return false: errno, 0: it is empty */
static bool read_part(part *p, FILE *file)
{
    p->data = mps__file_read(file, SIZE_MAX, &p->size);
    const int why = p->data ? 0 : errno;
    fclose(file);
    errno = why;
    return p->data && p->size > 0;
}

static bool write_part(part *p, void (*write)(FILE *, const fmu_about *), const fmu_about *a)
{
    FILE *out = open_memstream(&p->data, &p->size);
    if (!out) return false;
    write(out, a);
    int failed = ferror(out);
    failed |= fclose(out);
    return failed == 0;
}

static void describe(fmu_about *a, const choices *c, const mps_case *tank)
{
    cli_stem(c->file[0], a->name, sizeof a->name);
    snprintf(a->identifier, sizeof a->identifier, "%s", a->name);
    for (char *at = a->identifier; *at; at++)
        if (!isalnum((unsigned char)*at)) *at = '_';
    if (!isalpha((unsigned char)a->identifier[0])) a->identifier[0] = '_';
    fmu_token(mps_case_text(tank), a->token);
}

/* With --quiet. */
static void print_nothing(void *user, int32_t kind, const char *text)
{
    (void)user, (void)kind, (void)text;
}

/* Build the simulation of the case to check that it runs. Its sensors are known then. */
static bool open_model(const choices *c, mps_case *tank, fmu_model *m)
{
    char error[ERROR_SIZE] = "";
    if (fmu_model_open(m, tank, c->quiet ? print_nothing : NULL, NULL, error, sizeof error))
        return true;
    /* messages of the case end with a newline, one of the system does not */
    fprintf(stderr, "mps %s: %s%s", c->verb, error, strchr(error, '\n') ? "" : "\n");
    return false;
}

static void close_model(fmu_model *m)
{
    m->c = NULL; /* the caller owns it */
    fmu_model_close(m);
}

/* Write all files of the FMU to a temporary file, which then replaces `path`. */
static bool write_fmu(const char *path, const fmu_about *a, const part *p, const char *text)
{
    char name[PATH_SIZE], next[PATH_SIZE + 8];
    zip z = {.count = 0};
    snprintf(next, sizeof next, "%s.tmp", path);
    z.file = fopen(next, "wb");
    if (!z.file) return false;
    zip_add(&z, "modelDescription.xml", p[0].data, p[0].size);
    snprintf(name, sizeof name, "binaries/%s/%s.so",
             a->version == 2 ? "linux64" : MODULE_PROCESSOR "-linux", a->identifier);
    zip_add(&z, name, p[2].data, p[2].size);
    zip_add(&z, "resources/case.yaml", text, strlen(text));
    zip_add(&z, "documentation/index.html", p[1].data, p[1].size);
    zip_end(&z);
    if (fclose(z.file) != 0) z.failed = true;
    if (!z.failed && rename(next, path) == 0) return true;
    const int why = errno;
    unlink(next);
    errno = why;
    return false;
}

/* Detect failures here, not in the importer: models without the load that importers read. */
static bool takes_step(const choices *c, mps_sim *sim)
{
    if (mps_load_watch(sim, MPS_LOAD_MASS) >= 0 && mps_step(sim, 1, NULL) >= 0) return true;
    refuse(c, MPS_EXIT_USAGE, c->file[0], mps_sim_error(sim));
    return false;
}

static int make(const choices *c, mps_case *tank, const char *path)
{
    fmu_about a = {.version = c->fmi ? c->fmi : 3};
    part p[3] = {{NULL, 0}};
    char module[PATH_SIZE + 128];
    int code = MPS_EXIT_OK;
    if (!open_model(c, tank, &a.model)) {
        close_model(&a.model);
        return MPS_EXIT_USAGE;
    }
    describe(&a, c, tank);
    const char *why;
    FILE *file = open_module(module, sizeof module, &why);
    if (!file || !read_part(&p[2], file))
        code = refuse(c, MPS_EXIT_FAILED, module,
                      why     ? why
                      : errno ? strerror(errno)
                              : "it is empty");
    else if (!write_part(&p[0], fmu_write_description, &a) ||
             !write_part(&p[1], fmu_write_page, &a))
        code = refuse(c, MPS_EXIT_FAILED, path, "no memory");
    else if (!takes_step(c, a.model.sim))
        code = MPS_EXIT_USAGE;
    else if (!write_fmu(path, &a, p, mps_case_text(tank)))
        code = refuse(c, MPS_EXIT_FAILED, path, strerror(errno));
    else if (!c->quiet)
        printf("%s: FMI %d.0, co-simulation, %s\n", path, (int)a.version, a.token);
    for (int k = 0; k < 3; k++) free(p[k].data);
    close_model(&a.model);
    return code;
}

int verb_fmu(const choices *c)
{
    char path[PATH_SIZE], stem[PATH_SIZE - 8];
    int code = MPS_EXIT_FAILED;
    if (c->fmi && c->fmi != 2 && c->fmi != 3)
        return refuse(c, MPS_EXIT_USAGE, "--fmi", "must be 2 or 3");
    cli_stem(c->file[0], stem, sizeof stem);
    snprintf(path, sizeof path, "%s.fmu", stem);
    if (c->out && strlen(c->out) >= sizeof path - 8)
        return refuse(c, MPS_EXIT_USAGE, "--out", "is too long");
    if (c->out) snprintf(path, sizeof path, "%s", c->out);
    mps_case *tank = cli_case(c, &code);
    if (!tank) return code;
    if (mps_case_plugin(tank, 0)) {
        mps_case_destroy(tank);
        return refuse(c, MPS_EXIT_USAGE, "plugins",
                      "an FMU has a libmps of its own, which plug-ins cannot use; couple the case "
                      "by 'mps run', or by a program that loads the plug-in");
    }
    code = make(c, tank, path);
    mps_case_destroy(tank);
    return cli_flush(c, code);
}
