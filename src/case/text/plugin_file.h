/* SPDX-License-Identifier: BSD-3-Clause */
/* A plug-in: its shared library, and what it registers. */
#ifndef MPS_CASE_PLUGIN_FILE_H
#define MPS_CASE_PLUGIN_FILE_H

#include "sha256.h"
#include <limits.h>
#include <mps/mps.h>
#include <mps/plugin.h>

enum { PLUGIN_NAME = 48, PLUGIN_ITEMS = 64, PLUGIN_HELP = 160, PLUGIN_WHY = 600 };

typedef struct plugin_item {
    int32_t kind; /* MPS_PLUGIN_... */
    char name[PLUGIN_NAME], help[PLUGIN_HELP];
    mps_drive_ops drive; /* of loads and motions */
} plugin_item;

struct mps_plugin_file {
    void *handle; /* from dlopen() */
    mps_status (*begin)(mps_registry *r);
    char path[PATH_MAX];
    char sha256[SHA256_TEXT];
    char name[PLUGIN_NAME], version[PLUGIN_NAME];
    int32_t items;
    plugin_item item[PLUGIN_ITEMS];
};

/* Why a call failed; the first reason is kept. */
typedef struct plugin_why {
    mps_status status; /* MPS_OK: no failure */
    char text[PLUGIN_WHY];
} plugin_why;

/* Record a failure. @return false */
bool mps__plugin_fail(plugin_why *why, mps_status status, const char *format, ...);
/* Inspect a file and load it: path, checksum, handle and function of the plug-in. */
bool mps__plugin_load(mps_plugin_file *p, const char *path, plugin_why *why);
/* Call the function of the plug-in: it registers its tables on `sim`, and its items in the plug-in
 * if `list` is set. */
bool mps__plugin_call(mps_plugin_file *p, mps_sim *sim, bool list, plugin_why *why);

#endif
