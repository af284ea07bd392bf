/* SPDX-License-Identifier: BSD-3-Clause */
/* Frames for ParaView: XML PolyData (.vtp) with appended raw data, and the .pvd series that names them with their times.
 * Every file is written beside its place and renamed, so that a reader never sees half a file. */
#define _POSIX_C_SOURCE 200809L
#include "frames.h"
#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { NAME_SIZE = 48, CHUNK = 512, COLUMNS = MPS__FIELDS_MAX + 4, LINE_SIZE = 256 };

struct mps_frames {
    mps__world *world; /* borrowed */
    int32_t kinds;
    char name[NAME_SIZE];
    char *folder, *path, *temporary; /* the last two are room for file names */
    size_t path_size;
    int64_t count, capacity;
    double *times;
    bool continues; /* frames of a run before this one are in it */
};

/* How a column's numbers are stored in the file. */
typedef enum stored { AS_FLOAT32, AS_FLOAT64, AS_UINT8, AS_INT64 } stored;

static const struct {
    const char *name;
    size_t size;
} stored_type[] = {{"Float32", 4}, {"Float64", 8}, {"UInt8", 1}, {"Int64", 8}};

/* One array of a frame. */
typedef struct column {
    const char *name;
    stored type;
    /* numbers per particle in memory and in the file; the file's third of a 2-D vector is zero */
    int32_t stride, width;
    const void *data;
} column;

typedef struct frame {
    const mps_frames *series;
    const mps__particles *s;
    FILE *file;
    int64_t points;
    uint64_t offset; /* where the next array begins behind the '_' */
    int32_t columns;
    column column[COLUMNS];
} frame;

static mps_status io_failed(const mps_frames *f, const char *what, const char *path)
{
    return mps__fail(f->world->context, MPS_E_IO, "cannot %s \"%.300s\": %s", what, path,
                     strerror(errno));
}

/* A number as XML wants it, whatever the host program's locale says about the decimal point. */
static const char *number(char out[32], double value)
{
    snprintf(out, 32, "%.17g", value);
    for (char *c = out; *c; c++)
        if (*c == ',') *c = '.';
    return out;
}

/* What number() wrote, as strtod() wants it. */
static double number_back(const char *text)
{
    char own[32], half[8];
    snprintf(half, sizeof half, "%.1f", 0.5);
    snprintf(own, sizeof own, "%.31s", text);
    for (char *c = own; *c; c++)
        if (*c == '.') *c = half[1];
    return strtod(own, NULL);
}

static void print_escaped(FILE *file, const char *text)
{
    for (; *text; text++) switch (*text) {
        case '&':
            fputs("&amp;", file);
            break;
        case '<':
            fputs("&lt;", file);
            break;
        case '>':
            fputs("&gt;", file);
            break;
        case '"':
            fputs("&quot;", file);
            break;
        default:
            fputc((unsigned char)*text < 0x20 ? '_' : *text, file);
        }
}

static const char *byte_order(void)
{
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first ? "LittleEndian" : "BigEndian";
}

static bool selected(const frame *f, int64_t i)
{
    return (f->series->kinds >> f->s->kind[i] & 1) != 0 && !mps__is_shadow(f->s, i);
}

/* ---- columns ---- */

static void add_column(frame *f, const char *name, stored type, int32_t stride, const void *data)
{
    bool vector = type <= AS_FLOAT64 && stride == 2 && f->s->dim == 2;
    f->column[f->columns++] = (column){name, type, stride, vector ? 3 : stride, data};
}

/* Points first, then what belongs to them. */
static void list_columns(frame *f)
{
    const mps__particles *s = f->s;
    add_column(f, "position", AS_FLOAT32, s->dim, s->x);
    add_column(f, "velocity", AS_FLOAT32, s->dim, s->u);
    add_column(f, "pressure", AS_FLOAT32, 1, s->p);
    add_column(f, "number_density", AS_FLOAT32, 1, s->nd);
    add_column(f, "density", AS_FLOAT32, 1, s->rho);
    add_column(f, "kind", AS_UINT8, 1, s->kind);
    add_column(f, "phase", AS_UINT8, 1, s->phase);
    add_column(f, "id", AS_INT64, 1, s->id);
    for (int32_t k = 0; k < s->fields; k++)
        if (s->field[k].data == &s->field[k].own && s->field[k].is_public)
            add_column(f, s->field[k].name, AS_FLOAT64, s->field[k].components, s->field[k].own);
}

static uint64_t column_bytes(const frame *f, const column *c)
{
    return (uint64_t)f->points * (uint64_t)c->width * stored_type[c->type].size;
}

static void print_array(frame *f, const char *name, const char *type, int32_t width, uint64_t bytes)
{
    fprintf(f->file, "<DataArray type=\"%s\" Name=\"", type);
    print_escaped(f->file, name);
    fprintf(f->file, "\" NumberOfComponents=\"%d\" format=\"appended\" offset=\"%llu\"/>\n",
            (int)width, (unsigned long long)f->offset);
    f->offset += sizeof(uint64_t) + bytes;
}

static void print_column(frame *f, const column *c)
{
    print_array(f, c->name, stored_type[c->type].name, c->width, column_bytes(f, c));
}

static void print_xml(frame *f)
{
    char t[32];
    fprintf(f->file,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"%s\" "
            "header_type=\"UInt64\">\n<PolyData>\n",
            byte_order());
    fprintf(f->file,
            "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
            "format=\"ascii\">%s</DataArray></FieldData>\n",
            number(t, f->series->world->state.t));
    fprintf(f->file,
            "<Piece NumberOfPoints=\"%lld\" NumberOfVerts=\"%lld\" NumberOfLines=\"0\" "
            "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<Points>\n",
            (long long)f->points, (long long)f->points);
    print_column(f, &f->column[0]);
    fprintf(f->file, "</Points>\n<PointData>\n");
    for (int32_t k = 1; k < f->columns; k++) print_column(f, &f->column[k]);
    fprintf(f->file, "</PointData>\n<Verts>\n");
    print_array(f, "connectivity", "Int32", 1, (uint64_t)f->points * sizeof(int32_t));
    print_array(f, "offsets", "Int32", 1, (uint64_t)f->points * sizeof(int32_t));
    fprintf(f->file, "</Verts>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
}

/* ---- data ---- */

/* One number in the file's type; returns its bytes. */
static size_t store(unsigned char *out, const column *c, int64_t i, int32_t component)
{
    int64_t place = i * c->stride + component;
    bool padding = component >= c->stride;
    double d = c->type <= AS_FLOAT64 && !padding ? ((const double *)c->data)[place] : 0;
    float single = (float)d;
    switch (c->type) {
    case AS_FLOAT32:
        memcpy(out, &single, sizeof single);
        break;
    case AS_FLOAT64:
        memcpy(out, &d, sizeof d);
        break;
    case AS_UINT8:
        *out = (unsigned char)((const int32_t *)c->data)[place];
        break;
    case AS_INT64:
        memcpy(out, (const int64_t *)c->data + place, sizeof(int64_t));
        break;
    }
    return stored_type[c->type].size;
}

static void write_size(frame *f, uint64_t bytes)
{
    fwrite(&bytes, sizeof bytes, 1, f->file);
}

static void write_column(frame *f, const column *c)
{
    unsigned char block[CHUNK * 9 * 8];
    size_t used = 0, most = (size_t)c->width * stored_type[c->type].size;
    write_size(f, column_bytes(f, c));
    for (int64_t i = 0; i < f->s->n; i++) {
        if (!selected(f, i)) continue;
        for (int32_t k = 0; k < c->width; k++) used += store(block + used, c, i, k);
        if (used + most <= sizeof block) continue;
        fwrite(block, 1, used, f->file);
        used = 0;
    }
    fwrite(block, 1, used, f->file);
}

/* first, first + 1, ...: one number for each point. */
static void write_numbers(frame *f, int32_t first)
{
    int32_t block[CHUNK];
    write_size(f, (uint64_t)f->points * sizeof block[0]);
    for (int64_t k = 0; k < f->points;) {
        size_t count = 0;
        for (; k < f->points && count < CHUNK; k++) block[count++] = first + (int32_t)k;
        fwrite(block, sizeof block[0], count, f->file);
    }
}

/* One cell for each point, so that filters that choose cells choose particles. */
static void write_cells(frame *f)
{
    write_numbers(f, 0); /* points of the cells */
    write_numbers(f, 1); /* ends of the cells in that list */
}

static void write_frame(const mps_frames *series, FILE *file)
{
    frame f = {.series = series, .s = &series->world->particles, .file = file};
    for (int64_t i = 0; i < f.s->n; i++) f.points += selected(&f, i);
    list_columns(&f);
    print_xml(&f);
    for (int32_t k = 0; k < f.columns; k++) write_column(&f, &f.column[k]);
    write_cells(&f);
    fprintf(file, "\n</AppendedData>\n</VTKFile>\n");
}

static const char series_head[] = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" "
                                  "version=\"0.1\" byte_order=\"%s\">\n<Collection>\n";
static const char series_time[] = "<DataSet timestep=\"";
static const char series_end[] = "</Collection>\n</VTKFile>\n";

/* The line of frame k in the .pvd. */
static void series_line(const mps_frames *f, int64_t k, double time, char line[LINE_SIZE])
{
    char t[32];
    snprintf(line, LINE_SIZE, "%s%s\" part=\"0\" file=\"%s/%s_%06lld.vtp\"/>\n", series_time,
             number(t, time), f->name, f->name, (long long)k);
}

static void write_series(const mps_frames *f, FILE *file)
{
    char line[LINE_SIZE];
    fprintf(file, series_head, byte_order());
    for (int64_t k = 0; k < f->count; k++) {
        series_line(f, k, f->times[k], line);
        fputs(line, file);
    }
    fputs(series_end, file);
}

/* Write f->path through f->temporary. */
static mps_status write_file(const mps_frames *f, void (*write)(const mps_frames *f, FILE *file))
{
    snprintf(f->temporary, f->path_size + 8, "%s.tmp", f->path);
    FILE *file = fopen(f->temporary, "wb");
    if (!file) return io_failed(f, "create", f->temporary);
    write(f, file);
    bool good = !ferror(file);
    if (fclose(file) != 0 || !good) {
        mps_status status = io_failed(f, "write", f->temporary);
        remove(f->temporary);
        return status;
    }
    if (rename(f->temporary, f->path) != 0) {
        mps_status status = io_failed(f, "replace", f->path);
        remove(f->temporary);
        return status;
    }
    return MPS_OK;
}

static mps_status update_series(const mps_frames *f)
{
    snprintf(f->path, f->path_size, "%s/%s.pvd", f->folder, f->name);
    return write_file(f, write_series);
}

static mps_status create_folder(const mps_frames *f)
{
    snprintf(f->path, f->path_size, "%s/%s", f->folder, f->name);
    if (mkdir(f->path, 0777) != 0 && errno != EEXIST)
        return io_failed(f, "create the folder", f->path);
    return MPS_OK;
}

/* "<name>_<digits>.vtp" that the series does not name. */
static bool is_old_frame(const mps_frames *f, const char *file)
{
    size_t length = strlen(f->name);
    if (strncmp(file, f->name, length) != 0 || file[length] != '_') return false;
    const char *digits = file + length + 1;
    size_t count = strspn(digits, "0123456789");
    return count >= 6 && strcmp(digits + count, ".vtp") == 0 &&
           strtoll(digits, NULL, 10) >= f->count;
}

/* Frames of an earlier run in the same folder, which the new series may not reach; the .pvd names them no more. */
static mps_status remove_old(const mps_frames *f)
{
    const struct dirent *entry;
    mps_status status = MPS_OK;
    snprintf(f->temporary, f->path_size + 8, "%s/%s", f->folder, f->name);
    DIR *folder = opendir(f->temporary);
    if (!folder) return io_failed(f, "read the folder", f->temporary);
    while (status == MPS_OK && (entry = readdir(folder)) != NULL) {
        if (!is_old_frame(f, entry->d_name) || strlen(entry->d_name) >= NAME_SIZE + 24) continue;
        snprintf(f->path, f->path_size, "%s/%s/%s", f->folder, f->name, entry->d_name);
        if (remove(f->path) != 0 && errno != ENOENT) status = io_failed(f, "remove", f->path);
    }
    closedir(folder);
    return status;
}

/* ---- going on with a series -------------------------------------------------------------------------------------- */

/* Rounding of a time, as at the end of mps_run(). */
static double time_slack(const mps_frames *f)
{
    return 1e-12 * fmax(1.0, fabs(f->world->state.t));
}

static bool read_text(FILE *file, const char *wanted)
{
    for (; *wanted; wanted++)
        if (fgetc(file) != *wanted) return false;
    return true;
}

/* Times of the frames up to the present one. Every line must be the one that is written for its number and time. */
static mps_status read_times(mps_frames *f, FILE *file, bool *good)
{
    char head[LINE_SIZE], line[LINE_SIZE] = "", wanted[LINE_SIZE];
    const size_t before = strlen(series_time);
    const double last = f->world->state.t + time_slack(f);
    bool later = false;
    snprintf(head, sizeof head, series_head, byte_order());
    *good = read_text(file, head);
    for (int64_t k = 0;
         *good && fgets(line, sizeof line, file) && strncmp(line, series_time, before) == 0; k++) {
        const double time = number_back(line + before);
        series_line(f, k, time, wanted);
        *good = strcmp(line, wanted) == 0;
        later = later || !(time <= last);
        if (later) continue;
        MPS__TRY(mps__grow(f->world->context, (void **)&f->times, &f->capacity, f->count,
                           f->count + 1, sizeof *f->times));
        f->times[f->count++] = time;
    }
    const char *newline = strchr(series_end, '\n') + 1;
    *good = *good && strncmp(line, series_end, (size_t)(newline - series_end)) == 0 &&
            read_text(file, newline) && fgetc(file) == EOF;
    return MPS_OK;
}

/* The series that is there; none is an empty one. */
static mps_status read_series(mps_frames *f)
{
    bool good = false;
    snprintf(f->path, f->path_size, "%s/%s.pvd", f->folder, f->name);
    FILE *file = fopen(f->path, "rb");
    if (!file) return errno == ENOENT ? MPS_OK : io_failed(f, "read", f->path);
    mps_status status = read_times(f, file, &good);
    if (status == MPS_OK && ferror(file))
        status = io_failed(f, "read", f->path);
    else if (status == MPS_OK && !good)
        status = mps__fail(f->world->context, MPS_E_IO,
                           "cannot go on with \"%.300s\": it is not as mps_frames_write() leaves "
                           "it; without it a series begins",
                           f->path);
    fclose(file);
    return status;
}

/* ---- opening ----------------------------------------------------------------------------------------------------- */

/* Names go into paths and XML as they are. */
static bool good_name(const char *name)
{
    size_t length = name ? strnlen(name, NAME_SIZE) : 0;
    if (length == 0 || length == NAME_SIZE || name[0] == '.') return false;
    return strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.") ==
           length;
}

static mps_status open_series(mps_frames *f, const char *folder)
{
    mps__context *c = f->world->context;
    size_t length = strlen(folder);
    f->path_size = length + 2 * NAME_SIZE + 32;
    f->folder = mps__alloc(c, (int64_t)length + 1, 1);
    f->path = mps__alloc(c, (int64_t)f->path_size, 1);
    f->temporary = mps__alloc(c, (int64_t)f->path_size + 8, 1);
    if (!f->folder || !f->path || !f->temporary) return MPS_E_NOMEM;
    memcpy(f->folder, folder, length + 1);
    MPS__TRY(create_folder(f));
    if (f->continues) MPS__TRY(read_series(f));
    MPS__TRY(update_series(f));
    return remove_old(f);
}

mps_status mps__frames_open(mps__world *w, const char *folder, const char *name, int32_t kinds,
                            mps_frames **frames)
{
    mps__context *c = w->context;
    const int32_t some = MPS_FRAMES_FLUID | MPS_FRAMES_WALL | MPS_FRAMES_DUMMY,
                  all = some | MPS_FRAMES_CONTINUE;
    *frames = NULL;
    MPS__CHECK(c, folder && folder[0], "the folder of the frames is NULL or empty");
    MPS__CHECK(c, good_name(name),
               "frames: name \"%.60s\" must have 1..%d of the characters A-Z a-z 0-9 _ - . and not "
               "begin with a dot",
               name ? name : "", NAME_SIZE - 1);
    MPS__CHECK(c, kinds >= 0 && kinds <= all,
               "frames: kinds is %d, must be a sum of MPS_FRAMES_..., 0..%d", (int)kinds, (int)all);
    mps_frames *f = mps__alloc(c, 1, sizeof *f);
    if (!f) return MPS_E_NOMEM;
    f->world = w;
    f->kinds = kinds & some ? kinds & some : MPS_FRAMES_FLUID | MPS_FRAMES_WALL;
    f->continues = (kinds & MPS_FRAMES_CONTINUE) != 0;
    memcpy(f->name, name, strlen(name) + 1);
    mps_status status = open_series(f, folder);
    if (status < 0)
        mps_frames_close(f);
    else
        *frames = f;
    return status;
}

/* A run that goes on where another was interrupted may write its state again: the frame with the same time is written anew. */
static bool repeats_last(const mps_frames *f)
{
    return f->continues && f->count > 0 &&
           fabs(f->world->state.t - f->times[f->count - 1]) <= time_slack(f);
}

mps_status mps_frames_write(mps_frames *frames)
{
    mps_frames *f = frames;
    if (!f) return MPS_E_ARG;
    if (f->world->context->lock.level > MPS__READ_ONLY)
        return mps__fail(
            f->world->context, MPS_E_BUSY,
            "mps_frames_write() was called from %s: call it when mps_step() has returned",
            f->world->context->lock.what);
    const int64_t place = f->count - repeats_last(f);
    MPS__TRY(mps__grow(f->world->context, (void **)&f->times, &f->capacity, f->count, place + 1,
                       sizeof *f->times));
    snprintf(f->path, f->path_size, "%s/%s/%s_%06lld.vtp", f->folder, f->name, f->name,
             (long long)place);
    MPS__TRY(write_file(f, write_frame));
    if (place < f->count) return MPS_OK;
    f->times[f->count++] = f->world->state.t;
    mps_status status = update_series(f);
    if (status < 0) f->count--;
    return status;
}

void mps_frames_close(mps_frames *frames)
{
    if (!frames) return;
    mps__context *c = frames->world->context;
    mps__free(c, frames->folder);
    mps__free(c, frames->path);
    mps__free(c, frames->temporary);
    mps__free(c, frames->times);
    mps__free(c, frames);
}
