/* SPDX-License-Identifier: BSD-3-Clause */
/* Pockets of gas from step to step, on drawn voids: closing, splitting, merging and opening
 * conserve the amount of gas. */
#include "phase/gas_pocket.h"
#include "tank_fixture.h"
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 16, CELLS = WIDTH * 6, MOST = 6 };

/* A drawn step: '#' liquid, '0' the largest component, '1'.. others. */
typedef struct drawing {
    int32_t label[CELLS], size[MOST];
    mps_voids voids;
    double geometry[MOST];
    mps__pocket pocket[MOST];
    int32_t overlap[MOST * (MOST + 2)];
    double run[2 * CELLS];
    mps__pocket_head head;
} drawing;

static void draw(drawing *d, const char *picture)
{
    memset(d, 0, sizeof *d);
    assert_int_equal(strlen(picture), CELLS);
    d->voids = (mps_voids){.dim = 2, .side = 0.5, .cells = {WIDTH, CELLS / WIDTH, 1}};
    for (int c = 0; c < CELLS; c++) {
        d->label[c] = picture[c] == '#' ? MPS_VOID_NONE : picture[c] - '0';
        if (d->label[c] < 0) continue;
        d->size[d->label[c]]++;
        if (d->label[c] >= d->voids.count) d->voids.count = d->label[c] + 1;
    }
    for (int k = 0; k < MOST; k++) d->geometry[k] = 0.3 * d->size[k]; /* more than the cells */
    d->voids.label = d->label;
    d->voids.size = d->size;
}

/* From one drawing to the next. old: NULL at first */
static double follow(const drawing *before, drawing *d, double ambient)
{
    mps__pocket old_pocket[MOST];
    mps__pocket_old old = {0};
    double sum = 0;
    int32_t place[MOST] = {0};
    mps__pocket_now now = {.pocket = d->pocket,
                           .geometry = d->geometry,
                           .overlap = d->overlap,
                           .least = 8,
                           .ambient = ambient};
    if (before) {
        int32_t pockets = 0;
        d->head = before->head;
        for (int32_t k = 0; k < before->voids.count; k++) {
            place[k] = before->pocket[k].gas > 0 ? MPS__POCKET_FIRST + pockets : MPS__POCKET_NONE;
            if (before->pocket[k].gas > 0) old_pocket[pockets++] = before->pocket[k];
        }
        place[(int32_t)before->head.open] = MPS__POCKET_OPEN;
        d->head.pockets = pockets;
        d->head.runs = CELLS;
        for (int c = 0; c < CELLS; c++) {
            d->run[2 * c] = 1;
            d->run[2 * c + 1] = before->label[c] < 0 ? MPS__POCKET_NONE : place[before->label[c]];
        }
        old = (mps__pocket_old){&d->head, old_pocket, d->run};
    }
    mps__pocket_head head = d->head;
    mps__pocket_follow(&d->voids, &old, &now, &head);
    head.open = now.open;
    d->head = head;
    for (int k = 0; k < d->voids.count; k++) sum += d->pocket[k].gas;
    ASSERT_NEAR(sum, head.closed - head.vented, 1e-12);
    assert_true(d->pocket[now.open].gas == 0);
    return sum;
}

static const char open_air[] = "0000000000000000"
                               "0000000000000000"
                               "0000000000000000"
                               "0000000000000000"
                               "################"
                               "################";
static const char one[] = "0000000000000000"
                          "################"
                          "####11111111####"
                          "####11111111####"
                          "################"
                          "################";
static const char two[] = "0000000000000000"
                          "################"
                          "####1111##22####"
                          "####1111##22####"
                          "################"
                          "################";
static const char opened[] = "0000000000000000"
                             "####0000########"
                             "####0000##11####"
                             "####0000##11####"
                             "################"
                             "################";

/* A pocket closes with the gas of its volume, at the pressure that the ambient has. */
static void closes(void **state)
{
    (void)state;
    drawing a, b;
    draw(&a, open_air);
    ASSERT_NEAR(follow(NULL, &a, 1), 0, 0);
    draw(&b, one);
    ASSERT_NEAR(follow(&a, &b, 1.25), 1.25 * 0.3 * 16, 1e-14);
    ASSERT_NEAR(b.pocket[1].volume, 0.3 * 16, 1e-14);
    ASSERT_NEAR(b.pocket[1].number, 1, 0);
    assert_int_equal((int)b.head.open, 0);
}

/* Halves that were liquid before have no gas; small ones do not close. */
static void opens_inside(void **state)
{
    (void)state;
    drawing a, b;
    char small[CELLS + 1], full[CELLS + 1];
    memcpy(full, open_air, sizeof full);
    for (int c = WIDTH; c < CELLS; c++) full[c] = '#';
    draw(&a, full);
    follow(NULL, &a, 1);
    draw(&b, one);
    ASSERT_NEAR(follow(&a, &b, 1), 0, 0);
    memcpy(small, one, sizeof small);
    for (int c = 2 * WIDTH + 7; c < CELLS; c++) small[c] = '#';
    draw(&a, open_air);
    follow(NULL, &a, 1);
    draw(&b, small);
    ASSERT_NEAR(follow(&a, &b, 1), 0, 0);
}

static void splits_and_joins(void **state)
{
    (void)state;
    drawing a, b, c, d;
    draw(&a, open_air);
    follow(NULL, &a, 1);
    draw(&b, one);
    const double all = follow(&a, &b, 1);
    b.pocket[1].volume *= 0.5; /* compressed: both parts keep the pressure */
    draw(&c, two);
    ASSERT_NEAR(follow(&b, &c, 1), all, 1e-14);
    ASSERT_NEAR(c.pocket[1].gas, all * 2 / 3, 1e-14);
    ASSERT_NEAR(c.pocket[1].gas / c.pocket[1].volume, 2, 1e-14);
    ASSERT_NEAR(c.pocket[2].gas / c.pocket[2].volume, 2, 1e-14);
    ASSERT_NEAR(c.pocket[1].number, 1, 0);
    ASSERT_NEAR(c.pocket[2].number, 2, 0);
    draw(&d, one);
    ASSERT_NEAR(follow(&c, &d, 1), all, 1e-14);
    ASSERT_NEAR(d.pocket[1].number, 1, 0);
    ASSERT_NEAR(d.head.vented, 0, 0);
}

static void vents(void **state)
{
    (void)state;
    drawing a, b, c, d, e;
    draw(&a, open_air);
    follow(NULL, &a, 1);
    draw(&b, one);
    const double all = follow(&a, &b, 1);
    draw(&c, two);
    follow(&b, &c, 1);
    draw(&d, opened);
    ASSERT_NEAR(follow(&c, &d, 1), all / 3, 1e-14);
    ASSERT_NEAR(d.head.vented, all * 2 / 3, 1e-14);
    draw(&e, open_air);
    ASSERT_NEAR(follow(&d, &e, 1), 0, 0);
    ASSERT_NEAR(e.head.vented, all, 1e-14);
}

/* The ambient stays the ambient when a pocket grows larger than it. */
static void grows(void **state)
{
    (void)state;
    drawing a, b, c;
    char large[CELLS + 1];
    draw(&a, open_air);
    follow(NULL, &a, 1);
    draw(&b, one);
    const double all = follow(&a, &b, 1);
    for (int k = 0; k < CELLS; k++)
        large[k] = k < WIDTH ? '1' : k < 2 * WIDTH || k % WIDTH < 2 ? '#' : '0';
    large[CELLS] = 0;
    draw(&c, large);
    ASSERT_NEAR(follow(&b, &c, 1), all, 1e-14);
    assert_int_equal((int)c.head.open, 1);
    ASSERT_NEAR(c.pocket[0].gas, all, 1e-14);
}

/* p = P [(V0/V)^e - 1] */
static void law(void **state)
{
    (void)state;
    const double k[] = {1e5, 1.4, 4, 0};
    ASSERT_NEAR(mps__pocket_pressure(k, 2, 2), 0, 0);
    ASSERT_NEAR(mps__pocket_pressure(k, 2, 1), 1e5 * (pow(2, 1.4) - 1), 1e-9 * 1e5);
    ASSERT_NEAR(mps__pocket_pressure(k, 1, 2), 1e5 * (pow(0.5, 1.4) - 1), 1e-9 * 1e5);
    ASSERT_NEAR(mps__pocket_pressure(k, 1, -1), mps__pocket_pressure(k, 1, 0), 0);
    ASSERT_NEAR(mps__pocket_pressure(k, 0, 1), 0, 0);
    assert_true(isfinite(mps__pocket_pressure(k, 1, 0)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(closes),
                                       cmocka_unit_test(opens_inside),
                                       cmocka_unit_test(splits_and_joins),
                                       cmocka_unit_test(vents),
                                       cmocka_unit_test(grows),
                                       cmocka_unit_test(law)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
