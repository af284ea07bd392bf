/* SPDX-License-Identifier: BSD-3-Clause */
/* Small sets of particles with all inputs of an assembly of the pressure equation. */
#ifndef PPE_FIXTURE_H
#define PPE_FIXTURE_H

#include "cloud.h"
#include "ppe.h"
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

enum { MOST = 512 };
static const double re_near = 2.1 * CLOUD_DP, re_far = 3.1 * CLOUD_DP, rho0 = 1000, gravity = 9.81;

/* Particles with all inputs of an assembly. */
typedef struct tank {
    cloud c;
    mps_neighbours *list;
    mps__context context;
    mps__ppe e;
    int64_t id[MOST];
    int32_t kind[MOST], phase[MOST], region[MOST], fixed[MOST];
    double p[MOST], density[MOST], wet[MOST], depth[MOST], rhs[MOST], shift[MOST], value[MOST],
        accel[3 * MOST], gas[MOST], law[MOST];
    mps_view view;
    mps_flux flux;
    mps__ppe_terms terms;
} tank;

static inline void tank_init(tank *k, cloud c)
{
    mps_kernel kernel = {.struct_size = sizeof kernel};
    memset(k, 0, sizeof *k);
    assert_true(c.n <= MOST);
    k->c = c;
    k->view = (mps_view){.struct_size = sizeof k->view,
                         .dim = c.dim,
                         .n = c.n,
                         .dt = 1e-3,
                         .dp = CLOUD_DP,
                         .kind = k->kind,
                         .id = k->id,
                         .x = c.x,
                         .near = {.struct_size = sizeof k->view.near},
                         .far = {.struct_size = sizeof k->view.far}};
    k->context.allocator = mps__allocator_default();
    mps__ppe_init(&k->e, &k->context);
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    assert_int_equal(mps_neighbours_create(c.dim, CLOUD_DP, NULL, &k->list), MPS_OK);
    assert_int_equal(mps_neighbours_build(k->list, c.n, c.x, re_near, re_far), MPS_OK);
    assert_int_equal(mps_neighbours_stencil_get(k->list, MPS_NEAR, &kernel, &k->view.near), MPS_OK);
    assert_int_equal(mps_neighbours_stencil_get(k->list, MPS_FAR, &kernel, &k->view.far), MPS_OK);
    for (int64_t i = 0; i < c.n; i++) {
        k->id[i] = i;
        k->density[i] = rho0;
        k->wet[i] = 1;
    }
    k->flux = (mps_flux){.struct_size = sizeof k->flux,
                         .body = 1,
                         .kind = k->kind,
                         .phase = k->phase,
                         .density = k->density,
                         .distance = k->depth,
                         .wetted = k->wet,
                         .tank_acceleration = k->accel};
    k->terms = (mps__ppe_terms){.equation = {.radius = MPS_FAR, .gain = 1},
                                .flux = &k->flux,
                                .region = k->region,
                                .density = k->density,
                                .pressure = k->p,
                                .source = k->rhs,
                                .shift = k->shift,
                                .value = k->value,
                                .gas = k->gas,
                                .law = k->law,
                                .condition = k->fixed};
}

static inline void tank_free(tank *k)
{
    mps__ppe_free(&k->e);
    mps_neighbours_destroy(k->list);
    cloud_free(&k->c);
}

/* The lowest three rows of an nx wide lattice: two of dummies, one of walls. */
static inline void add_floor(tank *k, int nx)
{
    for (int32_t i = 0; i < 3 * nx; i++) {
        k->kind[i] = i / nx == 2 ? MPS_WALL : MPS_DUMMY;
        k->region[i] = i / nx == 2 ? MPS_REGION_INNER : MPS_REGION_DRY;
    }
}

/* The highest row: the surface, at a given pressure. */
static inline void add_surface(tank *k, int nx, double value)
{
    for (int64_t i = k->c.n - nx; i < k->c.n; i++) {
        k->region[i] = MPS_REGION_SURFACE;
        k->fixed[i] = 1;
        k->value[i] = value;
    }
}

static inline void assemble(tank *k)
{
    assert_int_equal(mps__ppe_fill(&k->e, &k->view, &k->terms), MPS_OK);
    assert_int_equal(mps__ppe_note(&k->e, &k->view, &k->terms), MPS_OK);
}

#endif
