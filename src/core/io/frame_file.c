/* SPDX-License-Identifier: BSD-3-Clause */
/* One frame for ParaView: XML PolyData (.vtp) with appended raw data, and the list of the ranks'
 * pieces (.pvtp). */
#include "frame_file.h"
#include "escape.h"
#include "collect.h"
#include <string.h>

enum { CHUNK = 512, COLUMNS = MPS__FIELDS_MAX + 4 };

/* Storage type of a column in the file. */
typedef enum stored { AS_FLOAT32, AS_FLOAT64, AS_UINT8, AS_INT32, AS_INT64 } stored;

static const struct {
    const char *name;
    size_t size;
} stored_type[] = {{"Float32", 4}, {"Float64", 8}, {"UInt8", 1}, {"Int32", 4}, {"Int64", 8}};

/* One array of a frame. */
typedef struct column {
    const char *name;
    stored type;
    /* numbers per particle in memory and in the file; in the file the third component of a 2-D
     * vector is zero */
    int32_t stride, width;
    const void *data;
    /* NULL, or a function that computes the values of particle i in the tank frame */
    void (*in_tank)(const mps__world *w, int64_t i, double out[3]);
} column;

typedef struct frame {
    const mps__world *world;
    int32_t kinds; /* sum of MPS_FRAMES_... */
    const mps__particles *s;
    FILE *file;
    int64_t points;
    uint64_t offset; /* offset of the array after the '_' */
    int32_t columns;
    column column[COLUMNS];
} frame;

const char *mps__frame_byte_order(void)
{
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first ? "LittleEndian" : "BigEndian";
}

static bool selected(const frame *f, int64_t i)
{
    return (f->kinds >> f->s->kind[i] & 1) != 0 && !mps__is_shadow(f->s, i) &&
           mps__own_output(&f->world->ghosts, i);
}

/* ---- columns ---- */

static void add_column(frame *f, const char *name, stored type, int32_t stride, const void *data)
{
    bool vector = type <= AS_FLOAT64 && stride == 2 && f->s->dim == 2;
    f->column[f->columns++] = (column){name, type, stride, vector ? 3 : stride, data, NULL};
}

static void place_in_tank(const mps__world *w, int64_t i, double out[3])
{
    mps__motion_to_tank(&w->motion, &w->motion.now, w->particles.x + i * w->particles.dim, out);
}

/* Velocity relative to the tank. */
static void velocity_in_tank(const mps__world *w, int64_t i, double out[3])
{
    double X[3], v[3];
    place_in_tank(w, i, X);
    mps__motion_point(&w->motion, &w->motion.now, X, NULL, v, NULL);
    for (int32_t d = 0; d < w->particles.dim; d++)
        v[d] = w->particles.u[i * w->particles.dim + d] - v[d];
    mps__motion_rotate_back(&w->motion, &w->motion.now, v, out);
}

/* Points first, then their data. */
static void list_columns(frame *f)
{
    const mps__particles *s = f->s;
    add_column(f, "position", AS_FLOAT32, s->dim, s->x);
    add_column(f, "velocity", AS_FLOAT32, s->dim, s->u);
    if (f->kinds & MPS_FRAMES_TANK) {
        f->column[0].in_tank = place_in_tank;
        f->column[1].in_tank = velocity_in_tank;
    }
    add_column(f, "pressure", AS_FLOAT32, 1, s->p);
    add_column(f, "wall_pressure", AS_FLOAT32, 1, s->load);
    add_column(f, "number_density", AS_FLOAT32, 1, s->nd);
    add_column(f, "density", AS_FLOAT32, 1, s->rho);
    add_column(f, "kind", AS_UINT8, 1, s->kind);
    add_column(f, "phase", AS_UINT8, 1, s->phase);
    add_column(f, "part", AS_INT32, 1, s->part);
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
    mps__put_escaped(f->file, name, mps__xml_character);
    fprintf(f->file, "\" NumberOfComponents=\"%d\" format=\"appended\" offset=\"%llu\"/>\n",
            (int)width, (unsigned long long)f->offset);
    f->offset += sizeof(uint64_t) + bytes;
}

static void print_column(frame *f, const column *c)
{
    print_array(f, c->name, stored_type[c->type].name, c->width, column_bytes(f, c));
}

/* Names of the parts: each a list of its characters, terminated by a 0. */
static void print_parts(const frame *f)
{
    fprintf(f->file,
            "<DataArray type=\"String\" Name=\"part_names\" NumberOfTuples=\"%d\" "
            "format=\"ascii\">",
            (int)f->s->parts);
    for (int32_t k = 0; k < f->s->parts; k++) {
        for (const char *c = f->s->part_name[k]; *c; c++)
            fprintf(f->file, "%d ", (int)(unsigned char)*c);
        fputs("0 ", f->file);
    }
    fputs("</DataArray>", f->file);
}

static void print_frame_data(const frame *f)
{
    fprintf(f->file,
            "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
            "format=\"ascii\">%.17g</DataArray>",
            f->world->state.t);
    if (f->s->parts > 0) print_parts(f);
    fputs("</FieldData>\n", f->file);
}

static void print_xml(frame *f)
{
    fprintf(f->file,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"%s\" "
            "header_type=\"UInt64\">\n<PolyData>\n",
            mps__frame_byte_order());
    print_frame_data(f);
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

/* Values of a particle. */
static void fetch(const frame *f, const column *c, int64_t i, double out[9])
{
    memset(out, 0, 9 * sizeof *out);
    if (c->in_tank)
        c->in_tank(f->world, i, out);
    else if (c->type <= AS_FLOAT64)
        memcpy(out, (const double *)c->data + i * c->stride, (size_t)c->stride * sizeof *out);
}

/* Convert one number to the file's type, from d if it is real; returns its bytes. */
static size_t store(unsigned char *out, const column *c, int64_t place, double d)
{
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
    case AS_INT32:
        memcpy(out, (const int32_t *)c->data + place, sizeof(int32_t));
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
        double numbers[9];
        fetch(f, c, i, numbers);
        for (int32_t k = 0; k < c->width; k++)
            used += store(block + used, c, i * c->stride + k, numbers[k]);
        if (used + most <= sizeof block) continue;
        fwrite(block, 1, used, f->file);
        used = 0;
    }
    fwrite(block, 1, used, f->file);
}

/* Write first, first + 1, ...: one number per point. */
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

/* One cell per point, so that cell filters select particles. */
static void write_cells(frame *f)
{
    write_numbers(f, 0); /* points of the cells */
    write_numbers(f, 1); /* ends of the cells in that list */
}

void mps__frame_write(const mps__world *world, int32_t kinds, FILE *file)
{
    frame f = {.world = world, .kinds = kinds, .s = &world->particles, .file = file};
    for (int64_t i = 0; i < f.s->n; i++) f.points += selected(&f, i);
    list_columns(&f);
    print_xml(&f);
    for (int32_t k = 0; k < f.columns; k++) write_column(&f, &f.column[k]);
    write_cells(&f);
    fprintf(file, "\n</AppendedData>\n</VTKFile>\n");
}

/* ---- pieces ---- */

static void print_piece_array(FILE *file, const column *c)
{
    fprintf(file, "<PDataArray type=\"%s\" Name=\"", stored_type[c->type].name);
    mps__put_escaped(file, c->name, mps__xml_character);
    fprintf(file, "\" NumberOfComponents=\"%d\"/>\n", (int)c->width);
}

void mps__frame_write_pieces(const mps__world *world, const char *stem, int32_t pieces, FILE *file)
{
    frame f = {.world = world, .s = &world->particles, .file = file};
    list_columns(&f);
    fprintf(file,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PPolyData\" version=\"1.0\" "
            "byte_order=\"%s\" header_type=\"UInt64\">\n<PPolyData GhostLevel=\"0\">\n",
            mps__frame_byte_order());
    print_frame_data(&f);
    fprintf(file, "<PPoints>\n");
    print_piece_array(file, &f.column[0]);
    fprintf(file, "</PPoints>\n<PPointData>\n");
    for (int32_t k = 1; k < f.columns; k++) print_piece_array(file, &f.column[k]);
    fprintf(file, "</PPointData>\n");
    for (int32_t k = 0; k < pieces; k++)
        fprintf(file, "<Piece Source=\"%s_%04d.vtp\"/>\n", stem, (int)k);
    fprintf(file, "</PPolyData>\n</VTKFile>\n");
}
