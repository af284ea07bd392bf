/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads constants of the statistics from a text through the table of keys. */
#include "read.h"
#include "statistics.h"
#include "tree.h"
#include "units.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char group[] = "impacts";

/* Refuse a text that is no constant, and propose the most similar key. */
static mps_status refuse(const mps_stats_config *config, const char *text)
{
    char name[80], near[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(text, "="), text);
    const char *known = mps__key_nearest(mps__key_at(group), name, near, sizeof near);
    mps__stats_fail(config, MPS_E_ARG,
                    "'%.80s' is no constant of the statistics; %s%s%s'%s.KEY=VALUE' is wanted, "
                    "e.g. '%s.threshold=6 kPa'",
                    text, known ? "did you mean 'impacts." : "", known ? known : "",
                    known ? "'? " : "", group, group);
    return MPS_E_ARG;
}

/* Report the message of the case about the text, without the last newline. */
static mps_status refuse_case(const mps_stats_config *config, const mps_case *c)
{
    const size_t size = mps_case_messages_write(c, NULL, 0) + 1;
    char *all = malloc(size);
    if (!all) return mps__stats_no_memory(config);
    mps_case_messages_write(c, all, size);
    all[strcspn(all, "\n")] = '\0';
    mps__stats_fail(config, MPS_E_ARG, "%s", all);
    free(all);
    return MPS_E_ARG;
}

static mps_status put_sensors(mps_case *c, const tree_node *map, mps_stats_config *config)
{
    char names[sizeof config->sensors + 1] = "";
    const char *name;
    size_t used = 0;
    for (int32_t k = 0; (name = mps__read_text_at(c, map, "sensors", k)) && used < sizeof names;
         k++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", k ? "; " : "", name);
    return mps__stats_put_sensors(config, names);
}

static mps_status put_all(mps_case *c, mps_stats_config *config)
{
    const tree_node *map = mps__tree_find(mps__case_root(c), group);
    mps_status status = MPS_OK;
    mps__case_scale_set(c, (read_scale){NAN, config->period, NAN});
    for (const tree_node *n = map ? map->first : NULL; n && status == MPS_OK; n = n->next) {
        char key[80];
        if (n->entry->shape == SHAPE_TEXTS) {
            status = put_sensors(c, map, config);
            continue;
        }
        const double value = mps__read_number(c, map, n->key, NAN);
        snprintf(key, sizeof key, "%s.%s", group, n->key);
        if (!mps__case_failed(c)) mps__stats_put(config, key, value);
    }
    if (c->no_memory) return mps__stats_no_memory(config);
    return status == MPS_OK && mps__case_failed(c) ? refuse_case(config, c) : status;
}

mps_status mps_stats_config_set(mps_stats_config *config, const char *text)
{
    /* minimal valid case; the text is checked as part of it */
    static const char around[] = "mps: 1\ndp: 1 m\ntank: {size: 1 1 m}\n"
                                 "fill: [{water: {depth: 1 m}}]\nrun: {until: 1 s}\n";
    mps_case *c = NULL;
    const size_t length = sizeof group - 1;
    MPS__STATS_TRY(mps__stats_check(config));
    MPS__STATS_CHECK(config, text, "text is required");
    if (strncmp(text, group, length) != 0 || !strchr(".=", text[length]) || !text[length])
        return refuse(config, text);
    mps_stats_config taken = *config;
    mps_status status = mps_case_read_text(around, sizeof around - 1, "", 1, &text, &c);
    if (status == MPS_OK)
        status = put_all(c, &taken);
    else if (c)
        status = refuse_case(config, c);
    else
        mps__stats_no_memory(config);
    mps_case_destroy(c);
    MPS__STATS_TRY(status);
    MPS__STATS_TRY(mps__stats_check(&taken));
    *config = taken;
    return MPS_OK;
}
