/* SPDX-License-Identifier: BSD-3-Clause */
/* The folder of a run, with particles on known paths in a moving tank, and separate code that
 * unpacks the film of a page. */
#ifndef PAGE_FIXTURE_H
#define PAGE_FIXTURE_H

#include <dirent.h>
#include <math.h>
#include <mps/page.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include <cmocka.h>

/* Contents of a folder. */
typedef struct scene {
    char folder[64];
    int32_t dim, fluid, frames, rows;
    bool moves; /* the tank rotates and moves */
    bool body;  /* the last four walls are a part of their own, which moves */
    bool front; /* the last eight walls are in front of the liquid, in 3-D: a chamfer of the tank */
    bool plate; /* these are a separate part inside the tank */
    int32_t pockets; /* number of pockets of gas; frames contain the pocket adjacent to a
                        particle */
    char error[512];
} scene;

enum { WALLS = 24 };

static inline void path_of(const scene *s, const char *name, char out[128])
{
    snprintf(out, 128, "%s/%s", s->folder, name);
}

static inline void text_write(const scene *s, const char *name, const char *text)
{
    char path[128];
    path_of(s, name, path);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static inline char *text_read(const scene *s, const char *name, size_t *size)
{
    char path[128];
    path_of(s, name, path);
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    fseek(file, 0, SEEK_END);
    const long length = ftell(file);
    rewind(file);
    char *text = malloc((size_t)length + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)length, file), (size_t)length);
    text[length] = '\0';
    fclose(file);
    if (size) *size = (size_t)length;
    return text;
}

/* Position of a particle in the frame of the tank, which is 2 x 1 (x 0.5). Walls are numbers -1,
 * -2, ... */
static inline void place_in_tank(const scene *s, int32_t i, int32_t k, double out[3])
{
    const double phase = 0.37 * i, t = (double)k / fmax(s->frames - 1, 1);
    out[0] = 1 + 0.9 * sin(phase + 0.5 * t);
    out[1] = 0.3 + 0.25 * cos(1.7 * phase + 2 * t);
    out[2] = s->dim == 3 ? 0.25 + 0.2 * sin(2.3 * phase - t) : 0;
    if (i >= 0) return;
    const int32_t w = -i - 1; /* along the edges of the box */
    out[0] = w % 2 ? 2 : 0;
    out[1] = (double)(w / 2 % 4) / 3;
    out[2] = s->dim == 3 ? 0.25 * (w / 8) : 0;
    if (s->body && w >= WALLS - 4) out[1] += 0.1 * k;
    if (s->front && w < WALLS - 8) out[2] = 0.5 * (w / 8);
    if (!s->front || w < WALLS - 8) return;
    out[0] = 0.5 + 0.12 * (w - WALLS + 8);
    out[1] = 0.3;
    out[2] = 0.44;
}

/* Position in the lab: a rotation about z and a displacement. */
static inline void place_in_lab(const scene *s, int32_t i, int32_t k, double out[3])
{
    double X[3];
    place_in_tank(s, i, k, X);
    const double a = s->moves ? 0.1 * k : 0, shift = s->moves ? 0.05 * k : 0;
    out[0] = cos(a) * X[0] - sin(a) * X[1] + shift;
    out[1] = sin(a) * X[0] + cos(a) * X[1] - 0.5 * shift;
    out[2] = X[2];
}

/* Ids are not in order, and the order of a frame changes. */
static inline int32_t particle_at(const scene *s, int32_t k, int32_t place)
{
    return place < WALLS ? -1 - place : (place - WALLS + 7 * k) % s->fluid;
}

static inline int64_t id_of(const scene *s, int32_t i)
{
    return i < 0 ? 5000000000 - i : 3 * ((int64_t)s->fluid - i);
}

static inline void write_array(FILE *file, const void *data, uint64_t bytes)
{
    fwrite(&bytes, sizeof bytes, 1, file);
    fwrite(data, 1, bytes, file);
}

/* Number of the pocket adjacent to a particle; 0: none. */
static inline int32_t pocket_of(const scene *s, int32_t i, int32_t k)
{
    return i >= 0 && k > 0 && i % 5 == 0 ? (3 * i + k) % (s->pockets + 1) : 0;
}

static inline void write_frame_head(FILE *file, const scene *s, int32_t n, double t)
{
    static const struct {
        const char *type, *name;
        int width, size;
    } array[] = {{"Float32", "position", 3, 4}, {"Float32", "velocity", 3, 4},
                 {"Float32", "pressure", 1, 4}, {"UInt8", "kind", 1, 1},
                 {"UInt8", "phase", 1, 1},      {"Int32", "part", 1, 4},
                 {"Int64", "id", 1, 8},         {"Float32", "pocket", 1, 4}};
    uint64_t offset = 0;
    fprintf(
        file,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
        "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<FieldData><DataArray "
        "type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
        "format=\"ascii\">%.17g</DataArray><DataArray type=\"String\" Name=\"part_names\" "
        "NumberOfTuples=\"1\" format=\"ascii\">116 97 110 107 0 98 0 "
        "</DataArray></FieldData>\n<Piece "
        "NumberOfPoints=\"%d\" NumberOfVerts=\"0\">\n<Points>\n",
        t, (int)n);
    for (int k = 0; k < (s->pockets ? 8 : 7); k++) {
        fprintf(file,
                "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" "
                "offset=\"%llu\"/>\n%s",
                array[k].type, array[k].name, array[k].width, (unsigned long long)offset,
                k == 0 ? "</Points>\n<PointData>\n" : "");
        offset += 8 + (uint64_t)n * (uint64_t)(array[k].width * array[k].size);
    }
    fputs("</PointData>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_", file);
}

static inline float pressure_of(int32_t i, int32_t k)
{
    return i < 0 ? 0 : (float)(1000 * (1 + sin(0.1 * i + 0.3 * k)));
}

static inline void write_frame(const scene *s, int32_t k)
{
    char name[64], path[128];
    const int32_t n = WALLS + s->fluid;
    snprintf(name, sizeof name, "frames/frames_%06d.vtp", (int)k);
    path_of(s, name, path);
    FILE *file = fopen(path, "wb");
    float *x = calloc((size_t)n * 8, sizeof *x), *u = x + 3 * n, *p = u + 3 * n, *pocket = p + n;
    unsigned char *kind = calloc((size_t)n, 2), *phase = kind + n;
    int32_t *part = calloc((size_t)n, sizeof *part);
    int64_t *id = calloc((size_t)n, sizeof *id);
    assert_true(file && x && kind && part && id);
    for (int32_t place = 0; place < n; place++) {
        const int32_t i = particle_at(s, k, place);
        double X[3];
        place_in_lab(s, i, k, X);
        for (int d = 0; d < 3; d++) x[3 * place + d] = (float)X[d];
        u[3 * place] = i < 0 ? 0 : (float)(0.01 * (i % 100));
        p[place] = pressure_of(i, k);
        pocket[place] = (float)pocket_of(s, i, k);
        kind[place] = i < 0;
        part[place] = i < 0 ? (s->body && i < -(WALLS - 4)) || (s->plate && i < -(WALLS - 8)) : -1;
        id[place] = id_of(s, i);
    }
    write_frame_head(file, s, n, k);
    write_array(file, x, (uint64_t)n * 12);
    write_array(file, u, (uint64_t)n * 12);
    write_array(file, p, (uint64_t)n * 4);
    write_array(file, kind, (uint64_t)n);
    write_array(file, phase, (uint64_t)n);
    write_array(file, part, (uint64_t)n * 4);
    write_array(file, id, (uint64_t)n * 8);
    if (s->pockets) write_array(file, pocket, (uint64_t)n * 4);
    assert_int_equal(fclose(file), 0);
    free(x);
    free(kind);
    free(part);
    free(id);
}

static inline void write_series(const scene *s)
{
    char path[128];
    path_of(s, "frames.pvd", path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\">\n<Collection>\n", file);
    for (int32_t k = 0; k < s->frames; k++)
        fprintf(file, "<DataSet timestep=\"%d\" part=\"0\" file=\"frames/frames_%06d.vtp\"/>\n",
                (int)k, (int)k);
    fputs("</Collection>\n</VTKFile>\n", file);
    assert_int_equal(fclose(file), 0);
}

static inline void write_tables(const scene *s)
{
    char path[128];
    path_of(s, "probes.csv", path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "t[s],P1[Pa],eta[m],%s,ke[J],pe[J],numerical[J],volume_error\n",
            s->front ? "F_x[N],F_y[N]" : "F[N]");
    for (int32_t i = 0; i < s->rows; i++) {
        const double t = 0.01 * i, hit = fmod(t, 1.0);
        fprintf(file, "%.17g,%.17g,%.17g,%.17g%s,%.17g,%.17g,%.17g,%.17g\n", t,
                hit < 0.05 ? 1e4 * (1 + 0.1 * floor(t)) *
                                 (hit < 0.02 ? hit / 0.02 : 1 - (hit - 0.02) / 0.03)
                           : 0,
                0.1 * sin(6 * t), i == 3 ? NAN : 40 * cos(t), s->front ? ",-9000" : "",
                2 * sin(t) * sin(t), 3 + 2 * cos(t) * cos(t), 0.01 * t, 1e-4 * t);
    }
    assert_int_equal(fclose(file), 0);
    text_write(s, "steps.csv",
               "t[s],dt[s],crossing_time[s]\n0.1,0.1,0.004\n0.3,0.2,0.005\n0.35,0.05,0.004\n");
}

static inline void write_summary(const scene *s, const char *more)
{
    static const char other[] = "{\"name\": \"F_x\", \"unit\": \"N\", \"type\": \"force\", "
                                "\"about\": \"Force: of F\"},\n";
    char text[4096];
    snprintf(
        text, sizeof text,
        "{\"case\": \"scene\", \"title\": \"Tank <1> & \\\"half\\\" full\", \"dim\": %d, \"dp\": "
        "0.05, "
        "\"n_fluid\": %d, \"particles_lost\": 0, \"t_end\": %.17g, \"status\": \"ok\", \"error\": "
        "\"\", "
        "\"version\": \"1.0.0\", \"gravity\": 9.81, \"wall_s\": 75, \"tank_lo_x\": 0, "
        "\"tank_lo_y\": 0, "
        "\"tank_size_x\": 2, \"tank_size_y\": 1, \"liquid_depth\": 0.5, \"still_level\": 0.5,\n"
        "\"columns\": [{\"name\": \"P1\", \"unit\": \"Pa\", \"type\": \"wall_pressure\", \"at\": "
        "[2, 0.1, 0], "
        "\"normal\": [-1, 0, 0], \"diameter\": 0.05, \"part\": \"tank.x1\", \"about\": \"Wall "
        "pressure: of "
        "P1\"},\n{\"name\": \"eta\", \"unit\": \"m\", \"type\": \"gauge\", \"at\": [0.1, 0, 0], "
        "\"about\": "
        "\"Elevation: of eta\"},\n%s{\"name\": \"F%s\", \"unit\": \"N\", \"type\": \"force\", "
        "\"about\": \"Force: "
        "of F\"}],\n\"references\": [{\"label\": \"measured\", \"unit\": \"m\", \"column\": "
        "\"eta\", \"line\": "
        "false, \"points\": [[0.5, 0.02], [1.005, -0.03]]}]%s}\n",
        (int)s->dim, (int)s->fluid, 0.01 * (s->rows - 1), s->front ? other : "",
        s->front ? "_y" : "", more);
    text_write(s, "summary.json", text);
}

/* Make the folder. */
static inline void scene_create(scene *s)
{
    char path[128];
    snprintf(s->folder, sizeof s->folder, "mps_page_XXXXXX");
    assert_non_null(mkdtemp(s->folder));
    path_of(s, "frames", path);
    assert_int_equal(mkdir(path, 0777), 0);
    write_summary(s, "");
    write_tables(s);
    if (s->frames > 0) write_series(s);
    for (int32_t k = 0; k < s->frames; k++) write_frame(s, k);
}

static inline void remove_files(const char *folder)
{
    char path[512];
    DIR *all = opendir(folder);
    for (struct dirent *e = all ? readdir(all) : NULL; e; e = readdir(all)) {
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        if (e->d_name[0] != '.') remove(path);
    }
    if (all) closedir(all);
}

static inline void scene_remove(const scene *s)
{
    char path[128];
    path_of(s, "frames", path);
    remove_files(path);
    rmdir(path);
    remove_files(s->folder);
    rmdir(s->folder);
}

static inline mps_status page_of(scene *s, int64_t bytes, mps_page_info *info)
{
    mps_page_config config;
    assert_int_equal(mps_page_config_init(&config, sizeof config), MPS_OK);
    if (bytes) config.bytes = bytes;
    config.error = s->error;
    config.error_size = sizeof s->error;
    if (info) assert_int_equal(mps_page_info_init(info, sizeof *info), MPS_OK);
    return mps_page_write(s->folder, &config, info);
}

/* ---- undoing --------------------------------------------------------------------------------- */

static inline int digit_of(char c)
{
    const char *const all = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = c ? strchr(all, c) : NULL;
    return found ? (int)(found - all) : -1;
}

/* base64 up to the first other character, then inflate. The caller frees it. */
static inline unsigned char *unpacked(const char *text, size_t most, size_t *size)
{
    const size_t digits = strspn(
        text, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/");
    unsigned char *packed = malloc(digits + 1), *out = malloc(most + 1);
    size_t n = 0;
    assert_true(packed && out);
    for (size_t i = 0; i + 1 < digits; i++) {
        const int a = digit_of(text[i]), b = digit_of(text[i + 1]);
        if (i % 4 == 0) packed[n++] = (unsigned char)(a << 2 | b >> 4);
        if (i % 4 == 1) packed[n++] = (unsigned char)(a << 4 | b >> 2);
        if (i % 4 == 2) packed[n++] = (unsigned char)(a << 6 | b);
    }
    uLongf length = most;
    assert_int_equal(uncompress(out, &length, packed, n), Z_OK);
    *size = length;
    free(packed);
    return out;
}

/* Add the frames of a block to the previous ones: q is [frames][dim][count]. @return frames in the
 * block */
static inline int32_t undo_block(const unsigned char *raw, size_t size, int32_t count, int32_t dim,
                                 int32_t values, int32_t bits, int32_t before, int32_t *q,
                                 unsigned char *value)
{
    const size_t step = (size_t)count * (size_t)(2 * dim + values);
    const int32_t frames = (int32_t)(size / step);
    assert_int_equal(size % step, 0);
    for (int32_t k = before; k < before + frames; k++, raw += step)
        for (int32_t i = 0; i < count; i++) {
            for (int32_t d = 0; d < dim; d++) {
                const int32_t at = (k * dim + d) * count + i, back = dim * count;
                const int32_t u = raw[d * count + i] | raw[(dim + d) * count + i] << 8;
                const int32_t difference = u % 2 ? -(u + 1) / 2 : u / 2;
                const int32_t guess = k > 1 ? 2 * q[at - back] - q[at - 2 * back]
                                      : k   ? q[at - back]
                                            : 0;
                q[at] = (guess + difference) & ((1 << bits) - 1);
            }
            for (int32_t v = 0; v < values; v++) {
                const int32_t at = (values * k + v) * count + i;
                value[at] = (unsigned char)(raw[(2 * dim + v) * count + i] +
                                            (k ? value[at - values * count] : 0));
            }
        }
    return frames;
}

#endif
