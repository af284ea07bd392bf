/* SPDX-License-Identifier: BSD-3-Clause */
/* Motion of the tank: degrees of freedom of a ship as harmonics in the lab frame. */
#include "drive.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

const char *const mps__degrees[MOTION_DEGREES] = {"surge", "sway", "heave", "roll", "pitch", "yaw"};

/* ---- reading ---- */

/* omega, from the one of the three keys that is given; the reader guarantees exactly one. */
static double read_omega(build *b, const tree_node *node)
{
    static const char *const key[] = {"omega", "period", "frequency"};
    const double turn = 2 * acos(-1.0);
    const int chosen = mps__build_kind(node, key, 3);
    const double value = mps__read_number(b->c, node, key[chosen], NAN);
    return chosen == 0 ? value : chosen == 1 ? turn / value : turn * value;
}

/* A time, or a number of periods. */
static double read_ramp(build *b, const tree_node *node, double omega)
{
    const double value = mps__read_number(b->c, node, "ramp", 0);
    return mps__read_is(b->c, node, "ramp", UNIT_NONE) && value > 0 ? value * 2 * acos(-1.0) / omega
                                                                    : value;
}

static void read_harmonic(build *b, build_motion *m, const tree_node *node, int32_t degree)
{
    const tree_node *spectrum = mps__tree_find(node, "jonswap");
    mps_harmonic h = {.dof = degree};
    if (m->count == MOTION_HARMONICS) {
        mps__case_log(b->c, node, false, "more than %d harmonics", MOTION_HARMONICS);
        return;
    }
    if (spectrum) {
        const double period = mps__read_number(b->c, spectrum, "peak", NAN);
        h.ramp = read_ramp(b, node, 2 * acos(-1.0) / period);
        mps__spectrum_add(b, m, spectrum, h);
        return;
    }
    if (mps__tree_find(node, "acceleration")) {
        h.form = MOTION_PUSH;
        h.amplitude = mps__read_number(b->c, node, "acceleration", NAN);
        m->harmonic[m->count++] = h;
        return;
    }
    h.form = mps__read_choice(b->c, node, "form", 0);
    h.amplitude = mps__read_number(b->c, node, "amplitude", NAN);
    h.omega = read_omega(b, node);
    if (mps__tree_find(node, "slope"))
        h.amplitude = mps__read_number(b->c, node, "slope", NAN) * b->gravity / (h.omega * h.omega);
    if (h.form == 0) h.phase = mps__read_number(b->c, node, "phase", 0);
    if (mps__case_failed(b->c)) return;
    h.ramp = read_ramp(b, node, h.omega);
    m->harmonic[m->count++] = h;
}

void mps__harmonics_read(build *b, build_motion *m, const tree_node *node, int32_t degree)
{
    const tree_node *at = node->kind == TREE_LIST ? node->first : node;
    for (; at && !mps__case_failed(b->c); at = at == node ? NULL : at->next)
        read_harmonic(b, m, at, degree);
}

static void read_degree(build *b, build_motion *m, const tree_node *map, int32_t degree)
{
    const tree_node *node = mps__tree_find(map, mps__degrees[degree]);
    if (!node) return;
    m->used[degree] = true;
    mps__degree_check(b, m, node, degree);
    mps__harmonics_read(b, m, node, degree);
}

static void read_order(build *b, build_motion *m, const tree_node *map)
{
    const char *order = mps__read_text(b->c, map, "order", "yaw pitch roll");
    char word[3][8] = {"", "", ""};
    const int words = sscanf(order, "%7s %7s %7s", word[0], word[1], word[2]);
    int seen = 0;
    for (int i = 0; i < 3; i++)
        for (int32_t d = MPS_SHIP_ROLL; d <= MPS_SHIP_YAW; d++)
            if (strcmp(word[i], mps__degrees[d]) == 0) {
                m->ship.order[i] = d;
                seen |= 1 << d;
            }
    if (words != 3 || seen != (1 << 3 | 1 << 4 | 1 << 5))
        mps__case_log(b->c, mps__tree_find(map, "order"), false,
                      "%s.order: must be roll, pitch and yaw, each once, the first rotation "
                      "first; usual is 'yaw pitch roll'",
                      m->of);
}

/* Read centre, bow and axes of the ship, "x forward, y port, z up". */
void mps__ship_read(build *b, build_motion *m, const tree_node *map)
{
    static const double forward[4][3] = {{1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}};
    mps_ship_init(&m->ship, sizeof m->ship);
    m->dim = b->dim;
    if (mps__read_numbers(b->c, map, "centre", 3, m->centre) == 2)
        m->centre[2] = mps__build_middle(b);
    const int32_t way = mps__read_choice(b->c, map, "forward", b->dim == 2 ? 1 : 0);
    memcpy(m->ship.forward, forward[way], sizeof forward[way]);
    m->has_forward = mps__tree_find(map, "forward") != NULL;
    /* z up, z down, axes of the library */
    const int32_t axes = mps__read_choice(b->c, map, "axes", 2);
    m->flipped = axes == 2;
    m->ship.axes = axes == 1 ? MPS_SHIP_Z_DOWN : MPS_SHIP_Z_UP;
    if (b->dim == 3) read_order(b, m, map); /* in the plane there is one rotation */
    memcpy(m->ship.origin, m->centre, sizeof m->centre);
}

/* ---- axes ---- */

static void cross(const double *a, const double *b, double *out)
{
    for (int d = 0; d < 3; d++)
        out[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

void mps__degree_to_lab(const build_motion *m, int32_t degree, int32_t *dof, double *sign)
{
    const double down = m->ship.axes == MPS_SHIP_Z_DOWN ? -1 : 1;
    double e[3][3];
    *dof = MPS_MOVE_X;
    *sign = 1;
    /* of a tank, not a ship */
    if (m->dim == 2 && !m->has_forward && degree == MPS_SHIP_SURGE) return;
    for (int d = 0; d < 3; d++) {
        e[0][d] = m->ship.forward[d];
        e[2][d] = down * m->ship.up[d];
    }
    cross(e[2], e[0], e[1]);
    const double *axis = e[degree % 3];
    const bool turned = m->flipped && degree % 3 == 1;
    for (int d = 0; d < 3; d++)
        if (fabs(axis[d]) > 0.5) {
            *dof = degree < 3 ? MPS_MOVE_X + d : MPS_ROTATE_X + d;
            *sign = (axis[d] > 0) != turned ? 1 : -1;
        }
}

/* In 2-D a degree of freedom moves the tank in the plane x, y, and no two of them are the same
 * motion. */
void mps__degree_check(build *b, const build_motion *m, const tree_node *at, int32_t degree)
{
    const bool along = fabs(m->ship.forward[0]) > 0.5;
    int32_t dof, other;
    double sign;
    char without[48] = "";
    if (b->dim == 3) return;
    if (!m->has_forward) snprintf(without, sizeof without, " without '%s.forward'", m->of);
    mps__degree_to_lab(m, degree, &dof, &sign);
    if (dof != MPS_MOVE_X && dof != MPS_MOVE_Y && dof != MPS_ROTATE_Z)
        mps__case_log(b->c, at, false,
                      "%s.%s: moves nothing in the plane x, y of a 2-D case, where the bow is "
                      "along %s%s: there are %s",
                      m->of, mps__degrees[degree], along ? "x" : "z", without,
                      along ? "surge (along x), heave (along y) and pitch; for a section across "
                              "the ship give 'forward: z'"
                      : m->has_forward
                          ? "sway (along x), heave (along y) and roll; for a section along the "
                            "ship give 'forward: x'"
                          : "surge or sway (along x), heave (along y) and roll (x to y); for a "
                            "section along the ship, with pitch, give 'forward: x'");
    for (int32_t d = 0; d < degree; d++) {
        mps__degree_to_lab(m, d, &other, &sign);
        if (m->used[d] && other == dof)
            mps__case_log(b->c, at, false,
                          "%s.%s: is the same motion as '%s' in a 2-D case; remove one", m->of,
                          mps__degrees[degree], mps__degrees[d]);
    }
}

/* The rotations of the library are yaw, pitch, roll of a ship with its bow along x; a single
 * rotation has no order. */
bool mps__motion_parallel(const build_motion *m)
{
    int rotations = 0;
    for (int32_t d = MPS_SHIP_ROLL; d <= MPS_SHIP_YAW; d++) rotations += m->used[d];
    const bool usual = m->ship.order[0] == MPS_SHIP_YAW && m->ship.order[1] == MPS_SHIP_PITCH;
    return m->dim == 2 || rotations < 2 || (usual && fabs(m->ship.forward[0]) > 0.5);
}

static bool is_sum_of_harmonics(const build_motion *m)
{
    for (int32_t i = 0; i < m->count; i++)
        if (m->harmonic[i].form == MOTION_PUSH) return false;
    return mps__motion_parallel(m);
}

/* Pose of the ship at t, for mps_motion_callback_set(). */
static int ship_at(void *user, double t, mps_motion_state *state)
{
    const build_motion *m = user;
    mps_ship_motion ship;
    mps_ship_motion_init(&ship, sizeof ship);
    for (int32_t d = 0; d < MOTION_DEGREES; d++) {
        double q[3], sign;
        int32_t dof;
        mps__harmonics_at(m, d, t, q);
        if (m->dim == 2) {
            mps__degree_to_lab(m, d, &dof, &sign);
            state->value[dof] += sign * q[0];
            state->rate[dof] += sign * q[1];
            state->accel[dof] += sign * q[2];
        }
        sign = m->flipped && d % 3 == 1 ? -1 : 1;
        ship.value[d] = sign * q[0];
        ship.rate[d] = sign * q[1];
        ship.accel[d] = sign * q[2];
    }
    return m->dim == 2 || mps_ship_to_tank(&m->ship, &ship, state) == MPS_OK ? 0 : 1;
}

/* ---- setting ---- */

double mps__shortest_period(const build_motion *m)
{
    double least = INFINITY;
    for (int32_t i = 0; i < m->count; i++) {
        if (m->harmonic[i].omega > 0) least = fmin(least, 2 * acos(-1.0) / m->harmonic[i].omega);
        if (m->harmonic[i].ramp > 0) least = fmin(least, m->harmonic[i].ramp);
    }
    return least;
}

static void set_harmonics(build *b, build_motion *m, const tree_node *map)
{
    if (!is_sum_of_harmonics(m)) {
        m->dt_max = fmin(mps__shortest_period(m), b->until) / 20;
        mps__build_try(b, mps_motion_callback_set(b->sim, ship_at, m), map, "motion");
        return;
    }
    mps_harmonic *lab = mps__build_alloc(b, (size_t)m->count * sizeof *lab);
    for (int32_t i = 0; lab && i < m->count; i++) {
        double sign = 1;
        lab[i] = m->harmonic[i];
        mps__degree_to_lab(m, m->harmonic[i].dof, &lab[i].dof, &sign);
        lab[i].amplitude *= sign;
    }
    if (lab) mps__build_try(b, mps_motion_harmonics_set(b->sim, m->count, lab), map, "motion");
}

static void set_table(build *b, build_motion *m, const tree_node *map)
{
    static const int32_t all[6] = {MPS_MOVE_X,   MPS_MOVE_Y,   MPS_MOVE_Z,
                                   MPS_ROTATE_X, MPS_ROTATE_Y, MPS_ROTATE_Z},
                         plane[3] = {MPS_MOVE_X, MPS_MOVE_Y, MPS_ROTATE_Z};
    const int32_t dofs = b->dim == 3 ? 6 : 3, *dof = b->dim == 3 ? all : plane;
    double *values = mps__build_alloc(b, (size_t)(m->rows * dofs) * sizeof *values);
    if (!values) return;
    for (int64_t i = 0; m->dim == 3 && m->flipped && i < m->rows; i++) {
        m->column[6 * i + MPS_SHIP_SWAY] *= -1;
        m->column[6 * i + MPS_SHIP_PITCH] *= -1;
    }
    if (b->dim == 3 &&
        !mps__build_try(b, mps_ship_table(&m->ship, m->rows, m->column, dofs, dof, values), map,
                        "motion.file"))
        return;
    for (int64_t i = 0; b->dim == 2 && i < m->rows; i++)
        for (int32_t d = 0; d < MOTION_DEGREES; d++) {
            int32_t to;
            double sign;
            if (!m->used[d]) continue;
            mps__degree_to_lab(m, d, &to, &sign);
            const int k = to == MPS_MOVE_X ? 0 : to == MPS_MOVE_Y ? 1 : 2;
            values[i * 3 + k] += sign * m->column[i * 6 + d];
        }
    mps__build_try(b, mps_motion_table_set(b->sim, m->rows, m->t, dofs, dof, values), map,
                   "motion.file");
}

static const double STEPS_A_PERIOD = 20;

static void set_drive(build *b, build_motion *m, const tree_node *map, const build_drive *d)
{
    m->dt_max = fmin(mps__drive_period(d), b->until) / STEPS_A_PERIOD;
    m->plugin = mps__read_text(b->c, map, "plugin", NULL);
    mps__build_try(b, mps_motion_callback_set(b->sim, mps__drive_motion, (void *)d), map,
                   "motion.plugin");
}

/* Find the degrees of freedom of the lab that a plug-in moves, as those of the ship parallel to
 * them. */
static void find_driven(build_motion *m, const build_drive *d, double until)
{
    enum { SAMPLES = 2000 };
    for (int i = 0; i <= SAMPLES; i++) {
        mps_motion_state state;
        mps_motion_state_init(&state, sizeof state);
        if (mps__drive_motion((void *)d, until * i / SAMPLES, &state) != 0) return;
        for (int32_t k = 0; k < MOTION_DEGREES; k++) {
            double sign;
            int32_t dof;
            mps__degree_to_lab(m, k, &dof, &sign);
            if (m->dim == 2 && k != MPS_SHIP_SURGE && k != MPS_SHIP_HEAVE && k != MPS_SHIP_ROLL)
                continue;
            m->used[k] = m->used[k] || state.value[dof] != 0 || state.rate[dof] != 0;
        }
    }
}

void mps__build_motion(build *b)
{
    const tree_node *map = mps__tree_find(b->root, "motion");
    if (!map || mps__case_failed(b->c)) return;
    build_motion *m = mps__build_alloc(b, sizeof *m);
    if (m) m->harmonic = mps__build_alloc(b, MOTION_HARMONICS * sizeof *m->harmonic);
    if (!m || !m->harmonic) return;
    const bool file = mps__tree_find(map, "file") != NULL;
    b->until = mps__read_number(b->c, mps__tree_find(b->root, "run"), "until", NAN);
    m->of = "motion";
    mps__ship_read(b, m, map);
    for (int32_t d = 0; d < MOTION_DEGREES && !mps__case_failed(b->c); d++)
        read_degree(b, m, map, d);
    const build_drive *drive = mps__drive_read(b, map, MPS_PLUGIN_MOTION);
    if (drive && m->count > 0)
        mps__case_log(b->c, mps__tree_find(map, "plugin"), false,
                      "motion: give a plug-in or degrees, not both");
    if (file && m->count > 0)
        mps__case_log(b->c, mps__tree_find(map, "file"), false,
                      "motion: give a file or degrees, not both");
    if (!file && !drive && m->count == 0 && !mps__case_failed(b->c))
        mps__case_log(b->c, map, false,
                      "motion: no degree is given: surge, sway, heave, roll, pitch, yaw, or file, "
                      "or plugin");
    if (mps__case_failed(b->c) || (file && !mps__motion_file(b, m, map))) return;
    m->start = mps__read_choice(b->c, map, "start", MPS_START_AT_REST);
    if (!mps__build_try(b, mps_motion_centre_set(b->sim, m->centre, m->start), map,
                        "motion.centre"))
        return;
    if (file)
        set_table(b, m, map);
    else if (drive)
        set_drive(b, m, map, drive);
    else
        set_harmonics(b, m, map);
    if (mps__case_failed(b->c) || b->status < 0) return;
    if (drive) find_driven(m, drive, b->until);
    mps__motion_measure(b, m, map);
    if (file) mps__motion_diagnose(b, m, map);
    b->motion = m;
}
