/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of checkpoints. */
#include "checkpoint.h"
#include "collect.h"
#include <mps/output.h>
#include <string.h>

static const char setup_part[] = "set-up";

/* Text of the set-up, allocated. */
static mps_status make_setup(mps_sim *sim, mps__text *text)
{
    *text = (mps__text){NULL, 0};
    mps__setup_text(sim, text);
    text->data = mps__alloc(&sim->context, text->size, 1);
    if (!text->data) return MPS_E_NOMEM;
    text->size = 0;
    mps__setup_text(sim, text);
    return MPS_OK;
}

static mps_status save_all(mps_sim *sim, const char *path)
{
    mps__archive a = {.context = &sim->context};
    mps__text setup;
    mps_status status = make_setup(sim, &setup);
    if (status == MPS_OK) status = mps__archive_create(&a, path);
    if (status == MPS_OK) {
        mps__archive_put(&a, setup_part, setup.data, 1, setup.size);
        mps__state_put(sim, &a);
        status = mps__archive_save(&a, path);
    }
    mps__free(&sim->context, setup.data);
    mps__archive_free(&a);
    return status;
}

mps_status mps_checkpoint_write(mps_sim *sim, const char *path)
{
    MPS__MEASURES(sim);
    mps__context *c = &sim->context;
    MPS__CHECK(c, path && path[0], "the path of the checkpoint is NULL or empty");
    for (int32_t k = 0; k < sim->world.particles.fields; k++)
        if (sim->world.particles.field[k].writer)
            return mps__fail(c, MPS_E_BUSY, "field \"%s\" is leased for writing",
                             sim->world.particles.field[k].name);
    mps__ranks *r = &sim->world.ranks;
    MPS__TRY(mps__world_fetch(&sim->world));
    MPS__TRY(mps__world_fetch_searched(&sim->world));
    MPS__TRY(mps__ranks_report(r, mps__collect_all(&sim->world)));
    const mps_status status = r->rank == 0 ? save_all(sim, path) : MPS_OK;
    mps__collect_end(&sim->world);
    return mps__ranks_agree(r, status);
}

mps_status mps_checkpoint_note_add(mps_sim *sim, const char *text)
{
    MPS__SETS(sim);
    mps__context *c = &sim->context;
    MPS__CHECK(c, text && text[0], "the line of a checkpoint is NULL or empty");
    MPS__CHECK(c, strlen(text) < MPS__NOTE_SIZE && !strpbrk(text, "\n\r"),
               "a line of a checkpoint has at most %d characters and no end of line",
               MPS__NOTE_SIZE - 1);
    MPS__CHECK(c, sim->notes < MPS__NOTES, "a checkpoint has at most %d lines of its caller",
               MPS__NOTES);
    mps__name_copy(sim->note[sim->notes++], MPS__NOTE_SIZE, text);
    return MPS_OK;
}

static mps_status check_setup(mps_sim *sim, const mps__archive *a)
{
    mps__text here;
    int64_t size;
    const char *saved = mps__archive_get(a, setup_part, 1, &size);
    if (!saved) return MPS_E_VERSION;
    MPS__CHECK(&sim->context, size > 0 && saved[size - 1] == 0,
               "the checkpoint's \"%s\" does not end", setup_part);
    mps_status status = make_setup(sim, &here);
    if (status == MPS_OK) status = mps__setup_compare(&sim->context, saved, here.data);
    mps__free(&sim->context, here.data);
    return status;
}

mps_status mps_checkpoint_read(mps_sim *sim, const char *path)
{
    MPS__STEPS(sim); /* all fields are replaced, also those valid only on a device */
    mps__context *c = &sim->context;
    MPS__CHECK(c, path && path[0], "the path of the checkpoint is NULL or empty");
    const int32_t open = mps__particles_leases(&sim->world.particles);
    if (open)
        return mps__fail(c, MPS_E_BUSY,
                         "%d lease(s) are open; end them before reading a checkpoint", open);
    mps__ranks *r = &sim->world.ranks;
    if (mps__world_divided(&sim->world))
        return mps__fail(c, MPS_E_STATE,
                         "the ranks have divided the particles: read a checkpoint before the first "
                         "step, and before anything is measured");
    mps__archive a = {.context = c};
    mps_status status = mps__ranks_agree(r, mps__archive_load(&a, path));
    if (status == MPS_OK) status = mps__ranks_agree(r, check_setup(sim, &a));
    if (status == MPS_OK) status = mps__state_get(sim, &a);
    mps__archive_free(&a);
    /* if one rank is out of memory, the others already have the state of the file */
    return status == MPS_E_NOMEM ? mps__ranks_report(r, status) : status;
}
