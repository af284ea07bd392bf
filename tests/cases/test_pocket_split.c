/* SPDX-License-Identifier: BSD-3-Clause */
/* A pocket of gas under a slug of liquid that falls, is decelerated by the gas and rises again. An
 * obstacle on the floor divides the gas while the slug is low, and it merges again:
 *   plate   a plate that the slug moves over;
 *   liquid  a column of liquid at rest.
 * The amount of gas is conserved. The energy exchanged between gas and liquid is known, that of the
 * slug; the residual of the budget is bounded on both sides. It is not zero because of the impacts
 * of the slug on the edge of the plate and on the column. */
#include "phase/gas_pocket.h"
#include "pocket_fixture.h"

enum { COLUMNS = 40, BELOW = 30, ROWS = 20, ABOVE = 60 };

static const double SPEED = 8, VISCOSITY = 50;

typedef struct books {
    int pockets, most, changes; /* now, at most, and how often they changed */
    double error;               /* largest of the amount of gas [m2] */
    double energy;              /* kinetic, of the first step [J/m] */
    double least, largest;      /* rest of the budget, of that */
    double pressure;            /* largest [Pa] */
} books;

static int follow(void *user, mps_sim *sim, const mps_step_info *info)
{
    books *b = user;
    const double *value = NULL;
    int64_t count = 0;
    double gas = 0;
    mps_energy e;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    ASSERT_OK(sim, mps_energy_get(sim, &e));
    ASSERT_OK(sim, mps_model_state(sim, "gas", &value, &count));
    const mps__pocket_head *head = (const mps__pocket_head *)(const void *)value;
    const mps__pocket *pocket = (const mps__pocket *)(const void *)(value + sizeof *head / 8);
    if (b->energy == 0) b->energy = e.kinetic;
    for (int k = 0; k < info->pockets; k++) gas += pocket[k].gas;
    b->error = fmax(b->error, fabs(gas - (head->closed - head->vented)));
    assert_true(head->vented == 0);
    b->changes += info->pockets != b->pockets;
    b->pockets = info->pockets;
    if (b->pockets > b->most) b->most = b->pockets;
    b->least = fmin(b->least, e.numerical / b->energy);
    b->largest = fmax(b->largest, e.numerical / b->energy);
    b->pressure = fmax(b->pressure, info->pocket_pressure);
    return 0;
}

static books run(const char *what, mps_sim *sim, double t_end)
{
    books b = {0};
    ASSERT_OK(sim, mps_run(sim, t_end, follow, &b));
    print_message("%s: %d pockets at most, %d at last, %d changes; gas within %.1e m2; rest of the "
                  "energy %+.4f to %+.4f of that exchanged; %.0f Pa at most\n",
                  what, b.most, b.pockets, b.changes, b.error, b.least, b.largest, b.pressure);
    assert_true(b.most == 2 && b.pockets == 1);
    assert_true(b.changes >= 3); /* one, two, one */
    ASSERT_NEAR(b.error, 0, 1e-12);
    mps_sim_destroy(sim);
    return b;
}

/* P h [(h/y)^(e-1) - 1]/(e-1) - P (h - y) = RHO length u^2/2, y the least height: its pressure. */
static double highest(double height, double length)
{
    double low = 0.01 * height, high = height;
    for (int k = 0; k < 60; k++) {
        const double y = 0.5 * (low + high), x = height / y;
        const double work = AMBIENT * height * (pow(x, EXPONENT - 1) - 1) / (EXPONENT - 1) -
                            AMBIENT * (height - y);
        if (work > 0.5 * RHO * length * SPEED * SPEED)
            low = y;
        else
            high = y;
    }
    return AMBIENT * (pow(height / high, EXPONENT) - 1);
}

static void plate(void **state)
{
    (void)state;
    const double foot[2] = {20 * DP, 0}, edge[2] = {0, 20 * DP};
    mps_sim *sim = begin(2, 0, VISCOSITY);
    add_slug(sim, COLUMNS, BELOW, ROWS, ABOVE, SPEED);
    ASSERT_OK(sim, mps_plate_add(sim, "plate", foot, edge, NULL));
    const books b = run("plate", sim, 0.05);
    ASSERT_NEAR(b.pressure / highest((BELOW - 0.5) * DP, ROWS * DP), 1, 0.02);
    assert_true(b.least > -0.06 && b.least < 0); /* what the edge takes */
    assert_true(b.largest < 0.01);               /* nothing is gained */
}

static void liquid(void **state)
{
    (void)state;
    const double lo[2] = {18.5 * DP, 0.1 * DP}, hi[2] = {22.5 * DP, 22.1 * DP};
    mps_sim *sim = begin(2, 0, VISCOSITY);
    add_slug(sim, COLUMNS, BELOW, ROWS, ABOVE, SPEED);
    ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, NULL, NULL));
    const books b = run("liquid", sim, 0.062);
    assert_true(b.least > -0.03 && b.largest < 0.015);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(plate), cmocka_unit_test(liquid)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
