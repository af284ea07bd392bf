/* SPDX-License-Identifier: BSD-3-Clause */
/* Each status has its own name and text, and the library returns its version. */
#include "tank_fixture.h"
#include <stdio.h>

static const mps_status all[] = {
#define ONE(name, value, text) name,
    MPS_STATUS_LIST(ONE)
#undef ONE
};
enum { COUNT = sizeof all / sizeof all[0] };

static void names_and_texts(void **state)
{
    (void)state;
    for (int k = 0; k < COUNT; k++) {
        assert_true(strncmp(mps_status_name(all[k]), "MPS_", 4) == 0);
        assert_true(strlen(mps_status_text(all[k])) > 0);
        for (int j = 0; j < k; j++) {
            assert_string_not_equal(mps_status_name(all[k]), mps_status_name(all[j]));
            assert_string_not_equal(mps_status_text(all[k]), mps_status_text(all[j]));
        }
    }
}

static void unknown(void **state)
{
    (void)state;
    assert_non_null(strstr(mps_status_name((mps_status)-12345), "UNKNOWN"));
    assert_string_equal(mps_status_text((mps_status)-12345), "unknown status");
}

static void version(void **state)
{
    (void)state;
    int major = -1, minor = -1, patch = -1;
    char text[40];
    assert_string_equal(mps_version(NULL, NULL, NULL), MPS_VERSION_STRING);
    assert_string_equal(mps_version(&major, &minor, &patch), MPS_VERSION_STRING);
    snprintf(text, sizeof text, "%d.%d.%d", major, minor, patch);
    assert_string_equal(text, MPS_VERSION_STRING);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(names_and_texts), cmocka_unit_test(unknown),
                                       cmocka_unit_test(version)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
