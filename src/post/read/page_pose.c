/* SPDX-License-Identifier: BSD-3-Clause */
#include "page_pose.h"
#include <math.h>
#include <string.h>

static const film_pose at_rest = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};

static void subtract(const double *a, const double *b, double out[3])
{
    for (int d = 0; d < 3; d++) out[d] = a[d] - b[d];
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double *a, const double *b, double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static bool is_tank_wall(const film_frame *s, int64_t i, double part)
{
    return (int)s->kind[i] == FILM_WALL && (part < 0 || s->part[i] == part);
}

/* The part of the tank (its name begins with "tank") with most wall particles, at least three; -1:
 * any wall. */
static double tank_part(const film_frame *s)
{
    double best = -1;
    int64_t most = 2, number = 0;
    for (const char *name = s->parts; name && *name; name += strlen(name) + 1, number++) {
        int64_t count = 0;
        if (strncmp(name, "tank", 4) != 0) continue;
        for (int64_t i = 0; i < s->count; i++) count += is_tank_wall(s, i, (double)number);
        if (count > most) {
            most = count;
            best = (double)number;
        }
    }
    return best;
}

/* The wall particle with the largest `measure`. */
static int64_t furthest(const film_frame *s, double part,
                        double (*measure)(const double *x, void *), void *user)
{
    int64_t best = -1;
    double most = -1;
    for (int64_t i = 0; i < s->count; i++) {
        if (!is_tank_wall(s, i, part)) continue;
        const double value = measure(s->x + 3 * i, user);
        if (value > most) {
            most = value;
            best = i;
        }
    }
    return best;
}

static double from_first(const double *x, void *user)
{
    const film *f = user;
    double a[3];
    subtract(x, f->corner[0], a);
    return dot(a, a);
}

/* Square of the area of the triangle of a point and the first two. */
static double from_line(const double *x, void *user)
{
    const film *f = user;
    double a[3], b[3], n[3];
    subtract(x, f->corner[0], a);
    subtract(f->corner[1], f->corner[0], b);
    cross(a, b, n);
    return dot(n, n);
}

static double first_of_all(const double *x, void *user)
{
    (void)x, (void)user;
    return 0;
}

void mps__pose_choose(film *f, const film_frame *s)
{
    static double (*const measure[])(const double *, void *) = {first_of_all, from_first,
                                                                from_line};
    const double part = tank_part(s);
    f->reference[0] = -1;
    for (int k = 0; k < (f->dim == 3 ? 3 : 2); k++) {
        const int64_t i = furthest(s, part, measure[k], f);
        if (i < 0) return;
        f->reference[k] = (int64_t)s->id[i];
        memcpy(f->corner[k], s->x + 3 * i, sizeof f->corner[k]);
    }
    if (f->dim == 2) { /* the third is above the first, out of the plane */
        memcpy(f->corner[2], f->corner[0], sizeof f->corner[2]);
        f->corner[2][2] += sqrt(from_first(f->corner[1], f));
    }
    if (!(from_line(f->corner[2], f) > 0)) f->reference[0] = -1; /* all are collinear */
    for (int k = 0; k < 3; k++) {
        const double lab[3] = {f->corner[k][0], f->corner[k][1], f->corner[k][2]};
        mps__film_to_tank(&f->start, lab, f->corner[k]);
    }
}

void mps__pose_start(film *f)
{
    const json_value *list = mps__json_get(f->run->summary, "tank_start"),
                     *turned = mps__json_get(f->run->summary, "tank_frame");
    double value[12];
    f->start = at_rest;
    if (mps__json_count(list) != 12 || (turned && turned->type == JSON_TRUE)) return;
    for (size_t k = 0; k < 12; k++) {
        value[k] = mps__json_number(mps__json_at(list, k));
        if (!isfinite(value[k])) return;
    }
    memcpy(f->start.turn, value, sizeof f->start.turn);
    memcpy(f->start.shift, value + 9, sizeof f->start.shift);
}

/* Three orthonormal vectors from three points, as columns. */
static void axes(double (*corner)[3], double out[9])
{
    double a[3], b[3], n[3];
    subtract(corner[1], corner[0], a);
    subtract(corner[2], corner[0], b);
    cross(a, b, n);
    cross(n, a, b);
    const double la = sqrt(dot(a, a)), lb = sqrt(dot(b, b)), ln = sqrt(dot(n, n));
    for (int d = 0; d < 3; d++) {
        out[3 * d] = a[d] / la;
        out[3 * d + 1] = b[d] / lb;
        out[3 * d + 2] = n[d] / ln;
    }
}

static bool find_corners(const film *f, const film_frame *s, double corner[3][3])
{
    const int wanted = f->dim == 3 ? 3 : 2;
    int found = 0;
    for (int64_t i = 0; i < s->count && found < wanted; i++)
        for (int k = 0; k < wanted; k++)
            if ((int64_t)s->id[i] == f->reference[k]) {
                memcpy(corner[k], s->x + 3 * i, 3 * sizeof(double));
                found++;
            }
    if (f->dim == 2) {
        memcpy(corner[2], corner[0], 3 * sizeof(double));
        corner[2][2] += f->corner[2][2] - f->corner[0][2];
    }
    return found == wanted;
}

static bool is_same(double (*a)[3], const double (*b)[3])
{
    for (int k = 0; k < 9; k++)
        if (a[k / 3][k % 3] != b[k / 3][k % 3]) return false;
    return true;
}

bool mps__pose_find(const film *f, const film_frame *s, film_pose *out)
{
    double corner[3][3] = {{0}}, first[3][3], now[9] = {0}, built[9] = {0};
    *out = f->start;
    if (f->reference[0] < 0) return true;
    if (!find_corners(f, s, corner)) return false;
    if (is_same(corner, f->corner)) {
        *out = at_rest;
        return true;
    }
    axes(corner, now);
    memcpy(first, f->corner, sizeof first);
    axes(first, built);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) out->turn[3 * i + j] = dot(now + 3 * i, built + 3 * j);
        out->shift[i] = corner[0][i];
    }
    for (int i = 0; i < 3; i++) out->shift[i] -= dot(out->turn + 3 * i, f->corner[0]);
    return true;
}

void mps__film_to_tank(const film_pose *pose, const double x[3], double out[3])
{
    double a[3];
    subtract(x, pose->shift, a);
    for (int j = 0; j < 3; j++)
        out[j] = pose->turn[j] * a[0] + pose->turn[3 + j] * a[1] + pose->turn[6 + j] * a[2];
}
