/* SPDX-License-Identifier: BSD-3-Clause */
#include "drive.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DRIVE_SETTINGS = 16 };

struct build_drive {
    const mps_drive_ops *ops;
    double setting[DRIVE_SETTINGS];
};

/* "magnet.strength": settings of models have the same form. */
static const tree_node *setting_of(const build *b, const mps_drive_ops *ops, const char *key)
{
    char name[96];
    snprintf(name, sizeof name, "%s.%s", ops->name, key);
    return mps__tree_find(mps__tree_find(b->root, "settings"), name);
}

const build_drive *mps__drive_read(build *b, const tree_node *map, int32_t kind)
{
    const char *name = mps__read_text(b->c, map, "plugin", NULL);
    const mps_drive_ops *ops = name ? mps__plugins_drive(b->c, name, kind, NULL, 0) : NULL;
    build_drive *d = ops ? mps__build_alloc(b, sizeof *d) : NULL;
    if (!d) return NULL;
    d->ops = ops;
    for (int32_t k = 0; k < ops->setting_count; k++) {
        const tree_node *node = setting_of(b, ops, ops->settings[k].key);
        d->setting[k] = node ? mps__read_setting(b->c, node, ops->settings[k].initial)
                             : ops->settings[k].initial;
    }
    return d;
}

bool mps__drive_has(const build *b, const char *key)
{
    const mps_drive_ops *ops;
    for (int32_t k = 0; (ops = mps__plugins_drive_at(b->c, k)) != NULL; k++) {
        const size_t length = strlen(ops->name);
        if (strncmp(key, ops->name, length) == 0 && key[length] == '.') return true;
    }
    return false;
}

double mps__drive_period(const build_drive *d)
{
    const double period = d && d->ops->period ? d->ops->period(d->setting) : 0;
    return period > 0 ? period : INFINITY;
}

int mps__drive_motion(void *drive, double t, mps_motion_state *state)
{
    const build_drive *d = drive;
    return d->ops->motion(d->ops->user, d->setting, t, state);
}

int mps__drive_load(const build_drive *d, double t, const mps_motion_state *state, double load[6])
{
    double own[6] = {0};
    const int failed = d->ops->load(d->ops->user, d->setting, t, state, own);
    for (int k = 0; k < 6; k++) load[k] += own[k];
    return failed;
}
