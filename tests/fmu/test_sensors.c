/* SPDX-License-Identifier: BSD-3-Clause */
/* Sensors of a case as outputs of its FMU. */
#include "scene.h"
#include <stdlib.h>

enum { SENSORS = 3 };
static const uint32_t sensor_refs[SENSORS] = {1024, 1025, 1026}; /* P1, left-wave, mid */

/* By probes of the library; the elevation above the still level. */
static void plain_sensors(const plain *p, double *value)
{
    static const char *const name[SENSORS] = {"P1", "left-wave", "mid"};
    mps_probe_info info;
    mps_probe_info_init(&info, sizeof info);
    for (int32_t id = 0, found = 0; mps_probe_info_get(p->sim, id, &info) == MPS_OK; id++)
        for (int k = 0; k < SENSORS; k++) {
            if (strcmp(info.name, name[k]) != 0) continue;
            assert_int_equal(mps_probe_read(p->sim, id, &value[k]), MPS_OK);
            if (++found == SENSORS) return;
        }
    fail_msg("a sensor of the case is no probe");
}

/* Values are those of the library; they are restored with states, also from bytes. */
void sensors(void **state)
{
    (void)state;
    for (int k = 0; k < MODULES; k++) {
        plain p = {.length = 0};
        tank t;
        void *kept = NULL, *read = NULL;
        size_t size = 0;
        double time = 0, expected[SENSORS], got[SENSORS], first[SENSORS], loads[OUTPUTS];
        const double seed = 1, value = 1;
        plain_open(&p);
        open_tank(&t, modules[k]);
        OK(&t, tank_start(&t, 0));
        OK(&t, tank_get(&t, sensor_refs, SENSORS, got));
        assert_true(got[0] == 0 && got[2] == 0 && isfinite(got[1]));
        for (int step = 0; step < STEPS; step++, time += LENGTH) {
            double q[INPUTS];
            pose_at(time + LENGTH, q);
            move(&t, time, LENGTH, q, loads);
            plain_move(&p, time + LENGTH, loads);
            OK(&t, tank_get(&t, sensor_refs, SENSORS, got));
            plain_sensors(&p, expected);
            assert_true(got[0] == expected[0] && got[2] == expected[2]);
        }
        print_message("P1 %.1f Pa, wave %.2g m, mid %.1f Pa\n", got[0], got[1], got[2]);
        assert_true(fabs(got[0] / (9.81 * 1000 * 0.15) - 1) < 0.1);
        assert_true(fabs(got[2] / (9.81 * 1000 * 0.1) - 1) < 0.1);
        assert_true(got[1] != 0 && fabs(got[1]) < 0.02);
        assert_true(fabs(expected[1] - got[1] - 0.2) < 0.02); /* the still level */
        OK(&t, tank_state_take(&t, &kept));
        OK(&t, tank_state_size(&t, kept, &size));
        char *bytes = malloc(size);
        assert_non_null(bytes);
        OK(&t, tank_state_write(&t, kept, bytes, size));
        go(&t, time, 1, loads);
        OK(&t, tank_get(&t, sensor_refs, SENSORS, first));
        assert_true(first[0] != got[0]);
        OK(&t, tank_state_read(&t, bytes, size, &read));
        for (int way = 0; way < 2; way++) {
            OK(&t, tank_state_put(&t, way ? read : kept));
            OK(&t, tank_get(&t, sensor_refs, SENSORS, expected));
            assert_memory_equal(expected, got, sizeof got);
            go(&t, time, 1, loads);
            OK(&t, tank_get(&t, sensor_refs, SENSORS, expected));
            assert_memory_equal(expected, first, sizeof first);
        }
        assert_int_equal(tank_set(&t, sensor_refs, 1, &value), 3); /* no input */
        assert_int_equal(tank_derivative(&t, sensor_refs, 1, &pose_refs[6], 1, &seed, got), 2);
        assert_int_equal(tank_get(&t, &(uint32_t){1027}, 1, got), 3);
        free(bytes);
        tank_close(&t);
        plain_close(&p);
    }
}
